#include "base/name_table.h"

#include "base/hash.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define NAME_COMPARED 63

void name_table_init(NameTable *table)
{
    *table = (NameTable){0};
    array_init(&table->entries, sizeof(NameEntry));
}

void name_table_destroy(NameTable *table)
{
    array_destroy(&table->entries);
    free(table->slots);
    table->slots = NULL;
    table->slot_count = 0;
}

static uint64_t name_hash(const char *name)
{
    uint64_t hash = hash_bytes(HASH_START, name, strlen(name));
    return hash ^ (hash >> 29);
}

/* The slot that holds `name`, or else the empty slot where it belongs. */
static size_t slot_find(const NameTable *table, const char *name)
{
    size_t mask = table->slot_count - 1;
    size_t slot = (size_t)name_hash(name) & mask;
    while (table->slots[slot] != NONE &&
           strcmp(ARRAY_AT(&table->entries, NameEntry, table->slots[slot]).name, name) != 0)
        slot = (slot + 1) & mask;
    return slot;
}

uint name_table_find(const NameTable *table, const char *name)
{
    if (table->slot_count == 0)
        return NONE;
    uint entry = table->slots[slot_find(table, name)];
    return entry == NONE ? NONE : ARRAY_AT(&table->entries, NameEntry, entry).value;
}

static bool slots_double(NameTable *table, Error *error)
{
    size_t count = table->slot_count > 0 ? 2 * table->slot_count : 64;
    uint *slots = malloc(count * sizeof *slots);
    if (!slots)
        return error_memory(error, count * sizeof *slots, "a table of names");
    memset(slots, 0xff, count * sizeof *slots);
    free(table->slots);
    table->slots = slots;
    table->slot_count = count;
    for (size_t i = 0; i < table->entries.count; ++i)
        slots[slot_find(table, ARRAY_AT(&table->entries, NameEntry, i).name)] = (uint)i;
    return true;
}

bool name_table_add(NameTable *table, const char *name, uint value, Error *error)
{
    if (2 * (table->entries.count + 1) > table->slot_count && !slots_double(table, error))
        return false;
    NameEntry *entry = array_grow(&table->entries, 1, error);
    if (!entry)
        return false;
    /* slot_find cannot find the new entry itself, because no slot refers to it yet; it returns an empty slot. */
    size_t slot = slot_find(table, name);
    *entry = (NameEntry){.name = name, .value = value};
    table->slots[slot] = (uint)(table->entries.count - 1);
    return true;
}

void name_table_list(const NameTable *table, char *out, size_t size)
{
    size_t used = (size_t)snprintf(out, size, "%s", table->entries.count == 0 ? "none" : "");
    for (size_t i = 0; i < table->entries.count; ++i) {
        const char *name = ARRAY_AT(&table->entries, NameEntry, i).name;
        size_t length = strlen(name) + 2;
        if (used + length + 5 > size) {
            snprintf(out + used, size - used, " ...");
            return;
        }
        used += (size_t)snprintf(out + used, size - used, "%s%s", i > 0 ? ", " : "", name);
    }
}

int name_distance(const char *a, const char *b, int limit)
{
    int row[NAME_COMPARED + 1];
    int n = (int)strnlen(a, NAME_COMPARED), m = (int)strnlen(b, NAME_COMPARED);
    if (n - m > limit || m - n > limit)
        return limit;
    for (int j = 0; j <= m; ++j)
        row[j] = j;
    for (int i = 1; i <= n; ++i) {
        int diagonal = row[0];
        row[0] = i;
        for (int j = 1; j <= m; ++j) {
            int substitute = diagonal + (a[i - 1] != b[j - 1]);
            int other = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = substitute < other ? substitute : other;
        }
    }
    return row[m] < limit ? row[m] : limit;
}

/* Largest edit distance at which a name is suggested for a word of this length. */
static int distance_allowed(const char *wanted)
{
    size_t length = strnlen(wanted, NAME_COMPARED);
    return length <= 2 ? 1 : length <= 5 ? 2 : 3;
}

const char *name_nearest(const char *wanted, const char *const *names, size_t count)
{
    const char *best = NULL;
    int best_distance = distance_allowed(wanted) + 1;
    for (size_t i = 0; i < count; ++i) {
        int distance = strcasecmp(wanted, names[i]) == 0 ? 0 : name_distance(wanted, names[i], best_distance);
        if (distance < best_distance) {
            best_distance = distance;
            best = names[i];
        }
    }
    return best;
}

const char *name_table_nearest(const NameTable *table, const char *wanted)
{
    const char *best = NULL;
    int best_distance = distance_allowed(wanted) + 1;
    for (size_t i = 0; i < table->entries.count && i < 10000; ++i) {
        const char *name = ARRAY_AT(&table->entries, NameEntry, i).name;
        int distance = name_distance(wanted, name, best_distance);
        if (distance < best_distance) {
            best_distance = distance;
            best = name;
        }
    }
    return best;
}
