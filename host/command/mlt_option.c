#include "command/mlt_option.h"

#include "base/log.h"
#include "base/name_table.h"
#include "base/option_values.h"

#include <string.h>

#define ITEM_MAX 64 /* size of KEY=VALUE; longer ones are refused */

typedef enum MltKey {
#define ENUMERATE(NAME, ...) MLT_##NAME,
    MLT_KEY_LIST(ENUMERATE)
#undef ENUMERATE
        MLT_KEY_COUNT
} MltKey;

#define NAME_OF(NAME, name, ...) name,
static const char *const NAMES[MLT_KEY_COUNT] = {MLT_KEY_LIST(NAME_OF)};
#undef NAME_OF

/* The option's name in messages. */
#define OPTION_OF(NAME, name, ...) "mlt=" name,
static const char *const OPTIONS[MLT_KEY_COUNT] = {MLT_KEY_LIST(OPTION_OF)};
#undef OPTION_OF

#define VALUES_OF(NAME, name, values, ...) values,
static const char *const VALUES[MLT_KEY_COUNT] = {MLT_KEY_LIST(VALUES_OF)};
#undef VALUES_OF

/* The deprecated options. */
static const struct {
    const char *name;
    MltKey key;
    const char *value; /* NULL: the option's own */
} OLD[] = {
    {"mlt-scheme", MLT_SCHEME, NULL}, {"chains", MLT_CHAINS, NULL},         {"steps", MLT_STEPS, NULL},
    {"pool", MLT_POOL, NULL},         {"large-step", MLT_LARGE_STEP, NULL}, {"mutations", MLT_MUTATIONS, NULL},
    {"sort", MLT_SORT, NULL},         {"no-sort", MLT_SORT, "none"},        {"no-group", MLT_GROUP, "off"},
    {"no-shift", MLT_SHIFT, "off"},   {"no-aim", MLT_GUIDE, "off"},         {"no-blend", MLT_COMBINE, "off"},
};

/* ---- values ----------------------------------------------------------------------------------------------------- */

/* The place of `value` among the key's values. */
static bool choice_read(MltKey key, const char *value, unsigned *choice, Error *error)
{
    const size_t length = strlen(value);
    *choice = 0;
    for (const char *known = VALUES[key];; ++*choice) {
        size_t known_length = strcspn(known, "|");
        if (known_length == length && strncmp(known, value, length) == 0)
            return true;
        if (known[known_length] == '\0')
            break;
        known += known_length + 1;
    }
    error_set(error, "--%s=%s: there is no such value", OPTIONS[key], value);
    return error_fix(error, "write --%s=%s", OPTIONS[key], VALUES[key]);
}

static bool flag_set(MltKey key, const char *value, bool *flag, Error *error)
{
    unsigned choice;
    if (!choice_read(key, value, &choice, error))
        return false;
    *flag = choice == 1;
    return true;
}

static bool order_set(const char *value, ChainOrder *order, Error *error)
{
    unsigned choice;
    if (!choice_read(MLT_SORT, value, &choice, error))
        return false;
    *order = (ChainOrder)choice;
    return true;
}

static bool number_set(MltKey key, const char *value, uint64_t high, unsigned *number, Error *error)
{
    uint64_t whole;
    if (!option_whole(OPTIONS[key], value, 1, high, &whole, error))
        return false;
    *number = (unsigned)whole;
    return true;
}

static bool mutations_set(const char *value, unsigned *mutations, Error *error)
{
    static const char *const KINDS[] = {"all", "light", "camera"}; /* MUTATION_* */
    const char *other;
    if (option_names(value, '+', KINDS, sizeof KINDS / sizeof KINDS[0], mutations, &other))
        return true;
    error_set(error, "--mlt=mutations=%s: there is no kind of mutation %.*s", value, (int)strcspn(other, "+"), other);
    return error_fix(error, "use all, light and camera, separated by +");
}

static bool value_set(ChainOptions *chains, MltKey key, const char *value, Error *error)
{
    switch (key) {
    case MLT_SCHEME:
        return flag_set(key, value, &chains->paper, error);
    case MLT_CHAINS:
        return number_set(key, value, 1u << 26, &chains->chains, error);
    case MLT_STEPS:
        return number_set(key, value, 1u << 14, &chains->steps, error);
    case MLT_POOL:
        return number_set(key, value, 1u << 30, &chains->pool, error);
    case MLT_LARGE_STEP:
        return option_number(OPTIONS[key], value, 1e-6, 1.0, &chains->large_step, error);
    case MLT_MUTATIONS:
        return mutations_set(value, &chains->mutations, error);
    case MLT_SORT:
        return order_set(value, &chains->order, error);
    case MLT_GROUP:
        return flag_set(key, value, &chains->ungrouped, error);
    case MLT_SHIFT:
        return flag_set(key, value, &chains->shiftless, error);
    case MLT_GUIDE:
        return flag_set(key, value, &chains->unguided, error);
    default:
        return flag_set(MLT_COMBINE, value, &chains->chains_only, error);
    }
}

/* ---- keys ------------------------------------------------------------------------------------------------------- */

static bool key_refuse(const char *key, Error *error)
{
#define LIST_OF(NAME, name, ...) name ", "
    const char *nearest = name_nearest(key, NAMES, MLT_KEY_COUNT);
    error_set(error, "--mlt=%s: there is no such switch", key);
    if (nearest)
        return error_fix(error, "did you mean %s? twinlight render --help lists all", nearest);
    return error_fix(error, "use " MLT_KEY_LIST(LIST_OF) "as in --mlt=shift=off,guide=off");
#undef LIST_OF
}

/* Sets KEY=VALUE, the first `length` characters of `text`. */
static bool item_set(ChainOptions *chains, const char *text, size_t length, Error *error)
{
    char item[ITEM_MAX];
    if (length >= sizeof item) {
        error_set(error, "--mlt=%.*s...: too long", ITEM_MAX / 2, text);
        return error_fix(error, "separate switches by commas, as in --mlt=shift=off,guide=off");
    }
    memcpy(item, text, length);
    item[length] = '\0';
    char *value = strchr(item, '=');
    if (value)
        *value++ = '\0';
    for (unsigned key = 0; key < MLT_KEY_COUNT; ++key) {
        if (strcmp(NAMES[key], item) != 0)
            continue;
        if (value && *value)
            return value_set(chains, (MltKey)key, value, error);
        error_set(error, "--%s needs a value", OPTIONS[key]);
        return error_fix(error, "write --%s=%s", OPTIONS[key], VALUES[key]);
    }
    return key_refuse(item, error);
}

bool mlt_option_set(ChainOptions *chains, const char *text, Error *error)
{
    for (const char *item = text;;) {
        size_t length = strcspn(item, ",");
        if (!item_set(chains, item, length, error))
            return false;
        if (item[length] == '\0')
            return true;
        item += length + 1;
    }
}

bool mlt_option_set_old(ChainOptions *chains, const char *name, const char *value, Error *error)
{
    char item[2 * ITEM_MAX]; /* a value that is cut here is still too long for item_set */
    size_t i = 0;
    while (strcmp(OLD[i].name, name) != 0)
        ++i;
    snprintf(item, sizeof item, "%s=%s", NAMES[OLD[i].key], OLD[i].value ? OLD[i].value : value);
    for (char *comma = item; (comma = strchr(comma, ',')) != NULL;)
        *comma = '+'; /* between kinds of mutation; no other value has one */
    log_message(LOG_WARNING, "--%s is deprecated; write --mlt=%s", name, item);
    return item_set(chains, item, strlen(item), error);
}
