#include "pbrt/coats.h"

#include "base/log.h"
#include "bsdf/fresnel.h"
#include "pbrt/errors.h"
#include "pbrt/values.h"
#include "scene/coat_medium.h"

static void thickness_read(PbrtImport *im, ParamList *list, CoatMedium *medium)
{
    FloatParam thickness = {.value = 0.01f, .program = NONE};
    if (!value_float_param(im, list, "thickness", &thickness))
        return;
    if (thickness.program != NONE) {
        thickness.value = float_max(value_texture_mean(im, thickness.program, 0.01f), 0.0f);
        log_message_at(LOG_WARNING, param_place(list, "thickness"),
                       "the thickness of the coat is a texture: its mean, %g, is used", (double)thickness.value);
    }
    if (!(thickness.value >= 0.0f))
        param_error(list, "thickness", "the thickness of a coat must be at least 0");
    medium->thickness = thickness.value;
}

static void albedo_read(PbrtImport *im, ParamList *list, bool scatters, CoatMedium *medium)
{
    ColorParam albedo = {.value = vec3_splat(0.0f), .program = NONE};
    if (!value_color_param(im, list, "albedo", COLOR_REFLECTANCE, &albedo) ||
        (albedo.program == NONE && vec3_is_zero(albedo.value)))
        return;
    medium->place = param_place(list, "albedo");
    if (scatters && albedo.program == NONE)
        medium->albedo = albedo.value;
    else
        list->failed = !import_unsupported(
            im, medium->place, scatters ? "a texture as the albedo inside a coat" : "a medium inside a coat (albedo)",
            "a clear coat", NULL);
}

static void asymmetry_read(PbrtImport *im, ParamList *list, CoatMedium *medium)
{
    FloatParam g = {.value = 0.0f, .program = NONE};
    value_float_param(im, list, "g", &g);
    if (vec3_is_zero(medium->albedo) || list->failed)
        return;
    if (g.program != NONE || !(g.value > -1.0f && g.value < 1.0f))
        param_error(list, "g", "the g of a coat must be a number above -1 and below 1");
    medium->g = g.value;
}

void coat_medium_read(PbrtImport *im, ParamList *list, bool scatters, CoatMedium *medium)
{
    *medium = (CoatMedium){.thickness = 0.01f};
    thickness_read(im, list, medium);
    albedo_read(im, list, scatters, medium);
    asymmetry_read(im, list, medium);
    param_integer(list, "maxdepth", 10);
    param_integer(list, "nsamples", 1);
}

/* ---- the mix that stands for a scattering medium ----------------------------------------------------------------- */

static CoatLayers layers_of(const CoatMedium *medium, const Material *coat)
{
    Vec3 eta = coat->color0.value, k = coat->color1.value;
    if ((coat->flags & MATERIAL_CONDUCTOR_REFLECTANCE) != 0u) {
        k = vec3(extinction_from_reflectance(eta.x), extinction_from_reflectance(eta.y),
                 extinction_from_reflectance(eta.z));
        eta = vec3_splat(1.0f);
    }
    return (CoatLayers){.eta = coat->eta,
                        .thickness = medium->thickness,
                        .g = medium->g,
                        .albedo = medium->albedo,
                        .metal_eta = vec3_scale(eta, 1.0f / coat->eta),
                        .metal_k = vec3_scale(k, 1.0f / coat->eta)};
}

void coat_medium_apply(PbrtImport *im, ParamList *list, const CoatMedium *medium, Material *coat)
{
    coat->scale = medium->thickness;
    if (vec3_is_zero(medium->albedo) || list->failed)
        return;
    if (coat->color0.program != NONE || coat->color1.program != NONE) {
        list->failed = !import_unsupported(im, medium->place, "a coat with an albedo over a metal with a texture",
                                           "a clear coat", NULL);
        return;
    }
    CoatLayers layers = layers_of(medium, coat);
    CoatMix found = coat_medium_mix(&layers);
    coat->scale = found.thickness;
    if (!(found.amount > 0.0f))
        return;
    log_message_at(LOG_WARNING, medium->place,
                   "the medium inside the coat scatters: a diffuse part of the same albedo stands for that");
    Material base = *coat, mix = *coat;
    base.kind = MATERIAL_COATED_DIFFUSE;
    base.flags &= ~MATERIAL_CONDUCTOR_REFLECTANCE;
    base.color0.value = found.reflectance;
    base.color1.value = vec3_splat(0.0f);
    mix.kind = MATERIAL_MIX;
    mix.amount = (FloatParam){.value = found.amount, .program = NONE};
    mix.displacement.program = NONE;
    mix.normal_map = NONE;
    if (!scene_add_material(im->scene, coat, &mix.mix_a, im->error) ||
        !scene_add_material(im->scene, &base, &mix.mix_b, im->error))
        list->failed = true;
    *coat = mix;
}
