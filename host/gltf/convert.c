/* Writes a glTF scene as files of pbrt-v4. */
#include "base/input_files.h"
#include "base/output_file.h"
#include "gltf/images.h"
#include "gltf/translate.h"
#include "image/exr.h"
#include "image/png_write.h"

#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* NAME.pbrt without its ending, in `stem`; false if it is too long. */
static bool stem_make(const char *path, char stem[PATH_MAX], Error *error)
{
    size_t length = strlen(path) - strlen(".pbrt");
    if (length + 64 < PATH_MAX) {
        snprintf(stem, PATH_MAX, "%.*s", (int)length, path);
        return true;
    }
    errno = ENAMETOOLONG;
    return error_errno(error, "write", path);
}

/* Fails if writing `path` would replace a file that the scene consists of. */
static bool input_keep(const char *path, Error *error)
{
    struct stat status;
    if (stat(path, &status) != 0 || !input_file_noted(&status))
        return true;
    error_set(error, "the conversion would overwrite a file that the scene reads: %s", path);
    return error_fix(error, "give another name");
}

/* Makes the folder STEM-WHAT unless it is there. */
static bool folder_make(const char *stem, const char *what, Error *error)
{
    char path[PATH_MAX + 32];
    struct stat status;
    snprintf(path, sizeof path, "%s-%s", stem, what);
    if (mkdir(path, 0777) == 0 || (errno == EEXIST && stat(path, &status) == 0 && S_ISDIR(status.st_mode)))
        return true;
    error_errno(error, "make the folder", path);
    return error_fix(error, "give a name in a folder that exists and is writable, and whose place nothing else takes");
}

/* ---- meshes ------------------------------------------------------------------------------------------------------ */

static void little_endian_put(FILE *stream, const void *words, size_t count)
{
    const uint32_t *from = words;
    for (size_t i = 0; i < count; ++i) {
        const unsigned char bytes[4] = {(unsigned char)from[i], (unsigned char)(from[i] >> 8),
                                        (unsigned char)(from[i] >> 16), (unsigned char)(from[i] >> 24)};
        fwrite(bytes, 1, 4, stream);
    }
}

static void ply_print(FILE *stream, const PlyMesh *mesh)
{
    fprintf(stream, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", mesh->vertex_count);
    fprintf(stream, "property float x\nproperty float y\nproperty float z\n");
    if (mesh->normals)
        fprintf(stream, "property float nx\nproperty float ny\nproperty float nz\n");
    if (mesh->uvs)
        fprintf(stream, "property float u\nproperty float v\n");
    fprintf(stream, "element face %zu\nproperty list uchar int vertex_indices\nend_header\n", mesh->triangle_count);
    for (size_t i = 0; i < mesh->vertex_count; ++i) {
        little_endian_put(stream, mesh->positions + 3 * i, 3);
        if (mesh->normals)
            little_endian_put(stream, mesh->normals + 3 * i, 3);
        if (mesh->uvs)
            little_endian_put(stream, mesh->uvs + 2 * i, 2);
    }
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        putc(3, stream);
        little_endian_put(stream, mesh->triangles + 3 * i, 3);
    }
}

static bool mesh_write(const char *path, const PlyMesh *mesh, Error *error)
{
    OutputFile file;
    if (!input_keep(path, error) || !output_file_begin(&file, path, error))
        return false;
    FILE *stream = output_file_stream(&file, error);
    if (!stream)
        return false;
    ply_print(stream, mesh);
    return output_file_stream_commit(&file, stream, error);
}

static bool meshes_write(const Gltf *gltf, const char *stem, Error *error)
{
    char path[PATH_MAX + 64];
    if (gltf->parts.count > 0 && !folder_make(stem, "meshes", error))
        return false;
    for (size_t i = 0; i < gltf->parts.count; ++i) {
        snprintf(path, sizeof path, "%s-meshes/%zu.ply", stem, i);
        if (!mesh_write(path, &ARRAY_AT(&gltf->parts, GltfPart, i).mesh, error))
            return false;
    }
    return true;
}

/* ---- images ------------------------------------------------------------------------------------------------------ */

static bool image_write(const char *path, const Image *image, Error *error)
{
    const float *data = image->data;
    size_t stride = (size_t)image->channels;
    if (!image->is_float)
        return png_write_bytes(path, image->data, image->width, image->height, image->channels, error);
    const ExrChannel grey[] = {{"Y", data, 1, false}};
    const ExrChannel color[] = {
        {"R", data, stride, false}, {"G", data + 1, stride, false}, {"B", data + 2, stride, false}};
    return exr_write(path, stride == 1 ? grey : color, stride, image->width, image->height, error);
}

static bool images_write(Gltf *gltf, const char *stem, Error *error)
{
    char path[PATH_MAX + 64];
    if (gltf->derived.count > 0 && !folder_make(stem, "textures", error))
        return false;
    for (size_t i = 0; i < gltf->derived.count; ++i) {
        Image image;
        snprintf(path, sizeof path, "%s-textures/%zu%s", stem, i, gltf_derived_ending(gltf, (int)i));
        if (!input_keep(path, error) ||
            !gltf_derived_make(gltf, &ARRAY_AT(&gltf->derived, DerivedImage, i), &image, error))
            return false;
        bool good = image_write(path, &image, error);
        image_destroy(&image);
        if (!good)
            return false;
    }
    return true;
}

/* ---- the scene --------------------------------------------------------------------------------------------------- */

/* The last part of the stem, as the scene names its files; quotes and backslashes would end or change the string. */
static const char *prefix_of(const char *stem, Error *error)
{
    const char *slash = strrchr(stem, '/'), *prefix = slash ? slash + 1 : stem;
    if (!strpbrk(prefix, "\"\\\n\r"))
        return prefix;
    error_set(error, "the name %s cannot be written in a scene file", prefix);
    error_fix(error, "give a name without quotes, backslashes and line breaks");
    return NULL;
}

bool gltf_convert(Gltf *gltf, const char *path, Error *error)
{
    GltfReader reader = {.path = gltf->path, .root = gltf->root, .error = error};
    char stem[PATH_MAX];
    OutputFile file;
    const char *prefix = stem_make(path, stem, error) ? prefix_of(stem, error) : NULL;
    if (!prefix || !input_keep(path, error) || !output_file_begin(&file, path, error))
        return false;
    FILE *stream = output_file_stream(&file, error);
    if (!stream)
        return false;
    Translation translation = {.gltf = gltf, .reader = &reader, .out = stream, .prefix = prefix};
    if (gltf_translate(&translation) && meshes_write(gltf, stem, error) && images_write(gltf, stem, error))
        return output_file_stream_commit(&file, stream, error);
    fclose(stream);
    output_file_cancel(&file);
    return false;
}
