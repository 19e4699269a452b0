/* Writes OpenEXR files through OpenEXRCore. The same image always gives the same bytes. */
#ifndef TWINLIGHT_IMAGE_EXR_H
#define TWINLIGHT_IMAGE_EXR_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* One channel ("R", "direct.R"): pixel (x, y) of the data window is data[(y * window width + x) * stride]. */
typedef struct ExrChannel {
    const char *name;
    const float *data;
    size_t stride; /* floats between pixels: 3 for a channel of interleaved RGB */
    bool half; /* store as 16-bit half floats */
} ExrChannel;

/* Clamps to the range of finite half floats, as values of such channels are; NaN stays. */
float exr_half_range(float x);

/* Rows per chunk of the file. */
#define EXR_BAND_ROWS 16

typedef enum ExrAttributeKind { EXR_TEXT, EXR_WHOLE, EXR_REAL, EXR_MATRIX } ExrAttributeKind;

/* A header attribute, made by one of the functions below. */
typedef struct ExrAttribute {
    const char *name;
    ExrAttributeKind kind;
    const char *text;
    uint64_t whole;
    double real;
    const float *matrix; /* 16 */
} ExrAttribute;

ExrAttribute exr_text(const char *name, const char *text);

/* An integer. Values beyond 2^31 - 1, EXR's largest, are written as text. */
ExrAttribute exr_whole(const char *name, uint64_t whole);

/* Written as a 32-bit float. */
ExrAttribute exr_real(const char *name, double real);

/* `matrix` is row-major and acts on column vectors. It is written transposed, since EXR's matrices act on row
 * vectors. */
ExrAttribute exr_matrix(const char *name, const float matrix[16]);

/* What one thread writes bands from. */
typedef struct ExrLane {
    const ExrChannel *channels; /* names and types as those of the picture, data of its own */
    void *context; /* for ExrPicture.band */
    float *plane; /* scratch of channel_count x EXR_BAND_ROWS rows of the data window */
} ExrLane;

typedef struct ExrPicture {
    const ExrChannel *channels;
    size_t channel_count;
    int width, height; /* the display window */
    int crop[4]; /* x0 y0 x1 y1: the data window */
    const ExrAttribute *attributes;
    size_t attribute_count;
    /* Fills rows first ... first + count - 1 of the data window, at most EXR_BAND_ROWS, into the start of the channels'
     * data of the lane whose context it gets. NULL: the channels' data hold all rows. */
    void (*band)(void *context, int first, int count);
    /* Threads that write bands at the same time, each from its lane; NULL (without `band`): one, from `channels`. */
    const ExrLane *lanes;
    int lane_count;
} ExrPicture;

/* Writes the pixels crop[0] <= x < crop[2], crop[1] <= y < crop[3] of a width x height image: scanlines, ZIP
 * compression, channels sorted by name as the format requires, chromaticities of sRGB, linear values. Nothing in the
 * file depends on time or machine. The file is written beside `path` and renamed when complete. Fails, naming the path,
 * if it cannot be written or a channel name occurs twice. */
bool exr_write_picture(const char *path, const ExrPicture *picture, Error *error);

/* exr_write_picture of all pixels of an image without attributes. */
bool exr_write(const char *path, const ExrChannel *channels, size_t channel_count, int width, int height, Error *error);

#endif
