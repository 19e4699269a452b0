/* Extends bidirectional paths vertex by vertex: what the walks from the light and from the camera share. */
#ifndef TWINLIGHT_PATH_BD_WALK_H
#define TWINLIGHT_PATH_BD_WALK_H

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
#include "layout/diagnostics.h"
#include "light/light_guide.h"
#include "math/rng.h"
#include "path/bd_vertex.h"
#include "path/caustic_rest.h"
#include "path/passage.h"
#include "path/strategy.h"

/* ---- a step ------------------------------------------------------------------------------------------------------ */

/* Where the state of a walk is. */
typedef struct Walk {
    __global uint *paths;
    __global uint *rays;
    __global uint *diagnostics;
    uint stride, item;
} Walk;

SHARED_FUNCTION void walk_end(__global uint *restrict paths, __global uint *restrict rays, uint stride, uint item)
{
    state_store(paths, stride, BD_DEPTH, item, 0u);
    state_store_float(rays, stride, RAY_T_MAX, item, 0.0f);
}

/* Adds light of a path of `segments` segments to what is gathered for its pixel. */
SHARED_FUNCTION void bd_add_radiance(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                     uint item, uint segments, Vec3 radiance)
{
    bool apart = frame->partition.split_direct != 0u && segments <= DIRECT_DEPTH;
    uint stride = frame->pass.stride, field = apart ? BD_DIRECT : BD_RADIANCE;
    Vec3 sum = state_load_vec3(paths, stride, field, item);
    state_store_vec3(paths, stride, field, item, vec3_add(sum, radiance));
}

/* The first ray of a walk. */
SHARED_FUNCTION void walk_begin(Walk walk, uint side, Ray ray, Vec3 beta, float pdf, uint flags)
{
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item;
    ray_store(walk.rays, stride, item, ray);
    state_store(paths, stride, BD_SIDE, item, side);
    state_store(paths, stride, BD_DEPTH, item, 1u);
    state_store_vec3(paths, stride, BD_BETA, item, beta);
    state_store_float(paths, stride, BD_PDF, item, pdf);
    state_store(paths, stride, BD_WALK_FLAGS, item, flags);
    state_store_float(paths, stride, BD_ROULETTE_SCALE, item, 1.0f / vec3_max_component(beta));
    state_store_float(paths, stride, BD_SURVIVAL, item, 1.0f);
    if (!ray_traceable(ray.o, ray.d)) {
        diagnostic_count(walk.diagnostics, DIAGNOSTIC_RAY_RANGE);
        walk_end(paths, walk.rays, stride, item);
    }
}

/* The vertex at a surface that a walk of throughput beta has hit along d. False if it scatters nothing. u_mix: decides
 * mix materials. */
SHARED_FUNCTION bool vertex_make(const SceneView *scene, Surface *surface, Vec3 d, Vec3 beta, float u_mix,
                                 Vertex *vertex)
{
    material_resolve(scene, u_mix, surface, &vertex->bsdf, &vertex->frame);
    if (vertex->bsdf.kind == MATERIAL_DIFFUSE && vec3_is_zero(vertex->bsdf.color0))
        return false;
    vertex->p = surface->p;
    vertex->ng = surface->ng;
    vertex->wo = frame_to_local(vertex->frame, vec3_negate(d));
    vertex->beta = beta;
    return true;
}

/* How a walk continues. */
typedef struct WalkStep {
    Ray ray;
    Vec3 beta;
    float forward; /* density of the new direction, per solid angle */
    float reverse; /* of the opposite direction, per area at the vertex before */
    float roulette_scale;
    float survival; /* probability with which it survived roulette here */
    uint delta;
    uint medium; /* in which the ray begins */
} WalkStep;

/* Minimum probability with which a pool's walk survives roulette. Pools clamp the contribution that a path has in
 * chains, without roulette, so a survivor may show the threshold divided by that probability. docs/TUNING.md */
#define POOL_SURVIVED_LEAST 0.35f

/* The minimum probability with which roulette lets the walk continue. */
SHARED_FUNCTION float walk_survival_least(__global const FrameParams *frame, __global const uint *paths, uint item)
{
    return frame->pool.enabled != 0u
               ? POOL_SURVIVED_LEAST / state_load_float(paths, frame->pass.stride, BD_SURVIVAL, item)
               : 0.0f;
}

