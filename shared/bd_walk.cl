/* Both walks of bidirectional path tracing (Veach 1997, chapter 10; Lafortune and Willems 1993), vertex by vertex. Per
 * segment: (rays traced) bd_shade_hits, bd_extend_walks; before them bd_start_light, then bd_start_camera. */
#ifndef TWINLIGHT_BD_WALK_CL
#define TWINLIGHT_BD_WALK_CL

#include "bd_random.h"
#include "bd_start.h"
#include "bd_walk.h"
#include "bd_weight.h"

/* From: nothing. To: the item's pixel and sample; y_0 and the light's first ray. */
__kernel void bd_start_light(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                             __global const uint *restrict tables, __global const uint *restrict texels,
                             __global uint *restrict paths, __global uint *restrict rays,
                             __global uint *restrict shadows, __global uint *restrict vertices,
                             __global uint *restrict densities, __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    bd_header_begin(frame, paths, rays, shadows, stride, t);
    state_store(paths, stride, BD_LENGTHS, t, 0u);
    state_store(paths, stride, BD_LIGHT_DELTA, t, 0u);
    state_store(paths, stride, BD_CAMERA_DELTA, t, 0u);
    state_store(paths, stride, BD_S, t, 2u);
    state_store(paths, stride, BD_T, t, 1u);
    if (frame->max_depth < 2u)
        return;
    float own;
    if (!walk_start_light(&scene, paths, rays, vertices, diagnostics, stride, t, vertex_base(frame, SIDE_LIGHT, 0u),
                          &own))
        return;
    state_store_float(densities, stride, density_base(frame, SIDE_LIGHT, 0u) + DENSITY_OWN, t, own);
    state_store(paths, stride, BD_LENGTHS, t, 1u);
}

/* From: nothing more than the pixel. To: the camera's first ray. */
__kernel void bd_start_camera(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    walk_start_camera(&scene, paths, rays, diagnostics, stride, t);
}

/* What the vertex before knows of the way back to it: see BD_BACK. */
SHARED_FUNCTION float walk_way_back(__global const FrameParams *frame, __global const uint *restrict paths,
                                    __global const uint *restrict vertices, uint stride, uint t, uint side, uint depth,
                                    Vec3 p)
{
    if (side == SIDE_CAMERA && depth == 1u)
        return 1.0f; /* the lens: never asked for */
    uint base = vertex_base(frame, side, depth - 1u);
    uint flags = side == SIDE_LIGHT && depth == 1u ? state_load(paths, stride, BD_EMITTER_FLAGS, t) : 0u;
    return walk_back(p, state_load_vec3(vertices, stride, base + VERTEX_POINT, t),
                     state_load_vec3(vertices, stride, base + VERTEX_NG, t), flags);
}

/* s = 0 at everything at infinity: the camera's walk has met nothing after `depth` segments. */
SHARED_FUNCTION Vec3 walk_environment(const SceneView *scene, DensityView view, Vec3 d, Vec3 ng, uint depth)
{
    Vec3 sum = vec3_splat(0.0f);
    for (uint i = 0; i < scene->frame->infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 radiance = environment_met(scene, scene->infinite_lights[i], d, ng, &ends);
        if (!vec3_is_zero(radiance))
            sum = vec3_mad(sum, bd_weight(scene->frame, 0u, depth + 1u, &view, &ends), radiance);
    }
    return sum;
}

SHARED_FUNCTION void bd_add_radiance(__global uint *restrict paths, uint stride, uint t, Vec3 radiance)
{
    Vec3 sum = state_load_vec3(paths, stride, BD_RADIANCE, t);
    state_store_vec3(paths, stride, BD_RADIANCE, t, vec3_add(sum, radiance));
}

/* From: closest hits. To: emission met by the camera's walk gathered; the vertex with its densities. Walks that miss
 * or are full end. */
