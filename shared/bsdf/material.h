/* From a material and a surface point to a Bsdf and its shading frame: chooses among mixes, looks up textures, applies
 * bump and normal maps. */
#ifndef TWINLIGHT_BSDF_MATERIAL_H
#define TWINLIGHT_BSDF_MATERIAL_H

#include "bsdf/bsdf.h"
#include "geometry/curve.h"
#include "geometry/texture.h"
#include "layout/path_types.h"
#include "layout/scene_view.h"

/* Mixes may nest this deep; the importer refuses deeper ones. */
#define MIX_DEPTH_MAX 6

/* Step in (u, v) for the finite differences of a displacement: pbrt's without ray differentials. */
#define BUMP_STEP 0.0005f

SHARED_FUNCTION TexturePoint texture_point(const Surface *surface)
{
    TexturePoint point;
    point.p = surface->p;
    point.uv = surface->uv;
    point.n = surface->ng;
    return point;
}

/* Follows mix materials down to a plain one. u in (0,1) decides; after each decision what remains of it is rescaled to
 * (0,1), so one number serves nested mixes. */
SHARED_FUNCTION uint material_choose(const SceneView *scene, uint material, const TexturePoint *point, float u)
{
    for (uint i = 0; i < MIX_DEPTH_MAX && scene->materials[material].kind == MATERIAL_MIX; ++i) {
        float amount = float_clamp(float_param_eval(scene, scene->materials[material].amount, point), 0.0f, 1.0f);
        if (u < amount) {
            u = u / amount;
            material = scene->materials[material].mix_b;
        } else {
            u = (u - amount) / (1.0f - amount);
            material = scene->materials[material].mix_a;
        }
    }
    return material;
}

/* The part of v perpendicular to the unit vector n; any perpendicular if that vanishes. */
SHARED_FUNCTION Vec3 vec3_orthogonal_part(Vec3 v, Vec3 n)
{
    Vec3 w = vec3_mad(v, -vec3_dot(v, n), n);
    return vec3_length_squared(w) > 1e-12f * vec3_length_squared(v) ? w : frame_from_normal(n).t;
}

/* Normal map: rgb in [0,1] is a direction in the frame (dpdu, ., ns). */
SHARED_FUNCTION void normal_map_apply(const SceneView *scene, uint image, Surface *surface)
{
    Vec3 rgb = image_lookup(scene, image, surface->uv);
    Vec3 mapped = vec3(2.0f * rgb.x - 1.0f, 2.0f * rgb.y - 1.0f, 2.0f * rgb.z - 1.0f);
    Frame frame;
    frame.n = surface->ns;
    frame.t = vec3_normalize(vec3_orthogonal_part(surface->dpdu, surface->ns));
    frame.b = vec3_cross(frame.n, frame.t);
    if (vec3_length_squared(mapped) > 0.0f)
        surface->ns = vec3_normalize(frame_to_world(frame, mapped));
}

/* Displacement as bump: the normal of the surface p + d(u,v) n (Blinn 1978); the term with dn/du is left out. */
SHARED_FUNCTION void bump_apply(const SceneView *scene, FloatParam displacement, Surface *surface)
{
    TexturePoint point = texture_point(surface), shifted = point;
    float here = float_param_eval(scene, displacement, &point);
    shifted.uv.x = point.uv.x + BUMP_STEP;
    shifted.p = vec3_mad(point.p, BUMP_STEP, surface->dpdu);
    float u_slope = (float_param_eval(scene, displacement, &shifted) - here) / BUMP_STEP;
    shifted.uv = vec2(point.uv.x, point.uv.y + BUMP_STEP);
    shifted.p = vec3_mad(point.p, BUMP_STEP, surface->dpdv);
    float v_slope = (float_param_eval(scene, displacement, &shifted) - here) / BUMP_STEP;
    Vec3 dpdu = vec3_mad(surface->dpdu, u_slope, surface->ns);
    Vec3 dpdv = vec3_mad(surface->dpdv, v_slope, surface->ns);
    Vec3 n = vec3_cross(dpdu, dpdv);
    if (!(vec3_length_squared(n) > 0.0f))
        return;
    n = vec3_normalize(n);
    surface->ns = vec3_dot(n, surface->ng) < 0.0f ? vec3_negate(n) : n;
    surface->dpdu = dpdu;
    surface->dpdv = dpdv;
}

