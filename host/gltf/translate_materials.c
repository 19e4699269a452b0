/* Materials and textures as directives. Metallic-roughness becomes a mix of a conductor and a coated diffuse material,
 * transmission a mix of that with glass, and a clear coat a mix with the same under another coat. */
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

/* The index of refraction of clear coats. */
#define COAT_IOR 1.5

/* What the textures of a material are for; those that it has are printed. */
typedef struct MaterialTextures {
    bool roughness, metallic, transmission, coat, coat_roughness;
} MaterialTextures;

/* One of a material's parts: its name's suffix, and whether it is under the clear coat. */
typedef struct MaterialPart {
    const char *suffix;
    bool coated;
} MaterialPart;

/* Parameter `name`, the alpha of a microfacet distribution: glTF's roughness squared. */
static void alpha_print(Translation *translation, int material, const char *name, const char *texture, double roughness)
{
    if (texture)
        PRINT(translation, " \"texture %s\" \"%d alpha of %s\"", name, material, texture);
    else
        PRINT(translation, " \"float %s\" %.9g", name, roughness * roughness);
}

/* The roughness of the base, or of the clear coat. */
static void roughness_print(Translation *translation, int material, const char *name, const MaterialTextures *textures,
                            bool coat)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    if (coat)
        alpha_print(translation, material, name, textures->coat_roughness ? "coat roughness" : NULL,
                    from->coat_roughness);
    else
        alpha_print(translation, material, name, textures->roughness ? "roughness" : NULL, from->roughness);
}

#define NO_REMAP " \"bool remaproughness\" false"

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

/* The part of diffuse light that the upper coat of a material reflects back inside; of a smooth one where roughness has
 * a texture. */
static double internal_reflectance(const GltfMaterial *material, const MaterialTextures *textures, bool coated)
{
    double root = coated ? material->coat_roughness : material->roughness, ior = coated ? COAT_IOR : material->ior;
    bool textured = coated ? textures->coat_roughness : textures->roughness;
    double alpha = textured ? 0.0 : root * root;
    return material->matte && !coated ? 0.0 : 1.0 - (double)coat_escape((float)alpha, (float)ior);
}

/* The part that is not metal: a coat over a diffuse base whose albedo through the coat is the base colour. A clear coat
 * takes the place of the base's own. */
static void dielectric_print(Translation *translation, int material, MaterialPart part,
                             const MaterialTextures *textures)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    const bool matte = from->matte && !part.coated;
    const char *name = part.coated ? "base under the coat" : "base";
    double internal = internal_reflectance(from, textures, part.coated), base[3];
    const DerivedImage color = {
        .kind = DERIVED_COLOR, .factor = {from->base[0], from->base[1], from->base[2]}, .coat = internal};
    for (int k = 0; k < 3; ++k)
        base[k] = gltf_coat_base(from->base[k], internal);
    bool textured = texture_print(translation, material, name, &from->base_texture, color);
    if (textured)
        PRINT(translation, "\n");
    named_begin(translation, material, part.suffix, matte ? "diffuse" : "coateddiffuse");
    color_print(translation, material, "reflectance", textured, name, base);
    if (!matte) {
        PRINT(translation, " \"float eta\" %.9g \"float thickness\" 0", part.coated ? COAT_IOR : from->ior);
        roughness_print(translation, material, "roughness", textures, part.coated);
        PRINT(translation, NO_REMAP);
    }
    named_end(translation, material);
}

static void metal_print(Translation *translation, int material, MaterialPart part, const MaterialTextures *textures)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    const char *name = part.coated ? "metal under the coat" : "metal";
    const DerivedImage color = {.kind = DERIVED_COLOR, .factor = {from->base[0], from->base[1], from->base[2]}};
    bool textured = texture_print(translation, material, name, &from->base_texture, color);
    if (textured)
        PRINT(translation, "\n");
    named_begin(translation, material, part.suffix, part.coated ? "coatedconductor" : "conductor");
    color_print(translation, material, "reflectance", textured, name, from->base);
    roughness_print(translation, material, part.coated ? "conductor.roughness" : "roughness", textures, false);
    if (part.coated) {
        PRINT(translation, " \"float interface.eta\" %.9g \"float thickness\" 0", COAT_IOR);
        roughness_print(translation, material, "interface.roughness", textures, true);
    }
    PRINT(translation, NO_REMAP);
    named_end(translation, material);
}