__kernel void bd_shade_hits(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                            __global const uint *restrict tables, __global const uint *restrict texels,
                            __global uint *restrict paths, __global uint *restrict rays,
                            __global const uint *restrict hits, __global uint *restrict vertices,
                            __global uint *restrict densities)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, t);
    if (depth == 0u)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    uint side = state_load(paths, stride, BD_SIDE, t), flags = state_load(paths, stride, BD_WALK_FLAGS, t);
    Ray ray = ray_load(rays, stride, t);
    Hit hit = hit_load(hits, stride, t);
    Vec3 beta = state_load_vec3(paths, stride, BD_BETA, t);
    float pdf = state_load_float(paths, stride, BD_PDF, t);
    DensityView view = bd_density_view(frame, paths, densities, t);
    uint own = density_base(frame, side, depth) + DENSITY_OWN;
    if (hit.primitive == NONE) {
        if (side == SIDE_CAMERA && SCENE_HAS(&scene, FEATURE_INFINITE_LIGHT)) {
            Vec3 ng = depth > 1u
                          ? state_load_vec3(vertices, stride, vertex_base(frame, side, depth - 1u) + VERTEX_NG, t)
                          : ray.d;
            state_store_float(densities, stride, own, t, pdf);
            bd_add_radiance(paths, stride, t, vec3_mul(beta, walk_environment(&scene, view, ray.d, ng, depth)));
        }
        walk_end(paths, rays, stride, t);
        return;
    }
    Surface surface = surface_from_hit(&scene, &ray, hit);
    uint before = vertex_base(frame, side, depth - 1u);
    bool first = side == SIDE_CAMERA && depth == 1u;
    bool bundle = (flags & WALK_PARALLEL) != 0u;
    Vec3 from = first || bundle ? ray.o : state_load_vec3(vertices, stride, before + VERTEX_POINT, t);
    float distance2 = vec3_length_squared(vec3_sub(surface.p, from));
    state_store_float(densities, stride, own, t,
                      walk_density(frame, &ray, &surface, distance2, side, depth, flags, pdf));
    state_store_float(paths, stride, BD_BACK, t,
                      walk_way_back(frame, paths, vertices, stride, t, side, depth, surface.p));
    uint first_light = scene.shapes[surface.shape].first_light;
    if (side == SIDE_CAMERA && SCENE_HAS(&scene, FEATURE_AREA_LIGHT) && first_light != NONE) {
        uint light = first_light + hit.primitive - scene.shapes[surface.shape].first_primitive;
        StrategyEnds ends = {0};
        Vec3 radiance = emission_met(&scene, light, &surface, ray.d, from, distance2,
                                     state_load_float(paths, stride, BD_BACK, t), &ends);
        if (!vec3_is_zero(radiance))
            bd_add_radiance(paths, stride, t,
                            vec3_scale(vec3_mul(beta, radiance), bd_weight(frame, 0u, depth + 1u, &view, &ends)));
    }
    uint last = side == SIDE_CAMERA ? frame->max_depth : frame->max_depth - 1u;
    if (side == SIDE_CAMERA && depth >= last) { /* a vertex that nothing can be connected to */
        walk_end(paths, rays, stride, t);
        return;
    }
    Random4 random = bd_random(frame, paths, t, bd_random_vertex(side, depth, BD_RANDOM_MIX));
    Vertex vertex;
    if (!vertex_make(&scene, &surface, ray.d, beta, random_float(random.x[0]), &vertex)) {
        walk_end(paths, rays, stride, t);
        return;
    }
    vertex_store(&scene, vertices, stride, vertex_base(frame, side, depth), t, &vertex);
    uint lengths = state_load(paths, stride, BD_LENGTHS, t);
    lengths = side == SIDE_LIGHT ? (lengths & 0xffff0000u) | (depth + 1u) : (lengths & 0xffffu) | (depth << 16);
    state_store(paths, stride, BD_LENGTHS, t, lengths);
    if (side == SIDE_LIGHT && depth == 1u)
        state_store_float(paths, stride, BD_CONNECT, t,
                          bd_emitter_ratio(&scene, paths, vertices, stride, t, surface.p));
}

/* From: the vertex. To: the density of the one before it as the other side makes it; the next ray, or the walk's end by
 * absorption or Russian roulette. Roulette leaves the weights alone: they need not know of it to sum to one. */
__kernel void bd_extend_walks(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                              __global const uint *restrict tables, __global const uint *restrict texels,
                              __global uint *restrict paths, __global uint *restrict rays,
                              __global const uint *restrict vertices, __global uint *restrict densities,
                              __global uint *restrict diagnostics)
{
    uint t = (uint)get_global_id(0), stride = frame->stride;
    if (t >= frame->item_count)
        return;
    uint depth = state_load(paths, stride, BD_DEPTH, t), side = state_load(paths, stride, BD_SIDE, t);
    if (depth == 0u)
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    Random4 random = bd_random(frame, paths, t, bd_random_vertex(side, depth, BD_RANDOM_SCATTER));
    Vertex vertex = vertex_load(&scene, vertices, stride, vertex_base(frame, side, depth), t);
    WalkStep step;
    if (!walk_scatter(&scene, &vertex, side, depth, state_load_float(paths, stride, BD_ETA_SCALE, t), random, &step)) {
        walk_end(paths, rays, stride, t);
        return;
    }
    if (!ray_traceable(step.ray.o, step.ray.d)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_RAY_RANGE);
        walk_end(paths, rays, stride, t);
        return;
    }
    uint mask = side == SIDE_LIGHT ? BD_LIGHT_DELTA : BD_CAMERA_DELTA;
    if (step.delta != 0u)
        state_store(paths, stride, mask, t, state_load(paths, stride, mask, t) | (1u << depth));
    if (side == SIDE_LIGHT || depth > 1u)
        state_store_float(densities, stride, density_base(frame, side, depth - 1u) + DENSITY_OTHER, t,
                          step.reverse * state_load_float(paths, stride, BD_BACK, t));
    walk_step_store(paths, rays, stride, t, depth, &step);
}

#endif
