#include "scene/features.h"

#include "bsdf/material.h"
#include "scene/media_setup.h"

#define FEATURE_OF(NAME, name, text, traits) [MATERIAL_##NAME] = FEATURE_BIT(NAME),
static const ulong FEATURE_OF_MATERIAL[MATERIAL_KINDS] = {MATERIAL_LIST(FEATURE_OF)};
#undef FEATURE_OF

float material_alpha(const Material *m, const FloatParam *roughness)
{
    return alpha_from_roughness(m->flags, roughness->value);
}

static bool roughness_is_rough(const Material *m, const FloatParam *roughness)
{
    return roughness->program != NONE || material_alpha(m, roughness) >= ALPHA_DELTA;
}

bool interface_is_rough(const Material *m)
{
    return roughness_is_rough(m, &m->roughness_u) || roughness_is_rough(m, &m->roughness_v);
}

static bool base_is_rough(const Material *m)
{
    return m->kind == MATERIAL_COATED_CONDUCTOR &&
           (roughness_is_rough(m, &m->base_u) || roughness_is_rough(m, &m->base_v));
}

bool scene_material_is_rough(const Material *m)
{
    return m->kind != MATERIAL_MIX && (bsdf_traits(m->kind) & TRAIT_MICROFACET) != 0u &&
           (interface_is_rough(m) || base_is_rough(m));
}

bool scene_material_has_delta(const Scene *scene, uint material)
{
    if (material == NONE)
        return false;
    const Material *m = &ARRAY_AT(&scene->materials, Material, material);
    if (m->kind == MATERIAL_MIX) /* of materials that were known before it: no cycles */
        return scene_material_has_delta(scene, m->mix_a) || scene_material_has_delta(scene, m->mix_b);
    return (bsdf_traits(m->kind) & TRAIT_DELTA) != 0u && !scene_material_is_rough(m);
}

bool scene_has_delta(const Scene *scene)
{
    for (size_t i = 0; i < scene->materials.count; ++i)
        if (scene_material_has_delta(scene, (uint)i))
            return true;
    return false;
}

bool scene_has_invisible_light(const Scene *scene)
{
    for (size_t i = 0; i < scene->lights.count; ++i)
        if ((ARRAY_AT(&scene->lights, Light, i).flags & LIGHT_INVISIBLE) != 0)
            return true;
    return false;
}

bool scene_hides_light(const Scene *scene)
{
    return scene_has_delta(scene) && ((scene->features & FEATURE_DELTA_LIGHT) != 0 || scene_has_invisible_light(scene));
}

/* Of hair, whose frame follows the tangent. */
static ulong hair_features(const Material *m)
{
    return FEATURE_TANGENTS | (m->base_u.program != NONE || m->base_v.program != NONE ? FEATURE_TEXTURE : 0u);
}

/* Of a coated conductor, whose record is kept with what rough lobes need. */
static ulong base_features(const Material *m)
{
    ulong features = FEATURE_ROUGH;
    if (m->base_u.program != m->base_v.program || m->base_u.value != m->base_v.value)
        features |= FEATURE_TANGENTS;
    return m->base_u.program != NONE || m->base_v.program != NONE ? features | FEATURE_TEXTURE : features;
}

static ulong material_features(const Material *m)
{
    ulong features = FEATURE_OF_MATERIAL[m->kind];
    if (scene_material_is_rough(m))
        features |= FEATURE_ROUGH;
    if (m->kind == MATERIAL_COATED_CONDUCTOR)
        features |= base_features(m);
    if (m->kind == MATERIAL_HAIR)
        features |= hair_features(m);
    if (m->normal_map != NONE || m->displacement.program != NONE)
        features |= FEATURE_BUMP | FEATURE_TEXTURE | FEATURE_TANGENTS;
    if (m->roughness_u.program != m->roughness_v.program || m->roughness_u.value != m->roughness_v.value)
        features |= FEATURE_TANGENTS;
    if (m->color0.program != NONE || m->color1.program != NONE || m->roughness_u.program != NONE ||
        m->roughness_v.program != NONE || m->amount.program != NONE)
        features |= FEATURE_TEXTURE;
    return features;
}

static ulong geometry_features(const Scene *scene)
{
    ulong features = scene->instances.count > 0 ? FEATURE_INSTANCE : 0u;
    for (size_t s = 0; s < scene->shapes.count; ++s) {
        const Shape *shape = &ARRAY_AT(&scene->shapes, Shape, s);
        features |= shape->alpha != NONE ? FEATURE_ALPHA | FEATURE_TEXTURE : 0u;
        features |= shape->flags & SHAPE_HAS_NORMALS ? FEATURE_NORMALS : 0u;
    }
    /* FEATURE_TRIANGLE << kind: the kinds have consecutive bits in the order of their numbers */
    for (size_t i = 0; i < scene->primitives.count; ++i)
        features |=
            FEATURE_TRIANGLE << (ARRAY_AT(&scene->primitives, Primitive, i).shape_and_kind >> PRIMITIVE_KIND_SHIFT);
    return features;
}

#define FEATURE_OF(NAME, name, text, feature, position) [LIGHT_##NAME] = (feature),
static const ulong FEATURE_OF_LIGHT[LIGHT_KINDS] = {LIGHT_LIST(FEATURE_OF)};
#undef FEATURE_OF

void scene_features_set(Scene *scene, ulong features)
{
    scene->features = features;
    scene->frame.scene.features[0] = (uint)features;
    scene->frame.scene.features[1] = (uint)(features >> 32);
}

ulong scene_features(const Scene *scene)
{
    ulong features = geometry_features(scene);
    for (size_t i = 0; i < scene->materials.count; ++i)
        features |= material_features(&ARRAY_AT(&scene->materials, Material, i));
    for (size_t i = 0; i < scene->lights.count; ++i)
        features |= FEATURE_OF_LIGHT[light_kind(&ARRAY_AT(&scene->lights, Light, i))];
    for (size_t i = 0; i < scene->texture_ops.count; ++i)
        features |= ARRAY_AT(&scene->texture_ops, TextureOp, i).code >= TEXTURE_FBM ? FEATURE_PROCEDURAL : 0u;
    if (scene->camera_settings.lens_radius > 0.0f)
        features |= FEATURE_LENS;
    if (scene->camera_settings.kind >= CAMERA_EQUAL_AREA)
        features |= FEATURE_SPHERICAL_CAMERA;
    return features | media_features(scene);
}
