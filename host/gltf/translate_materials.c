/* Materials and textures as directives. Metallic-roughness becomes a mix of a conductor and a coated diffuse material,
 * transmission a mix of that with glass. */
#include "base/log.h"
#include "gltf/images.h"
#include "gltf/translate.h"
#include "gltf/uv_transform.h"
#include "scene/coat_table.h"

#include <math.h>

#define PRINT(translation, ...) fprintf((translation)->out, __VA_ARGS__)

void gltf_material_name(const Translation *translation, int material, const char *suffix)
{
    const char *name = translation->gltf->materials[material].name;
    PRINT(translation, "\"%d%s%s%s\"", material, *name ? " " : "", name, suffix);
}

/* File name of derived image `image`, in quotes. */
static void file_print(Translation *translation, int image)
{
    PRINT(translation, "\"%s-textures/%d%s\"", translation->prefix, image,
          gltf_derived_ending(translation->gltf, image));
}

/* Mapping, wrap and filter of a texture. */
static void sampling_print(Translation *translation, const GltfTexture *texture)
{
    const UvTransform to = uv_of_pbrt(&texture->transform);
    if (texture->clamp)
        PRINT(translation, " \"string wrap\" \"clamp\"");
    if (texture->nearest)
        PRINT(translation, " \"string filter\" \"point\"");
    if (!uv_is_identity(&texture->transform))
        PRINT(translation, " \"float uscale\" %.9g \"float udelta\" %.9g \"float vscale\" %.9g \"float vdelta\" %.9g",
              to.m[0], to.m[2], to.m[4], to.m[5]);
}

/* Texture "N NAME" of an image made of a texture of the file. False if the material has no such texture. */
static bool texture_print(Translation *translation, int material, const char *name, const GltfTexture *texture,
                          DerivedImage derived)
{
    if (texture->image < 0)
        return false;
    bool color = derived.kind == DERIVED_COLOR;
    derived.image = texture->image;
    int image = gltf_derived_add(translation->gltf, translation->reader, derived);
    if (image < 0)
        return false;
    PRINT(translation, "Texture \"%d %s\" \"%s\" \"imagemap\" \"string filename\" ", material, name,
          color ? "spectrum" : "float");
    file_print(translation, image);
    if (!color)
        PRINT(translation, " \"string encoding\" \"linear\"");
    sampling_print(translation, texture);
    return true;
}

/* The same for one channel, times `factor`. */
static bool channel_print(Translation *translation, int material, const char *name, const GltfTexture *texture,
                          int channel, double factor)
{
    if (!texture_print(translation, material, name, texture,
                       (DerivedImage){.kind = DERIVED_CHANNEL, .channel = channel}))
        return false;
    PRINT(translation, " \"float scale\" %.9g\n", factor);
    return true;
}

/* Parameter `name`: the texture "N TEXTURE" or a colour. */
static void color_print(Translation *translation, int material, const char *name, bool textured, const char *texture,
                        const double color[3])
{
    if (textured)
        PRINT(translation, " \"texture %s\" \"%d %s\"", name, material, texture);
    else
        PRINT(translation, " \"rgb %s\" [ %.9g %.9g %.9g ]", name, color[0], color[1], color[2]);
}

/* The alpha of the microfacet distribution: glTF's roughness squared. */
static void roughness_print(Translation *translation, int material, bool textured)
{
    double roughness = translation->gltf->materials[material].roughness;
    if (textured)
        PRINT(translation, " \"texture roughness\" \"%d alpha of roughness\"", material);
    else
        PRINT(translation, " \"float roughness\" %.9g", roughness * roughness);
    PRINT(translation, " \"bool remaproughness\" false");
}

static void normal_print(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    if (from->normal_texture.image < 0)
        return;
    const DerivedImage derived = {
        .kind = DERIVED_NORMAL, .image = from->normal_texture.image, .factor = {from->normal_scale}};
    int image = gltf_derived_add(translation->gltf, translation->reader, derived);
    if (image < 0)
        return;
    PRINT(translation, " \"string normalmap\" ");
    file_print(translation, image);
}

static void named_begin(Translation *translation, int material, const char *suffix, const char *kind)
{
    PRINT(translation, "MakeNamedMaterial ");
    gltf_material_name(translation, material, suffix);
    PRINT(translation, " \"string type\" \"%s\"", kind);
}

static void named_end(Translation *translation, int material)
{
    normal_print(translation, material);
    PRINT(translation, "\n");
}

/* Material N of the given suffix as a mix of two others. */
static void mix_print(Translation *translation, int material, const char *suffix, const char *const parts[2],
                      const char *texture, double amount)
{
    named_begin(translation, material, suffix, "mix");
    PRINT(translation, " \"string materials\" [ ");
    for (int i = 0; i < 2; ++i) {
        gltf_material_name(translation, material, parts[i]);
        PRINT(translation, " ");
    }
    if (texture)
        PRINT(translation, "] \"texture amount\" \"%d %s\"\n", material, texture);
    else
        PRINT(translation, "] \"float amount\" %.9g\n", amount);
}

/* The part of diffuse light that the coat of a material reflects back inside; smooth where roughness has a texture. */
static double internal_reflectance(const GltfMaterial *material, bool rough)
{
    double alpha = rough ? 0.0 : material->roughness * material->roughness;
    return material->matte ? 0.0 : 1.0 - (double)coat_escape((float)alpha, (float)material->ior);
}

