#include "image.h"

#include "color.h"
#include "image_formats.h"
#include "input_files.h"
#include "path_name.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define HEADER_SIZE 26 /* enough for every signature, and for PNG's bit depth at byte 24 */

bool image_error(Error *error, const char *path, const char *why)
{
    error_set(error, "cannot read the image %s: %s", path, why);
    return error_fix(error, "convert it again, or use another of: exr, hdr, pfm, png, jpg, tga");
}

bool image_size_check(FILE *file, const char *path, ImageSize size, Error *error)
{
    struct stat status;
    if (size.width < 1 || size.height < 1) {
        error_set(error, "cannot read the image %s: it is %lld x %lld pixels", path, size.width, size.height);
        return error_fix(error, "scale it down");
    }
    if (size.width > IMAGE_SIDE_MAX || size.height > IMAGE_SIDE_MAX || size.width * size.height > IMAGE_PIXELS_MAX) {
        error_set(error, "the image %s is too large: %lld x %lld pixels", path, size.width, size.height);
        return error_fix(error, "use one of at most %u pixels, no side longer than %d", IMAGE_PIXELS_MAX,
                         IMAGE_SIDE_MAX);
    }
    if (fstat(fileno(file), &status) == 0 && size.width * size.height / size.density <= (long long)status.st_size)
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

/* TGA has no signature: what its header must fulfil. Every other format that stb_image knows fails this. */
static bool is_tga(const unsigned char *header, size_t size)
{
    return size >= 18 && header[1] <= 1 && ((header[2] >= 1 && header[2] <= 3) || (header[2] >= 9 && header[2] <= 11));
}

static bool is_exr(const unsigned char *header, size_t size)
{
    return size >= 4 && memcmp(header, "\x76\x2f\x31\x01", 4) == 0;
}

static bool image_read_kind(FILE *file, const char *path, const unsigned char *header, size_t size, Image *image,
                            Error *error)
{
    if (is_exr(header, size))
        return image_read_exr(file, path, image, error);
    if (size >= 3 && (memcmp(header, "PF", 2) == 0 || memcmp(header, "Pf", 2) == 0))
        return image_read_pfm(file, path, image, error);
    if (size == HEADER_SIZE && memcmp(header, "\x89PNG\r\n\x1a\n", 8) == 0)
        return image_read_stb(file, path, STB_PNG, header[24] == 16, image, error);
    if (size >= 3 && memcmp(header, "\xff\xd8\xff", 3) == 0)
        return image_read_stb(file, path, STB_JPEG, false, image, error);
    if (size >= 2 && memcmp(header, "#?", 2) == 0)
        return image_read_stb(file, path, STB_HDR, false, image, error);
    if (path_ends(path, ".tga") && is_tga(header, size))
        return image_read_stb(file, path, STB_TGA, false, image, error);
    image_error(error, path, size == 0 ? "the file is empty" : "it is of no kind that is known, or truncated");
    return error_fix(error, "use PNG, JPEG, TGA, HDR, EXR or PFM");
}

/* Opens a regular file and reads its first bytes, of which there are *size. */
static FILE *image_open(const char *path, unsigned char header[HEADER_SIZE], size_t *size, Error *error)
{
    struct stat status;
    FILE *file = fopen(path, "rb");
    if (!file || fstat(fileno(file), &status) != 0) {
        error_errno(error, "open the image", path);
        error_fix(error, "check the name; those in a scene are relative to the scene's folder");
        if (file)
            fclose(file);
        return NULL;
    }
    if (!S_ISREG(status.st_mode)) {
        image_error(error, path, "it is not a file");
        fclose(file);
        return NULL;
    }
    input_file_note(fileno(file));
    *size = fread(header, 1, HEADER_SIZE, file);
    rewind(file);
    return file;
}

bool image_read(const char *path, Image *image, Error *error)
{
    unsigned char header[HEADER_SIZE];
    size_t size = 0;
    *image = (Image){0};
    FILE *file = image_open(path, header, &size, error);
    if (!file)
        return false;
    bool good = image_read_kind(file, path, header, size, image, error);
    fclose(file);
    if (!good)
        image_destroy(image);
    return good;
}

bool image_read_layer(const char *path, const char *layer, Image *image, bool *found, Error *error)
{
    unsigned char header[HEADER_SIZE];
    size_t size = 0;
    *image = (Image){0};
    *found = false;
    FILE *file = image_open(path, header, &size, error);
    if (!file)
        return false;
    bool good = !is_exr(header, size) || image_read_exr_layer(file, path, layer, image, found, error);
    fclose(file);
    if (!*found)
        image_destroy(image);
    return good;
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
    assert(pixels > 0); /* no empty picture is read: image_size_check */
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

bool image_read_rgb(const char *path, float **rgb, int *width, int *height, Error *error)
{
    Image image;
    *rgb = NULL;
    if (!image_read(path, &image, error))
        return false;
    *width = image.width;
    *height = image.height;
    bool good = image_linear_rgb(&image, rgb, error);
    image_destroy(&image);
    return good;
}
