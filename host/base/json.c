#include "base/json.h"

#include <inttypes.h>
#include <math.h>

void json_init(JsonWriter *json, FILE *stream)
{
    json->stream = stream;
    json->depth = 0;
    json->empty = true;
}

static void json_newline(JsonWriter *json)
{
    fputc('\n', json->stream);
    for (int i = 0; i < json->depth; ++i)
        fputs("  ", json->stream);
}

/* Length of the well-formed UTF-8 sequence at `s` (RFC 3629), 0 when there is none. */
static int utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80)
        return 1;
    int length = s[0] >= 0xc2 && s[0] < 0xe0   ? 2
                 : s[0] >= 0xe0 && s[0] < 0xf0 ? 3
                 : s[0] >= 0xf0 && s[0] < 0xf5 ? 4
                                               : 0;
    for (int i = 1; i < length; ++i)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    bool overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    bool surrogate = s[0] == 0xed && s[1] >= 0xa0;
    bool too_large = s[0] == 0xf4 && s[1] >= 0x90;
    return overlong || surrogate || too_large ? 0 : length;
}

static void json_escaped(JsonWriter *json, const char *text)
{
    const unsigned char *s = (const unsigned char *)text;
    fputc('"', json->stream);
    while (*s) {
        int length = utf8_length(s);
        if (length == 0)
            fputs("\\ufffd", json->stream);
        else if (*s == '"' || *s == '\\')
            fprintf(json->stream, "\\%c", *s);
        else if (*s < 0x20)
            fprintf(json->stream, "\\u%04x", *s);
        else
            fwrite(s, 1, (size_t)length, json->stream);
        s += length > 0 ? length : 1;
    }
    fputc('"', json->stream);
}

/* Writes comma, line break, indent and key, as needed before a value. */
static void json_prefix(JsonWriter *json, const char *key)
{
    if (!json->empty)
        fputc(',', json->stream);
    if (json->depth > 0)
        json_newline(json);
    json->empty = false;
    if (key) {
        json_escaped(json, key);
        fputs(": ", json->stream);
    }
}

static void json_open(JsonWriter *json, const char *key, char bracket)
{
    json_prefix(json, key);
    fputc(bracket, json->stream);
    ++json->depth;
    json->empty = true;
}

static void json_close(JsonWriter *json, char bracket)
{
    --json->depth;
    if (!json->empty)
        json_newline(json);
    fputc(bracket, json->stream);
    json->empty = false;
    if (json->depth == 0)
        fputc('\n', json->stream);
}

void json_object_begin(JsonWriter *json, const char *key)
{
    json_open(json, key, '{');
}

void json_object_end(JsonWriter *json)
{
    json_close(json, '}');
}

void json_array_begin(JsonWriter *json, const char *key)
{
    json_open(json, key, '[');
}

void json_array_end(JsonWriter *json)
{
    json_close(json, ']');
}

void json_text(JsonWriter *json, const char *key, const char *value)
{
    json_prefix(json, key);
    if (value)
        json_escaped(json, value);
    else
        fputs("null", json->stream);
}

void json_number(JsonWriter *json, const char *key, double value)
{
    json_prefix(json, key);
    if (isfinite(value))
        fprintf(json->stream, "%.9g", value);
    else
        fputs("null", json->stream);
}

void json_signed(JsonWriter *json, const char *key, int64_t value)
{
    json_prefix(json, key);
    fprintf(json->stream, "%" PRId64, value);
}

void json_unsigned(JsonWriter *json, const char *key, uint64_t value)
{
    json_prefix(json, key);
    fprintf(json->stream, "%" PRIu64, value);
}

void json_bool(JsonWriter *json, const char *key, bool value)
{
    json_prefix(json, key);
    fputs(value ? "true" : "false", json->stream);
}