/* The point that draws the direction within a lobe. */
SHARED_FUNCTION Vec2 scatter_point(Random4 random)
{
    return vec2(random_float(random.x[1]), random_float(random.x[2]));
}

/* What Russian roulette needs to know of a walk. */
typedef struct Roulette {
    uint depth; /* segments so far */
    float scale; /* of the throughput (BD_ROULETTE_SCALE) */
    float least; /* walk_survival_least */
} Roulette;

/* Draws the next direction at a vertex. False: absorbed, or ended by Russian roulette, which MIS weights ignore: they
 * sum to one without it. random: lobe, direction, roulette. */
SHARED_FUNCTION bool walk_scatter(const SceneView *scene, const Vertex *vertex, uint side, Roulette roulette,
                                  Random4 random, WalkStep *step)
{
    bool plays = roulette.depth >= scene->frame->path.roulette_depth;
    BsdfSample sample = {0};
    uint transport = side == SIDE_CAMERA ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE;
    Vec2 u = scatter_point(random), u_base = u;
    if (side == SIDE_CAMERA && scene->frame->scene.guide_count > 0u && bsdf_has_base(&vertex->bsdf))
        u_base = scatter_point(light_guide_numbers(scene, vertex->p, vertex->frame, random));
    BsdfDraw draw = {random_float(random.x[0]), u, u_base, transport};
    if (!bsdf_sample_base(scene, &vertex->bsdf, vertex->wo, draw, &sample))
        return false;
    Vec3 wi = frame_to_world(vertex->frame, sample.wi);
    step->beta = vec3_mul(vertex->beta, sample.weight);
    if (side == SIDE_LIGHT && !bsdf_is_phase(scene, &vertex->bsdf))
        step->beta = vec3_scale(step->beta, adjoint_factor(scene, vertex->ng, frame_to_world(vertex->frame, vertex->wo),
                                                           wi, vertex->wo.z, sample.wi.z));
    step->roulette_scale = side == SIDE_CAMERA ? roulette.scale * sample.eta * sample.eta : roulette.scale;
    float scale = scene->frame->path.roulette_scale * step->roulette_scale;
    float survival = plays ? vec3_max_component(step->beta) * scale : 1.0f;
    if (survival > 0.0f) /* rejects NaN */
        survival = float_max(survival, roulette.least);
    if (!(random_float(random.x[3]) < survival) || vec3_is_zero(step->beta))
        return false;
    step->survival = float_min(survival, 1.0f);
    if (survival < 1.0f)
        step->beta = vec3_scale(step->beta, 1.0f / survival);
    step->ray = ray_spawn(vertex->p, vertex->ng, wi);
    step->medium = medium_leaving(scene, vertex->bsdf.media, vertex->ng, wi);
    step->delta = sample.delta;
    step->forward = sample.pdf_w;
    step->reverse = sample.pdf_rev_w;
    if (sample.delta != 0u)
        delta_densities(&sample, vertex->wo, &step->forward, &step->reverse);
    step->reverse *= vertex->back;
    return true;
}

SHARED_FUNCTION void walk_step_store(__global uint *restrict paths, __global uint *restrict rays, uint stride,
                                     uint item, uint depth, const WalkStep *step)
{
    state_store(paths, stride, BD_DEPTH, item, depth + 1u);
    state_store_vec3(paths, stride, BD_BETA, item, step->beta);
    state_store_float(paths, stride, BD_PDF, item, step->forward);
    state_store(paths, stride, BD_WALK_FLAGS, item, step->delta != 0u ? WALK_DELTA : 0u);
    state_store_float(paths, stride, BD_ROULETTE_SCALE, item, step->roulette_scale);
    state_store_float(paths, stride, BD_SURVIVAL, item,
                      step->survival * state_load_float(paths, stride, BD_SURVIVAL, item));
    ray_store(rays, stride, item, step->ray);
}

/* The stored ray begins in `medium`. bits: of the number that draws its distance. */
SHARED_FUNCTION void walk_ray_media(const SceneView *scene, __global uint *restrict rays, uint stride, uint item,
                                    uint medium, uint bits)
{
    ray_medium_store(scene, rays, stride, item, medium);
    if (SCENE_HAS(scene, FEATURE_SCATTERING))
        ray_distance_draw(rays, stride, item, bits);
}

