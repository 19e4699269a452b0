/* Typed parameter lists ("float radius" 2) and their consumers' view of them.
 *
 * A ParamBuffer holds the parameters of the directive being read; a ParamSet is a permanent copy (of Attribute and
 * AreaLightSource). A ParamList is what one consumer (a sphere, a material) sees: the directive's own parameters first,
 * then those of the Attribute directives in force; the last of equal ones wins, as in pbrt. The consumer asks for
 * everything that it knows, then calls param_list_finish, which reports what nobody asked for. The first error sticks:
 * getters return their fallback after it, and param_list_finish returns false. */
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

/* A set of types, for getters that take several. */
#define PARAM_BIT(type) (1u << (type))
#define PARAM_COLORS (PARAM_BIT(PARAM_RGB) | PARAM_BIT(PARAM_BLACKBODY) | PARAM_BIT(PARAM_SPECTRUM))

typedef struct Param {
    ParamType type;
    const char *name;
    SourcePlace place; /* of the quoted declaration */
    size_t count; /* values; three a point3 */
    size_t first; /* while being read: of the buffer's array */
    bool is_text; /* the values are strings, though the type may be spectrum */
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

/* Limits of one directive, far beyond what any takes: parameters and strings are several times larger in memory than in
 * the file. Numbers may be as many as the file holds. */
#define PARAMS_MAX 1024
#define PARAM_STRINGS_MAX 1024

void param_buffer_init(ParamBuffer *buffer);
void param_buffer_destroy(ParamBuffer *buffer);

/* Forgets the parameters, keeps the memory. */
void param_buffer_clear(ParamBuffer *buffer);

/* Begins a parameter from its declaration, a string token such as "float radius". */
bool param_declare(ParamBuffer *buffer, const Token *declaration, Error *error);

/* Adds one value to the parameter begun last. */
bool param_value_add(ParamBuffer *buffer, const Token *value, Error *error);

/* Ends the parameter begun last: right number and kind of values. */
bool param_end(ParamBuffer *buffer, Error *error);

/* Sets the pointers of all parameters; no more may be added. */
void param_buffer_seal(ParamBuffer *buffer);

/* A permanent list of parameters; `older` leads to those of earlier directives. */
typedef struct ParamSet {
    const Param *params;
    size_t count;
    const struct ParamSet *older;
    size_t total; /* parameters in the chain, this set's included */
} ParamSet;

/* A copy of the buffer's parameters in `arena`, before `older`. NULL when memory is out. */
const ParamSet *param_set_make(const ParamBuffer *buffer, const ParamSet *older, Arena *arena, Error *error);

#define PARAM_ASKED_MAX 64

typedef struct ParamEntry {
    const Param *param;
    bool used;
    bool optional; /* of an Attribute: may stay unused */
} ParamEntry;

typedef struct ParamList {
    Array entries; /* ParamEntry, those that win first */
    char owner[96]; /* "sphere", "material "glass"", for messages */
    SourcePlace place; /* of the directive */
    const char *asked[PARAM_ASKED_MAX];
    int asked_count;
    Error *error;
    bool failed;
} ParamList;

void param_list_init(ParamList *list, const char *owner, SourcePlace place, Error *error);
void param_list_destroy(ParamList *list);

/* Adds parameters behind those that are there. */
void param_list_add_buffer(ParamList *list, const ParamBuffer *buffer);
void param_list_add_set(ParamList *list, const ParamSet *set, bool optional);

/* The parameter of that name if it has one of the types; NULL when there is none. Another type is an error. */
const Param *param_find(ParamList *list, const char *name, unsigned types);

/* Single values. */
float param_float(ParamList *list, const char *name, float fallback);
int param_integer(ParamList *list, const char *name, int fallback);
bool param_bool(ParamList *list, const char *name, bool fallback);
const char *param_string(ParamList *list, const char *name, const char *fallback);
/* out keeps its values when the parameter is absent. Returns whether it is present. */
bool param_vector(ParamList *list, const char *name, ParamType type, float out[3]);

/* Arrays: `*count` numbers (three a point), NULL and 0 when absent. */
const float *param_floats(ParamList *list, const char *name, ParamType type, size_t *count);
const int *param_integers(ParamList *list, const char *name, size_t *count);

/* Accepts a parameter of any type without using it; returns it, or NULL. */
const Param *param_ignore(ParamList *list, const char *name);

/* Error at the place of the named parameter (of the directive when absent). The list has failed afterwards. */
void param_error(ParamList *list, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Place of the named parameter, of the directive when absent. */
SourcePlace param_place(const ParamList *list, const char *name);

/* Reports the first parameter that nobody asked for (a warning when `lenient`) and whether anything failed. */
bool param_list_finish(ParamList *list, bool lenient);

const char *param_type_name(ParamType type);

#endif
