/* PNG, JPEG, TGA and HDR decoders of stb_image. image_read has checked the signature, so its other decoders are
 * unreachable. */
#include "image/decoders.h"

#include <stb_image.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* stb_image sometimes reads the end of a file as zeros; a read that returns nothing identifies a truncated file. Its
 * HDR decoder would then loop forever, waiting for the header's empty line or decoding zeros as runs of length 0;
 * feeding it newlines ends both loops. */
typedef struct StbSource {
    FILE *file;
    StbKind kind;
    bool truncated;
} StbSource;

static int source_read(void *user, char *data, int size)
{
    StbSource *source = user;
    size_t n = fread(data, 1, (size_t)size, source->file);
    if (n > 0 || size <= 0)
        return (int)n;
    source->truncated = true;
    if (source->kind != STB_HDR)
        return 0;
    memset(data, '\n', (size_t)size);
    return size;
}

static void source_skip(void *user, int n)
{
    StbSource *source = user;
    if (fseek(source->file, n, SEEK_CUR) != 0)
        source->truncated = true;
}

static int source_at_end(void *user)
{
    StbSource *source = user;
    int c = getc(source->file);
    if (c == EOF)
        return 1;
    ungetc(c, source->file);
    return 0;
}

static const stbi_io_callbacks SOURCE_CALLBACKS = {source_read, source_skip, source_at_end};

/* 16-bit samples to floats in 0 ... 1. */
static bool sixteen_bits_convert(uint16_t *samples, Image *image, Error *error)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    float *data = malloc(count * sizeof *data);
    for (size_t i = 0; data && i < count; ++i)
        data[i] = (float)samples[i] / 65535.0f;
    stbi_image_free(samples);
    image->data = data;
    image->is_float = true;
    return data || error_memory(error, count * sizeof *data, "an image");
}

static bool pixels_read(StbSource *source, StbKind kind, bool sixteen_bits, Image *image, Error *error)
{
    int width, height, present, channels = image->channels;
    if (kind == STB_HDR) {
        image->is_float = true;
        image->data = stbi_loadf_from_callbacks(&SOURCE_CALLBACKS, source, &width, &height, &present, channels);
        return image->data != NULL;
    }
    image->srgb_encoded = true;
    if (sixteen_bits) {
        uint16_t *samples = stbi_load_16_from_callbacks(&SOURCE_CALLBACKS, source, &width, &height, &present, channels);
        return samples && sixteen_bits_convert(samples, image, error);
    }
    /* The library allocates with malloc, so image_destroy can free it. */
    image->data = stbi_load_from_callbacks(&SOURCE_CALLBACKS, source, &width, &height, &present, channels);
    return image->data != NULL;
}

/* Channels to request from stb_image: grey without alpha, TGA without alpha (as pbrt). */
static int channels_wanted(StbKind kind, int present)
{
    if (present <= 2)
        return 1;
    return kind == STB_TGA ? 3 : present;
}

/* Upper bound of pixels per byte of a file. PNG: deflate expands at most 1032-fold, to bytes of at most eight pixels.
 * JPEG: at least one bit per 8 x 8 block, and at least 9 blocks per 1024 pixels for the sparsest sampling factors. TGA
 * and HDR: runs of at most 128 pixels in two bytes. */
static long long density(StbKind kind)
{
    return kind == STB_PNG ? 8 * 1032 : kind == STB_JPEG ? 1024 : 64;
}

bool image_read_stb(FILE *file, const char *path, StbKind kind, bool sixteen_bits, Image *image, Error *error)
{
    StbSource source = {.file = file, .kind = kind};
    int present = 0;
    if (!stbi_info_from_callbacks(&SOURCE_CALLBACKS, &source, &image->width, &image->height, &present))
        return image_error(error, path, source.truncated ? "the file is truncated" : stbi_failure_reason());
    if (!image_size_check(file, path, (ImageSize){image->width, image->height, density(kind)}, error))
        return false;
    rewind(file);
    source.truncated = false;
    image->channels = channels_wanted(kind, present);
    error->message[0] = '\0';
    bool good = pixels_read(&source, kind, sixteen_bits, image, error);
    if (source.truncated || (!good && !error->message[0]))
        return image_error(error, path, source.truncated ? "the file is truncated" : stbi_failure_reason());
    return good;
}
