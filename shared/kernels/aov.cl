/* Auxiliary variables (AOVs) of a pixel, for denoisers and compositors: albedo, normal and distance of the first
 * visible surface. A pass: pt_start_paths, (rays traced) aov_splat. */
#ifndef TWINLIGHT_AOV_CL
#define TWINLIGHT_AOV_CL

#include "bsdf/bsdf.h"
#include "bsdf/material.h"
#include "geometry/ray.h"
#include "geometry/surface.h"
#include "light/light.h"
#include "path/path_random.h"
#include "path/path_state.h"

/* An estimate of the directional albedo: the fraction of uniform incident light that the surface scatters along `back`,
 * towards the viewer. It is the weight of one direction drawn from the Bsdf. */
SHARED_FUNCTION Vec3 aov_albedo(const SceneView *scene, Random4 random, const Bsdf *bsdf, Frame shading, Vec3 back)
{
    BsdfSample sample;
    bool drawn = bsdf_sample(scene, bsdf, frame_to_local(shading, back), random_float(random.x[0]),
                             vec2(random_float(random.x[1]), random_float(random.x[2])), TRANSPORT_IMPORTANCE, &sample);
    return drawn ? sample.weight : vec3_splat(0.0f);
}

SHARED_FUNCTION bool aov_lamp(const SceneView *scene, const Surface *surface, uint primitive, Vec3 back)
{
    uint first = scene->shapes[surface->shape].first_light;
    if (!SCENE_HAS(scene, FEATURE_AREA_LIGHT) || first == NONE)
        return false;
    uint light = first + primitive - scene->shapes[surface->shape].first_primitive;
    return !vec3_is_zero(light_emitted(scene, light, surface->ng, back));
}

/* The albedo (1 for a lamp), the shading normal on the viewer's side, or the distance. */
SHARED_FUNCTION Vec3 aov_value(const SceneView *scene, uint pixel, uint sample, Ray ray, Hit hit)
{
    __global const FrameParams *frame = scene->frame;
    Surface surface = surface_from_hit(scene, &ray, hit);
    Vec3 back = vec3_negate(ray.d);
    if (frame->pass.aov == AOV_DEPTH)
        return vec3_splat(vec3_length(vec3_sub(surface.p, ray.o)));
    if (frame->pass.aov == AOV_ALBEDO && aov_lamp(scene, &surface, hit.primitive, back))
        return vec3_splat(1.0f);
    Random4 mix = path_random(frame, pixel, sample, path_random_block(1u, RANDOM_MIX));
    Bsdf bsdf;
    Frame shading;
    material_resolve(scene, random_float(mix.x[0]), &surface, &bsdf, &shading);
    if (frame->pass.aov == AOV_NORMAL)
        return vec3_face_forward(shading.n, back);
    return aov_albedo(scene, path_random(frame, pixel, sample, path_random_block(1u, RANDOM_SCATTER)), &bsdf, shading,
                      back);
}

/* From: closest hits. To: one sample of the variable. Rays that miss give zero albedo and normal, and no sample of the
 * distance. */
__kernel void aov_splat(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                        __global const uint *restrict tables, __global const uint *restrict texels,
                        __global const uint *restrict paths, __global const uint *restrict rays,
                        __global const uint *restrict hits, __global uint *restrict splats)
{
    uint item = (uint)get_global_id(0), stride = frame->pass.stride;
    if (item >= frame->pass.item_count)
        return;
    uint pixel = state_load(paths, stride, PATH_PIXEL, item), sample = state_load(paths, stride, PATH_SAMPLE, item);
    Hit hit = hit_load(hits, stride, item);
    bool met = state_load(paths, stride, PATH_DEPTH, item) != 0u && hit.primitive != NONE;
    Vec3 value = vec3_splat(0.0f);
    if (met) {
        KERNEL_SCENE(frame, geometry, tables, texels);
        value = aov_value(scene, pixel, sample, ray_load(rays, stride, item), hit);
    }
    if (frame->pass.aov != AOV_DEPTH)
        value = vec3_scale(value, state_load_float(paths, stride, PATH_WEIGHT, item));
    state_store(splats, stride, SPLAT_PIXEL, item, met || frame->pass.aov != AOV_DEPTH ? pixel : NONE);
    state_store_vec3(splats, stride, SPLAT_COLOR, item, value);
}

#endif
