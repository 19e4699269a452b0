/* Rays through media. A ray query goes on behind interfaces, surfaces without material, until the ray meets a surface
 * with one, leaves the scene, or is scattered; it sums up the optical depths on the way. BUFFER_RAYS and BUFFER_SHADOWS
 * tell the medium in which a ray begins, BUFFER_HITS and BUFFER_SHADOWS what it has gone through. Only scenes with
 * media have these words (FEATURE_MEDIUM). */
#ifndef TWINLIGHT_GEOMETRY_MEDIA_WALK_H
#define TWINLIGHT_GEOMETRY_MEDIA_WALK_H

#include "geometry/grid_emission.h"
#include "geometry/medium.h"
#include "geometry/surface.h"
#include "layout/diagnostics.h"
#include "layout/state.h"
#include "math/rng.h"

/* ---- the words that go with a ray -------------------------------------------------------------------------------- */

/* The ray begins in `medium` and is not scattered. */
SHARED_FUNCTION void ray_medium_store(const SceneView *scene, __global uint *rays, uint stride, uint item, uint medium)
{
    if (!SCENE_HAS(scene, FEATURE_MEDIUM))
        return;
    state_store(rays, stride, RAY_MEDIUM, item, medium);
    state_store(rays, stride, RAY_CHANNEL, item, 0u);
    state_store_float(rays, stride, RAY_TARGET, item, FLOAT_INFINITY);
}

/* Draws where a stored ray is scattered, as a colour channel and an optical depth. The optical depth is from 6e-8 to
 * 16. bits: a random number. */
SHARED_FUNCTION void ray_distance_draw(__global uint *rays, uint stride, uint item, uint bits)
{
    ulong number = (ulong)bits * 3u;
    state_store(rays, stride, RAY_CHANNEL, item, (uint)(number >> 32));
    state_store_float(rays, stride, RAY_TARGET, item, -float_log(random_float((uint)number)));
}

/* The shadow ray begins in `medium`. */
SHARED_FUNCTION void shadow_medium_store(const SceneView *scene, __global uint *shadows, uint stride, uint item,
                                         uint medium)
{
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        state_store(shadows, stride, SHADOW_MEDIUM, item, medium);
}

SHARED_FUNCTION void optical_depth_store(__global uint *words, uint stride, uint field, uint item,
                                         const OpticalDepth *depth)
{
    state_store_vec3(words, stride, field, item, depth->all);
    state_store_vec3(words, stride, field + 3u, item, depth->scattering);
}

SHARED_FUNCTION OpticalDepth optical_depth_load(__global const uint *words, uint stride, uint field, uint item)
{
    OpticalDepth depth;
    depth.all = state_load_vec3(words, stride, field, item);
    depth.scattering = state_load_vec3(words, stride, field + 3u, item);
    return depth;
}

/* ---- during a query ---------------------------------------------------------------------------------------------- */

/* Interfaces that a ray may cross. One that meets more counts as blocked, and in the diagnostics. */
#define CROSSINGS_MAX 1024u

/* Where a ray is scattered. */
typedef struct ScatterPoint {
    Vec3 origin; /* of the part of the ray, ... */
    float t; /* ... along which it is */
    float travelled; /* distance from the origin of the whole ray */
    uint medium;
    OpticalDepth depth;
} ScatterPoint;

/* What a ray has gone through so far. */
typedef struct MediaWalk {
    uint medium; /* it is in */
    uint crossings;
    float travelled; /* distance */
    OpticalDepth depth;
    float target; /* what is left to the optical depth in `channel` at which it is scattered */
    uint channel;
    bool scattered; /* at `point`; then the walk continues for `emission` alone */
    bool arrived; /* at the end of a ray with t_max, right behind an interface */
    bool blocked; /* CROSSINGS_MAX */
    bool gathers; /* emission is wanted */
    ScatterPoint point;
    Vec3 emission; /* light that the media emit towards the ray's origin, as far as the walk would go unscattered */
} MediaWalk;

SHARED_FUNCTION MediaWalk media_walk_begin(uint medium)
{
    MediaWalk walk = {0};
    walk.medium = medium;
    walk.target = FLOAT_INFINITY;
    return walk;
}

/* Of a ray for closest hits. */
SHARED_FUNCTION MediaWalk media_walk_load(const SceneView *scene, __global const uint *rays, uint stride, uint item)
{
    MediaWalk walk = media_walk_begin(state_load(rays, stride, RAY_MEDIUM, item));
    walk.target = state_load_float(rays, stride, RAY_TARGET, item);
    walk.channel = state_load(rays, stride, RAY_CHANNEL, item);
    walk.gathers = SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION);
    return walk;
}

/* The rest of the ray behind the interface at its hit. */
SHARED_FUNCTION Ray ray_behind(const Ray *ray, const Surface *surface)
{
    Ray rest = ray_spawn(surface->p, surface->ng, ray->d);
    if (ray->t_max < FLOAT_MAX) {
        Vec3 end = vec3_mad(ray->o, ray->t_max, ray->d);
        rest.d = vec3_sub(end, rest.o);
        rest.t_max = vec3_dot(rest.d, ray->d) > 0.0f ? 1.0f : 0.0f;
    }
    return rest;
}

