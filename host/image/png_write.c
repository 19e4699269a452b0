#include "image/png_write.h"

#include "base/output_file.h"
#include "image/color.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* With this level of zlib and one filter, renderings become smaller than with the library's defaults, three times as
 * soon: noise is not what those were made for. */
#define PNG_LEVEL 2

/* Destination: a file or memory. */
typedef struct PngWriter {
    OutputFile *file; /* NULL: in memory */
    int write_errno; /* errno of a failed write; 0: none */
    unsigned char *bytes;
    size_t size, capacity;
    char message[256]; /* reason of the failure */
} PngWriter;

/* Source of the pixels. */
typedef struct PngPicture {
    int width, height;
    double exposure; /* factor */
    PngRows rows;
    const unsigned char *bytes; /* in place of `rows`: values to be written as they are */
    int channels; /* of `bytes`: 1 or 3 */
} PngPicture;

static void png_failed(png_structp png, png_const_charp message)
{
    PngWriter *writer = png_get_error_ptr(png);
    snprintf(writer->message, sizeof writer->message, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void png_warned(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void png_file_bytes(png_structp png, png_bytep bytes, png_size_t size)
{
    PngWriter *writer = png_get_io_ptr(png);
    if (output_file_bytes(writer->file, bytes, size))
        return;
    writer->write_errno = errno;
    png_error(png, strerror(errno));
}

static void png_memory_bytes(png_structp png, png_bytep bytes, png_size_t size)
{
    PngWriter *writer = png_get_io_ptr(png);
    if (writer->capacity - writer->size < size) {
        size_t capacity = 2 * writer->capacity + size;
        unsigned char *grown = realloc(writer->bytes, capacity);
        if (!grown)
            png_error(png, "out of memory");
        writer->bytes = grown;
        writer->capacity = capacity;
    }
    memcpy(writer->bytes + writer->size, bytes, size);
    writer->size += size;
}

static void png_flush_nothing(png_structp png)
{
    (void)png;
}

/* Nearest sRGB byte of a linear value; NaN and negative values become 0. */
static unsigned char byte_encode(float linear, double exposure)
{
    double x = (double)linear * exposure;
    if (!(x > 0.0))
        return 0;
    return (unsigned char)(color_srgb_encode(x < 1.0 ? x : 1.0) * 255.0 + 0.5);
}

static void png_bytes_write(png_structp png, png_infop info, const PngPicture *picture)
{
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8,
                 picture->channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < picture->height; ++y)
        png_write_row(png, picture->bytes + (size_t)y * (size_t)picture->width * (size_t)picture->channels);
    png_write_end(png, info);
}

/* Everything between creating and destroying the png_struct. Longjmps out on failure, so it owns no resources. */
static void png_rows_write(png_structp png, png_infop info, unsigned char *bytes, const PngPicture *picture)
{
    png_set_IHDR(png, info, (png_uint_32)picture->width, (png_uint_32)picture->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, PNG_LEVEL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    size_t values = 3 * (size_t)picture->width;
    assert(picture->rows.row);
    for (int y = 0; y < picture->height; ++y) {
        const float *row = picture->rows.row(picture->rows.context, y);
        for (size_t i = 0; i < values; ++i)
            bytes[i] = byte_encode(row[i], picture->exposure);
        png_write_row(png, bytes);
    }
    png_write_end(png, info);
}

static bool png_encode(PngWriter *writer, const PngPicture *picture)
{
    unsigned char *volatile row = malloc(3 * (size_t)picture->width);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, writer, png_failed, png_warned);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    volatile bool good = false;
    if (!row || !info) {
        snprintf(writer->message, sizeof writer->message, "out of memory");
    } else if (setjmp(png_jmpbuf(png)) == 0) {
        png_set_write_fn(png, writer, writer->file ? png_file_bytes : png_memory_bytes, png_flush_nothing);
        if (picture->bytes)
            png_bytes_write(png, info, picture);
        else
            png_rows_write(png, info, row, picture);
        good = true;
    }
    png_destroy_write_struct(&png, &info);
    free(row);
    return good;
}

/* ---- images in memory -------------------------------------------------------------------------------------------- */

typedef struct WholePicture {
    const float *rgb;
    int width;
} WholePicture;

static const float *whole_row(void *context, int y)
{
    const WholePicture *picture = context;
    return picture->rgb + 3 * (size_t)y * (size_t)picture->width;
}

bool png_memory(const float *rgb, int width, int height, float exposure_stops, unsigned char **bytes, size_t *size,
                Error *error)
{
    PngWriter writer = {0};
    WholePicture whole = {rgb, width};
    const PngPicture picture = {
        .width = width, .height = height, .exposure = exp2((double)exposure_stops), .rows = {whole_row, &whole}};
    if (!png_encode(&writer, &picture)) {
        free(writer.bytes);
        return error_set(error, "cannot make a PNG of %d x %d pixels: %s", width, height, writer.message);
    }
    *bytes = writer.bytes;
    *size = writer.size;
    return true;
}

bool png_write(const char *path, const float *rgb, int width, int height, float exposure_stops, Error *error)
{
    WholePicture whole = {rgb, width};
    return png_write_picture(path, (PngRows){whole_row, &whole}, width, height, exposure_stops, error);
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static bool png_file_write(const char *path, const PngPicture *picture, Error *error)
{
    OutputFile file;
    PngWriter writer = {.file = &file};
    if (!output_file_begin(&file, path, error))
        return false;
    bool good = png_encode(&writer, picture);
    if (!good) {
        error_set(error, "cannot write %s: %s", path, writer.message);
        if (writer.write_errno != 0)
            error_fix_errno(error, writer.write_errno);
    }
    good = good && output_file_commit(&file, error);
    output_file_cancel(&file);
    return good;
}

bool png_write_picture(const char *path, PngRows rows, int width, int height, float exposure_stops, Error *error)
{
    const PngPicture picture = {
        .width = width, .height = height, .exposure = exp2((double)exposure_stops), .rows = rows};
    return png_file_write(path, &picture, error);
}

bool png_write_bytes(const char *path, const unsigned char *bytes, int width, int height, int channels, Error *error)
{
    const PngPicture picture = {.width = width, .height = height, .bytes = bytes, .channels = channels};
    return png_file_write(path, &picture, error);
}
