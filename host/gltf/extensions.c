/* What is not supported: said, or refused if the file requires it. */
#include "base/log.h"
#include "gltf/document.h"

#include <string.h>

/* Extensions that are read. */
static const char *const READ[] = {"KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
                                   "KHR_materials_ior",   "KHR_materials_specular",  "KHR_materials_transmission",
                                   "KHR_materials_unlit", "KHR_texture_transform"};

/* Extensions that describe nothing that is seen here. */
static const char *const SILENT[] = {"KHR_xmp_json_ld", "KHR_materials_variants"};

static bool listed(const char *name, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

#define LISTED(name, names) listed(name, names, sizeof(names) / sizeof *(names))

static const char *extension_name(GltfReader *reader, const char *key, size_t i)
{
    const GltfObject root = {reader->root, ""};
    size_t count;
    const char *name = json_string_value(json_array_get(gltf_array(reader, &root, key, &count), i));
    if (!name)
        gltf_fail(reader, "%s[%zu] must be a string", key, i);
    return name;
}

static bool required_check(GltfReader *reader)
{
    const GltfObject root = {reader->root, ""};
    size_t count;
    gltf_array(reader, &root, "extensionsRequired", &count);
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        const char *name = extension_name(reader, "extensionsRequired", i);
        /* A volume is an addition to transmission, which is rendered. */
        if (!name || LISTED(name, READ) || strcmp(name, "KHR_materials_volume") == 0)
            continue;
        gltf_fail(reader, "the file requires the extension %.100s, which is not supported", name);
        return error_fix(reader->error, "%s",
                         strstr(name, "draco") || strstr(name, "meshopt") || strstr(name, "quantization")
                             ? "export it again without compression of meshes"
                         : strstr(name, "basisu") || strstr(name, "webp") || strstr(name, "avif")
                             ? "export it again with textures in PNG or JPEG"
                             : "export it again without this extension");
    }
    return !reader->failed;
}

static void used_report(GltfReader *reader)
{
    const GltfObject root = {reader->root, ""};
    size_t count;
    gltf_array(reader, &root, "extensionsUsed", &count);
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        const char *name = extension_name(reader, "extensionsUsed", i);
        if (!name || LISTED(name, READ) || LISTED(name, SILENT))
            continue;
        if (strcmp(name, "KHR_materials_volume") == 0)
            log_message(LOG_WARNING, "%s: KHR_materials_volume makes surfaces refract; its attenuation is ignored",
                        reader->path);
        else
            log_message(LOG_WARNING, "%s: the extension %.100s is not supported and is ignored", reader->path, name);
    }
}

/* Whether an entry of `array` has the member, or one of its primitives. */
static bool any_has(GltfReader *reader, const char *array, const char *key)
{
    size_t count = gltf_count(reader, array), primitives;
    for (size_t i = 0; i < count && !reader->failed; ++i) {
        const GltfObject entry = gltf_entry(reader, array, i);
        const json_t *list = gltf_array(reader, &entry, "primitives", &primitives);
        if (json_object_get(entry.json, key))
            return true;
        for (size_t k = 0; k < primitives; ++k)
            if (json_object_get(json_array_get(list, k), key))
                return true;
    }
    return false;
}

bool gltf_extensions_check(const Gltf *gltf, GltfReader *reader)
{
    if (!required_check(reader))
        return false;
    used_report(reader);
    if (gltf_count(reader, "animations") > 0)
        log_message(LOG_INFO, "%s: animations are not played: nodes stay where the file puts them", gltf->path);
    if (any_has(reader, "meshes", "targets"))
        log_message(LOG_INFO, "%s: morph targets have the default weights of their nodes and meshes", gltf->path);
    return !reader->failed;
}