/* Records whether vertex `depth` of a side scatters by a delta lobe. */
SHARED_FUNCTION void walk_mark(__global uint *restrict paths, uint stride, uint item, uint side, uint depth,
                               const WalkStep *step)
{
    uint mask = side == SIDE_LIGHT ? BD_LIGHT_DELTA : BD_CAMERA_DELTA;
    if (step->delta != 0u)
        state_store(paths, stride, mask, item, state_load(paths, stride, mask, item) | (1u << depth));
}

/* ---- what a ray has hit ------------------------------------------------------------------------------------------ */

typedef struct WalkHit {
    uint before; /* base of the vertex that the ray left */
    Ray ray;
    Vec3 from_ng; /* geometric normal where the ray left; for the camera's first ray its direction */
    float own; /* density with which the walk has made the point; for a miss, its direction */
    uint light; /* index of the light that the primitive is; NONE: it is no light */
    uint instance, primitive; /* of the hit */
    bool missed;
    bool scattered; /* the hit is in a medium; of `surface` only p and ng, which is 0, are set */
    Vec3 beta; /* throughput of the walk at the hit */
    Passage passage;
    float passage_back; /* density of the distance from the hit to the vertex before */
    /* Unless the ray missed: */
    Surface surface;
    Vec3 from; /* where the ray left */
    float distance2;
    float back; /* Vertex.back at the hit */
} WalkHit;

/* The media between the vertex before and the hit: the throughput, and the densities of the distance in both
 * directions. end: the vertex before is the end of the path. */
SHARED_FUNCTION void walk_hit_pass(const SceneView *scene, __global const uint *restrict rays,
                                   __global const uint *restrict hits, uint stride, uint item, bool end,
                                   WalkHit *walk_hit)
{
    Vec3 p = vec3_splat(0.0f);
    if (walk_hit->scattered) {
        Ray last_part = ray_last_part(scene, hits, stride, item, walk_hit->ray);
        p = scatter_position(&last_part, hit_load(hits, stride, item));
    }
    walk_hit->passage = passage_load(scene, hits, stride, item, walk_hit->scattered, p);
    walk_hit->beta = vec3_mul(walk_hit->beta, walk_hit->passage.weight);
    walk_hit->own *= walk_hit->passage.pdf; /* of a miss; walk_hit_make computes others anew */
    Vec3 ng = end ? walk_hit->ray.d : walk_hit->from_ng;
    walk_hit->passage_back =
        passage_density(scene, walk_hit->passage, walk_hit->ray.o, ng, state_load(rays, stride, RAY_MEDIUM, item));
}

/* Vertex.back at the hit. */
SHARED_FUNCTION float walk_hit_back(const SceneView *scene, __global const uint *restrict vertices, uint stride,
                                    uint item, uint emitter_flags, const WalkHit *walk_hit)
{
    Vec3 d = vec3_sub(state_load_vec3(vertices, stride, walk_hit->before + VERTEX_POINT, item), walk_hit->surface.p);
    float distance2 = vec3_length_squared(d);
    if (walk_hit->scattered) {
        distance2 = walk_hit->distance2;
        d = vec3_scale(walk_hit->ray.d, float_sqrt(distance2));
    }
    return walk_back(scene, d, distance2, walk_hit->from_ng, emitter_flags) * walk_hit->passage_back;
}

