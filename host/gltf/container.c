/* The container of a glTF file: JSON text, or the chunks of a .glb; buffers, base64. */
#include "base/file_read.h"
#include "gltf/document.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a file. Chunks of a .glb have 32-bit lengths. */
#define FILE_BYTES_MAX 0xffffffffu

#define GLB_MAGIC 0x46546c67u /* "glTF" */
#define GLB_JSON 0x4e4f534au
#define GLB_BINARY 0x004e4942u

bool gltf_allocate(GltfReader *reader, void **array, size_t count, size_t size)
{
    *array = calloc(count + 1, size);
    if (!*array && !reader->failed)
        reader->failed = !error_memory(reader->error, count * size, "a glTF scene");
    return *array != NULL;
}

static uint32_t little_endian(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* Finds the chunks of a .glb (specification of glTF 2.0, section 4.4). */
static bool chunks_find(Gltf *gltf, GltfReader *reader, GltfBytes *json)
{
    const GltfBytes *file = &gltf->file;
    if (file->size < 12 || little_endian(file->data) != GLB_MAGIC)
        return gltf_fail(reader, "the file does not begin like a .glb");
    uint32_t version = little_endian(file->data + 4), length = little_endian(file->data + 8);
    if (version != 2)
        return gltf_fail(reader, "the file has version %u of glTF instead of 2", version);
    if (length > file->size)
        return gltf_fail(reader, "the file is truncated: it has %zu of %u bytes", file->size, length);
    for (size_t at = 12; length - at >= 8 && at < length;) {
        size_t size = little_endian(file->data + at);
        uint32_t kind = little_endian(file->data + at + 4);
        at += 8;
        if (size > length - at)
            return gltf_fail(reader, "a chunk of the file is longer than the file");
        if (kind == GLB_JSON && !json->data)
            *json = (GltfBytes){file->data + at, size, NULL};
        else if (kind == GLB_BINARY && !gltf->binary.data)
            gltf->binary = (GltfBytes){file->data + at, size, NULL};
        at += size;
    }
    return json->data || gltf_fail(reader, "the file has no JSON chunk");
}

static bool version_check(GltfReader *reader)
{
    const GltfObject root = {reader->root, ""};
    if (!json_is_object(reader->root))
        return gltf_fail(reader, "the JSON is not an object");
    const GltfObject asset = gltf_object(reader, &root, "asset");
    const char *version = gltf_text(reader, &asset, "version", "");
    if (!reader->failed && strncmp(version, "2.", 2) != 0) {
        gltf_fail(reader, "the file has version \"%.20s\" of glTF instead of 2.0", version);
        return error_fix(reader->error, "export it as glTF 2.0");
    }
    return !reader->failed;
}

bool gltf_container_read(Gltf *gltf, GltfReader *reader)
{
    FileData file;
    json_error_t failure;
    if (!file_read(gltf->path, FILE_BYTES_MAX, (SourcePlace){0}, &file, reader->error)) {
        reader->failed = true;
        return false;
    }
    gltf->file = (GltfBytes){(const unsigned char *)file.data, file.size, file.data};
    GltfBytes json = {0};
    if (file.size >= 4 && little_endian(gltf->file.data) == GLB_MAGIC) {
        if (!chunks_find(gltf, reader, &json))
            return false;
    } else {
        json = (GltfBytes){gltf->file.data, file.size, NULL};
    }
    gltf->root = json_loadb((const char *)json.data, json.size, JSON_REJECT_DUPLICATES, &failure);
    if (!gltf->root) {
        gltf_fail(reader, "the JSON is not valid: %s (line %d, column %d)", failure.text, failure.line, failure.column);
        return error_fix(reader->error, "check that the file is complete and glTF 2.0");
    }
    reader->root = gltf->root;
    return version_check(reader);
}

/* ---- URIs -------------------------------------------------------------------------------------------------------- */

/* Value of a character of base64 (RFC 4648), -1 if it is none. */
static int base64_value(char c)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c ? strchr(DIGITS, c) : NULL;
    return found ? (int)(found - DIGITS) : -1;
}

/* Decodes `length` characters, padding removed, to 3/4 as many bytes. False for a character that is not base64. */
static bool base64_decode(const char *text, size_t length, unsigned char *out)
{
    uint32_t bits = 0;
    unsigned held = 0;
    for (size_t i = 0; i < length; ++i) {
        int value = base64_value(text[i]);
        if (value < 0)
            return false;
        bits = (bits << 6 | (uint32_t)value) & 0xffffffu;
        held += 6;
        if (held >= 8) {
            held -= 8;
            *out++ = (unsigned char)(bits >> held & 0xffu);
        }
    }
    return true;
}

