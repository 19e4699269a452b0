#include "gltf/json_value.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool gltf_fail(GltfReader *reader, const char *format, ...)
{
    char text[sizeof reader->error->message];
    va_list arguments;
    if (reader->failed)
        return false;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    reader->failed = true;
    return error_at(reader->error, (SourcePlace){.file = reader->path}, "%s", text);
}

/* Member `key`, NULL if absent or after a failure. */
static const json_t *member(const GltfReader *reader, const GltfObject *object, const char *key)
{
    return reader->failed || !object->json ? NULL : json_object_get(object->json, key);
}

/* "a.b", or "b" in the root. */
static void name_join(char *out, size_t size, const char *object, const char *key)
{
    snprintf(out, size, "%.100s%s%.50s", object, object[0] ? "." : "", key);
}

static void wrong(GltfReader *reader, const GltfObject *object, const char *key, const char *wanted)
{
    char name[240];
    name_join(name, sizeof name, object->name, key);
    gltf_fail(reader, "%s must be %s", name, wanted);
}

size_t gltf_count(GltfReader *reader, const char *array)
{
    const GltfObject root = {reader->root, ""};
    size_t count;
    gltf_array(reader, &root, array, &count);
    return count;
}

GltfObject gltf_entry(GltfReader *reader, const char *array, size_t i)
{
    const GltfObject root = {reader->root, ""};
    GltfObject entry = {json_array_get(member(reader, &root, array), i), ""};
    snprintf(entry.name, sizeof entry.name, "%s[%zu]", array, i);
    if (!reader->failed && !json_is_object(entry.json))
        gltf_fail(reader, "%s must be an object", entry.name);
    return entry;
}

GltfObject gltf_object(GltfReader *reader, const GltfObject *object, const char *key)
{
    GltfObject found = {member(reader, object, key), ""};
    name_join(found.name, sizeof found.name, object->name, key);
    if (found.json && !json_is_object(found.json)) {
        gltf_fail(reader, "%s must be an object", found.name);
        found.json = NULL;
    }
    return found;
}

GltfObject gltf_extension(GltfReader *reader, const GltfObject *object, const char *name)
{
    const GltfObject extensions = gltf_object(reader, object, "extensions");
    return gltf_object(reader, &extensions, name);
}

const json_t *gltf_array(GltfReader *reader, const GltfObject *object, const char *key, size_t *count)
{
    const json_t *array = member(reader, object, key);
    *count = array ? json_array_size(array) : 0;
    if (array && (!json_is_array(array) || *count > GLTF_COUNT_MAX)) {
        wrong(reader, object, key, "an array");
        *count = 0;
        return NULL;
    }
    return array;
}

double gltf_number(GltfReader *reader, const GltfObject *object, const char *key, double fallback, double least,
                   double most)
{
    const json_t *value = member(reader, object, key);
    if (!value)
        return fallback;
    double number = json_number_value(value);
    if (json_is_number(value) && number >= least && number <= most)
        return number;
    char wanted[80];
    snprintf(wanted, sizeof wanted, "a number from %.6g to %.6g", least, most);
    wrong(reader, object, key, wanted);
    return fallback;
}

bool gltf_numbers(GltfReader *reader, const GltfObject *object, const char *key, size_t count, double *out)
{
    size_t found;
    const json_t *array = gltf_array(reader, object, key, &found);
    bool good = found == count;
    if (!array)
        return false;
    for (size_t i = 0; good && i < count; ++i) {
        const json_t *value = json_array_get(array, i);
        double number = json_number_value(value);
        good = json_is_number(value) && number >= -(double)FLT_MAX && number <= (double)FLT_MAX;
        out[i] = number;
    }
    char wanted[64];
    snprintf(wanted, sizeof wanted, "an array of %zu numbers", count);
    if (!good)
        wrong(reader, object, key, wanted);
    return good;
}

#define SIZE_LARGEST ((json_int_t)1 << 53)

size_t gltf_size(GltfReader *reader, const GltfObject *object, const char *key, size_t fallback)
{
    const json_t *value = member(reader, object, key);
    json_int_t number = json_integer_value(value);
    if (!value)
        return fallback;
    if (json_is_integer(value) && number >= 0 && number <= SIZE_LARGEST)
        return (size_t)number;
    wrong(reader, object, key, "a whole number of at least 0");
    return fallback;
}

/* Checks an index; `name` is that of the value. */
static int index_check(GltfReader *reader, const json_t *value, const char *name, const char *array)
{
    size_t count = gltf_count(reader, array);
    json_int_t number = json_integer_value(value);
    if (json_is_integer(value) && number >= 0 && (size_t)number < count)
        return (int)number;
    if (json_is_integer(value))
        gltf_fail(reader, "%s is %" JSON_INTEGER_FORMAT ", but there are %zu %s", name, number, count, array);
    else
        gltf_fail(reader, "%s must be an index into %s", name, array);
    return -1;
}

int gltf_index(GltfReader *reader, const GltfObject *object, const char *key, const char *array)
{
    const json_t *value = member(reader, object, key);
    char name[240];
    name_join(name, sizeof name, object->name, key);
    return value ? index_check(reader, value, name, array) : -1;
}

int gltf_index_at(GltfReader *reader, const GltfObject *object, const char *key, size_t i, const char *array)
{
    char part[64], name[240];
    snprintf(part, sizeof part, "%s[%zu]", key, i);
    name_join(name, sizeof name, object->name, part);
    return reader->failed ? -1 : index_check(reader, json_array_get(member(reader, object, key), i), name, array);
}

bool gltf_bool(GltfReader *reader, const GltfObject *object, const char *key, bool fallback)
{
    const json_t *value = member(reader, object, key);
    if (value && !json_is_boolean(value))
        wrong(reader, object, key, "true or false");
    return value ? json_is_true(value) : fallback;
}

const char *gltf_text(GltfReader *reader, const GltfObject *object, const char *key, const char *fallback)
{
    const json_t *value = member(reader, object, key);
    if (value && !json_is_string(value)) {
        wrong(reader, object, key, "a string");
        return fallback;
    }
    return value ? json_string_value(value) : fallback;
}