/* Fills *walk_hit, whose `before` is given, from the ray under way and its hit. */
SHARED_FUNCTION void walk_hit_make(const SceneView *scene, __global const uint *restrict paths,
                                   __global const uint *restrict rays, __global const uint *restrict hits,
                                   __global const uint *restrict vertices, uint item, WalkHit *walk_hit)
{
    uint stride = scene->frame->pass.stride, before = walk_hit->before;
    uint side = state_load(paths, stride, BD_SIDE, item), depth = state_load(paths, stride, BD_DEPTH, item);
    uint flags = state_load(paths, stride, BD_WALK_FLAGS, item);
    bool first = side == SIDE_CAMERA && depth == 1u;
    Hit hit = hit_load(hits, stride, item);
    walk_hit->ray = ray_load(rays, stride, item);
    walk_hit->missed = hit.primitive == NONE;
    walk_hit->scattered = SCENE_HAS(scene, FEATURE_SCATTERING) && hit.primitive == HIT_SCATTERED;
    walk_hit->beta = state_load_vec3(paths, stride, BD_BETA, item);
    walk_hit->instance = hit.instance;
    walk_hit->primitive = hit.primitive;
    walk_hit->own = state_load_float(paths, stride, BD_PDF, item);
    walk_hit->from_ng = first ? walk_hit->ray.d : state_load_vec3(vertices, stride, before + VERTEX_NG, item);
    walk_hit->light = NONE;
    uint emitter_flags = side == SIDE_LIGHT && depth == 1u ? state_load(paths, stride, BD_EMITTER_FLAGS, item) : 0u;
    walk_hit->passage_back = 1.0f;
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        walk_hit_pass(scene, rays, hits, stride, item, first || (side == SIDE_LIGHT && depth == 1u), walk_hit);
    if (walk_hit->missed)
        return;
    Ray last_part = ray_last_part(scene, hits, stride, item, walk_hit->ray);
    if (walk_hit->scattered) {
        walk_hit->surface.p = scatter_position(&last_part, hit);
        walk_hit->surface.ng = vec3_splat(0.0f);
        walk_hit->surface.shape = NONE;
    } else {
        walk_hit->surface = surface_from_hit(scene, &last_part, hit);
    }
    walk_hit->from = first || (flags & WALK_PARALLEL) != 0u
                         ? walk_hit->ray.o
                         : state_load_vec3(vertices, stride, before + VERTEX_POINT, item);
    walk_hit->distance2 = vec3_length_squared(vec3_sub(walk_hit->surface.p, walk_hit->from));
    if (walk_hit->scattered) { /* the points may coincide by rounding */
        float distance = state_load_float(hits, stride, HIT_DISTANCE, item);
        walk_hit->distance2 = distance * distance;
    }
    walk_hit->own = walk_density(scene, &walk_hit->ray, walk_hit->surface.ng, walk_hit->distance2, first, flags,
                                 state_load_float(paths, stride, BD_PDF, item));
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        walk_hit->own *= walk_hit->passage.pdf;
    walk_hit->back = first ? 1.0f : walk_hit_back(scene, vertices, stride, item, emitter_flags, walk_hit);
    if (walk_hit->scattered)
        return;
    uint first_light = scene->shapes[walk_hit->surface.shape].first_light;
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && first_light != NONE)
        walk_hit->light = first_light + hit.primitive - scene->shapes[walk_hit->surface.shape].first_primitive;
}

/* The vertex where the ray was scattered. */
SHARED_FUNCTION void medium_vertex_make(const SceneView *scene, const WalkHit *walk_hit, Vertex *vertex)
{
    vertex->p = walk_hit->surface.p;
    vertex->ng = walk_hit->surface.ng;
    vertex->frame = frame_from_normal(vec3_negate(walk_hit->ray.d));
    vertex->wo = vec3(0.0f, 0.0f, 1.0f);
    vertex->beta = walk_hit->beta;
    vertex->bsdf = medium_bsdf(scene, walk_hit->passage.medium);
}

/* Makes the vertex at the hit. False, and the walk is to end, if the vertex scatters nothing, or if it is the camera's
 * and has max_depth segments. */
SHARED_FUNCTION bool walk_vertex_make(const SceneView *scene, __global uint *restrict paths,
                                      __global const uint *restrict vertices, uint item, float u_mix, WalkHit *walk_hit,
                                      Vertex *vertex)
{
    uint stride = scene->frame->pass.stride;
    uint side = state_load(paths, stride, BD_SIDE, item), depth = state_load(paths, stride, BD_DEPTH, item);
    if (side == SIDE_CAMERA && depth >= scene->frame->path.max_depth)
        return false;
    if (walk_hit->scattered)
        medium_vertex_make(scene, walk_hit, vertex);
    else if (!vertex_make(scene, &walk_hit->surface, walk_hit->ray.d, walk_hit->beta, u_mix, vertex))
        return false;
    else
        vertex->bsdf.media = media_at(scene, walk_hit->surface.shape, walk_hit->passage.medium);
    bool first = side == SIDE_LIGHT && depth == 1u;
    if (first && SCENE_HAS(scene, FEATURE_PORTAL) && !emitter_reaches(scene, paths, item, &walk_hit->ray, vertex->p))
        return false;
    /* Before the vertex may overwrite y_0. */
    if (first)
        state_store_float(paths, stride, BD_CONNECT, item,
                          emitter_connect_ratio(scene, paths, vertices, item, walk_hit->before, vertex));
    vertex->back = walk_hit->back;
    return true;
}

