/* OpenEXR files written through OpenEXRCore: the same picture gives the same bytes. */
#ifndef TWINLIGHT_IMAGE_EXR_H
#define TWINLIGHT_IMAGE_EXR_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* One channel ("R", "direct.R"): pixel (x, y) of the data window at data[(y * window width + x) * stride]. */
typedef struct ExrChannel {
    const char *name;
    const float *data;
    size_t stride; /* floats from one pixel to the next: 3 for a channel of interleaved RGB */
    bool half; /* store 16 bits */
} ExrChannel;

/* Rows of a chunk of the file. */
#define EXR_BAND_ROWS 16

typedef enum ExrAttributeKind { EXR_TEXT, EXR_WHOLE, EXR_REAL, EXR_MATRIX } ExrAttributeKind;

/* What the header says besides; made by one of the functions below. */
typedef struct ExrAttribute {
    const char *name;
    ExrAttributeKind kind;
    const char *text;
    uint64_t whole;
    double real;
    const float *matrix; /* 16 */
} ExrAttribute;

ExrAttribute exr_text(const char *name, const char *text);

/* EXR's whole numbers end at 2^31 - 1: a larger one is written as text. */
ExrAttribute exr_whole(const char *name, uint64_t whole);

/* Written with 32 bits. */
ExrAttribute exr_real(const char *name, double real);

/* Row-major, for columns: EXR's are for rows, with translations in the fourth row, and so it is written. */
ExrAttribute exr_matrix(const char *name, const float matrix[16]);
typedef struct ExrPicture {
    const ExrChannel *channels;
    size_t channel_count;
    int width, height; /* the display window */
    int crop[4]; /* x0 y0 x1 y1: the data window */
    const ExrAttribute *attributes;
    size_t attribute_count;
    /* Puts rows first ... first + count - 1 of the data window, EXR_BAND_ROWS at most, into the channels' data. NULL:
     * all rows are there. */
    void (*band)(void *context, int first, int count);
    void *context;
    float *plane; /* room for channel_count x EXR_BAND_ROWS rows of the data window; NULL: it is allocated */
} ExrPicture;

/* Writes a picture as exr_write does. */
bool exr_write_picture(const char *path, const ExrPicture *picture, Error *error);

/* Writes `channel_count` channels of the pixels crop[0] <= x < crop[2], crop[1] <= y < crop[3] of a width x height
 * picture (the display window): scanlines, ZIP, sorted by name as the format wants; chromaticities are those of linear
 * sRGB. `crop` may be NULL: everything. Nothing in the file depends on time or machine. Written beside `path` and
 * renamed: an old file stays until the new one is whole. Fails, naming the path, when it cannot be written, and for a
 * channel named twice. */
bool exr_write(const char *path, const ExrChannel *channels, size_t channel_count, int width, int height,
               const int crop[4], const ExrAttribute *attributes, size_t attribute_count, Error *error);

#endif
