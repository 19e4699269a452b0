/* ParamList of pbrt/params.h: the consumers' side. */
#include "pbrt/params.h"

#include "base/log.h"
#include "base/name_table.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void param_list_init(ParamList *list, const char *owner, SourcePlace place, Error *error)
{
    *list = (ParamList){.place = place, .error = error};
    snprintf(list->owner, sizeof list->owner, "%s", owner);
    array_init(&list->entries, sizeof(ParamEntry));
}

void param_list_destroy(ParamList *list)
{
    array_destroy(&list->entries);
}

static void entries_add(ParamList *list, const Param *params, size_t count, bool optional)
{
    for (size_t i = count; i-- > 0 && !list->failed;) {
        ParamEntry *entry = array_grow(&list->entries, 1, list->error);
        if (entry)
            *entry = (ParamEntry){.param = &params[i], .optional = optional};
        list->failed = !entry;
    }
}

void param_list_add_buffer(ParamList *list, const ParamBuffer *buffer)
{
    entries_add(list, buffer->params.data, buffer->params.count, false);
}

void param_list_add_set(ParamList *list, const ParamSet *set, bool optional)
{
    for (; set; set = set->older)
        entries_add(list, set->params, set->count, optional);
}

static void asked_note(ParamList *list, const char *name)
{
    for (int i = 0; i < list->asked_count; ++i)
        if (strcmp(list->asked[i], name) == 0)
            return;
    if (list->asked_count < PARAM_ASKED_MAX)
        list->asked[list->asked_count++] = name;
}

/* Marks all entries of that name as used and returns the one that takes precedence. */
static const Param *entry_use(ParamList *list, const char *name)
{
    const Param *found = NULL;
    asked_note(list, name);
    for (size_t i = 0; i < list->entries.count; ++i) {
        ParamEntry *entry = &ARRAY_AT(&list->entries, ParamEntry, i);
        if (strcmp(entry->param->name, name) != 0)
            continue;
        entry->used = true;
        if (!found)
            found = entry->param;
    }
    return found;
}

static void types_print(unsigned types, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (int i = 0; i < PARAM_TYPE_COUNT; ++i)
        if ((types & PARAM_BIT(i)) && used < size)
            used += (size_t)snprintf(out + used, size - used, "%s%s", used > 0 ? " or " : "",
                                     param_type_name((ParamType)i));
}

const Param *param_find(ParamList *list, const char *name, unsigned types)
{
    const Param *param = entry_use(list, name);
    if (!param || list->failed)
        return NULL;
    if (types & PARAM_BIT(param->type))
        return param;
    char wanted[128];
    types_print(types, wanted, sizeof wanted);
    param_error(list, name, "parameter \"%s\" of %s is of type %s", name, list->owner, param_type_name(param->type));
    error_fix(list->error, "give it as \"%s %s\"", wanted, name);
    return NULL;
}

/* Finds a parameter that must have exactly `count` values. */
static const Param *find_counted(ParamList *list, const char *name, unsigned types, size_t count)
{
    const Param *param = param_find(list, name, types);
    if (!param || param->count == count)
        return param;
    param_error(list, name, "parameter \"%s\" of %s has %zu values instead of %zu", name, list->owner, param->count,
                count);
    return NULL;
}

float param_float(ParamList *list, const char *name, float fallback)
{
    const Param *param = find_counted(list, name, PARAM_BIT(PARAM_FLOAT), 1);
    return param ? param->floats[0] : fallback;
}

int param_integer(ParamList *list, const char *name, int fallback)
{
    const Param *param = find_counted(list, name, PARAM_BIT(PARAM_INTEGER), 1);
    return param ? param->integers[0] : fallback;
}

bool param_bool(ParamList *list, const char *name, bool fallback)
{
    const Param *param = find_counted(list, name, PARAM_BIT(PARAM_BOOL), 1);
    return param ? param->bools[0] != 0 : fallback;
}

const char *param_string(ParamList *list, const char *name, const char *fallback)
{
    const Param *param = find_counted(list, name, PARAM_BIT(PARAM_STRING), 1);
    return param ? param->strings[0] : fallback;
}

bool param_vector(ParamList *list, const char *name, ParamType type, float out[3])
{
    const Param *param = find_counted(list, name, PARAM_BIT(type), 3);
    if (param)
        memcpy(out, param->floats, 3 * sizeof *out);
    return param != NULL;
}

const float *param_floats(ParamList *list, const char *name, ParamType type, size_t *count)
{
    const Param *param = param_find(list, name, PARAM_BIT(type));
    *count = param ? param->count : 0;
    return param ? param->floats : NULL;
}

const int *param_integers(ParamList *list, const char *name, size_t *count)
{
    const Param *param = param_find(list, name, PARAM_BIT(PARAM_INTEGER));
    *count = param ? param->count : 0;
    return param ? param->integers : NULL;
}

const Param *param_ignore(ParamList *list, const char *name)
{
    return entry_use(list, name);
}

SourcePlace param_place(const ParamList *list, const char *name)
{
    for (size_t i = 0; i < list->entries.count; ++i) {
        const Param *param = ARRAY_AT(&list->entries, ParamEntry, i).param;
        if (strcmp(param->name, name) == 0)
            return param->place;
    }
    return list->place;
}

void param_error(ParamList *list, const char *name, const char *format, ...)
{
    char text[512];
    va_list arguments;
    if (list->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    error_at(list->error, param_place(list, name), "%s", text);
    if (entry_use(list, name))
        error_fix(list->error, "change \"%s\", or leave it out if it has a default", name);
    else
        error_fix(list->error, "add \"%s\" to %s", name, list->owner);
    list->failed = true;
}

static void unknown_fix(const ParamList *list, const char *name)
{
    const char *nearest = name_nearest(name, list->asked, (size_t)list->asked_count);
    if (nearest) {
        error_fix(list->error, "did you mean \"%s\"?", nearest);
        return;
    }
    char known[400] = "";
    size_t used = 0;
    for (int i = 0; i < list->asked_count && used + 40 < sizeof known; ++i)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i > 0 ? ", " : "", list->asked[i]);
    error_fix(list->error, list->asked_count > 0 ? "it takes %s" : "it takes no parameters%s", known);
}

bool param_list_finish(ParamList *list, bool lenient)
{
    for (size_t i = 0; i < list->entries.count && !list->failed; ++i) {
        const ParamEntry *entry = &ARRAY_AT(&list->entries, ParamEntry, i);
        if (entry->used || entry->optional)
            continue;
        if (lenient) {
            log_message_at(LOG_WARNING, entry->param->place, "unknown parameter \"%s\" of %s is ignored",
                           entry->param->name, list->owner);
            continue;
        }
        error_at(list->error, entry->param->place, "unknown parameter \"%s\" of %s", entry->param->name, list->owner);
        unknown_fix(list, entry->param->name);
        list->failed = true;
    }
    return !list->failed;
}
