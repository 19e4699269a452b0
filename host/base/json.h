/* JSON writer (RFC 8259). The caller opens and closes objects and arrays and names values; the writer takes care of
 * commas, indentation and escapes.
 *
 * Inside an object every value needs a key; inside an array the key is NULL. NaN and infinities, which JSON cannot
 * express, are written as null. */
#ifndef TWINLIGHT_BASE_JSON_H
#define TWINLIGHT_BASE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct JsonWriter {
    FILE *stream;
    int depth;
    bool empty; /* the innermost object or array has no element yet */
} JsonWriter;

void json_init(JsonWriter *json, FILE *stream);

void json_object_begin(JsonWriter *json, const char *key);
void json_object_end(JsonWriter *json);
void json_array_begin(JsonWriter *json, const char *key);
void json_array_end(JsonWriter *json);

/* `value` is UTF-8; each invalid byte becomes U+FFFD. NULL is written as null. */
void json_text(JsonWriter *json, const char *key, const char *value);
void json_number(JsonWriter *json, const char *key, double value);
void json_signed(JsonWriter *json, const char *key, int64_t value);
void json_unsigned(JsonWriter *json, const char *key, uint64_t value);
void json_bool(JsonWriter *json, const char *key, bool value);

#endif