/* Below this optical depth the emission of a part of a ray is a series, whose error is below 2^-24. */
#define EMISSION_SERIES 0.03125f

/* Light that `distance` in a medium emits towards its near end, in one channel. */
SHARED_FUNCTION float emission_part(float emission, float extinction, float distance)
{
    float x = attenuation(extinction, distance);
    if (!(emission > 0.0f))
        return 0.0f;
    if (x < EMISSION_SERIES)
        return emission * distance * (1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f))));
    return emission * (1.0f - float_exp(-x)) / extinction;
}

/* A part of a ray that is in a single medium. */
typedef struct RayPart {
    const Ray *ray;
    float length; /* of the ray's direction */
    float distance; /* up to its end */
    bool surface; /* which is on one */
} RayPart;

/* Whether the emission of the medium, which has a grid, differs from extinction by more than a factor. */
SHARED_FUNCTION bool medium_emission_varies(const SceneView *scene, __global const Medium *medium)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM_GRID) && medium->grid != 0u &&
           scene->grids[medium->grid - 1u].emission != 0u && !vec3_is_zero(medium->emission);
}

/* Adds the light that the next part of a ray emits; walk->depth is still that before it. lengths: as of
 * optical_depth_add: where emission does not vary, it has the same factor as extinction. */
SHARED_FUNCTION void media_walk_emission(const SceneView *scene, const RayPart *part, Vec3 lengths, MediaWalk *walk)
{
    __global const Medium *medium = scene->media + walk->medium;
    Vec3 emission;
    if (medium_emission_varies(scene, medium))
        emission =
            grid_emission(scene, medium, part->ray->o, vec3_scale(part->ray->d, 1.0f / part->length), part->distance);
    else
        emission = vec3(emission_part(medium->emission.x, medium->extinction.x, lengths.x),
                        emission_part(medium->emission.y, medium->extinction.y, lengths.y),
                        emission_part(medium->emission.z, medium->extinction.z, lengths.z));
    walk->emission = vec3_add(walk->emission, vec3_mul(transmittance(walk->depth.all), emission));
}

/* Scatters the ray at the distance `near` from its origin. lengths: as of optical_depth_add, up to the point. */
SHARED_FUNCTION void media_walk_scatter_at(const SceneView *scene, const RayPart *part, float near, Vec3 lengths,
                                           MediaWalk *walk)
{
    /* Rounding must not move the point through the surface. */
    float last = part->distance;
    if (part->surface)
        last -= RAY_OFFSET_ULPS * FLOAT_EPSILON * (vec3_max_abs(part->ray->o) + part->distance);
    near = float_min(near, float_max(last, 0.5f * part->distance));
    walk->scattered = true;
    walk->point.origin = part->ray->o;
    walk->point.t = near / part->length;
    walk->point.travelled = walk->travelled + near;
    walk->point.medium = walk->medium;
    walk->point.depth = walk->depth;
    optical_depth_add(scene, &walk->point.depth, walk->medium, lengths);
}

/* Scatters the ray in its homogeneous medium, where that is due. */
SHARED_FUNCTION void media_walk_scatter(const SceneView *scene, const RayPart *part, MediaWalk *walk)
{
    __global const Medium *medium = scene->media + walk->medium;
    if (walk->scattered || !medium_scatters(medium))
        return;
    float coefficient = vec3_component(medium->extinction, walk->channel);
    float most = attenuation(coefficient, part->distance);
    if (!(walk->target < most)) {
        walk->target -= most;
        return;
    }
    float near = walk->target / coefficient;
    media_walk_scatter_at(scene, part, near, vec3_splat(near), walk);
}

/* Goes through a medium of a grid, which scatters the ray where that is due. Returns the lengths that optical_depth_add
 * takes, which after scattering matter to emission alone. */
SHARED_FUNCTION_APART Vec3 media_walk_grid(const SceneView *scene, const RayPart *part, MediaWalk *walk)
{
    __global const Medium *medium = scene->media + walk->medium;
    float coefficient = vec3_component(medium->extinction, walk->channel), target = FLOAT_INFINITY;
    bool scatters = SCENE_HAS(scene, FEATURE_SCATTERING) && !walk->scattered && medium_scatters(medium);
    if (scatters && coefficient > 0.0f)
        target = walk->target / coefficient;
    Vec3 w = vec3_scale(part->ray->d, 1.0f / part->length);
    GridColumn column = grid_column(scene, medium->grid - 1u, part->ray->o, w, part->distance, walk->channel, target);
    if (column.reached)
        media_walk_scatter_at(scene, part, column.distance, column.sums, walk);
    else if (scatters)
        walk->target -= attenuation(coefficient, vec3_component(column.sums, walk->channel));
    if (column.reached && SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION) && walk->gathers)
        column = grid_column(scene, medium->grid - 1u, part->ray->o, w, part->distance, 0u, FLOAT_INFINITY);
    return column.sums;
}

