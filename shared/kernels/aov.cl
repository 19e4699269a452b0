/* Auxiliary variables (AOVs) of a pixel, properties of the first visible surface (layout/aov_list.h). A pass:
 * pt_start_paths, (rays traced), aov_shade_hits, and for each of its variables aov_splat. */
#ifndef TWINLIGHT_AOV_CL
#define TWINLIGHT_AOV_CL

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
#include "geometry/media_walk.h"
#include "geometry/ray.h"
#include "geometry/surface.h"
#include "layout/aov_list.h"
#include "light/light.h"
#include "path/path_random.h"
#include "path/path_state.h"

/* What a camera ray meets first. */
typedef struct AovHit {
    Surface surface;
    Vec3 back; /* towards the viewer; unit */
    float distance; /* from the ray's origin */
    uint primitive;
    Bsdf bsdf;
    Frame shading;
    Random4 random; /* that a path of light would draw its next direction from */
} AovHit;

/* ray: from `origin`; its last part (media_walk.h). */
SHARED_FUNCTION void aov_hit(const SceneView *scene, uint pixel, uint sample, Ray ray, Vec3 origin, Hit met,
                             AovHit *hit)
{
    hit->surface = surface_from_hit(scene, &ray, met);
    hit->back = vec3_negate(ray.d);
    hit->distance = vec3_length(vec3_sub(hit->surface.p, origin));
    hit->primitive = met.primitive;
    Surface surface = hit->surface;
    Random4 mix = path_random(scene->frame, pixel, sample, path_random_block(1u, RANDOM_MIX));
    material_resolve(scene, random_float(mix.x[0]), &surface, &hit->bsdf, &hit->shading);
    hit->random = path_random(scene->frame, pixel, sample, path_random_block(1u, RANDOM_SCATTER));
}

SHARED_FUNCTION bool aov_lamp(const SceneView *scene, const AovHit *hit)
{
    __global const Shape *shape = scene->shapes + hit->surface.shape;
    if (!SCENE_HAS(scene, FEATURE_AREA_LIGHT) || shape->first_light == NONE)
        return false;
    uint light = shape->first_light + hit->primitive - shape->first_primitive;
    return !vec3_is_zero(light_emitted(scene, light, hit->surface.ng, hit->back));
}

/* ---- variables: aov_name of AOV_LIST ----------------------------------------------------------------------------- */

/* An estimate of the directional albedo: the fraction of uniform incident light that the surface scatters towards the
 * viewer. It is the weight of one direction drawn from the Bsdf; 1 for a lamp. */
SHARED_FUNCTION Vec3 aov_albedo(const SceneView *scene, const AovHit *hit)
{
    if (aov_lamp(scene, hit))
        return vec3_splat(1.0f);
    BsdfSample sample;
    bool drawn = bsdf_sample(scene, &hit->bsdf, frame_to_local(hit->shading, hit->back), random_float(hit->random.x[0]),
                             vec2(random_float(hit->random.x[1]), random_float(hit->random.x[2])), TRANSPORT_IMPORTANCE,
                             &sample);
    return drawn ? sample.weight : vec3_splat(0.0f);
}

/* The shading normal on the viewer's side. */
SHARED_FUNCTION Vec3 aov_normal(const SceneView *scene, const AovHit *hit)
{
    (void)scene;
    return vec3_face_forward(hit->shading.n, hit->back);
}

SHARED_FUNCTION Vec3 aov_depth(const SceneView *scene, const AovHit *hit)
{
    (void)scene;
    return vec3_splat(hit->distance);
}

/* Whether there is something to see: a surface or an environment (aov_missed). */
SHARED_FUNCTION Vec3 aov_alpha(const SceneView *scene, const AovHit *hit)
{
    (void)scene;
    (void)hit;
    return vec3_splat(1.0f);
}

/* The value where the ray meets nothing. */
SHARED_FUNCTION Vec3 aov_missed(const SceneView *scene, uint aov)
{
    return vec3_splat(aov == AOV_ALPHA && SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) ? 1.0f : 0.0f);
}

/* ---- the kernel -------------------------------------------------------------------------------------------------- */

/* AOV_LIGHTLIKE, AOV_DISTANCE or AOV_PART. */
SHARED_FUNCTION uint aov_values(uint aov)
{
#define VALUES_OF(NAME, name, text, values, red, green, blue) | (values) << 2u * AOV_##NAME
    return (0u AOV_LIST(VALUES_OF)) >> 2u * aov & 3u;
#undef VALUES_OF
}

SHARED_FUNCTION Vec3 aov_value(const SceneView *scene, uint aov, const AovHit *hit)
{
#define VALUE(NAME, name, text, values, red, green, blue)                                                              \
    if (aov == AOV_##NAME)                                                                                             \
        return aov_##name(scene, hit);
    AOV_LIST(VALUE)
#undef VALUE
    return vec3_splat(0.0f);
}

SHARED_FUNCTION void aov_store(__global uint *paths, uint stride, uint item, uint aov, Vec3 value)
{
    float weight = aov_values(aov) == AOV_LIGHTLIKE ? state_load_float(paths, stride, PATH_WEIGHT, item) : 1.0f;
    state_store_vec3(paths, stride, PATH_AOV_VALUES + 3u * aov, item, vec3_scale(value, weight));
}

/* From: closest hits. To: a sample of each variable of the pass. Paths that meet nothing end. */
__kernel void aov_shade_hits(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                             __global const uint *restrict tables, __global const uint *restrict texels,
                             __global uint *restrict paths, __global const uint *restrict rays,
                             __global const uint *restrict hits)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    KERNEL_SCENE(frame, geometry, tables, texels);
    Hit met = hit_load(hits, stride, item);
    if (state_load(paths, stride, PATH_DEPTH, item) == 0u || met.primitive == NONE) {
        state_store(paths, stride, PATH_DEPTH, item, 0u);
        for (uint aov = 0; aov < AOV_COUNT; ++aov)
            aov_store(paths, stride, item, aov, aov_missed(scene, aov));
        return;
    }
    AovHit hit;
    Ray ray = ray_load(rays, stride, item);
    aov_hit(scene, state_load(paths, stride, PATH_PIXEL, item), state_load(paths, stride, PATH_SAMPLE, item),
            ray_last_part(scene, hits, stride, item, ray), ray.o, met, &hit);
    for (uint aov = 0; aov < AOV_COUNT; ++aov)
        if ((frame->pass.aovs >> aov & 1u) != 0u)
            aov_store(paths, stride, item, aov, aov_value(scene, aov, &hit));
}

/* From: samples. To: that of the next variable (PATH_AOV) of the pass, for the image of that number; of an AOV_DISTANCE
 * none if the ray has met nothing. */
__kernel void aov_splat(__global const FrameParams *restrict frame, __global uint *restrict paths,
                        __global uint *restrict splats)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint aov = state_load(paths, stride, PATH_AOV, item);
    while (aov < AOV_COUNT && (frame->pass.aovs >> aov & 1u) == 0u)
        ++aov;
    state_store(paths, stride, PATH_AOV, item, aov + 1u);
    bool met = state_load(paths, stride, PATH_DEPTH, item) != 0u;
    state_store(splats, stride, SPLAT_PIXEL, item,
                met || aov_values(aov) != AOV_DISTANCE
                    ? state_load(paths, stride, PATH_PIXEL, item) | aov << SPLAT_FILM_SHIFT
                    : NONE);
    state_store_vec3(splats, stride, SPLAT_COLOR, item,
                     state_load_vec3(paths, stride, PATH_AOV_VALUES + 3u * aov, item));
}

#endif