static bool data_uri_decode(GltfReader *reader, const char *uri, const char *what, GltfBytes *bytes)
{
    static const char MARK[] = ";base64,";
    const char *text = strstr(uri, MARK);
    if (!text)
        return gltf_fail(reader, "the data URI of %s is not base64", what);
    text += sizeof MARK - 1;
    size_t length = strlen(text);
    while (length > 0 && text[length - 1] == '=')
        --length;
    if (!gltf_allocate(reader, &bytes->owned, length / 4 * 3 + 3, 1))
        return false;
    bytes->data = bytes->owned;
    bytes->size = length * 3 / 4;
    return base64_decode(text, length, bytes->owned) ||
           gltf_fail(reader, "the data URI of %s has a character that is not base64", what);
}

static int hex_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Appends the URI to `path`, with %20 and the like decoded. False if it is too long. */
static bool uri_append(char *path, size_t size, const char *uri)
{
    size_t n = strlen(path);
    for (; *uri && n + 1 < size; ++n) {
        bool coded = uri[0] == '%' && hex_value(uri[1]) >= 0 && hex_value(uri[2]) >= 0;
        path[n] = coded ? (char)(16 * hex_value(uri[1]) + hex_value(uri[2])) : *uri;
        uri += coded ? 3 : 1;
    }
    path[n] = '\0';
    return *uri == '\0';
}

bool gltf_uri_read(Gltf *gltf, GltfReader *reader, const char *uri, const char *what, GltfBytes *bytes)
{
    char path[4096] = "";
    FileData file;
    if (strncmp(uri, "data:", 5) == 0)
        return data_uri_decode(reader, uri, what, bytes);
    const char *slash = strrchr(gltf->path, '/');
    int folder = slash && uri[0] != '/' ? (int)(slash - gltf->path) + 1 : 0;
    snprintf(path, sizeof path, "%.*s", folder, gltf->path);
    if (strstr(uri, "://") || !uri_append(path, sizeof path, uri))
        return gltf_fail(reader, "%s is not a file: %.200s", what, uri);
    if (!file_read(path, FILE_BYTES_MAX, (SourcePlace){.file = gltf->path}, &file, reader->error)) {
        reader->failed = true;
        return false;
    }
    *bytes = (GltfBytes){(const unsigned char *)file.data, file.size, file.data};
    return true;
}

/* ---- buffers ----------------------------------------------------------------------------------------------------- */

static bool buffer_read(Gltf *gltf, GltfReader *reader, size_t i)
{
    const GltfObject object = gltf_entry(reader, "buffers", i);
    const char *uri = gltf_text(reader, &object, "uri", NULL);
    size_t length = gltf_size(reader, &object, "byteLength", 0);
    GltfBytes *buffer = &gltf->buffers[i];
    if (reader->failed)
        return false;
    if (uri && !gltf_uri_read(gltf, reader, uri, object.name, buffer))
        return false;
    if (!uri && (i > 0 || !gltf->binary.data))
        return gltf_fail(reader, "%s has no uri, and the file has no binary chunk for it", object.name);
    if (!uri)
        *buffer = gltf->binary;
    if (length > buffer->size)
        return gltf_fail(reader, "%s is truncated: it has %zu of %zu bytes", object.name, buffer->size, length);
    buffer->size = length;
    return true;
}

bool gltf_buffers_read(Gltf *gltf, GltfReader *reader)
{
    size_t count = gltf_count(reader, "buffers");
    void *buffers = NULL;
    if (reader->failed || !gltf_allocate(reader, &buffers, count, sizeof *gltf->buffers))
        return false;
    gltf->buffers = buffers;
    gltf->buffer_count = count;
    for (size_t i = 0; i < count; ++i)
        if (!buffer_read(gltf, reader, i))
            return false;
    return true;
}

GltfBytes gltf_view(const Gltf *gltf, GltfReader *reader, size_t view)
{
    const GltfObject object = gltf_entry(reader, "bufferViews", view);
    int index = gltf_index(reader, &object, "buffer", "buffers");
    size_t offset = gltf_size(reader, &object, "byteOffset", 0), length = gltf_size(reader, &object, "byteLength", 0);
    if (!reader->failed && index < 0)
        gltf_fail(reader, "%s names no buffer", object.name);
    if (reader->failed)
        return (GltfBytes){0};
    const GltfBytes *buffer = &gltf->buffers[index];
    if (offset > buffer->size || length > buffer->size - offset) {
        gltf_fail(reader, "%s reaches beyond the %zu bytes of its buffer", object.name, buffer->size);
        return (GltfBytes){0};
    }
    return (GltfBytes){buffer->data + offset, length, NULL};
}
