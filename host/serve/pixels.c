#include "serve/pixels.h"

#include "image/exr.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Its conversion narrows integers. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <half.h>
#pragma GCC diagnostic pop

/* What pixels are made from. */
typedef struct Source {
    const float *rgb, *other;
    int width, height, level;
} Source;

static float value_at(const Source *source, size_t i)
{
    return source->other ? source->rgb[i] - source->other[i] : source->rgb[i];
}

/* The mean of channel c over the block that is pixel x, y of the level. */
static float block_mean(const Source *source, int x, int y, size_t c)
{
    int left = x << source->level, top = y << source->level, size = 1 << source->level;
    int right = left + size < source->width ? left + size : source->width;
    int below = top + size < source->height ? top + size : source->height;
    float sum = 0.0f;
    for (int row = top; row < below; ++row)
        for (int column = left; column < right; ++column)
            sum += value_at(source, 3 * ((size_t)row * (size_t)source->width + (size_t)column) + c);
    return sum / (float)((right - left) * (below - top));
}

static void half_put(unsigned char *out, float value)
{
    uint32_t bits = imath_float_to_half(exr_half_range(value));
    out[0] = (unsigned char)(bits & 0xff);
    out[1] = (unsigned char)(bits >> 8);
}

static void float_put(unsigned char *out, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i)
        out[i] = (unsigned char)(bits >> (8 * i));
}

/* Writes the values of a row of the level. */
static void row_put(const Source *source, int y, int width, float *values)
{
    size_t first = 3 * (size_t)y * (size_t)source->width;
    for (size_t i = 0; source->level == 0 && i < 3 * (size_t)width; ++i)
        values[i] = value_at(source, first + i);
    for (int x = 0; source->level > 0 && x < width; ++x)
        for (size_t c = 0; c < 3; ++c)
            values[3 * (size_t)x + c] = block_mean(source, x, y, c);
}

bool pixels_make(Pixels *pixels, const float *rgb, const float *other, int width, int height, int level, bool half)
{
    const Source source = {rgb, other, width, height, level};
    const size_t bytes = half ? 2 : 4;
    pixels->width = (width + (1 << level) - 1) >> level;
    pixels->height = (height + (1 << level) - 1) >> level;
    size_t row = 3 * (size_t)pixels->width;
    pixels->size = bytes * row * (size_t)pixels->height;
    pixels->bytes = malloc(pixels->size);
    float *values = calloc(row, sizeof *values);
    unsigned char *out = pixels->bytes;
    for (int y = 0; out && values && y < pixels->height; ++y) {
        row_put(&source, y, pixels->width, values);
        for (size_t i = 0; i < row; ++i, out += bytes)
            if (half)
                half_put(out, values[i]);
            else
                float_put(out, values[i]);
    }
    bool made = pixels->bytes && values;
    free(values);
    if (!made)
        free(pixels->bytes);
    return made;
}
