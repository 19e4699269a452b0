/* Writes JSON (RFC 8259) to a stream: the caller opens, names and closes, the writer sets commas, indents and escapes.
 *
 * Inside an object every value needs a key; inside an array the key is NULL. Numbers that JSON cannot express (NaN,
 * infinities) are written as null. */
#ifndef TWINLIGHT_BASE_JSON_H
#define TWINLIGHT_BASE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct JsonWriter {
    FILE *stream;
    int depth;
    bool empty; /* nothing yet in the innermost object or array */
} JsonWriter;

void json_init(JsonWriter *json, FILE *stream);

void json_object_begin(JsonWriter *json, const char *key);
void json_object_end(JsonWriter *json);
void json_array_begin(JsonWriter *json, const char *key);
void json_array_end(JsonWriter *json);

/* `value` is UTF-8; bytes that are not become U+FFFD. NULL is written as null. */
void json_string(JsonWriter *json, const char *key, const char *value);
void json_number(JsonWriter *json, const char *key, double value);
void json_integer(JsonWriter *json, const char *key, int64_t value);
void json_unsigned(JsonWriter *json, const char *key, uint64_t value);
void json_bool(JsonWriter *json, const char *key, bool value);

#endif
