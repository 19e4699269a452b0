#include "base/options.h"

#include "base/name_table.h"

#include <assert.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

/* getopt_long returns OPTION_CODE + i for option i if it has no letter. */
#define OPTION_CODE 256

static const OptionSpec HELP = {"help", 'h', NULL, "print this and exit"};

/* pbrt's names of options, accepted where a command has the option. --help does not list them. */
static const struct {
    const char *alias, *name;
} ALIASES[] = {{"nthreads", "threads"}, {"outfile", "output"}, {"spp", "samples"}};

#define ALIAS_COUNT (sizeof ALIASES / sizeof ALIASES[0])

/* Option i; --help comes last. */
static const OptionSpec *spec_at(const OptionTable *table, int i)
{
    return i < table->count ? &table->specs[i] : &HELP;
}

/* getopt_long's long and short options. */
typedef struct GetoptTables {
    struct option longs[OPTION_SPECS_MAX + ALIAS_COUNT + 1];
    char letters[2 + 3 * OPTION_SPECS_MAX];
} GetoptTables;

static int spec_argument(const OptionSpec *spec)
{
    if (!spec->argument)
        return no_argument;
    return spec->argument[0] == '[' ? optional_argument : required_argument;
}

static void getopt_tables_fill(GetoptTables *tables, const OptionTable *table)
{
    assert(table->count < OPTION_SPECS_MAX);
    memset(tables, 0, sizeof *tables);
    char *letter = tables->letters;
    *letter++ = ':'; /* tells a missing value from an unknown option */
    for (int i = 0; i <= table->count; ++i) {
        const OptionSpec *spec = spec_at(table, i);
        int argument = spec_argument(spec);
        tables->longs[i] = (struct option){spec->name, argument, NULL, OPTION_CODE + i};
        if (!spec->letter)
            continue;
        *letter++ = spec->letter;
        for (int colons = 0; colons < argument; ++colons)
            *letter++ = ':';
    }
    struct option *next = &tables->longs[table->count + 1];
    for (size_t a = 0; a < ALIAS_COUNT; ++a)
        for (int i = 0; i < table->count; ++i)
            if (strcmp(table->specs[i].name, ALIASES[a].name) == 0) {
                *next = tables->longs[i];
                next++->name = ALIASES[a].alias;
            }
}

static int spec_index(const OptionTable *table, int code)
{
    if (code >= OPTION_CODE)
        return code - OPTION_CODE;
    for (int i = 0; i <= table->count; ++i)
        if (spec_at(table, i)->letter == code)
            return i;
    return -1;
}

/* Reports a long option that is unknown or an ambiguous abbreviation. */
static void name_refuse(const OptionTable *table, const char *word, Error *error)
{
    const char *names[OPTION_SPECS_MAX];
    char given[64], list[256] = "";
    size_t count = 0;
    int used = 0, matches = 0;
    word += strspn(word, "-");
    int length = (int)strcspn(word, "=");
    for (int i = 0; i <= table->count; ++i) {
        const char *name = spec_at(table, i)->name;
        if (!spec_at(table, i)->help)
            continue;
        names[count++] = name;
        if (strncmp(name, word, (size_t)length) != 0)
            continue;
        ++matches;
        if (used < (int)sizeof list - 32)
            used += snprintf(list + used, sizeof list - (size_t)used, "%s--%.20s", used > 0 ? ", " : "", name);
    }
    snprintf(given, sizeof given, "%.*s", length, word);
    if (matches > 1) {
        error_set(error, "option --%s is ambiguous: it may stand for %s", given, list);
        error_fix(error, "write more letters of the name");
        return;
    }
    const char *nearest = name_nearest(given, names, count);
    error_set(error, "unknown option --%s", given);
    if (nearest)
        error_fix(error, "did you mean --%s? twinlight %s --help lists all", nearest, table->command);
    else
        error_fix(error, "see twinlight %s --help", table->command);
}

/* Reports what getopt_long rejected: `code` is its return value, `word` the argument it was reading. */
static void options_refuse(const OptionTable *table, int code, const char *word, Error *error)
{
    int index = optopt ? spec_index(table, optopt) : -1;
    const OptionSpec *spec = index < 0 ? NULL : spec_at(table, index);
    if (code == ':' && spec) {
        error_set(error, "option --%s needs a value", spec->name);
        error_fix(error, "write --%s=%s", spec->name, spec->argument);
        return;
    }
    if (!spec && !optopt) {
        name_refuse(table, word, error);
        return;
    }
    if (spec)
        error_set(error, "option --%s takes no value: %s", spec->name, word);
    else
        error_set(error, "unknown option -%c", optopt);
    error_fix(error, "see twinlight %s --help", table->command);
}

static void help_print(const OptionTable *table)
{
    printf("Usage: twinlight %s\n%s\n\n", table->usage, table->summary);
    for (int i = 0; i <= table->count; ++i) {
        const OptionSpec *spec = spec_at(table, i);
        const char *argument = spec->argument ? spec->argument : "";
        bool optional = argument[0] == '[';
        char left[64];
        char letter[8] = "    ";
        if (!spec->help)
            continue;
        if (spec->letter)
            snprintf(letter, sizeof letter, "-%c, ", spec->letter);
        snprintf(left, sizeof left, "%s--%s%s%s%s", letter, spec->name, optional ? "[" : "", argument[0] ? "=" : "",
                 optional ? argument + 1 : argument);
        printf("  %-28s  %s\n", left, spec->help);
    }
    if (table->footer)
        printf("\n%s\n", table->footer);
}

OptionsEnd options_parse(const OptionTable *table, int argc, char **argv, OptionSetter set, void *context,
                         int *first_operand, Error *error)
{
    GetoptTables tables;
    bool help = false;
    getopt_tables_fill(&tables, table);
    opterr = 0;
    optind = 0; /* glibc: restart the scan */
    for (;;) {
        int code = getopt_long(argc, argv, tables.letters, tables.longs, NULL);
        if (code == -1)
            break;
        if (code == '?' || code == ':') {
            options_refuse(table, code, argv[optind - 1], error);
            return OPTIONS_WRONG;
        }
        int index = spec_index(table, code);
        if (optarg && !optarg[0]) {
            error_set(error, "option --%s has an empty value", table->specs[index].name);
            error_fix(error, "write --%s=%s", table->specs[index].name, table->specs[index].argument);
            return OPTIONS_WRONG;
        }
        if (index == table->count)
            help = true;
        else if (!set(context, index, optarg, error))
            return OPTIONS_WRONG;
    }
    *first_operand = optind;
    if (help)
        help_print(table);
    return help ? OPTIONS_HELPED : OPTIONS_READ;
}

bool options_scene(const OptionTable *table, int argc, char **argv, int first_operand, const char **scene, Error *error)
{
    if (first_operand >= argc) {
        error_set(error, "no scene is given");
        return error_fix(error, "write twinlight %s SCENE, e.g. twinlight %s scenes/cornell.pbrt", table->command,
                         table->command);
    }
    if (first_operand + 1 < argc) {
        error_set(error, "more than one scene: %s and %s", argv[first_operand], argv[first_operand + 1]);
        return error_fix(error, "give one scene at a time; options come as --name=value");
    }
    *scene = argv[first_operand];
    return true;
}
