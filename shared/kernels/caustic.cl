/* Caustics of path tracing by photons (path/caustic.h): pt_start_caustics; per segment (rays traced) pt_walk_caustics.
 * They come between a vertex and the path's next ray, whose place in BUFFER_RAYS they use, so that path tracing's own
 * kernels see no ray after them. */
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

/* From: closest hits. To: the light that was hit, gathered; the next ray, or none. */
__kernel void pt_walk_caustics(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                               __global const uint *restrict tables, __global const uint *restrict texels,
                               __global uint *restrict paths, __global uint *restrict rays,
                               __global const uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count || !(state_load_float(rays, stride, RAY_T_MAX, item) > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Ray whole = ray_load(rays, stride, item), ray = ray_last_part(scene, hits, stride, item, whole);
    Hit hit = hit_load(hits, stride, item);
    Vec3 beta = state_load_vec3(paths, stride, PATH_CAUSTIC_BETA, item);
    if (SCENE_HAS(scene, FEATURE_MEDIUM)) { /* its directions are drawn for paths that pass unscattered */
        beta = vec3_mul(beta, transmittance(hit_depth(hits, stride, item).all));
        state_store_vec3(paths, stride, PATH_CAUSTIC_BETA, item, beta);
    }
    Surface surface = {0};
    if (hit.primitive != NONE)
        surface = surface_from_hit(scene, &ray, hit);
    uint segments = state_load(paths, stride, PATH_CAUSTIC_SEGMENTS, item);
    if (segments > state_load(paths, stride, PATH_DEPTH, item) + 1u) {
        Vec3 light = caustic_radiance(scene, state_load(paths, stride, PATH_CAUSTIC_LIGHT, item),
                                      hit.primitive == NONE ? whole : ray, hit, &surface);
        light = vec3_mul(light, beta);
        state_store_vec3(paths, stride, PATH_CAUSTIC_RADIANCE, item,
                         vec3_add(light, state_load_vec3(paths, stride, PATH_CAUSTIC_RADIANCE, item)));
    }
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (hit.primitive != NONE)
        caustic_continue(scene, paths, rays, item, &surface, ray.d, hit_medium(scene, hits, stride, item));
}

#endif
