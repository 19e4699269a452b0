/* Checked access to the JSON of a glTF file. The first failure sticks: afterwards getters return their fallback. */
#ifndef TWINLIGHT_GLTF_JSON_VALUE_H
#define TWINLIGHT_GLTF_JSON_VALUE_H

#include "base/error.h"

#include <jansson.h>

/* Entries of an array at most: indices are ints. */
#define GLTF_COUNT_MAX (1u << 28)

typedef struct GltfReader {
    const char *path; /* of the file, for messages */
    const json_t *root;
    Error *error;
    bool failed;
} GltfReader;

/* An object, with its name in messages: "materials[3].pbrMetallicRoughness". */
typedef struct GltfObject {
    const json_t *json; /* NULL: absent */
    char name[160];
} GltfObject;

/* Fails with "PATH: error: ...". Returns false. */
bool gltf_fail(GltfReader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Number of entries of an array of the root ("meshes"); 0 if absent. Fails for anything but an array of objects. */
size_t gltf_count(GltfReader *reader, const char *array);

/* Entry i < gltf_count of an array of the root. */
GltfObject gltf_entry(GltfReader *reader, const char *array, size_t i);

/* Member `key` that must be an object if present. */
GltfObject gltf_object(GltfReader *reader, const GltfObject *object, const char *key);

/* The extension NAME of an object. */
GltfObject gltf_extension(GltfReader *reader, const GltfObject *object, const char *name);

/* Member `key` that must be an array if present; *count is its length. NULL and 0 if absent. */
const json_t *gltf_array(GltfReader *reader, const GltfObject *object, const char *key, size_t *count);

/* A number from `least` to `most`. */
double gltf_number(GltfReader *reader, const GltfObject *object, const char *key, double fallback, double least,
                   double most);

/* An array of exactly `count` numbers, which must fit floats; `out` is unchanged if absent. Returns whether it is
 * there. */
bool gltf_numbers(GltfReader *reader, const GltfObject *object, const char *key, size_t count, double *out);

/* A whole number from 0 to 2^53. */
size_t gltf_size(GltfReader *reader, const GltfObject *object, const char *key, size_t fallback);

/* An index of an entry of the root's array; -1 if absent. */
int gltf_index(GltfReader *reader, const GltfObject *object, const char *key, const char *array);

/* The same for element i of an array of indices; fails if it is not one. */
int gltf_index_at(GltfReader *reader, const GltfObject *object, const char *key, size_t i, const char *array);

bool gltf_bool(GltfReader *reader, const GltfObject *object, const char *key, bool fallback);

/* Text, owned by the JSON. */
const char *gltf_text(GltfReader *reader, const GltfObject *object, const char *key, const char *fallback);

#endif