/* Glass: thin unless the material has a volume. A thin one is smooth. A clear coat changes nothing of it. */
static void glass_print(Translation *translation, int material, MaterialPart part, const MaterialTextures *textures)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    bool tinted = from->base_texture.image >= 0 || from->base[0] < 1.0 || from->base[1] < 1.0 || from->base[2] < 1.0;
    bool rough = textures->roughness || from->roughness > 0.0;
    if (!part.coated && (tinted || (!from->volume && rough)))
        log_message(LOG_WARNING, "%s: what materials[%d] transmits is not tinted%s", translation->gltf->path, material,
                    from->volume ? "" : ", and a thin pane is smooth");
    if (part.coated)
        log_message(LOG_WARNING, "%s: the clear coat of materials[%d] leaves out what transmits light",
                    translation->gltf->path, material);
    named_begin(translation, material, part.suffix, from->volume ? "dielectric" : "thindielectric");
    PRINT(translation, " \"float eta\" %.9g", from->ior);
    if (from->volume) {
        roughness_print(translation, material, "roughness", textures, false);
        PRINT(translation, NO_REMAP);
    }
    named_end(translation, material);
}

/* The square of a roughness times its texture, as "N alpha of NAME". */
static bool alpha_of_texture(Translation *translation, int material, const char *name, const GltfTexture *texture,
                             double factor)
{
    if (!channel_print(translation, material, name, texture, 1, factor))
        return false;
    PRINT(translation,
          "Texture \"%d alpha of %s\" \"float\" \"scale\" \"texture tex\" \"%d %s\" \"texture scale\" \"%d %s\"\n",
          material, name, material, name, material, name);
    return true;
}

/* The part that is not metal: with transmission a mix. */
static void nonmetal_print(Translation *translation, int material, MaterialPart part, const MaterialTextures *textures)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    static const char *const PARTS[2][2] = {{" coat", " glass"}, {" coat under the coat", " glass under the coat"}};
    if (from->transmission == 0.0) {
        dielectric_print(translation, material, part, textures);
    } else if (from->transmission == 1.0 && !textures->transmission) {
        glass_print(translation, material, part, textures);
    } else {
        const char *const *parts = PARTS[part.coated];
        dielectric_print(translation, material, (MaterialPart){parts[0], part.coated}, textures);
        glass_print(translation, material, (MaterialPart){parts[1], part.coated}, textures);
        mix_print(translation, material, part.suffix, parts, textures->transmission ? "transmission" : NULL,
                  from->transmission);
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

static MaterialTextures textures_print(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    MaterialTextures textures = {0};
    textures.roughness =
        alpha_of_texture(translation, material, "roughness", &from->metallic_roughness_texture, from->roughness);
    textures.metallic = from->metallic > 0.0 && channel_print(translation, material, "metallic",
                                                              &from->metallic_roughness_texture, 2, from->metallic);
    textures.transmission =
        (from->metallic < 1.0 || textures.metallic) && from->transmission > 0.0 &&
        channel_print(translation, material, "transmission", &from->transmission_texture, 0, from->transmission);
    textures.coat =
        from->coat > 0.0 && channel_print(translation, material, "clear coat", &from->coat_texture, 0, from->coat);
    textures.coat_roughness = from->coat > 0.0 && alpha_of_texture(translation, material, "coat roughness",
                                                                   &from->coat_roughness_texture, from->coat_roughness);
    alpha_texture(translation, material);
    return textures;
}

/* Metal, what is not, or a mix of both. */
static void base_print(Translation *translation, int material, MaterialPart part, const MaterialTextures *textures)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    static const char *const PARTS[2][2] = {{" dielectric", " metal"},
                                            {" dielectric under the coat", " metal under the coat"}};
    if (from->metallic == 0.0) {
        nonmetal_print(translation, material, part, textures);
    } else if (from->metallic == 1.0 && !textures->metallic) {
        metal_print(translation, material, part, textures);
    } else {
        const char *const *parts = PARTS[part.coated];
        nonmetal_print(translation, material, (MaterialPart){parts[0], part.coated}, textures);
        metal_print(translation, material, (MaterialPart){parts[1], part.coated}, textures);
        mix_print(translation, material, part.suffix, parts, textures->metallic ? "metallic" : NULL, from->metallic);
    }
}

static void material_print(Translation *translation, int material)
{
    const GltfMaterial *from = &translation->gltf->materials[material];
    static const char *const PARTS[2] = {" bare", " under the coat"};
    const MaterialTextures textures = textures_print(translation, material);
    if (from->coat == 0.0 || (from->coat == 1.0 && !textures.coat)) {
        base_print(translation, material, (MaterialPart){"", from->coat > 0.0}, &textures);
        return;
    }
    base_print(translation, material, (MaterialPart){PARTS[0], false}, &textures);
    base_print(translation, material, (MaterialPart){PARTS[1], true}, &textures);
    mix_print(translation, material, "", PARTS, textures.coat ? "clear coat" : NULL, from->coat);
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
