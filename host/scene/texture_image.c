#include "scene/texture_image.h"

#include "base/log.h"
#include "image/color.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A TextureImage loaded from a file. */
typedef struct CacheEntry {
    char *path;
    TextureImageOptions options;
    uint image;
} CacheEntry;

void texture_cache_init(TextureCache *cache)
{
    *cache = (TextureCache){0};
    array_init(&cache->entries, sizeof(CacheEntry));
}

void texture_cache_destroy(TextureCache *cache)
{
    for (size_t i = 0; i < cache->entries.count; ++i)
        free(ARRAY_AT(&cache->entries, CacheEntry, i).path);
    array_destroy(&cache->entries);
}

bool texture_encoding_parse(const char *text, TextureImageOptions *options)
{
    char *end;
    options->gamma = 1.0f;
    if (strcmp(text, "sRGB") == 0 || strcmp(text, "linear") == 0) {
        options->encoding = text[0] == 's' ? ENCODING_SRGB : ENCODING_LINEAR;
        return true;
    }
    if (strncmp(text, "gamma ", 6) != 0)
        return false;
    options->encoding = ENCODING_GAMMA;
    options->gamma = strtof(text + 6, &end);
    return end != text + 6 && end[strspn(end, " ")] == '\0' && isfinite(options->gamma) && options->gamma > 0.0f;
}

static bool encoding_equal(const TextureImageOptions *a, const TextureImageOptions *b)
{
    return a->encoding == b->encoding && (a->encoding != ENCODING_GAMMA || a->gamma == b->gamma);
}

/* Decodes a value in [0, 1] to linear. */
static float encoding_decode(const TextureImageOptions *options, double encoded)
{
    if (options->encoding == ENCODING_LINEAR)
        return (float)encoded;
    if (options->encoding == ENCODING_SRGB)
        return (float)color_srgb_decode(encoded);
    return (float)pow(fmax(encoded, 0.0), (double)options->gamma);
}

/* Index in scene->lookup of the table that decodes bytes: an existing one if equal, else a new one. */
static bool lut_find(Scene *scene, const TextureImageOptions *options, uint *lut, Error *error)
{
    float table[256];
    for (int i = 0; i < 256; ++i)
        table[i] = encoding_decode(options, i / 255.0);
    for (size_t i = 0; i < scene->images.count; ++i) {
        const TextureImage *image = &ARRAY_AT(&scene->images, TextureImage, i);
        /* Bitwise comparison is intended.
         * NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
        if (image->lut != NONE && memcmp(&ARRAY_AT(&scene->lookup, float, image->lut), table, sizeof table) == 0) {
            *lut = image->lut;
            return true;
        }
    }
    *lut = (uint)scene->lookup.count;
    float *to = array_grow(&scene->lookup, 256, error);
    if (!to)
        return false;
    memcpy(to, table, sizeof table);
    return true;
}

/* Whether the alpha channel is 1 everywhere. */
static bool alpha_is_one(const Image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; ++i)
        if (image_value(image, 4 * i + 3) != 1.0f)
            return false;
    return true;
}

/* Packs bytes: four texels of one channel per word, or one texel of 3 or 4 channels, first channel in the low bits. */
static void bytes_pack(const Image *image, uint channels, uint *words)
{
    const unsigned char *data = image->data;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; ++i) {
        for (uint c = 0; c < channels; ++c) {
            size_t byte = channels == 1 ? i : 4 * i + c;
            words[byte / 4] |= (uint)data[i * (size_t)image->channels + c] << (8u * (byte % 4));
        }
    }
}

/* Packs floats, decoding encoded ones. Returns how many were not finite and became 0. */
static size_t floats_pack(const Image *image, uint channels, const TextureImageOptions *options, uint *words)
{
    const float *data = image->data;
    size_t pixels = (size_t)image->width * (size_t)image->height, dropped = 0;
    for (size_t i = 0; i < pixels; ++i) {
        for (uint c = 0; c < channels; ++c) {
            float value = data[i * (size_t)image->channels + c];
            if (image->srgb_encoded)
                value = encoding_decode(options, (double)value);
            dropped += !float_finite(value);
            words[i * channels + c] = float_bits(float_finite(value) ? value : 0.0f);
        }
    }
    return dropped;
}

static size_t words_needed(const Image *image, uint channels)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    if (image->is_float)
        return pixels * channels;
    return channels == 1 ? (pixels + 3) / 4 : pixels;
}

static bool image_append(Scene *scene, const TextureImage *texture, uint *index, Error *error)
{
    if (scene->images.count >= SCENE_IMAGES_MAX) {
        error_set(error, "the scene has more than %d images", SCENE_IMAGES_MAX);
        return error_fix(error, "use one image with one encoding, wrap and filter in place of several");
    }
    TextureImage *to = array_grow(&scene->images, 1, error);
    if (!to)
        return false;
    *to = *texture;
    *index = (uint)(scene->images.count - 1);
    return true;
}