/* walk_vertex_make, then stores the vertex at `base`. */
SHARED_FUNCTION bool walk_vertex(const SceneView *scene, __global uint *restrict paths,
                                 __global uint *restrict vertices, uint item, uint base, float u_mix, WalkHit *walk_hit)
{
    uint stride = scene->frame->pass.stride;
    Vertex vertex;
    if (!walk_vertex_make(scene, paths, vertices, item, u_mix, walk_hit, &vertex))
        return false;
    vertex_store(scene, vertices, stride, base, item, &vertex);
    state_store(vertices, stride, base + VERTEX_SURVIVAL, item, state_load(paths, stride, BD_SURVIVAL, item));
    return true;
}

/* Draws how the walk continues from its last vertex; false if it has ended. random: lobe, direction, roulette. */
SHARED_FUNCTION bool walk_leave_vertex(const SceneView *scene, Walk walk, const Vertex *vertex, Random4 random,
                                       WalkStep *step)
{
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item, side = state_load(paths, stride, BD_SIDE, item);
    Roulette roulette;
    roulette.depth = state_load(paths, stride, BD_DEPTH, item);
    roulette.scale = state_load_float(paths, stride, BD_ROULETTE_SCALE, item);
    roulette.least = walk_survival_least(scene->frame, paths, item);
    if (walk_scatter(scene, vertex, side, roulette, random, step)) {
        if (ray_traceable(step->ray.o, step->ray.d)) {
            if (side == SIDE_CAMERA && scene->frame->photons.count > 0u)
                receiver_leave(paths, stride, BD_RECEIVER, item, vertex->p, step->ray.d,
                               receiver_pdf(scene, &vertex->bsdf, step->forward, step->delta));
            return true;
        }
        diagnostic_count(walk.diagnostics, DIAGNOSTIC_RAY_RANGE);
    }
    walk_end(paths, walk.rays, stride, item);
    return false;
}

/* walk_leave_vertex for the vertex stored at `base`. */
SHARED_FUNCTION bool walk_leave(const SceneView *scene, Walk walk, __global const uint *restrict vertices, uint base,
                                Random4 random, WalkStep *step)
{
    Vertex vertex = vertex_load(scene, vertices, walk.stride, base, walk.item);
    return walk_leave_vertex(scene, walk, &vertex, random, step);
}

/* ---- lights that the camera walk hits (s = 0) -------------------------------------------------------------------- */

/* What the light that was hit emits back along the ray, and the densities that its weight needs. */
SHARED_FUNCTION Vec3 emission_met(const SceneView *scene, const WalkHit *walk_hit, StrategyEnds *ends)
{
    const Surface *surface = &walk_hit->surface;
    uint light = walk_hit->light;
    Vec3 towards = vec3_negate(walk_hit->ray.d);
    ends->light_z1 = light_start_pdf(scene, light) * light_emit_pdf_p(scene, light, surface);
    ends->light_z2 = light_aimed_pdf_w(scene, light, surface->p, surface->ng, towards) * walk_hit->back;
    ends->connect = light_connect_ratio(scene, light, walk_hit->from, walk_hit->ray.d, walk_hit->distance2, surface) *
                    light_choice_ratio(scene, light, walk_hit->from, walk_hit->from_ng);
    ends->hittable = true;
    return light_emitted(scene, light, surface->ng, towards);
}

/* The same for a light at infinity that the walk has missed the scene towards. */
SHARED_FUNCTION Vec3 environment_met(const SceneView *scene, uint light, const WalkHit *miss, StrategyEnds *ends)
{
    const Ray *ray = &miss->ray;
    Vec3 ng = miss->from_ng;
    ends->light_z1 = light_start_pdf(scene, light) * environment_pdf_w(scene, light, ray->d);
    ends->light_z2 = light_aimed_pdf_disc(scene, light, ray->o, vec3_negate(ray->d)) *
                     vertex_cosine(scene, ray->d, ng) * miss->passage_back;
    ends->connect =
        light_choice_ratio(scene, light, ray->o, ng) * environment_connect_ratio(scene, light, ray->o, ray->d);
    ends->hittable = true;
    return environment_light_radiance(scene, light, ray->o, ray->d);
}

#endif