SHARED_FUNCTION float alpha_from_roughness(uint flags, float roughness)
{
    float alpha = flags & MATERIAL_REMAP_ROUGHNESS ? roughness_to_alpha(roughness) : roughness;
    return float_clamp(alpha, 0.0f, 1.0f);
}

/* Clamps to [0,1]: reflectances from textures may lie outside, where they would create energy. */
SHARED_FUNCTION Vec3 color_unit(Vec3 c)
{
    return vec3(float_clamp(c.x, 0.0f, 1.0f), float_clamp(c.y, 0.0f, 1.0f), float_clamp(c.z, 0.0f, 1.0f));
}

/* Index and alphas of the conductor below a coat, as it has them in the coat. */
SHARED_FUNCTION void coated_conductor_set(const SceneView *scene, __global const Material *material,
                                          const TexturePoint *point, Bsdf *bsdf)
{
    Vec3 eta = bsdf->color0, k = color_param_eval(scene, material->color1, point);
    if ((material->flags & MATERIAL_CONDUCTOR_REFLECTANCE) != 0u) {
        k = vec3(extinction_from_reflectance(eta.x), extinction_from_reflectance(eta.y),
                 extinction_from_reflectance(eta.z));
        eta = vec3_splat(1.0f);
    }
    bsdf->color0 = vec3_scale(eta, 1.0f / bsdf->eta);
    bsdf->color1 = vec3_scale(k, 1.0f / bsdf->eta);
    float alpha_x = alpha_from_roughness(material->flags, float_param_eval(scene, material->base_u, point));
    float alpha_y = alpha_from_roughness(material->flags, float_param_eval(scene, material->base_v, point));
    bsdf->flags |= bsdf_base_pack(alpha_x, alpha_y);
}

/* Absorption, roughnesses and tilt of hair, and where across it the point lies. As in pbrt-v4, v goes from one side to
 * the other. */
SHARED_FUNCTION_APART void hair_set(const SceneView *scene, __global const Material *material,
                                    const TexturePoint *point, Bsdf *bsdf)
{
    float beta_m = float_param_eval(scene, material->roughness_u, point);
    float beta_n = float_param_eval(scene, material->roughness_v, point);
    Vec3 color = bsdf->color0;
    bsdf->alpha_x = float_clamp(beta_m, HAIR_BETA_MIN, 1.0f);
    bsdf->alpha_y = float_clamp(beta_n, HAIR_BETA_MIN, 1.0f);
    if ((material->flags & MATERIAL_HAIR_COLOR) != 0u)
        color = vec3(hair_absorption(color.x, bsdf->alpha_y), hair_absorption(color.y, bsdf->alpha_y),
                     hair_absorption(color.z, bsdf->alpha_y));
    if ((material->flags & MATERIAL_HAIR_MELANIN) != 0u) {
        float eumelanin = float_max(float_param_eval(scene, material->base_u, point), 0.0f);
        float pheomelanin = float_max(float_param_eval(scene, material->base_v, point), 0.0f);
        color = hair_melanin(eumelanin, pheomelanin);
    }
    bsdf->color0 = vec3_max(color, vec3_splat(0.0f));
    bsdf->color1.x = float_clamp(2.0f * point->uv.y - 1.0f, -1.0f, 1.0f);
    bsdf->color1.y = float_param_eval(scene, material->amount, point) * (PI / 180.0f);
    bsdf->color1.z = 0.0f;
}

