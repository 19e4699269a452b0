#include "image/image.h"

#include "image/color.h"

#include <assert.h>
#include <stdlib.h>
#include <sys/types.h>

bool image_error(Error *error, const char *path, const char *why)
{
    error_set(error, "cannot read the image %s: %s", path, why);
    return error_fix(error, "convert it again, or use another of: exr, hdr, pfm, png, jpg, tga");
}

/* Bytes of a file or of a stream in memory, -1 if they cannot be told. Keeps the position. */
static long long file_size(FILE *file)
{
    off_t position = ftello(file);
    if (position < 0 || fseeko(file, 0, SEEK_END) != 0)
        return -1;
    off_t end = ftello(file);
    return fseeko(file, position, SEEK_SET) == 0 ? (long long)end : -1;
}

bool image_size_check(FILE *file, const char *path, ImageSize size, Error *error)
{
    if (size.width < 1 || size.height < 1) {
        error_set(error, "cannot read the image %s: it is %lld x %lld pixels", path, size.width, size.height);
        return error_fix(error, "scale it down");
    }
    if (size.width > IMAGE_SIDE_MAX || size.height > IMAGE_SIDE_MAX || size.width * size.height > IMAGE_PIXELS_MAX) {
        error_set(error, "the image %s is too large: %lld x %lld pixels", path, size.width, size.height);
        return error_fix(error, "use one of at most %u pixels, no side longer than %d", IMAGE_PIXELS_MAX,
                         IMAGE_SIDE_MAX);
    }
    if (size.width * size.height / size.density <= file_size(file))
        return true;
    error_set(error, "cannot read the image %s: it is too short for %lld x %lld pixels", path, size.width, size.height);
    return error_fix(error, "it is damaged or truncated: convert or copy it again");
}

bool image_allocate_float(FILE *file, const char *path, ImageSize size, int channels, Image *image, Error *error)
{
    if (!image_size_check(file, path, size, error))
        return false;
    size_t count = (size_t)size.width * (size_t)size.height * (size_t)channels;
    *image = (Image){.width = (int)size.width, .height = (int)size.height, .channels = channels, .is_float = true};
    image->data = calloc(count, sizeof(float));
    return image->data || error_memory(error, count * sizeof(float), path);
}

void image_destroy(Image *image)
{
    free(image->data);
    *image = (Image){0};
}

float image_value(const Image *image, size_t i)
{
    if (image->is_float)
        return ((const float *)image->data)[i];
    return (float)((const unsigned char *)image->data)[i] / 255.0f;
}

bool image_linear_rgb(const Image *image, float **rgb, Error *error)
{
    size_t pixels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    assert(pixels > 0); /* image_size_check refuses empty images */
    float *out = malloc(pixels * 3 * sizeof *out);
    if (!out)
        return error_memory(error, pixels * 3 * sizeof *out, "an image");
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < 3; ++c) {
            float value = image_value(image, i * channels + (channels >= 3 ? c : 0));
            out[3 * i + c] = image->srgb_encoded ? (float)color_srgb_decode((double)value) : value;
        }
    }
    *rgb = out;
    return true;
}
