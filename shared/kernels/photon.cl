/* Light subpaths through smooth specular surfaces, of which photons are made (host/render/photon_map.c): photon_start;
 * per segment (rays traced) photon_walk; photon_end. A subpath is drawn from the lights, or follows the ray that it is
 * given with the choices of lobes of another. Photons only say where light comes from, so media neither scatter nor
 * attenuate these subpaths: all of their rays begin in medium 0. */
#ifndef TWINLIGHT_PHOTON_CL
#define TWINLIGHT_PHOTON_CL

#include "layout/pass_data.h"
#include "light/aim.h"
#include "path/caustic.h"
#include "path/photon_path.h"

/* The subpath's random numbers; block 0: which light, and 1: point and direction. */
SHARED_FUNCTION Random4 photon_random(__global const FrameParams *frame, uint number, uint block)
{
    return random_four(number, block, 0u, PATH_STREAM_PHOTON, frame->pass.seed_low, frame->pass.seed_high);
}

/* Turns what a light emits to go through a point; false if it emits nothing that way. From infinity: from outside the
 * scene, in the direction that was drawn. */
SHARED_FUNCTION bool photon_aim(const SceneView *scene, uint light, Vec3 through, LightEmission *emission)
{
    if (light_kind(scene->lights + light) >= LIGHT_DISTANT) {
        emission->p = vec3_mad(through, -2.0f * scene->frame->scene.world_radius, emission->w);
        return true;
    }
    emission->w = vec3_normalize(vec3_sub(through, emission->p));
    return light_emit_pdf_w(scene, light, emission->ng, emission->w) > 0.0f;
}

/* Draws the first ray of a subpath, perhaps aimed through a point; false if the light emits nothing there. */
SHARED_FUNCTION bool photon_emit(const SceneView *scene, uint number, bool aimed, Vec3 through, Ray *ray, uint *light)
{
    Random4 choice = photon_random(scene->frame, number, 0u), random = photon_random(scene->frame, number, 1u);
    LightEmission emission = {0};
    *light = light_select(scene, choice.x[0], choice.x[1]);
    /* No direction that photons draw would hit it. */
    if (light_is_invisible(scene, *light))
        return false;
    if (!light_emit_aimed(scene, *light, random_float(choice.x[2]),
                          vec2(random_float(random.x[0]), random_float(random.x[1])),
                          vec2(random_float(random.x[2]), random_float(random.x[3])), &emission) ||
        (aimed && !photon_aim(scene, *light, through, &emission)))
        return false;
    bool on_surface = emission.infinite == 0u && emission.delta_position == 0u;
    *ray = ray_spawn(emission.p, on_surface ? emission.ng : vec3_splat(0.0f), emission.w);
    return true;
}

/* From: BUFFER_PASS. To: the first ray. */
__kernel void photon_start(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                           __global const uint *restrict tables, __global const uint *restrict texels,
                           __global const uint *restrict pass, __global uint *restrict paths,
                           __global uint *restrict rays)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    for (uint i = 0u; i < PHOTON_PATH_VERTICES; ++i)
        state_store(paths, stride, i, item, pass_load(frame, pass, i, item));
    Vec3 origin = state_load_vec3(paths, stride, PHOTON_PATH_ORIGIN, item);
    Ray ray = ray_spawn(origin, vec3_splat(0.0f), state_load_vec3(paths, stride, PHOTON_PATH_FIRST, item));
    uint number = state_load(paths, stride, PHOTON_PATH_NUMBER, item);
    uint light = state_load(paths, stride, PHOTON_PATH_EMITTER, item);
    bool aimed = light == PHOTON_AIMED, given = light != NONE && !aimed;
    bool begun = given || photon_emit(scene, number, aimed, origin, &ray, &light);
    state_store(paths, stride, PHOTON_PATH_EMITTER, item, light);
    state_store(paths, stride, PHOTON_PATH_VERTICES, item, 0u);
    state_store(paths, stride, PHOTON_PATH_LOBES, item, 0u);
    state_store(paths, stride, PHOTON_PATH_ARRIVED, item, 0u);
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (!begun || !ray_traceable(ray.o, ray.d))
        return;
    state_store_vec3(paths, stride, PHOTON_PATH_ORIGIN, item, ray.o);
    state_store_vec3(paths, stride, PHOTON_PATH_FIRST, item, ray.d);
    ray_store(rays, stride, item, ray);
    ray_medium_store(scene, rays, stride, item, 0u);
}

/* From: closest hits. To: the next ray, or where the subpath has arrived. */
__kernel void photon_walk(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                          __global const uint *restrict tables, __global const uint *restrict texels,
                          __global uint *restrict paths, __global uint *restrict rays,
                          __global const uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count || !(state_load_float(rays, stride, RAY_T_MAX, item) > 0.0f))
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Ray ray = ray_last_part(scene, hits, stride, item, ray_load(rays, stride, item));
    Hit hit = hit_load(hits, stride, item);
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (hit.primitive == NONE)
        return;
    Surface surface = surface_from_hit(scene, &ray, hit);
    uint vertices = state_load(paths, stride, PHOTON_PATH_VERTICES, item);
    uint lobes = state_load(paths, stride, PHOTON_PATH_LOBES, item);
    Random4 random = photon_random(frame, state_load(paths, stride, PHOTON_PATH_NUMBER, item), 2u + vertices);
    DeltaScatter scatter;
    if (delta_scatter(scene, &surface, ray.d, 0u, TRANSPORT_IMPORTANCE, random, &scatter)) {
        if (vertices < CAUSTIC_VERTICES) {
            ray_store(rays, stride, item, scatter.ray);
            ray_medium_store(scene, rays, stride, item, 0u);
        }
        state_store(paths, stride, PHOTON_PATH_VERTICES, item, vertices + 1u);
        state_store(paths, stride, PHOTON_PATH_LOBES, item, lobes | (scatter.transmitted ? 1u << vertices : 0u));
    } else if (!scatter.smooth && vertices > 0u) {
        state_store(paths, stride, PHOTON_PATH_ARRIVED, item, 1u);
        state_store_vec3(paths, stride, PHOTON_PATH_POINT, item, surface.p);
        state_store_vec3(paths, stride, PHOTON_PATH_LAST, item, ray.d);
    }
}

/* From: the finished subpath. To: BUFFER_PASS; of one that has not arrived, only that. */
__kernel void photon_end(__global const FrameParams *restrict frame, __global const uint *restrict paths,
                         __global uint *restrict pass)
{
    uint item = (uint)get_global_id(0);
    if (item >= frame->pass.item_count)
        return;
    uint stride = frame->pass.stride;
    pass_store(frame, pass, PHOTON_PATH_ARRIVED, item, state_load(paths, stride, PHOTON_PATH_ARRIVED, item));
    for (uint i = 0u; i < PHOTON_PATH_WORDS && state_load(paths, stride, PHOTON_PATH_ARRIVED, item) != 0u; ++i)
        pass_store(frame, pass, i, item, state_load(paths, stride, i, item));
}

#endif