/* Goes on from the ray's origin to its hit, through a single medium. *ray becomes the rest of the ray behind an
 * interface, and true is returned if that is to be traced; otherwise *hit is the end of the walk. A miss is the end of
 * a ray with t_max, else infinity. */
SHARED_FUNCTION bool media_walk_on(const SceneView *scene, Ray *ray, const Hit *hit, MediaWalk *walk)
{
    bool missed = hit->primitive == NONE;
    float length = vec3_length(ray->d), distance = length * (missed ? ray->t_max : hit->t);
    if (missed && ray->t_max == FLOAT_MAX)
        distance = FLOAT_INFINITY;
    RayPart part = {ray, length, distance, !missed};
    Vec3 lengths = vec3_splat(distance);
    if (medium_has_grid(scene, walk->medium))
        lengths = media_walk_grid(scene, &part, walk);
    else if (SCENE_HAS(scene, FEATURE_SCATTERING))
        media_walk_scatter(scene, &part, walk);
    if (SCENE_HAS(scene, FEATURE_MEDIUM_EMISSION) && walk->gathers)
        media_walk_emission(scene, &part, lengths, walk);
    else if (walk->scattered)
        return false;
    optical_depth_add(scene, &walk->depth, walk->medium, lengths);
    walk->travelled += distance;
    if (missed)
        return false;
    uint flags = scene->shapes[scene->primitives[hit->primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    walk->blocked = walk->crossings == CROSSINGS_MAX;
    if ((flags & SHAPE_INTERFACE) == 0u || walk->blocked)
        return false;
    ++walk->crossings;
    Surface surface = surface_from_hit(scene, ray, *hit);
    walk->medium = medium_towards(flags, surface.ng, ray->d);
    *ray = ray_behind(ray, &surface);
    walk->arrived = !(ray->t_max > 0.0f);
    return !walk->arrived;
}

/* ---- after a query ----------------------------------------------------------------------------------------------- */

/* Of a ray for closest hits, whose last part is `rest`. *hit becomes what the ray has met: scattering, or nothing if it
 * is blocked, with an infinite optical depth. */
SHARED_FUNCTION void media_walk_end(__global uint *hits, __global uint *diagnostics, uint stride, uint item, Ray rest,
                                    const MediaWalk *walk, Hit *hit)
{
    ScatterPoint point = walk->point;
    if (walk->scattered) {
        hit->primitive = HIT_SCATTERED;
        hit->t = point.t;
    } else {
        point.origin = rest.o;
        point.travelled = walk->travelled;
        point.medium = walk->medium;
        point.depth = walk->depth;
    }
    if (walk->blocked)
        diagnostic_count(diagnostics, DIAGNOSTIC_CROSSINGS);
    if (walk->blocked && !walk->scattered) {
        hit->primitive = NONE;
        point.depth.all = vec3_splat(FLOAT_INFINITY);
    }
    state_store_vec3(hits, stride, HIT_ORIGIN, item, point.origin);
    state_store(hits, stride, HIT_MEDIUM, item, point.medium);
    state_store_float(hits, stride, HIT_DISTANCE, item, point.travelled);
    optical_depth_store(hits, stride, HIT_DEPTH, item, &point.depth);
    state_store_vec3(hits, stride, HIT_EMISSION, item, walk->emission);
}

/* Of a shadow ray that has ended at `hit`. */
SHARED_FUNCTION void shadow_walk_end(__global uint *shadows, __global uint *diagnostics, uint stride, uint item,
                                     const MediaWalk *walk, const Hit *hit)
{
    bool occluded = hit->primitive != NONE && !walk->arrived;
    state_store(shadows, stride, SHADOW_OCCLUDED, item, occluded ? 1u : 0u);
    optical_depth_store(shadows, stride, SHADOW_DEPTH, item, &walk->depth);
    if (walk->blocked)
        diagnostic_count(diagnostics, DIAGNOSTIC_CROSSINGS);
}

/* ---- what kernels read of it ------------------------------------------------------------------------------------- */

/* The last part of a ray, to which its hit refers. */
SHARED_FUNCTION Ray ray_last_part(const SceneView *scene, __global const uint *hits, uint stride, uint item, Ray ray)
{
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        ray.o = state_load_vec3(hits, stride, HIT_ORIGIN, item);
    return ray;
}

/* The medium at the end of a ray. */
SHARED_FUNCTION uint hit_medium(const SceneView *scene, __global const uint *hits, uint stride, uint item)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM) ? state_load(hits, stride, HIT_MEDIUM, item) : 0u;
}

SHARED_FUNCTION OpticalDepth hit_depth(__global const uint *hits, uint stride, uint item)
{
    return optical_depth_load(hits, stride, HIT_DEPTH, item);
}

#endif
