#include "scene/format.h"

#include "base/path_name.h"

#include <string.h>

/* First bytes of other formats. Leading blanks and a UTF-8 byte order mark are skipped. */
static const struct {
    const char *head;
    size_t size;
    const char *what, *fix;
} FORMATS[] = {
    {"glTF", 4, "a binary glTF file", "give it a name that ends in .glb"},
    {"{", 1, "a JSON file, as those of glTF and Tungsten are", "give it a name that ends in .gltf if it is glTF"},
    {"<", 1, "an XML file, as Mitsuba's scenes are", "export the scene for pbrt-v4"},
    {"ply\n", 4, "a PLY mesh", "name it in a scene: Shape \"plymesh\" \"string filename\" \"FILE.ply\""},
    {"ply\r", 4, "a PLY mesh", "name it in a scene: Shape \"plymesh\" \"string filename\" \"FILE.ply\""},
    {"#usda", 5, "a USD file", "export the scene for pbrt-v4"},
    {"PXR-USDC", 8, "a USD file", "export the scene for pbrt-v4"},
    {"\x1f\x8b", 2, "compressed by gzip", "uncompress it: gunzip --keep FILE.gz"}, /* on standard input */
    {"Kaydara FBX Binary", 18, "an FBX file", "export the scene for pbrt-v4"},
    {"PK\x03\x04", 4, "a ZIP archive, as USDZ files are", "unpack it, and give the scene for pbrt-v4 in it"},
    {"\x89PNG", 4, "a PNG image", "give the scene that was rendered"},
    {"\x76\x2f\x31\x01", 4, "an OpenEXR image", "give the scene that was rendered"},
    {"BLENDER", 7, "a Blender file", "export the scene for pbrt-v4"},
};

const char *scene_format_other(const char *head, size_t size, const char **fix)
{
    size_t blanks = 0;
    if (size >= 3 && memcmp(head, "\xef\xbb\xbf", 3) == 0)
        blanks = 3;
    while (blanks < size && strchr(" \t\r\n", head[blanks]) && head[blanks])
        ++blanks;
    for (size_t i = 0; i < sizeof FORMATS / sizeof FORMATS[0]; ++i)
        if (size - blanks >= FORMATS[i].size && memcmp(head + blanks, FORMATS[i].head, FORMATS[i].size) == 0) {
            *fix = FORMATS[i].fix;
            return FORMATS[i].what;
        }
    return NULL;
}

/* Names of other formats' files, for those that do not begin with a mark. */
static const struct {
    const char *extension, *what, *fix;
} EXTENSIONS[] = {
    {".obj", "a Wavefront OBJ mesh", "convert it to PLY, and name that in a scene"},
    {".mtl", "a Wavefront material library", "write the materials into a scene for pbrt-v4"},
    {".stl", "an STL mesh", "convert it to PLY, and name that in a scene"},
    {".xml", "an XML file, as Mitsuba's scenes are", "export the scene for pbrt-v4"},
    {".blend", "a Blender file", "export the scene for pbrt-v4"},
    {".usd", "a USD file", "export the scene for pbrt-v4"},
    {".usda", "a USD file", "export the scene for pbrt-v4"},
    {".usdc", "a USD file", "export the scene for pbrt-v4"},
    {".usdz", "a USD file", "export the scene for pbrt-v4"},
    {".fbx", "an FBX file", "export the scene for pbrt-v4"},
    {".dae", "a COLLADA file", "export the scene for pbrt-v4"},
    {".abc", "an Alembic file", "export the scene for pbrt-v4"},
    {".json", "a JSON file, as Tungsten's scenes are", "export the scene for pbrt-v4"},
    {".lxs", "a LuxRender scene", "export the scene for pbrt-v4"},
    {".scn", "a LuxCoreRender scene", "export the scene for pbrt-v4"},
};

const char *scene_format_named(const char *name, const char **fix)
{
    for (size_t i = 0; i < sizeof EXTENSIONS / sizeof EXTENSIONS[0]; ++i)
        if (path_ends(name, EXTENSIONS[i].extension)) {
            *fix = EXTENSIONS[i].fix;
            return EXTENSIONS[i].what;
        }
    return NULL;
}

bool scene_format_is_v3(const char *kind, const char *name)
{
    static const char *const NAMES[][2] = {
        {"material", "disney"},       {"material", "fourier"}, {"material", "glass"},
        {"material", "kdsubsurface"}, {"material", "matte"},   {"material", "metal"},
        {"material", "mirror"},       {"material", "plastic"}, {"material", "substrate"},
        {"material", "translucent"},  {"material", "uber"},    {"film", "image"},
        {"type of texture", "color"}, {"shape", "cone"},       {"shape", "heightfield"},
        {"shape", "hyperboloid"},     {"shape", "nurbs"},      {"shape", "paraboloid"}};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; ++i)
        if (strcmp(kind, NAMES[i][0]) == 0 && strcmp(name, NAMES[i][1]) == 0)
            return true;
    return false;
}
