#include "pbrt/ply_header.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A line of the header, split into words. */
#define WORDS_MAX 6

typedef struct Line {
    int number;
    int count;
    const char *words[WORDS_MAX];
    size_t lengths[WORDS_MAX];
} Line;

static const struct {
    const char *name, *alias;
    PlyType type;
    size_t size;
} TYPES[] = {{"char", "int8", PLY_INT8, 1},        {"uchar", "uint8", PLY_UINT8, 1},
             {"short", "int16", PLY_INT16, 2},     {"ushort", "uint16", PLY_UINT16, 2},
             {"int", "int32", PLY_INT32, 4},       {"uint", "uint32", PLY_UINT32, 4},
             {"float", "float32", PLY_FLOAT32, 4}, {"double", "float64", PLY_FLOAT64, 8}};
#define TYPE_COUNT (sizeof TYPES / sizeof *TYPES)

size_t ply_type_size(PlyType type)
{
    return TYPES[type - 1].size;
}

bool ply_error(const PlySource *source, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    error_at(source->error, source->place, "%s: %s", source->path, text);
    return error_fix(source->error, "export the mesh again, as binary or ASCII PLY of triangles");
}

static bool word_is(const Line *line, int i, const char *word)
{
    return i < line->count && line->lengths[i] == strlen(word) && memcmp(line->words[i], word, line->lengths[i]) == 0;
}

static PlyType type_find(const Line *line, int i)
{
    for (size_t t = 0; t < TYPE_COUNT; ++t)
        if (word_is(line, i, TYPES[t].name) || word_is(line, i, TYPES[t].alias))
            return TYPES[t].type;
    return PLY_NONE;
}

/* Reads the line at *position and advances past it. False at the end of the data. */
static bool line_read(const char *data, size_t size, size_t *position, Line *line)
{
    const char *start = data + *position;
    const char *newline = memchr(start, '\n', size - *position);
    if (!newline)
        return false;
    line->count = 0;
    ++line->number;
    for (const char *p = start; p < newline;) {
        while (p < newline && (*p == ' ' || *p == '\t' || *p == '\r'))
            ++p;
        const char *word = p;
        while (p < newline && *p != ' ' && *p != '\t' && *p != '\r')
            ++p;
        if (p > word && line->count < WORDS_MAX) {
            line->words[line->count] = word;
            line->lengths[line->count++] = (size_t)(p - word);
        }
    }
    *position = (size_t)(newline - data) + 1;
    return true;
}

static bool format_read(const PlySource *source, const Line *line, PlyFormat *format)
{
    if (word_is(line, 1, "ascii"))
        *format = PLY_ASCII;
    else if (word_is(line, 1, "binary_little_endian"))
        *format = PLY_LITTLE_ENDIAN;
    else if (word_is(line, 1, "binary_big_endian"))
        *format = PLY_BIG_ENDIAN;
    else
        return ply_error(source, "line %d: unknown format", line->number);
    return true;
}

static bool element_read(const PlySource *source, const Line *line, PlyHeader *header)
{
    int64_t count = 0;
    if (line->count != 3 || header->element_count == PLY_ELEMENTS_MAX)
        return ply_error(source, "line %d: malformed element, or more than %d of them", line->number, PLY_ELEMENTS_MAX);
    for (size_t i = 0; i < line->lengths[2]; ++i) {
        char c = line->words[2][i];
        count = c < '0' || c > '9' ? -1 : 10 * count + (c - '0');
        if (count < 0 || count > UINT32_MAX)
            return ply_error(source, "line %d: an element's count is not a number below 2^32", line->number);
    }
    PlyElement *element = &header->elements[header->element_count++];
    *element = (PlyElement){.count = (size_t)count};
    if (word_is(line, 1, "vertex"))
        element->kind = PLY_VERTEX;
    else if (word_is(line, 1, "face"))
        element->kind = PLY_FACE;
    return true;
}