bool texture_image_add(Scene *scene, const Image *image, const TextureImageOptions *options, uint *index, Error *error)
{
    uint channels = image->channels == 4 && alpha_is_one(image) ? 3u : (uint)image->channels;
    TextureImage texture = {.width = (uint)image->width,
                            .height = (uint)image->height,
                            .channels = channels,
                            .format = image->is_float ? TEXEL_F32 : TEXEL_U8,
                            .first_word = (uint)scene->texels.count,
                            .wrap = options->wrap,
                            .filter = options->filter,
                            .lut = NONE};
    size_t needed = words_needed(image, channels);
    if (needed > UINT32_MAX - scene->texels.count) {
        error_set(error, "the images of the scene have more than %u words of texels", UINT32_MAX);
        return error_fix(error, "scale the images down");
    }
    if (!image->is_float && !lut_find(scene, options, &texture.lut, error))
        return false;
    uint *words = array_grow(&scene->texels, needed, error);
    if (!words)
        return false;
    if (image->is_float) {
        size_t dropped = floats_pack(image, channels, options, words);
        if (dropped > 0)
            log_message(LOG_WARNING, "%zu values of a %d x %d image are not finite and count as 0", dropped,
                        image->width, image->height);
    } else {
        bytes_pack(image, channels, words);
    }
    return image_append(scene, &texture, index, error);
}

/* Finds an entry for `path`. With same_sampling its options must be equal; else only its texels must be usable, and
 * stored bytes suit every encoding. NULL if there is none. */
static const CacheEntry *cache_find(const TextureCache *cache, const Scene *scene, const char *path,
                                    const TextureImageOptions *options, bool same_sampling)
{
    for (size_t i = 0; i < cache->entries.count; ++i) {
        const CacheEntry *entry = &ARRAY_AT(&cache->entries, CacheEntry, i);
        const TextureImage *image = &ARRAY_AT(&scene->images, TextureImage, entry->image);
        bool texels_serve = image->format == TEXEL_U8 || encoding_equal(&entry->options, options);
        bool same = encoding_equal(&entry->options, options) && entry->options.wrap == options->wrap &&
                    entry->options.filter == options->filter;
        if (strcmp(entry->path, path) == 0 && (same_sampling ? same : texels_serve))
            return entry;
    }
    return NULL;
}

static bool cache_add(TextureCache *cache, const char *path, const TextureImageOptions *options, uint image,
                      Error *error)
{
    char *copy = strdup(path);
    CacheEntry *entry = copy ? array_grow(&cache->entries, 1, error) : NULL;
    if (!entry) {
        free(copy);
        return error_memory(error, strlen(path) + sizeof *entry, "a list of images");
    }
    *entry = (CacheEntry){copy, *options, image};
    return true;
}

/* Adds a TextureImage that shares the texels of an existing one. */
static bool image_share(Scene *scene, uint old, const TextureImageOptions *options, uint *index, Error *error)
{
    TextureImage texture = ARRAY_AT(&scene->images, TextureImage, old);
    texture.wrap = options->wrap;
    texture.filter = options->filter;
    if (texture.format == TEXEL_U8 && !lut_find(scene, options, &texture.lut, error))
        return false;
    return image_append(scene, &texture, index, error);
}

bool texture_image_load(Scene *scene, TextureCache *cache, const char *path, const TextureImageOptions *options,
                        uint *index, Error *error)
{
    const CacheEntry *entry = cache_find(cache, scene, path, options, true);
    if (entry) {
        *index = entry->image;
        return true;
    }
    entry = cache_find(cache, scene, path, options, false);
    if (entry)
        return image_share(scene, entry->image, options, index, error) &&
               cache_add(cache, path, options, *index, error);
    Image image;
    if (!(cache->read ? cache->read(cache->owner, path, &image, error) : image_read(path, &image, error)))
        return false;
    bool good =
        texture_image_add(scene, &image, options, index, error) && cache_add(cache, path, options, *index, error);
    image_destroy(&image);
    return good;
}

/* Number of values that an op pops from the stack; -1 for an unknown code. Every op except the end pushes one. */
static int op_operands(const TextureOp *op)
{
    switch (op->code) {
    case TEXTURE_CONSTANT:
    case TEXTURE_IMAGE:
    case TEXTURE_IMAGE_FLOAT:
    case TEXTURE_FBM:
    case TEXTURE_WRINKLED:
    case TEXTURE_WINDY:
    case TEXTURE_MARBLE:
        return 0;
    case TEXTURE_SCALE:
    case TEXTURE_CHECKERBOARD:
    case TEXTURE_DOTS:
    case TEXTURE_DIRECTION_MIX:
        return 2;
    case TEXTURE_MIX:
        return 3;
    case TEXTURE_BILERP:
        return 4;
    default:
        return -1;
    }
}

unsigned texture_program_depth(const TextureOp *ops, size_t count)
{
    int depth = 0, deepest = 0;
    for (size_t i = 0; i < count; ++i) {
        if (ops[i].code == TEXTURE_END)
            return depth == 1 ? (unsigned)deepest : 0u;
        int operands = op_operands(&ops[i]);
        if (operands < 0 || operands > depth || ops[i].mapping > MAPPING_3D)
            return 0;
        depth += 1 - operands;
        deepest = depth > deepest ? depth : deepest;
    }
    return 0;
}
