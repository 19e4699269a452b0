/* Hash table from names to indices (open addressing), and the search for the known name nearest to a misspelt one. */
#ifndef TWINLIGHT_BASE_NAME_TABLE_H
#define TWINLIGHT_BASE_NAME_TABLE_H

#include "base/array.h"
#include "math/platform.h"

typedef struct NameEntry {
    const char *name; /* borrowed: must outlive the table */
    uint value;
} NameEntry;

typedef struct NameTable {
    Array entries; /* NameEntry, in order of insertion */
    uint *slots; /* index of an entry, or NONE; capacity a power of two */
    size_t slot_count;
} NameTable;

void name_table_init(NameTable *table);
void name_table_destroy(NameTable *table);

/* The value of `name`, or NONE. */
uint name_table_find(const NameTable *table, const char *name);

/* Adds `name`, which must not be in the table. False when out of memory. */
bool name_table_add(NameTable *table, const char *name, uint value, Error *error);

/* Writes "a, b, c ..." with as many of the first names as fit into out[size]; "none" for an empty table. */
void name_table_list(const NameTable *table, char *out, size_t size);

/* Edit distance of a and b (Levenshtein), at most `limit`. Only the first 63 characters of a name are compared. */
int name_distance(const char *a, const char *b, int limit);

/* The name among `names` that is nearest to `wanted`, or NULL if none is near enough to be a likely typo. */
const char *name_nearest(const char *wanted, const char *const *names, size_t count);

/* The same for the names of a table. */
const char *name_table_nearest(const NameTable *table, const char *wanted);

#endif
