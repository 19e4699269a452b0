/* Materials as glTF describes them. */
#include "base/log.h"
#include "gltf/uv_transform.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Wrap modes and filters of samplers: OpenGL's constants. */
#define WRAP_CLAMP_TO_EDGE 33071
#define WRAP_MIRRORED_REPEAT 33648
#define FILTER_NEAREST 9728

static void sampler_read(GltfReader *reader, int index, GltfTexture *texture)
{
    const GltfObject sampler = gltf_entry(reader, "samplers", (size_t)index);
    size_t s = gltf_size(reader, &sampler, "wrapS", 0), t = gltf_size(reader, &sampler, "wrapT", 0);
    texture->nearest = gltf_size(reader, &sampler, "magFilter", 0) == FILTER_NEAREST;
    texture->clamp = s == WRAP_CLAMP_TO_EDGE;
    if (s == WRAP_MIRRORED_REPEAT || t == WRAP_MIRRORED_REPEAT)
        log_message(LOG_WARNING, "%s: mirrored textures are not supported: %s repeats its images", reader->path,
                    sampler.name);
    else if ((s == WRAP_CLAMP_TO_EDGE) != (t == WRAP_CLAMP_TO_EDGE))
        log_message(LOG_WARNING, "%s: %s wraps in one direction only: the other direction does as u", reader->path,
                    sampler.name);
}

/* The texture `key` of an object; `info` becomes its textureInfo. */
static GltfTexture texture_read(GltfReader *reader, const GltfObject *object, const char *key, GltfObject *info)
{
    GltfTexture texture = {.image = -1, .transform = uv_identity()};
    *info = gltf_object(reader, object, key);
    if (!info->json)
        return texture;
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
    const GltfObject transform = gltf_extension(reader, info, "KHR_texture_transform");
    int index = gltf_index(reader, info, "index", "textures");
    size_t set = gltf_size(reader, info, "texCoord", 0);
    gltf_numbers(reader, &transform, "offset", 2, offset);
    gltf_numbers(reader, &transform, "scale", 2, scale);
    double angle = gltf_number(reader, &transform, "rotation", 0.0, -1e6, 1e6);
    if (transform.json)
        texture.transform = uv_make(offset, angle, scale);
    texture.uv_set = (int)gltf_size(reader, &transform, "texCoord", set);
    if (!reader->failed && (index < 0 || texture.uv_set < 0 || texture.uv_set > 7))
        gltf_fail(reader, index < 0 ? "%s names no texture" : "%s: its set of texture coordinates is above 7",
                  info->name);
    if (reader->failed)
        return texture;
    const GltfObject source = gltf_entry(reader, "textures", (size_t)index);
    texture.image = gltf_index(reader, &source, "source", "images");
    int sampler = gltf_index(reader, &source, "sampler", "samplers");
    if (sampler >= 0)
        sampler_read(reader, sampler, &texture);
    if (texture.image < 0 && !reader->failed)
        log_message(LOG_WARNING, "%s: %s has no image in PNG or JPEG and is left out", reader->path, source.name);
    return texture;
}

static void pbr_read(GltfReader *reader, const GltfObject *object, GltfMaterial *material)
{
    GltfObject info;
    const GltfObject pbr = gltf_object(reader, object, "pbrMetallicRoughness");
    gltf_numbers(reader, &pbr, "baseColorFactor", 4, material->base);
    material->metallic = gltf_number(reader, &pbr, "metallicFactor", 1.0, 0.0, 1.0);
    material->roughness = gltf_number(reader, &pbr, "roughnessFactor", 1.0, 0.0, 1.0);
    material->base_texture = texture_read(reader, &pbr, "baseColorTexture", &info);
    material->metallic_roughness_texture = texture_read(reader, &pbr, "metallicRoughnessTexture", &info);
    for (int k = 0; k < 4; ++k)
        material->base[k] = fmin(fmax(material->base[k], 0.0), 1.0);
}