static bool property_read(const PlySource *source, const Line *line, PlyHeader *header)
{
    bool list = word_is(line, 1, "list");
    int name = list ? 4 : 2;
    if (header->element_count == 0 || line->count != name + 1)
        return ply_error(source, "line %d: malformed property", line->number);
    PlyElement *element = &header->elements[header->element_count - 1];
    if (element->property_count == PLY_PROPERTIES_MAX)
        return ply_error(source, "line %d: more than %d properties", line->number, PLY_PROPERTIES_MAX);
    PlyProperty *property = &element->properties[element->property_count++];
    *property = (PlyProperty){.type = type_find(line, name - 1)};
    property->count_type = list ? type_find(line, 2) : PLY_NONE;
    if (property->type == PLY_NONE ||
        (list && (property->count_type == PLY_NONE || property->count_type >= PLY_FLOAT32)))
        return ply_error(source, "line %d: unknown type of a property", line->number);
    snprintf(property->name, sizeof property->name, "%.*s",
             (int)(line->lengths[name] < PLY_NAME_MAX ? line->lengths[name] : PLY_NAME_MAX), line->words[name]);
    return true;
}

static PlyProperty *property_find(PlyElement *element, const char *name, bool list)
{
    for (int i = 0; i < element->property_count; ++i)
        if (strcmp(element->properties[i].name, name) == 0 && (element->properties[i].count_type != PLY_NONE) == list)
            return &element->properties[i];
    return NULL;
}

/* Gives `count` scalar properties consecutive meanings from `first` on, if all of them exist. */
static bool meanings_set(PlyElement *element, const char *const *names, int count, PlyMeaning first)
{
    for (int i = 0; i < count; ++i)
        if (!property_find(element, names[i], false))
            return false;
    for (int i = 0; i < count; ++i)
        property_find(element, names[i], false)->meaning = (PlyMeaning)((int)first + i);
    return true;
}

/* Texture coordinates have several names; the first complete pair is used, as in pbrt. */
static bool vertex_meanings(const PlySource *source, PlyElement *element)
{
    static const char *const XYZ[] = {"x", "y", "z"}, *const NORMAL[] = {"nx", "ny", "nz"};
    static const char *const UV[4][2] = {
        {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    if (!meanings_set(element, XYZ, 3, PLY_X))
        return ply_error(source, "the vertices lack x, y or z");
    meanings_set(element, NORMAL, 3, PLY_NX);
    for (int i = 0; i < 4; ++i)
        if (meanings_set(element, UV[i], 2, PLY_U))
            break;
    return true;
}

static bool face_meanings(const PlySource *source, PlyElement *element)
{
    PlyProperty *indices = property_find(element, "vertex_indices", true);
    if (!indices)
        indices = property_find(element, "vertex_index", true);
    if (!indices || indices->type >= PLY_FLOAT32)
        return ply_error(source, "the faces lack a list of integers named vertex_indices");
    indices->meaning = PLY_INDICES;
    return true;
}

static bool header_check(const PlySource *source, PlyHeader *header)
{
    int vertices = 0, faces = 0;
    for (int i = 0; i < header->element_count; ++i) {
        PlyElement *element = &header->elements[i];
        if (element->kind == PLY_VERTEX && (++vertices > 1 || !vertex_meanings(source, element)))
            return vertices > 1 ? ply_error(source, "two elements named vertex") : false;
        if (element->kind == PLY_FACE && (++faces > 1 || !face_meanings(source, element)))
            return faces > 1 ? ply_error(source, "two elements named face") : false;
        if (element->kind != PLY_OTHER && element->count == 0)
            return ply_error(source, "the file has no %s", element->kind == PLY_VERTEX ? "vertices" : "faces");
    }
    return (vertices == 1 && faces == 1) || ply_error(source, "the header lacks the element vertex or face");
}

bool ply_header_read(const PlySource *source, const char *data, size_t size, PlyHeader *header)
{
    Line line = {0};
    bool has_format = false;
    header->element_count = 0;
    header->size = 0;
    if (!line_read(data, size, &header->size, &line) || line.count != 1 || !word_is(&line, 0, "ply"))
        return ply_error(source, "not a PLY file");
    while (line_read(data, size, &header->size, &line)) {
        bool good = true;
        if (word_is(&line, 0, "end_header"))
            return has_format ? header_check(source, header) : ply_error(source, "the header names no format");
        if (word_is(&line, 0, "format"))
            good = has_format = format_read(source, &line, &header->format);
        else if (word_is(&line, 0, "element"))
            good = element_read(source, &line, header);
        else if (word_is(&line, 0, "property"))
            good = property_read(source, &line, header);
        else if (!word_is(&line, 0, "comment") && !word_is(&line, 0, "obj_info") && line.count > 0)
            good = ply_error(source, "line %d: unknown keyword", line.number);
        if (!good)
            return false;
    }
    return ply_error(source, "the header has no end_header");
}
