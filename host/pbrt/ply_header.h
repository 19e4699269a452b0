/* The header of a PLY file: the elements of its body and the meanings of their properties. */
#ifndef TWINLIGHT_PBRT_PLY_HEADER_H
#define TWINLIGHT_PBRT_PLY_HEADER_H

#include "base/error.h"

#include <stddef.h>

typedef enum PlyType {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
} PlyType;

typedef enum PlyFormat { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } PlyFormat;

#define PLY_PROPERTIES_MAX 64
#define PLY_ELEMENTS_MAX 16
#define PLY_NAME_MAX 32

/* What a property contains. */
typedef enum PlyMeaning {
    PLY_IGNORED,
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_NX,
    PLY_NY,
    PLY_NZ,
    PLY_U,
    PLY_V,
    PLY_MEANING_FLOATS, /* number of the above */
    PLY_INDICES
} PlyMeaning;

typedef struct PlyProperty {
    char name[PLY_NAME_MAX];
    PlyType type;
    PlyType count_type; /* type of a list's count; PLY_NONE for a scalar */
    PlyMeaning meaning;
} PlyProperty;

typedef enum PlyElementKind { PLY_OTHER, PLY_VERTEX, PLY_FACE } PlyElementKind;

typedef struct PlyElement {
    PlyElementKind kind;
    size_t count;
    int property_count;
    PlyProperty properties[PLY_PROPERTIES_MAX];
} PlyElement;

typedef struct PlyHeader {
    PlyFormat format;
    int element_count;
    PlyElement elements[PLY_ELEMENTS_MAX];
    size_t size; /* bytes before the body */
} PlyHeader;

/* Bytes of a binary value. */
size_t ply_type_size(PlyType type);

/* For errors: which file, and where the scene names it. */
typedef struct PlySource {
    const char *path;
    SourcePlace place;
    Error *error;
} PlySource;

/* Sets "error: PATH: ..." at the place. Returns false. */
bool ply_error(const PlySource *source, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Parses the header at the start of `data`; fails by ply_error. */
bool ply_header_read(const PlySource *source, const char *data, size_t size, PlyHeader *header);

#endif