static void emission_read(GltfReader *reader, const GltfObject *object, GltfMaterial *material)
{
    GltfObject info;
    const GltfObject strength = gltf_extension(reader, object, "KHR_materials_emissive_strength");
    double factor = gltf_number(reader, &strength, "emissiveStrength", 1.0, 0.0, 1e30);
    gltf_numbers(reader, object, "emissiveFactor", 3, material->emission);
    for (int k = 0; k < 3; ++k)
        material->emission[k] = fmin(fmax(material->emission[k], 0.0), 1.0) * factor;
    material->emissive_texture = texture_read(reader, object, "emissiveTexture", &info);
}

/* Whether KHR_materials_specular asks for more than all of the specular reflection or none. */
static bool specular_is_partial(const GltfObject *specular, double factor)
{
    size_t plain = json_object_get(specular->json, "specularFactor") ? 1 : 0;
    return factor != 0.0 && (factor != 1.0 || json_object_size(specular->json) > plain);
}

/* After the normal texture. */
static void coat_read(GltfReader *reader, const GltfObject *object, GltfMaterial *material)
{
    GltfObject info;
    const GltfObject coat = gltf_extension(reader, object, "KHR_materials_clearcoat");
    material->coat = gltf_number(reader, &coat, "clearcoatFactor", 0.0, 0.0, 1.0);
    if (gltf_extension(reader, object, "KHR_materials_unlit").json)
        material->coat = 0.0;
    material->coat_roughness = gltf_number(reader, &coat, "clearcoatRoughnessFactor", 0.0, 0.0, 1.0);
    material->coat_texture = texture_read(reader, &coat, "clearcoatTexture", &info);
    material->coat_roughness_texture = texture_read(reader, &coat, "clearcoatRoughnessTexture", &info);
    const GltfTexture normals = texture_read(reader, &coat, "clearcoatNormalTexture", &info);
    if (material->coat > 0.0 && normals.image != material->normal_texture.image)
        log_message(LOG_WARNING, "%s: the clear coat of %s has the normals of what is below", reader->path,
                    object->name);
}

static void extensions_read(GltfReader *reader, const GltfObject *object, GltfMaterial *material)
{
    GltfObject info;
    const GltfObject transmission = gltf_extension(reader, object, "KHR_materials_transmission");
    const GltfObject volume = gltf_extension(reader, object, "KHR_materials_volume");
    const GltfObject ior = gltf_extension(reader, object, "KHR_materials_ior");
    const GltfObject specular = gltf_extension(reader, object, "KHR_materials_specular");
    const GltfObject unlit = gltf_extension(reader, object, "KHR_materials_unlit");
    material->transmission = gltf_number(reader, &transmission, "transmissionFactor", 0.0, 0.0, 1.0);
    material->transmission_texture = texture_read(reader, &transmission, "transmissionTexture", &info);
    material->volume = gltf_number(reader, &volume, "thicknessFactor", 0.0, 0.0, 1e30) > 0.0;
    material->ior = gltf_number(reader, &ior, "ior", 1.5, 0.0, 100.0);
    if (material->ior < 1.0 && !reader->failed) {
        log_message(LOG_WARNING, "%s: %s: an index of refraction below 1 counts as 1.5", reader->path, object->name);
        material->ior = 1.5;
    }
    double factor = gltf_number(reader, &specular, "specularFactor", 1.0, 0.0, 1e30);
    material->matte = unlit.json != NULL || factor == 0.0 || material->ior == 1.0;
    if (specular_is_partial(&specular, factor))
        log_message(LOG_WARNING, "%s: %s: KHR_materials_specular is ignored unless its factor is 0", reader->path,
                    object->name);
    if (unlit.json) {
        log_message(LOG_WARNING, "%s: %s is unlit: it becomes a diffuse surface, which needs light", reader->path,
                    object->name);
        material->metallic = 0.0;
    }
}

static void alpha_read(GltfReader *reader, const GltfObject *object, GltfMaterial *material)
{
    const char *mode = gltf_text(reader, object, "alphaMode", "OPAQUE");
    material->cutoff = gltf_number(reader, object, "alphaCutoff", 0.5, 0.0, 1e30);
    material->double_sided = gltf_bool(reader, object, "doubleSided", false);
    if (strcmp(mode, "MASK") == 0)
        material->alpha = GLTF_MASK;
    else if (strcmp(mode, "BLEND") == 0)
        material->alpha = GLTF_BLEND;
    else if (strcmp(mode, "OPAQUE") != 0)
        gltf_fail(reader, "%s.alphaMode is \"%.40s\" instead of OPAQUE, MASK or BLEND", object->name, mode);
}

