/* Portable float maps: "PF" (RGB) or "Pf" (grey), width, height, a scale whose sign gives the byte order (negative:
 * little-endian), one whitespace character, then 32-bit floats, bottom row first. */
#include "image/decoders.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static float pfm_value(const unsigned char *bytes, bool little_endian)
{
    uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i)
        bits |= (uint32_t)bytes[i] << (8u * (little_endian ? i : 3u - i));
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static bool pfm_rows_read(FILE *file, Image *image, bool little_endian, float factor)
{
    size_t values = (size_t)image->width * (size_t)image->channels;
    unsigned char *row = malloc(4 * values);
    bool good = row != NULL;
    for (int y = image->height - 1; good && y >= 0; --y) {
        good = fread(row, 4, values, file) == values;
        float *out = (float *)image->data + (size_t)y * values;
        for (size_t i = 0; good && i < values; ++i)
            out[i] = pfm_value(row + 4 * i, little_endian) * factor;
    }
    free(row);
    return good;
}

bool image_read_pfm(FILE *file, const char *path, Image *image, Error *error)
{
    char kind = 0, after = 0;
    ImageSize size = {.density = 1};
    double scale = 0.0;
    /* At most 9 digits per side, so that neither the numbers nor their product overflow.
     * NOLINTNEXTLINE(cert-err34-c) */
    if (fscanf(file, "P%c%9lld%9lld%31lf%c", &kind, &size.width, &size.height, &scale, &after) != 5 ||
        !isfinite(scale) || scale == 0.0)
        return image_error(error, path, "its PFM header is damaged");
    if (!image_allocate_float(file, path, size, kind == 'F' ? 3 : 1, image, error))
        return false;
    if (!pfm_rows_read(file, image, scale < 0.0, (float)fabs(scale)))
        return image_error(error, path, "the file is truncated");
    return true;
}
