/* Typed parameter lists ("float radius" 2), and the view of their consumers.
 *
 * A ParamBuffer holds the parameters of the directive being read; a ParamSet is a permanent copy (for Attribute and
 * AreaLightSource). A ParamList is what one consumer (a sphere, a material) sees: the directive's own parameters first,
 * then those of the Attribute directives in force; within these, the last of equal names takes precedence, as in pbrt.
 * The consumer asks for every parameter that it knows, then calls param_list_finish, which reports those never asked
 * for. The first error sticks: afterwards getters return their fallback, and param_list_finish returns false. */
#ifndef TWINLIGHT_PBRT_PARAMS_H
#define TWINLIGHT_PBRT_PARAMS_H

#include "base/array.h"
#include "pbrt/lexer.h"

typedef enum ParamType {
    PARAM_INTEGER,
    PARAM_FLOAT,
    PARAM_BOOL,
    PARAM_STRING,
    PARAM_POINT2,
    PARAM_VECTOR2,
    PARAM_POINT3,
    PARAM_VECTOR3,
    PARAM_NORMAL,
    PARAM_RGB,
    PARAM_BLACKBODY,
    PARAM_SPECTRUM, /* numbers, or one name in strings */
    PARAM_TEXTURE,
    PARAM_TYPE_COUNT
} ParamType;

/* Set of types, for getters that accept several. */
#define PARAM_BIT(type) (1u << (type))
#define PARAM_COLORS (PARAM_BIT(PARAM_RGB) | PARAM_BIT(PARAM_BLACKBODY) | PARAM_BIT(PARAM_SPECTRUM))

typedef struct Param {
    ParamType type;
    const char *name;
    SourcePlace place; /* of the quoted declaration */
    size_t count; /* number of values; three per point3 */
    size_t first; /* while being read: index in the buffer's array */
    bool is_text; /* values are strings, even if the type is spectrum */
    const float *floats;
    const int *integers;
    const char *const *strings;
    const int *bools;
} Param;

typedef struct ParamBuffer {
    Array params; /* Param */
    Array floats, integers, strings, bools; /* float, int, const char *, int */
    Arena texts;
} ParamBuffer;

/* Limits per directive, far beyond any real use: parameters and strings take several times more memory than in the
 * file. Numbers are limited only by the file's size. */
#define PARAMS_MAX 1024
#define PARAM_STRINGS_MAX 1024

void param_buffer_init(ParamBuffer *buffer);
void param_buffer_destroy(ParamBuffer *buffer);

/* Removes all parameters but keeps the memory. */
void param_buffer_clear(ParamBuffer *buffer);

/* Starts a parameter from its declaration, a string token such as "float radius". */
bool param_declare(ParamBuffer *buffer, const Token *declaration, Error *error);

/* Adds a value to the latest parameter. */
bool param_value_add(ParamBuffer *buffer, const Token *value, Error *error);

/* Ends the latest parameter and checks the number of its values. */
bool param_end(ParamBuffer *buffer, Error *error);

/* Sets the pointers of all parameters; no more may be added. */
void param_buffer_seal(ParamBuffer *buffer);

/* A permanent list of parameters; `older` links to those of earlier directives. */
typedef struct ParamSet {
    const Param *params;
    size_t count;
    const struct ParamSet *older;
    size_t total; /* number of parameters in the chain, including this set */
} ParamSet;

/* Copies the buffer's parameters into `arena`, in front of `older`. NULL when out of memory. */
const ParamSet *param_set_make(const ParamBuffer *buffer, const ParamSet *older, Arena *arena, Error *error);

#define PARAM_ASKED_MAX 64

typedef struct ParamEntry {
    const Param *param;
    bool used;
    bool optional; /* from an Attribute: may stay unused */
} ParamEntry;

typedef struct ParamList {
    Array entries; /* ParamEntry, in order of precedence */
    char owner[96]; /* "sphere", "material "glass"", for messages */
    SourcePlace place; /* of the directive */
    const char *asked[PARAM_ASKED_MAX];
    int asked_count;
    Error *error;
    bool failed;
} ParamList;

/* `owner` names the consumer in messages. */
void param_list_init(ParamList *list, const char *owner, SourcePlace place, Error *error);
void param_list_destroy(ParamList *list);

/* Appends parameters, which have lower precedence than those already there. */
void param_list_add_buffer(ParamList *list, const ParamBuffer *buffer);
void param_list_add_set(ParamList *list, const ParamSet *set, bool optional);

/* The parameter of that name if it has one of the types; NULL if there is none. Another type is an error. */
const Param *param_find(ParamList *list, const char *name, unsigned types);

/* Single values; `fallback` if the parameter is absent or the list has failed. */
float param_float(ParamList *list, const char *name, float fallback);
int param_integer(ParamList *list, const char *name, int fallback);
bool param_bool(ParamList *list, const char *name, bool fallback);
const char *param_string(ParamList *list, const char *name, const char *fallback);
/* `out` is unchanged if the parameter is absent. Returns whether it is present. */
bool param_vector(ParamList *list, const char *name, ParamType type, float out[3]);

/* Arrays: `*count` numbers (three per point); NULL and 0 if absent. */
const float *param_floats(ParamList *list, const char *name, ParamType type, size_t *count);
const int *param_integers(ParamList *list, const char *name, size_t *count);

/* Accepts a parameter of any type; returns it, or NULL. */
const Param *param_ignore(ParamList *list, const char *name);

/* Sets an error at the place of the named parameter (of the directive if absent). The list has then failed. */
void param_error(ParamList *list, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Place of the named parameter (of the directive if absent). */
SourcePlace param_place(const ParamList *list, const char *name);

/* Reports the first parameter that was never asked for (`lenient`: each, as a warning). False if anything failed. */
bool param_list_finish(ParamList *list, bool lenient);

const char *param_type_name(ParamType type);

#endif