/* The part that is not metal: a coat over a diffuse base whose albedo through the coat is the base colour. */
static void dielectric_print(Translation *translation, int material, const char *suffix, bool rough)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    double internal = internal_reflectance(from, rough), base[3];
    const DerivedImage color = {
        .kind = DERIVED_COLOR, .factor = {from->base[0], from->base[1], from->base[2]}, .coat = internal};
    for (int k = 0; k < 3; ++k)
        base[k] = gltf_coat_base(from->base[k], internal);
    bool textured = texture_print(translation, material, "base", &from->base_texture, color);
    if (textured)
        PRINT(translation, "\n");
    named_begin(translation, material, suffix, from->matte ? "diffuse" : "coateddiffuse");
    color_print(translation, material, "reflectance", textured, "base", base);
    if (!from->matte) {
        PRINT(translation, " \"float eta\" %.9g \"float thickness\" 0", from->ior);
        roughness_print(translation, material, rough);
    }
    named_end(translation, material);
}

static void metal_print(Translation *translation, int material, const char *suffix, bool rough)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    const DerivedImage color = {.kind = DERIVED_COLOR, .factor = {from->base[0], from->base[1], from->base[2]}};
    bool textured = texture_print(translation, material, "metal", &from->base_texture, color);
    if (textured)
        PRINT(translation, "\n");
    named_begin(translation, material, suffix, "conductor");
    color_print(translation, material, "reflectance", textured, "metal", from->base);
    roughness_print(translation, material, rough);
    named_end(translation, material);
}

/* Glass: thin unless the material has a volume. A thin one is smooth. */
static void glass_print(Translation *translation, int material, const char *suffix, bool rough)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    bool tinted = from->base_texture.image >= 0 || from->base[0] < 1.0 || from->base[1] < 1.0 || from->base[2] < 1.0;
    if (tinted || (!from->volume && (rough || from->roughness > 0.0)))
        log_message(LOG_WARNING, "%s: what materials[%d] transmits is not tinted%s", translation->gltf->path, material,
                    from->volume ? "" : ", and a thin pane is smooth");
    named_begin(translation, material, suffix, from->volume ? "dielectric" : "thindielectric");
    PRINT(translation, " \"float eta\" %.9g", from->ior);
    if (from->volume)
        roughness_print(translation, material, rough);
    named_end(translation, material);
}

/* The square of roughness times its texture, as "N alpha of roughness". */
static bool roughness_texture(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    if (!channel_print(translation, material, "roughness", &from->metallic_roughness_texture, 1, from->roughness))
        return false;
    PRINT(translation,
          "Texture \"%d alpha of roughness\" \"float\" \"scale\" \"texture tex\" \"%d roughness\" \"texture scale\" "
          "\"%d roughness\"\n",
          material, material, material);
    return true;
}

/* The part that is not metal, as material SUFFIX: with transmission a mix. */
static void nonmetal_print(Translation *translation, int material, const char *suffix, bool rough)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    static const char *const PARTS[2] = {" coat", " glass"};
    bool textured = from->transmission > 0.0 && channel_print(translation, material, "transmission",
                                                              &from->transmission_texture, 0, from->transmission);
    if (from->transmission == 0.0) {
        dielectric_print(translation, material, suffix, rough);
    } else if (from->transmission == 1.0 && !textured) {
        glass_print(translation, material, suffix, rough);
    } else {
        dielectric_print(translation, material, PARTS[0], rough);
        glass_print(translation, material, PARTS[1], rough);
        mix_print(translation, material, suffix, PARTS, textured ? "transmission" : NULL, from->transmission);
    }
}

static void alpha_texture(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    if (from->alpha != GLTF_OPAQUE &&
        texture_print(translation, material, "alpha", &from->base_texture,
                      (DerivedImage){.kind = from->alpha == GLTF_MASK ? DERIVED_MASK : DERIVED_ALPHA,
                                     .factor = {from->base[3], from->alpha == GLTF_MASK ? from->cutoff : 0.0}}))
        PRINT(translation, "\n");
}

static void material_print(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    static const char *const PARTS[2] = {" dielectric", " metal"};
    bool rough = roughness_texture(translation, material);
    bool mixed = from->metallic > 0.0 &&
                 channel_print(translation, material, "metallic", &from->metallic_roughness_texture, 2, from->metallic);
    alpha_texture(translation, material);
    if (from->metallic == 0.0) {
        nonmetal_print(translation, material, "", rough);
    } else if (from->metallic == 1.0 && !mixed) {
        metal_print(translation, material, "", rough);
    } else {
        nonmetal_print(translation, material, PARTS[0], rough);
        metal_print(translation, material, PARTS[1], rough);
        mix_print(translation, material, "", PARTS, mixed ? "metallic" : NULL, from->metallic);
    }
}

void gltf_material_alpha(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    if (from->alpha == GLTF_OPAQUE)
        return;
    if (from->base_texture.image >= 0)
        PRINT(translation, " \"texture alpha\" \"%d alpha\"", material);
    else if (from->alpha == GLTF_BLEND && from->base[3] < 1.0)
        PRINT(translation, " \"float alpha\" %.9g", from->base[3]);
}

bool gltf_material_invisible(const GltfMaterial *material)
{
    return (material->alpha == GLTF_MASK && material->base[3] < material->cutoff) ||
           (material->alpha == GLTF_BLEND && material->base[3] == 0.0);
}

bool gltf_translate_materials(Translation *translation)
{
    const Gltf *gltf = translation->gltf;
    for (size_t i = 0; i < gltf->material_count && !translation->reader->failed; ++i)
        if (gltf->materials[i].used)
            material_print(translation, (int)i);
    return !translation->reader->failed;
}
