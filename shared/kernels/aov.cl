/* Auxiliary variables (AOVs) of a pixel, properties of the first visible surface (layout/aov_list.h). A pass:
 * pt_start_paths, (rays traced), and for each of its variables aov_splat. */
#ifndef TWINLIGHT_AOV_CL
#define TWINLIGHT_AOV_CL

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
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
    uint pixel, sample;
} AovHit;

/* The random numbers that a path of light would draw at this hit. */
SHARED_FUNCTION Random4 aov_random(const SceneView *scene, const AovHit *hit, uint purpose)
{
    return path_random(scene->frame, hit->pixel, hit->sample, path_random_block(1u, purpose));
}

/* The surface's Bsdf and shading frame. */
SHARED_FUNCTION void aov_material(const SceneView *scene, const AovHit *hit, Bsdf *bsdf, Frame *shading)
{
    Surface surface = hit->surface;
    material_resolve(scene, random_float(aov_random(scene, hit, RANDOM_MIX).x[0]), &surface, bsdf, shading);
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
    Bsdf bsdf;
    Frame shading;
    BsdfSample sample;
    aov_material(scene, hit, &bsdf, &shading);
    Random4 random = aov_random(scene, hit, RANDOM_SCATTER);
    bool drawn = bsdf_sample(scene, &bsdf, frame_to_local(shading, hit->back), random_float(random.x[0]),
                             vec2(random_float(random.x[1]), random_float(random.x[2])), TRANSPORT_IMPORTANCE, &sample);
    return drawn ? sample.weight : vec3_splat(0.0f);
}

/* The shading normal on the viewer's side. */
SHARED_FUNCTION Vec3 aov_normal(const SceneView *scene, const AovHit *hit)
{
    Bsdf bsdf;
    Frame shading;
    aov_material(scene, hit, &bsdf, &shading);
    return vec3_face_forward(shading.n, hit->back);
}

SHARED_FUNCTION Vec3 aov_depth(const SceneView *scene, const AovHit *hit)
{
    (void)scene;
    return vec3_splat(hit->distance);
}

/* ---- the kernel -------------------------------------------------------------------------------------------------- */

/* AOV_LIGHTLIKE or AOV_DISTANCE. */
SHARED_FUNCTION uint aov_values(uint aov)
{
#define VALUES_OF(NAME, name, text, values, red, green, blue) | (values) << AOV_##NAME
    return (0u AOV_LIST(VALUES_OF)) >> aov & 1u;
#undef VALUES_OF
}

SHARED_FUNCTION Vec3 aov_value(const SceneView *scene, uint aov, uint pixel, uint sample, Ray ray, Hit hit)
{
    AovHit found;
    found.surface = surface_from_hit(scene, &ray, hit);
    found.back = vec3_negate(ray.d);
    found.distance = vec3_length(vec3_sub(found.surface.p, ray.o));
    found.primitive = hit.primitive;
    found.pixel = pixel;
    found.sample = sample;
#define VALUE(NAME, name, text, values, red, green, blue)                                                              \
    if (aov == AOV_##NAME)                                                                                             \
        return aov_##name(scene, &found);
    AOV_LIST(VALUE)
#undef VALUE
    return vec3_splat(0.0f);
}

/* From: closest hits. To: one sample of the next variable (PATH_AOV) of the pass, for the film of that number; of an
 * AOV_DISTANCE none if the ray meets nothing. */
__kernel void aov_splat(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                        __global const uint *restrict tables, __global const uint *restrict texels,
                        __global uint *restrict paths, __global const uint *restrict rays,
                        __global const uint *restrict hits, __global uint *restrict splats)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint pixel = state_load(paths, stride, PATH_PIXEL, item), sample = state_load(paths, stride, PATH_SAMPLE, item);
    uint aov = state_load(paths, stride, PATH_AOV, item);
    while (aov < AOV_COUNT && (frame->pass.aovs >> aov & 1u) == 0u)
        ++aov;
    state_store(paths, stride, PATH_AOV, item, aov + 1u);
    Hit hit = hit_load(hits, stride, item);
    bool met = state_load(paths, stride, PATH_DEPTH, item) != 0u && hit.primitive != NONE;
    Vec3 value = vec3_splat(0.0f);
    if (met) {
        KERNEL_SCENE(frame, geometry, tables, texels);
        value = aov_value(scene, aov, pixel, sample, ray_load(rays, stride, item), hit);
    }
    bool distance = aov_values(aov) == AOV_DISTANCE;
    if (!distance)
        value = vec3_scale(value, state_load_float(paths, stride, PATH_WEIGHT, item));
    state_store(splats, stride, SPLAT_PIXEL, item, met || !distance ? pixel | aov << SPLAT_FILM_SHIFT : NONE);
    state_store_vec3(splats, stride, SPLAT_COLOR, item, value);
}

#endif