/* Looks up the parameters of a plain material (not a mix). */
SHARED_FUNCTION Bsdf material_bsdf(const SceneView *scene, uint index, const TexturePoint *point)
{
    __global const Material *material = &scene->materials[index];
    Bsdf bsdf;
    bsdf.kind = material->kind;
    bsdf.flags = 0u;
    bsdf.media = 0u;
    bsdf.color0 = color_param_eval(scene, material->color0, point);
    bsdf.color1 = vec3_splat(0.0f);
    bsdf.alpha_x = 0.0f;
    bsdf.alpha_y = 0.0f;
    bsdf.eta = material->eta;
    bsdf.coat_table = material->coat_table;
    if (bsdf.kind == MATERIAL_CONDUCTOR) {
        bsdf.color1 = color_param_eval(scene, material->color1, point);
        if ((material->flags & MATERIAL_CONDUCTOR_REFLECTANCE) != 0u) {
            bsdf.flags |= BSDF_REFLECTANCE;
            bsdf.color0 = color_unit(bsdf.color0);
        }
    } else if (SCENE_HAS(scene, FEATURE_COATED_CONDUCTOR) && bsdf.kind == MATERIAL_COATED_CONDUCTOR) {
        coated_conductor_set(scene, material, point, &bsdf);
    } else if (bsdf.kind == MATERIAL_DIFFUSE_TRANSMISSION) {
        bsdf.color1 = color_unit(vec3_scale(color_param_eval(scene, material->color1, point), material->scale));
        bsdf.color0 = color_unit(vec3_scale(bsdf.color0, material->scale));
    } else if (!(SCENE_HAS(scene, FEATURE_HAIR) && bsdf.kind == MATERIAL_HAIR)) {
        bsdf.color0 = color_unit(bsdf.color0);
        bsdf.color1 = material->color1.value;
    }
    if (SCENE_HAS(scene, FEATURE_HAIR) && bsdf.kind == MATERIAL_HAIR) {
        hair_set(scene, material, point, &bsdf);
    } else if (SCENE_HAS(scene, FEATURE_ROUGH)) {
        bsdf.alpha_x = alpha_from_roughness(material->flags, float_param_eval(scene, material->roughness_u, point));
        bsdf.alpha_y = alpha_from_roughness(material->flags, float_param_eval(scene, material->roughness_v, point));
    }
    bsdf_flags_set(&bsdf);
    return bsdf;
}

/* Chooses among mixes with u_mix, applies bump or normal map to `surface`, and fills `bsdf` and the frame in which it
 * is evaluated. On curves that has the tangent as x. An isotropic Bsdf gets a frame from its normal alone, which is
 * continuous over the surface whatever the texture coordinates do; an anisotropic one follows dpdu. */
SHARED_FUNCTION void material_resolve(const SceneView *scene, float u_mix, Surface *surface, Bsdf *bsdf, Frame *frame)
{
    TexturePoint point = texture_point(surface);
    uint material = scene->shapes[surface->shape].material;
    if (SCENE_HAS(scene, FEATURE_MIX))
        material = material_choose(scene, material, &point, u_mix);
    *bsdf = material_bsdf(scene, material, &point);
    if (SCENE_HAS(scene, FEATURE_BUMP)) {
        uint normal_map = scene->materials[material].normal_map;
        if (normal_map != NONE)
            normal_map_apply(scene, normal_map, surface);
        if (scene->materials[material].displacement.program != NONE)
            bump_apply(scene, scene->materials[material].displacement, surface);
    }
    bool fibre = normal_is_fibre(scene, surface->ng);
    if (fibre)
        bsdf->flags |= BSDF_FIBRE;
    bool hair = SCENE_HAS(scene, FEATURE_HAIR) && bsdf->kind == MATERIAL_HAIR;
    if (fibre || hair || bsdf->alpha_x != bsdf->alpha_y || bsdf_base_is_anisotropic(bsdf->flags)) {
        frame->n = surface->ns;
        frame->t = vec3_normalize(vec3_orthogonal_part(surface->dpdu, surface->ns));
        frame->b = vec3_cross(frame->n, frame->t);
    } else {
        *frame = frame_from_normal(surface->ns);
    }
}

#endif
