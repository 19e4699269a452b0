/* Numbers in the body of a PLY file, in any of its formats. */
#ifndef TWINLIGHT_PBRT_PLY_VALUES_H
#define TWINLIGHT_PBRT_PLY_VALUES_H

#include "pbrt/ply_header.h"

#include <stdint.h>

/* What is left of the body. */
typedef struct PlyReader {
    const PlySource *source; /* for errors */
    PlyFormat format;
    const char *p, *end;
} PlyReader;

/* Read the next number, of the given type unless the file is ascii. An integer that is negative becomes huge. They fail
 * by ply_error. */
bool ply_integer_next(PlyReader *r, PlyType type, uint64_t *value);
bool ply_float_next(PlyReader *r, PlyType type, float *value);
bool ply_values_skip(PlyReader *r, PlyType type, uint64_t count);

/* Binary values at p: an unsigned integer of `size` bytes, and any number as a float. */
uint64_t ply_bytes_integer(const char *p, size_t size, bool little);
float ply_float_decode(const char *p, PlyType type, bool little);

/* Sets an error: the file ends too early. Returns false. */
bool ply_truncated(const PlyReader *r);

#endif
