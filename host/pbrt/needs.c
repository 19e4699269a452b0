#include "pbrt/needs.h"

#include "base/json.h"
#include "base/log.h"

#include <string.h>

static const char *const STATUS_NAMES[] = {"supported", "approximated", "not supported", "error"};

void needs_init(SceneNeeds *needs)
{
    *needs = (SceneNeeds){.current = NONE};
    array_init(&needs->needs, sizeof(Need));
    name_table_init(&needs->table);
}

void needs_destroy(SceneNeeds *needs)
{
    array_destroy(&needs->needs);
    name_table_destroy(&needs->table);
    arena_destroy(&needs->texts);
}

bool needs_met(const SceneNeeds *needs)
{
    for (size_t i = 0; i < needs->needs.count; ++i)
        if (ARRAY_AT(&needs->needs, Need, i).status > NEED_APPROXIMATED)
            return false;
    return true;
}

/* ---- recording --------------------------------------------------------------------------------------------------- */

/* The entry of that kind and name, a new one if there is none; NULL when out of memory. */
static Need *need_find(SceneNeeds *needs, const char *kind, const char *name, Error *error)
{
    char key[1024];
    snprintf(key, sizeof key, "%s %s", kind, name);
    uint known = name_table_find(&needs->table, key);
    if (known != NONE)
        return &ARRAY_AT(&needs->needs, Need, known);
    const char *kept = arena_text(&needs->texts, key, strlen(key), error);
    Need *need = kept ? array_grow(&needs->needs, 1, error) : NULL;
    if (!need || !name_table_add(&needs->table, kept, (uint)needs->needs.count - 1, error))
        return NULL;
    const char *kept_kind = arena_text(&needs->texts, kind, strlen(kind), error);
    *need = (Need){.kind = kept_kind, .name = kept + strlen(kind) + 1, .note = ""};
    return kept_kind ? need : NULL;
}

/* Makes the status worse, and keeps where that was first and what to do. */
static bool need_mark(SceneNeeds *needs, Need *need, NeedStatus status, const char *note, const char *place,
                      Error *error)
{
    if (status <= need->status)
        return true;
    need->status = status;
    snprintf(need->place, sizeof need->place, "%s", place);
    need->note = arena_text(&needs->texts, note, strlen(note), error);
    return need->note != NULL;
}

static void place_write(SourcePlace place, char out[512])
{
    snprintf(out, 512, "%s:%d:%d", place.file ? place.file : "", place.line, place.column);
}

void needs_directive(SceneNeeds *needs)
{
    needs->current = NONE;
    needs->warnings = log_warning_count();
}

bool needs_use(SceneNeeds *needs, const char *kind, const char *name, SourcePlace place, Error *error)
{
    Need *need = need_find(needs, kind, name, error);
    if (!need)
        return false;
    if (need->count++ == 0)
        place_write(place, need->place);
    needs->current = (size_t)(need - (Need *)needs->needs.data);
    return true;
}

/* What the directive uses, if the text names it in quotes; else NULL. */
static Need *need_named(SceneNeeds *needs, const char *text)
{
    char quoted[512];
    if (needs->current == NONE)
        return NULL;
    Need *need = &ARRAY_AT(&needs->needs, Need, needs->current);
    snprintf(quoted, sizeof quoted, "\"%s\"", need->name);
    return strstr(text, quoted) ? need : NULL;
}

static bool need_add(SceneNeeds *needs, const char *kind, const char *name, NeedStatus status, const char *note,
                     const char *place, Error *error)
{
    Need *need = need_named(needs, name);
    if (!need) {
        need = need_find(needs, kind, name, error);
        if (need)
            ++need->count;
    }
    return need && need_mark(needs, need, status, note, place, error);
}

bool needs_unsupported(SceneNeeds *needs, const char *what, const char *note, SourcePlace place, Error *error)
{
    char at[512];
    place_write(place, at);
    return need_add(needs, "feature", what, NEED_UNSUPPORTED, note, at, error);
}

bool needs_error(SceneNeeds *needs, const Error *found, Error *error)
{
    char place[512] = "";
    const char *text = error_text(found);
    size_t length = (size_t)(text - found->message), suffix = strlen(": error: ");
    bool unknown = strncmp(text, "unknown ", 8) == 0;
    if (length > suffix)
        snprintf(place, sizeof place, "%.*s", (int)(length - suffix), found->message);
    if (!unknown)
        needs->current = NONE;
    return need_add(needs, "error", text, unknown ? NEED_UNSUPPORTED : NEED_ERROR, found->fix, place, error);
}

void needs_warned(SceneNeeds *needs, SourcePlace place)
{
    if (needs->current == NONE || log_warning_count() == needs->warnings)
        return;
    Need *need = &ARRAY_AT(&needs->needs, Need, needs->current);
    if (need->status >= NEED_APPROXIMATED)
        return;
    need->status = NEED_APPROXIMATED;
    place_write(place, need->place);
}

/* ---- printing ---------------------------------------------------------------------------------------------------- */

void needs_print(const SceneNeeds *needs, FILE *stream)
{
    fprintf(stream, "%7s  %-13s  %-18s  %s\n", "count", "status", "kind", "name");
    for (size_t i = 0; i < needs->needs.count; ++i) {
        const Need *need = &ARRAY_AT(&needs->needs, Need, i);
        fprintf(stream, "%7lu  %-13s  %-18s  %s", need->count, STATUS_NAMES[need->status], need->kind, need->name);
        if (need->status != NEED_SUPPORTED)
            fprintf(stream, "  (%s%s%s)", need->place, need->note[0] ? "; " : "", need->note);
        fputc('\n', stream);
    }
}

void needs_print_json(const SceneNeeds *needs, const char *path, FILE *stream)
{
    JsonWriter json;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_text(&json, "scene", path);
    json_bool(&json, "supported", needs_met(needs));
    json_array_begin(&json, "needs");
    for (size_t i = 0; i < needs->needs.count; ++i) {
        const Need *need = &ARRAY_AT(&needs->needs, Need, i);
        json_object_begin(&json, NULL);
        json_text(&json, "kind", need->kind);
        json_text(&json, "name", need->name);
        json_unsigned(&json, "count", need->count);
        json_text(&json, "status", STATUS_NAMES[need->status]);
        json_text(&json, "note", need->note);
        json_text(&json, "place", need->place);
        json_object_end(&json);
    }
    json_array_end(&json);
    json_object_end(&json);
}
