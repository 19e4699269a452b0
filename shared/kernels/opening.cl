/* Camera subpaths that are connected to lights at infinity, by whose last rays openings are found
 * (host/render/openings.c): opening_start; per segment (rays traced) opening_walk; opening_end. They only say where
 * light comes from, so every receiver is a white diffuse reflector, smooth specular surfaces let connections pass, and
 * media neither scatter nor attenuate. */
#ifndef TWINLIGHT_OPENING_CL
#define TWINLIGHT_OPENING_CL

#include "camera/view.h"
#include "layout/pass_data.h"
#include "light/light.h"
#include "path/bd_start.h"
#include "path/caustic.h"
#include "path/opening_path.h"

/* A subpath's random numbers after `segments` segments: at the start, 0: film and lens, 1: number of receivers; at a
 * surface, 0: its lobe, 1: direction of a receiver or of its connection. split: whether they are its own. */
SHARED_FUNCTION Random4 opening_random(__global const FrameParams *frame, uint number, bool split, uint segments,
                                       uint which)
{
    return random_four(split ? number : number / OPENING_SPLITS, segments, split ? 2u + which : which,
                       PATH_STREAM_OPENING, frame->pass.seed_low, frame->pass.seed_high);
}

/* From: BUFFER_PASS. To: the first ray. */
__kernel void opening_start(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global const uint *restrict pass, __global uint *restrict paths,
                            __global uint *restrict rays)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    uint number = pass_load(frame, pass, OPENING_PATH_NUMBER, item);
    Random4 random = opening_random(frame, number, false, 0u, 0u);
    /* those of light that is reflected once matter most: connections to lights find direct light */
    uint bits = opening_random(frame, number, false, 0u, 1u).x[0];
    uint receivers = bits < 0x40000000u ? 0u : bits < 0xc0000000u ? 1u : bits < 0xe0000000u ? 2u : 3u;
    Ray ray = view_ray(scene, film_position(frame, random.x[0], random.x[1]),
                       vec2(random_float(random.x[2]), random_float(random.x[3])));
    state_store(paths, stride, OPENING_PATH_NUMBER, item, number);
    state_store(paths, stride, OPENING_PATH_LIGHT, item, pass_load(frame, pass, OPENING_PATH_LIGHT, item));
    state_store(paths, stride, OPENING_PATH_RECEIVERS, item, receivers);
    state_store(paths, stride, OPENING_PATH_SEGMENTS, item, 0u);
    state_store(paths, stride, OPENING_PATH_SPLIT, item, 0u);
    state_store_float(paths, stride, OPENING_PATH_WEIGHT, item, 0.0f);
    state_store_vec3(paths, stride, OPENING_PATH_NORMAL, item, vec3_splat(0.0f));
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    if (!ray_traceable(ray.o, ray.d))
        return;
    ray_store(rays, stride, item, ray);
    ray_medium_store(scene, rays, stride, item, 0u);
}

/* The ray that connects a receiver to the light; false if the light does not shine on its side n. *weight: what the
 * light brings. */
SHARED_FUNCTION bool opening_connect(const SceneView *scene, const Surface *surface, Vec3 n, uint light, Random4 random,
                                     Ray *ray, float *weight)
{
    LightSample sample = {0};
    if (!light_sample(scene, light, surface->p, vec2(random_float(random.x[0]), random_float(random.x[1])), &sample))
        return false;
    *weight = rgb_luminance(sample.radiance) * vec3_dot(n, sample.wi) / sample.pdf_w;
    *ray = ray_spawn(surface->p, surface->ng, sample.wi);
    return *weight > 0.0f && float_finite(*weight) && ray_traceable(ray->o, ray->d);
}

/* What a subpath does at a receiver that its ray has hit: it goes on in a cosine-distributed direction, or is connected
 * to the light. False: it ends. */
SHARED_FUNCTION bool opening_receive(const SceneView *scene, __global uint *restrict paths, uint item,
                                     const Surface *surface, uint segments, Ray *ray)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, receivers = state_load(paths, stride, OPENING_PATH_RECEIVERS, item);
    uint number = state_load(paths, stride, OPENING_PATH_NUMBER, item);
    Vec3 n = vec3_dot(surface->ng, ray->d) > 0.0f ? vec3_negate(surface->ng) : surface->ng;
    if (receivers == OPENING_CONNECTING)
        return false;
    Random4 random = opening_random(frame, number, true, segments, 1u);
    if (state_load(paths, stride, OPENING_PATH_SPLIT, item) == 0u)
        state_store_vec3(paths, stride, OPENING_PATH_NORMAL, item, n);
    state_store(paths, stride, OPENING_PATH_SPLIT, item, 1u);
    if (receivers > 0u) {
        Vec2 u = vec2(random_float(random.x[0]), random_float(random.x[1]));
        Vec3 w = vec3_normalize(frame_to_world(frame_from_normal(n), warp_cosine_hemisphere(u)));
        *ray = ray_spawn(surface->p, surface->ng, w);
        state_store(paths, stride, OPENING_PATH_RECEIVERS, item, receivers - 1u);
        return ray_traceable(ray->o, ray->d);
    }
    float weight;
    uint light = state_load(paths, stride, OPENING_PATH_LIGHT, item);
    if (!opening_connect(scene, surface, n, light, random, ray, &weight))
        return false;
    state_store(paths, stride, OPENING_PATH_RECEIVERS, item, OPENING_CONNECTING);
    state_store_float(paths, stride, OPENING_PATH_WEIGHT, item, weight);
    return true;
}

/* From: closest hits. To: the next ray. A subpath whose connection is blocked has weight 0. */
__kernel void opening_walk(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
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
    uint segments = state_load(paths, stride, OPENING_PATH_SEGMENTS, item) + 1u;
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
    state_store(paths, stride, OPENING_PATH_SEGMENTS, item, segments);
    if (hit.primitive == NONE) {
        state_store_vec3(paths, stride, OPENING_PATH_ORIGIN, item, ray.o);
        state_store_vec3(paths, stride, OPENING_PATH_DIRECTION, item, ray.d);
        return; /* not on its way to the light: weight 0 */
    }
    Surface surface = surface_from_hit(scene, &ray, hit);
    uint number = state_load(paths, stride, OPENING_PATH_NUMBER, item);
    bool split = state_load(paths, stride, OPENING_PATH_SPLIT, item) != 0u;
    DeltaScatter scatter;
    bool goes_on = delta_scatter(scene, &surface, ray.d, 0u, TRANSPORT_RADIANCE,
                                 opening_random(frame, number, split, segments, 0u), &scatter);
    if (goes_on)
        ray = scatter.ray;
    else if (!scatter.smooth)
        goes_on = opening_receive(scene, paths, item, &surface, segments, &ray);
    if (!goes_on || segments == OPENING_SEGMENTS) {
        state_store_float(paths, stride, OPENING_PATH_WEIGHT, item, 0.0f);
        return;
    }
    ray_store(rays, stride, item, ray);
    ray_medium_store(scene, rays, stride, item, 0u);
}

/* From: the finished subpath. To: BUFFER_PASS. */
__kernel void opening_end(__global const FrameParams *restrict frame, __global const uint *restrict paths,
                          __global uint *restrict pass)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    for (uint i = OPENING_PATH_WEIGHT; i < OPENING_PATH_WORDS; ++i)
        pass_store(frame, pass, i, item, state_load(paths, stride, i, item));
}

#endif
