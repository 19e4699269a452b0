/* OpenEXR files written through OpenEXRCore: the same picture gives the same bytes. */
#ifndef TWINLIGHT_EXR_H
#define TWINLIGHT_EXR_H

#include "error.h"

#include <stddef.h>

/* One channel ("R", "direct.R"): pixel (x, y) of the data window at data[(y * window width + x) * stride]. */
typedef struct ExrChannel {
    const char *name;
    const float *data;
    size_t stride; /* floats from one pixel to the next: 3 for a channel of interleaved RGB */
    bool half; /* store 16 bits */
} ExrChannel;

/* A string in the header. */
typedef struct ExrAttribute {
    const char *name;
    const char *value;
} ExrAttribute;

/* Writes `channel_count` channels of the pixels crop[0] <= x < crop[2], crop[1] <= y < crop[3] of a width x height
 * picture (the display window): scanlines, ZIP, sorted by name as the format wants. `crop` may be NULL: everything.
 * Nothing in the file depends on time or machine. Written beside `path` and renamed: an old file stays until the new
 * one is whole. Fails, naming the path, when it cannot be written, and for a channel named twice. */
bool exr_write(const char *path, const ExrChannel *channels, size_t channel_count, int width, int height,
               const int crop[4], const ExrAttribute *attributes, size_t attribute_count, Error *error);

#endif
