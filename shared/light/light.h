/* Lights as path tracing sees them: choosing one, drawing a point or direction on it, and the density of that. */
#ifndef TWINLIGHT_LIGHT_LIGHT_H
#define TWINLIGHT_LIGHT_LIGHT_H

#include "geometry/ray.h"
#include "layout/distribution.h"
#include "light/area.h"
#include "light/delta.h"
#include "light/infinite.h"
#include "light/light_tree.h"
#include "math/rng.h"

/* Draws the light of a light subpath, with probability lights[i].select_pdf (host/scene/light_setup.h). The scene must
 * have at least one. */
SHARED_FUNCTION uint light_select(const SceneView *scene, uint bits0, uint bits1)
{
    return alias_sample(scene->light_alias, scene->frame->scene.light_count, bits0, bits1);
}

/* Where the light's share of light subpaths is (layout/openings.h); OPENING_LIGHTS_MAX: lights[light].select_pdf. */
SHARED_FUNCTION uint light_divided(const SceneView *scene, uint light)
{
    __global const OpeningParams *openings = &scene->frame->openings;
    for (uint i = 0u; i < openings->light_count; ++i)
        if (openings->lights[i] == light)
            return i;
    return OPENING_LIGHTS_MAX;
}

/* Probability with which light_start_point chooses the light. */
SHARED_FUNCTION float light_start_pdf(const SceneView *scene, uint light)
{
    uint i = light_divided(scene, light);
    return i < OPENING_LIGHTS_MAX ? scene->frame->openings.light_pdfs[i] : scene->lights[light].select_pdf;
}

/* light_select with the numbers of a point on the light, the first of which chooses the light and is stretched to what
 * is left of it, so that points stay stratified; *u: then those of the point. random: x: as bits1 of light_select; z,
 * w: point (y is not used). */
SHARED_FUNCTION uint light_select_point(const SceneView *scene, Random4 random, Vec2 *u)
{
    u->y = random_float(random.x[3]);
    return alias_sample_rest(scene->light_alias, scene->frame->scene.light_count, random.x[2], random.x[0], &u->x);
}

/* Chooses the light from which a light subpath starts; numbers as in light_select_point. */
SHARED_FUNCTION uint light_start_point(const SceneView *scene, Random4 random, Vec2 *u)
{
    uint light = light_select_point(scene, random, u);
    __global const OpeningParams *openings = &scene->frame->openings;
    if (light_divided(scene, light) == OPENING_LIGHTS_MAX)
        return light;
    uint i = 0u;
    for (; i + 1u < openings->light_count && u->x >= openings->light_shares[i]; ++i)
        u->x -= openings->light_shares[i];
    u->x = float_min(u->x / openings->light_shares[i], 0.99999994f);
    return openings->lights[i];
}

/* Chooses the light that a vertex at p with geometric normal ng is connected to; numbers as in light_select_point.
 * *pdf: light_choice_pdf. */
SHARED_FUNCTION uint light_choose_point(const SceneView *scene, Vec3 p, Vec3 ng, Random4 random, Vec2 *u, float *pdf)
{
    if (!SCENE_HAS(scene, FEATURE_LIGHT_TREE)) {
        uint light = light_select_point(scene, random, u);
        *pdf = scene->lights[light].select_pdf;
        return light;
    }
    ulong number = (ulong)random.x[2] << 32 | random.x[0];
    uint light = light_tree_choose(scene, p, ng, &number, pdf);
    *u = vec2(random_float((uint)(number >> 32)), random_float(random.x[3]));
    return light;
}

/* The probability with which light_choose_point chooses the light. */
SHARED_FUNCTION float light_choice_pdf(const SceneView *scene, uint light, Vec3 p, Vec3 ng)
{
    if (!SCENE_HAS(scene, FEATURE_LIGHT_TREE))
        return scene->lights[light].select_pdf;
    return light_tree_pdf(scene, light, p, ng);
}

/* light_choice_pdf over the probability with which a light subpath starts there. */
SHARED_FUNCTION float light_choice_ratio(const SceneView *scene, uint light, Vec3 p, Vec3 ng)
{
    if (!SCENE_HAS(scene, FEATURE_LIGHT_TREE) && scene->frame->openings.light_count == 0u)
        return 1.0f;
    float pdf = light_choice_pdf(scene, light, p, ng), start = light_start_pdf(scene, light);
    return pdf > 0.0f ? pdf / start : 0.0f;
}

/* Draws light that arrives at `ref` from `light`, occlusion ignored. False: no contribution; *sample is then
 * meaningless. */
SHARED_FUNCTION bool light_sample(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample)
{
    uint kind = light_kind(scene->lights + light);
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA)
        return area_light_sample(scene, light, ref, u, sample);
    if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && kind >= LIGHT_INFINITE)
        return infinite_light_sample(scene, light, ref, u, sample);
    if (SCENE_HAS(scene, FEATURE_DELTA_LIGHT))
        return delta_light_sample(scene, scene->lights + light, ref, sample);
    return false;
}

/* The open segment between two points; in scenes with media, from p to q. Arguments as of ray_between. */
SHARED_FUNCTION Ray connecting_ray(const SceneView *scene, Vec3 p, Vec3 ngp, Vec3 q, Vec3 ngq)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM) ? ray_from_to(p, ngp, q, ngq) : ray_between(p, ngp, q, ngq);
}

/* The shadow ray from a point p with geometric normal ng (0 in a medium) to its light sample. */
SHARED_FUNCTION Ray light_shadow_ray(const SceneView *scene, Vec3 p, Vec3 ng, const LightSample *sample)
{
    if (sample->infinite != 0u)
        return ray_spawn(p, ng, sample->wi);
    return connecting_ray(scene, p, ng, sample->p, sample->ng);
}

/* Solid-angle density at `ref` with which light_sample, given the light, draws the direction `wi` (unit). Area lights:
 * `hit` is the point on the light that wi leads to (p, ng, u, v are read). Infinite lights do not read `hit`. 0 for
 * delta lights. */
SHARED_FUNCTION float light_pdf_w(const SceneView *scene, uint light, Vec3 ref, Vec3 wi, const Surface *hit)
{
    uint kind = light_kind(scene->lights + light);
    if (SCENE_HAS(scene, FEATURE_AREA_LIGHT) && kind == LIGHT_AREA)
        return area_light_pdf_w(scene, light, ref, wi, hit);
    if (SCENE_HAS(scene, FEATURE_INFINITE_LIGHT) && kind >= LIGHT_INFINITE)
        return environment_sample_pdf_w(scene, light, ref, wi);
    return 0.0f;
}

#endif