#define TEXTURES_PER_MATERIAL 7

static void textures_list(GltfMaterial *material, GltfTexture *out[TEXTURES_PER_MATERIAL])
{
    out[0] = &material->normal_texture;
    out[1] = &material->base_texture;
    out[2] = &material->metallic_roughness_texture;
    out[3] = &material->emissive_texture;
    out[4] = &material->transmission_texture;
    out[5] = &material->coat_texture;
    out[6] = &material->coat_roughness_texture;
}

/* Shapes of pbrt have one set of texture coordinates, normal maps no transform of their own, and textures none that
 * turns. So the vertices get the transform of the normal map or else of a texture that is turned; what the other
 * textures differ by must be a scale and an offset. */
static void textures_unify(GltfReader *reader, const char *name, GltfMaterial *material)
{
    GltfTexture *textures[TEXTURES_PER_MATERIAL];
    bool chosen = false, based = false;
    textures_list(material, textures);
    material->bake = uv_identity();
    for (int i = 0; i < TEXTURES_PER_MATERIAL; ++i) {
        GltfTexture *texture = textures[i];
        if (texture->image < 0)
            continue;
        if (chosen && texture->uv_set != material->uv_set) {
            log_message(LOG_WARNING,
                        "%s: %s uses several sets of texture coordinates: only textures of set %d are kept",
                        reader->path, name, material->uv_set);
            texture->image = -1;
            continue;
        }
        material->uv_set = texture->uv_set;
        chosen = true;
        if (!based && (i == 0 || uv_turns(&texture->transform))) {
            material->bake = texture->transform;
            based = true;
        }
    }
    for (int i = 0; i < TEXTURES_PER_MATERIAL; ++i) {
        textures[i]->transform = uv_after(&textures[i]->transform, &material->bake);
        if (textures[i]->image >= 0 && uv_turns(&textures[i]->transform))
            log_message(LOG_WARNING, "%s: %s turns its textures by different angles: only one is kept", reader->path,
                        name);
    }
}

/* For a name in quotes. */
static void name_clean(char *name)
{
    text_make_printable(name);
    for (; *name; ++name)
        if (*name == '"' || *name == '\\')
            *name = '?';
}

static void material_default(GltfMaterial *material)
{
    *material = (GltfMaterial){.base = {1.0, 1.0, 1.0, 1.0},
                               .metallic = 1.0,
                               .roughness = 1.0,
                               .normal_scale = 1.0,
                               .ior = 1.5,
                               .bake = uv_identity()};
    GltfTexture *textures[TEXTURES_PER_MATERIAL];
    textures_list(material, textures);
    for (int i = 0; i < TEXTURES_PER_MATERIAL; ++i)
        *textures[i] = (GltfTexture){.image = -1, .transform = uv_identity()};
}

static void material_read(GltfReader *reader, size_t i, GltfMaterial *material)
{
    const GltfObject object = gltf_entry(reader, "materials", i);
    GltfObject info;
    material_default(material);
    snprintf(material->name, sizeof material->name, "%.79s", gltf_text(reader, &object, "name", ""));
    name_clean(material->name);
    pbr_read(reader, &object, material);
    emission_read(reader, &object, material);
    extensions_read(reader, &object, material);
    alpha_read(reader, &object, material);
    material->normal_texture = texture_read(reader, &object, "normalTexture", &info);
    material->normal_scale = gltf_number(reader, &info, "scale", 1.0, -1e6, 1e6);
    coat_read(reader, &object, material);
    if (!reader->failed)
        textures_unify(reader, object.name, material);
}

bool gltf_materials_read(Gltf *gltf, GltfReader *reader)
{
    void *materials = NULL;
    size_t count = gltf_count(reader, "materials");
    if (reader->failed || !gltf_allocate(reader, &materials, count + 1, sizeof *gltf->materials))
        return false;
    gltf->materials = materials;
    gltf->material_count = count + 1;
    material_default(&gltf->materials[count]);
    for (size_t i = 0; i < count && !reader->failed; ++i)
        material_read(reader, i, &gltf->materials[i]);
    return !reader->failed;
}
