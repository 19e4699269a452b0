/* Caustics of path tracing by photons (path/caustic.h): pt_start_caustics; per segment (rays traced) pt_walk_caustics.
 * They come between a vertex and the path's next ray, whose place in BUFFER_RAYS they use, so that path tracing's own
 * kernels see no ray after them, and after its shadow ray, whose place in BUFFER_SHADOWS is free. */
#ifndef TWINLIGHT_CAUSTIC_CL
#define TWINLIGHT_CAUSTIC_CL

#include "path/caustic.h"

/* From: the vertex. To: the first ray. */
__kernel void pt_start_caustics(__global const FrameParams *restrict frame, __global const uint *restrict photons,
                                __global const uint *restrict geometry, __global const uint *restrict tables,
                                __global const uint *restrict texels, __global uint *restrict paths,
                                __global uint *restrict rays)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (state_load(paths, stride, PATH_DEPTH, item) == 0u)
        return;
    KERNEL_SCENE_PHOTONS(frame, 0, photons, geometry, tables, texels);
    caustic_begin(scene, paths, rays, item);
}

/* Takes the caustic path, with throughput *beta, through the media before its hit: gathers its light at a point, which
 * is on the way. */
SHARED_FUNCTION_APART void caustic_pass_media(const SceneView *scene, __global uint *restrict paths,
                                              __global uint *restrict shadows, __global const uint *restrict hits,
                                              uint item, Vec3 *beta)
{
    uint stride = scene->frame->pass.stride;
    if (SCENE_HAS(scene, FEATURE_DELTA_LIGHT))
        caustic_gather(scene->frame, paths, item, state_load(paths, stride, PATH_CAUSTIC_SEGMENTS, item),
                       vec3_mul(*beta, caustic_shadow_radiance(scene, paths, shadows, item)), 1.0f);
    /* Its directions are drawn for paths that pass unscattered. */
    *beta = vec3_mul(*beta, transmittance(hit_depth(hits, stride, item).all));
    state_store_vec3(paths, stride, PATH_CAUSTIC_BETA, item, *beta);
}

/* From: closest hits, traced shadow rays. To: the light that was hit, gathered; shadow rays cleared; the next ray, or
 * none. */
__kernel void pt_walk_caustics(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                               __global const uint *restrict tables, __global const uint *restrict texels,
                               __global uint *restrict paths, __global uint *restrict rays,
                               __global uint *restrict shadows, __global const uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count || !(state_load_float(rays, stride, RAY_T_MAX, item) > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Ray whole = ray_load(rays, stride, item), ray = ray_last_part(scene, hits, stride, item, whole);
    Hit hit = hit_load(hits, stride, item);
    Vec3 beta = state_load_vec3(paths, stride, PATH_CAUSTIC_BETA, item);
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        caustic_pass_media(scene, paths, shadows, hits, item, &beta);
    Surface surface = {0};
    if (hit.primitive != NONE)
        surface = surface_from_hit(scene, &ray, hit);
    uint segments = state_load(paths, stride, PATH_CAUSTIC_SEGMENTS, item);
    if (segments > state_load(paths, stride, PATH_DEPTH, item) + 1u) {
        float alpha;
        Vec3 light = caustic_radiance(scene, state_load(paths, stride, PATH_CAUSTIC_LIGHT, item),
                                      hit.primitive == NONE ? whole : ray, hit, &surface, &alpha);
        caustic_gather(frame, paths, item, segments, vec3_mul(light, beta), alpha);
    }
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (hit.primitive != NONE &&
        caustic_continue(scene, paths, rays, item, &surface, ray.d, hit_medium(scene, hits, stride, item)) &&
        SCENE_HAS(scene, FEATURE_MEDIUM) && SCENE_HAS(scene, FEATURE_DELTA_LIGHT))
        caustic_shadow_store(scene, paths, rays, shadows, item);
}

#endif
