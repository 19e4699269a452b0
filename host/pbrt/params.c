#include "pbrt/params.h"

#include "base/name_table.h"

#include <string.h>

typedef struct TypeInfo {
    const char *name;
    unsigned per_item; /* values per item */
} TypeInfo;

static const TypeInfo TYPES[PARAM_TYPE_COUNT] = {
    [PARAM_INTEGER] = {"integer", 1}, [PARAM_FLOAT] = {"float", 1},         [PARAM_BOOL] = {"bool", 1},
    [PARAM_STRING] = {"string", 1},   [PARAM_POINT2] = {"point2", 2},       [PARAM_VECTOR2] = {"vector2", 2},
    [PARAM_POINT3] = {"point3", 3},   [PARAM_VECTOR3] = {"vector3", 3},     [PARAM_NORMAL] = {"normal", 3},
    [PARAM_RGB] = {"rgb", 3},         [PARAM_BLACKBODY] = {"blackbody", 1}, [PARAM_SPECTRUM] = {"spectrum", 1},
    [PARAM_TEXTURE] = {"texture", 1},
};

/* pbrt-v3's names, which pbrt's --upgrade replaces. */
static const struct {
    const char *name;
    ParamType type;
} ALIASES[] = {{"point", PARAM_POINT3}, {"vector", PARAM_VECTOR3}, {"color", PARAM_RGB}, {"normal3", PARAM_NORMAL}};

const char *param_type_name(ParamType type)
{
    return TYPES[type].name;
}

void param_buffer_init(ParamBuffer *buffer)
{
    *buffer = (ParamBuffer){0};
    array_init(&buffer->params, sizeof(Param));
    array_init(&buffer->floats, sizeof(float));
    array_init(&buffer->integers, sizeof(int));
    array_init(&buffer->strings, sizeof(const char *));
    array_init(&buffer->bools, sizeof(int));
}

void param_buffer_destroy(ParamBuffer *buffer)
{
    array_destroy(&buffer->params);
    array_destroy(&buffer->floats);
    array_destroy(&buffer->integers);
    array_destroy(&buffer->strings);
    array_destroy(&buffer->bools);
    arena_destroy(&buffer->texts);
}

void param_buffer_clear(ParamBuffer *buffer)
{
    buffer->params.count = buffer->floats.count = buffer->integers.count = 0;
    buffer->strings.count = buffer->bools.count = 0;
    if (buffer->texts.bytes > 0)
        arena_destroy(&buffer->texts);
}

static bool type_parse(const char *text, size_t length, ParamType *type)
{
    for (int i = 0; i < PARAM_TYPE_COUNT; ++i)
        if (strlen(TYPES[i].name) == length && memcmp(TYPES[i].name, text, length) == 0) {
            *type = (ParamType)i;
            return true;
        }
    for (size_t i = 0; i < sizeof ALIASES / sizeof *ALIASES; ++i)
        if (strlen(ALIASES[i].name) == length && memcmp(ALIASES[i].name, text, length) == 0) {
            *type = ALIASES[i].type;
            return true;
        }
    return false;
}

static bool type_unknown(const Token *declaration, const char *type, Error *error)
{
    const char *names[PARAM_TYPE_COUNT];
    for (int i = 0; i < PARAM_TYPE_COUNT; ++i)
        names[i] = TYPES[i].name;
    const char *nearest = name_nearest(type, names, PARAM_TYPE_COUNT);
    error_at(error, declaration->place, "unknown parameter type \"%s\"", type);
    if (nearest)
        return error_fix(error, "did you mean \"%s\"?", nearest);
    return error_fix(error, "use integer, float, bool, string, point2, vector2, point3, vector3, normal, rgb, "
                            "blackbody, spectrum or texture");
}

static bool too_many(SourcePlace place, int limit, const char *what, Error *error)
{
    error_at(error, place, "the directive has more than %d %s", limit, what);
    return error_fix(error, "delete those that are not needed");
}

bool param_declare(ParamBuffer *buffer, const Token *declaration, Error *error)
{
    if (buffer->params.count >= PARAMS_MAX)
        return too_many(declaration->place, PARAMS_MAX, "parameters", error);
    const char *text = token_text(declaration, &buffer->texts, error);
    if (!text)
        return false;
    const char *type = text + strspn(text, " \t");
    size_t type_length = strcspn(type, " \t");
    const char *name = type + type_length + strspn(type + type_length, " \t");
    size_t name_length = strcspn(name, " \t");
    if (name_length == 0) {
        error_at(error, declaration->place, "the parameter \"%s\" lacks a type or a name", text);
        return error_fix(error, "write type and name, as in \"float radius\"");
    }
    ParamType parsed;
    if (!type_parse(type, type_length, &parsed)) {
        type = arena_text(&buffer->texts, type, type_length, error);
        return type ? type_unknown(declaration, type, error) : false;
    }
    Param *param = array_grow(&buffer->params, 1, error);
    const char *copy = param ? arena_text(&buffer->texts, name, name_length, error) : NULL;
    if (!copy)
        return false;
    *param = (Param){.type = parsed, .name = copy, .place = declaration->place};
    return true;
}

/* The array of the buffer for the parameter's values. */
static Array *values_array(ParamBuffer *buffer, const Param *param)
{
    if (param->is_text)
        return &buffer->strings;
    return param->type == PARAM_INTEGER ? &buffer->integers
           : param->type == PARAM_BOOL  ? &buffer->bools
                                        : &buffer->floats;
}

