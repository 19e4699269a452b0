#include "pbrt/ply_values.h"

#include "base/text_number.h"
#include "math/platform.h"

#include <string.h>

bool ply_truncated(const PlyReader *r)
{
    return ply_error(r->source, "the file ends too early");
}

uint64_t ply_bytes_integer(const char *p, size_t size, bool little)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size; ++i)
        value |= (uint64_t)(unsigned char)p[i] << (8 * (little ? i : size - 1 - i));
    return value;
}

/* Decodes an integer of any type; negative ones become huge. */
static uint64_t integer_decode(const char *p, PlyType type, bool little)
{
    uint64_t raw = ply_bytes_integer(p, ply_type_size(type), little);
    switch (type) {
    case PLY_INT8:
        return (uint64_t)(int8_t)raw;
    case PLY_INT16:
        return (uint64_t)(int16_t)raw;
    case PLY_INT32:
        return (uint64_t)(int32_t)raw;
    default:
        return raw;
    }
}

float ply_float_decode(const char *p, PlyType type, bool little)
{
    uint64_t raw = ply_bytes_integer(p, ply_type_size(type), little);
    if (type == PLY_FLOAT32)
        return bits_float((uint)raw);
    if (type == PLY_FLOAT64) {
        double value;
        memcpy(&value, &raw, sizeof value);
        return (float)value;
    }
    return (float)(int64_t)integer_decode(p, type, little);
}

/* Reads the next word of an ascii body. */
static bool word_next(PlyReader *r, const char **word, size_t *length)
{
    while (r->p < r->end && (*r->p == ' ' || *r->p == '\n' || *r->p == '\r' || *r->p == '\t'))
        ++r->p;
    *word = r->p;
    while (r->p < r->end && *r->p != ' ' && *r->p != '\n' && *r->p != '\r' && *r->p != '\t')
        ++r->p;
    *length = (size_t)(r->p - *word);
    return *length > 0 || ply_truncated(r);
}

static bool not_a_number(const PlyReader *r, const char *word, size_t length)
{
    return ply_error(r->source, "expected a number, found %.*s", (int)(length < 40 ? length : 40), word);
}

bool ply_integer_next(PlyReader *r, PlyType type, uint64_t *value)
{
    if (r->format == PLY_ASCII) {
        const char *word;
        size_t length;
        int number;
        if (!word_next(r, &word, &length))
            return false;
        if (number_integer(word, length, &number) != NUMBER_OK)
            return not_a_number(r, word, length);
        *value = (uint64_t)number;
        return true;
    }
    size_t size = ply_type_size(type);
    if ((size_t)(r->end - r->p) < size)
        return ply_truncated(r);
    *value = integer_decode(r->p, type, r->format == PLY_LITTLE_ENDIAN);
    r->p += size;
    return true;
}

bool ply_float_next(PlyReader *r, PlyType type, float *value)
{
    if (r->format == PLY_ASCII) {
        const char *word;
        size_t length;
        return word_next(r, &word, &length) &&
               (number_float(word, length, value) == NUMBER_OK || not_a_number(r, word, length));
    }
    size_t size = ply_type_size(type);
    if ((size_t)(r->end - r->p) < size)
        return ply_truncated(r);
    *value = ply_float_decode(r->p, type, r->format == PLY_LITTLE_ENDIAN);
    r->p += size;
    return true;
}

bool ply_values_skip(PlyReader *r, PlyType type, uint64_t count)
{
    if (r->format != PLY_ASCII) {
        if (count > (uint64_t)(r->end - r->p) / ply_type_size(type))
            return ply_truncated(r);
        r->p += count * ply_type_size(type);
        return true;
    }
    const char *word;
    size_t length;
    for (uint64_t i = 0; i < count; ++i)
        if (!word_next(r, &word, &length))
            return false;
    return true;
}