static bool string_add(ParamBuffer *buffer, const Token *value, Error *error)
{
    if (buffer->strings.count >= PARAM_STRINGS_MAX)
        return too_many(value->place, PARAM_STRINGS_MAX, "strings", error);
    const char *text = token_text(value, &buffer->texts, error);
    const char **slot = text ? array_grow(&buffer->strings, 1, error) : NULL;
    if (!slot)
        return false;
    *slot = text;
    return true;
}

static bool bool_add(ParamBuffer *buffer, const Token *value, Error *error)
{
    bool yes = token_is(value, "true");
    if (!yes && !token_is(value, "false"))
        return token_unexpected(value, "true or false", error);
    int *slot = array_grow(&buffer->bools, 1, error);
    if (!slot)
        return false;
    *slot = yes;
    return true;
}

/* Called for millions of numbers, so it does nothing else. */
static bool float_add(ParamBuffer *buffer, const Token *value, Error *error)
{
    float number;
    if (!token_float(value, &number, error))
        return false;
    float *slot = array_grow(&buffer->floats, 1, error);
    if (!slot)
        return false;
    *slot = number;
    return true;
}

static bool integer_add(ParamBuffer *buffer, const Token *value, Error *error)
{
    int number;
    if (!token_integer(value, &number, error))
        return false;
    int *slot = array_grow(&buffer->integers, 1, error);
    if (!slot)
        return false;
    *slot = number;
    return true;
}

bool param_value_add(ParamBuffer *buffer, const Token *value, Error *error)
{
    Param *param = &ARRAY_AT(&buffer->params, Param, buffer->params.count - 1);
    if (param->count == 0) {
        param->is_text = param->type == PARAM_STRING || param->type == PARAM_TEXTURE ||
                         (param->type == PARAM_SPECTRUM && value->kind == TOKEN_STRING);
        param->first = values_array(buffer, param)->count;
    }
    ++param->count;
    if (param->is_text && value->kind != TOKEN_STRING)
        return token_unexpected(value, "a string", error);
    if (param->is_text)
        return string_add(buffer, value, error);
    if (param->type == PARAM_INTEGER)
        return integer_add(buffer, value, error);
    return param->type == PARAM_BOOL ? bool_add(buffer, value, error) : float_add(buffer, value, error);
}

bool param_end(ParamBuffer *buffer, Error *error)
{
    const Param *param = &ARRAY_AT(&buffer->params, Param, buffer->params.count - 1);
    unsigned per_item = TYPES[param->type].per_item;
    if (param->count == 0) {
        error_at(error, param->place, "the parameter \"%s %s\" has no value", TYPES[param->type].name, param->name);
        return error_fix(error, "give it one, or delete it");
    }
    if (param->count % per_item != 0) {
        error_at(error, param->place, "\"%s %s\" has %zu values, not a multiple of %u", TYPES[param->type].name,
                 param->name, param->count, per_item);
        return error_fix(error, "complete the last item, or delete it");
    }
    if (param->type == PARAM_SPECTRUM && !param->is_text && param->count % 2 != 0) {
        error_at(error, param->place,
                 "\"spectrum %s\" has %zu values, which are not pairs of wavelength and "
                 "value",
                 param->name, param->count);
        return error_fix(error, "complete the last pair, or delete it");
    }
    return true;
}

void param_buffer_seal(ParamBuffer *buffer)
{
    for (size_t i = 0; i < buffer->params.count; ++i) {
        Param *param = &ARRAY_AT(&buffer->params, Param, i);
        if (param->is_text)
            param->strings = (const char *const *)buffer->strings.data + param->first;
        else if (param->type == PARAM_INTEGER)
            param->integers = (const int *)buffer->integers.data + param->first;
        else if (param->type == PARAM_BOOL)
            param->bools = (const int *)buffer->bools.data + param->first;
        else
            param->floats = (const float *)buffer->floats.data + param->first;
    }
}

static const void *values_copy(const void *values, size_t bytes, Arena *arena, Error *error)
{
    void *copy = arena_alloc(arena, bytes, error);
    return copy ? memcpy(copy, values, bytes) : NULL;
}

static bool strings_copy(const Param *from, Param *to, Arena *arena, Error *error)
{
    const char **strings = arena_alloc(arena, from->count * sizeof *strings, error);
    if (!strings)
        return false;
    for (size_t i = 0; i < from->count; ++i)
        if (!(strings[i] = arena_text(arena, from->strings[i], strlen(from->strings[i]), error)))
            return false;
    to->strings = strings;
    return true;
}

static bool param_copy(const Param *from, Param *to, Arena *arena, Error *error)
{
    *to = *from;
    to->name = arena_text(arena, from->name, strlen(from->name), error);
    if (!to->name)
        return false;
    if (from->strings)
        return strings_copy(from, to, arena, error);
    if (from->floats)
        return (to->floats = values_copy(from->floats, from->count * sizeof(float), arena, error)) != NULL;
    if (from->integers)
        return (to->integers = values_copy(from->integers, from->count * sizeof(int), arena, error)) != NULL;
    return (to->bools = values_copy(from->bools, from->count * sizeof(int), arena, error)) != NULL;
}

const ParamSet *param_set_make(const ParamBuffer *buffer, const ParamSet *older, Arena *arena, Error *error)
{
    size_t count = buffer->params.count;
    ParamSet *set = arena_alloc(arena, sizeof *set, error);
    Param *params = set ? arena_alloc(arena, count * sizeof *params, error) : NULL;
    if (!params)
        return NULL;
    for (size_t i = 0; i < count; ++i)
        if (!param_copy(&ARRAY_AT(&buffer->params, Param, i), &params[i], arena, error))
            return NULL;
    *set = (ParamSet){.params = params, .count = count, .older = older, .total = count + (older ? older->total : 0)};
    return set;
}
