#include "options.h"

#include <assert.h>
#include <getopt.h>
#include <string.h>

/* getopt_long's return value for option i without a letter of its own. */
#define OPTION_CODE 256

/* getopt's two tables. */
typedef struct GetoptTables {
    struct option longs[OPTION_SPECS_MAX + 1];
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
    assert(table->count <= OPTION_SPECS_MAX);
    memset(tables, 0, sizeof *tables);
    char *letter = tables->letters;
    *letter++ = ':'; /* tells a missing value from an unknown option */
    for (int i = 0; i < table->count; ++i) {
        const OptionSpec *spec = &table->specs[i];
        int argument = spec_argument(spec);
        tables->longs[i] = (struct option){spec->name, argument, NULL, OPTION_CODE + i};
        if (!spec->letter)
            continue;
        *letter++ = spec->letter;
        for (int colons = 0; colons < argument; ++colons)
            *letter++ = ':';
    }
}

static int spec_index(const OptionTable *table, int code)
{
    if (code >= OPTION_CODE)
        return code - OPTION_CODE;
    for (int i = 0; i < table->count; ++i)
        if (table->specs[i].letter == code)
            return i;
    return -1;
}

/* What getopt_long refused: `code` is its return value, `word` the argument it was reading. */
static bool options_refuse(const OptionTable *table, int code, const char *word, Error *error)
{
    int index = optopt ? spec_index(table, optopt) : -1;
    if (code == ':') {
        error_set(error, "option --%s needs a value", table->specs[index].name);
        return error_fix(error, "write --%s=%s", table->specs[index].name, table->specs[index].argument);
    }
    if (index >= 0)
        error_set(error, "option --%s takes no value: %s", table->specs[index].name, word);
    else if (optopt)
        error_set(error, "unknown option -%c", optopt);
    else
        error_set(error, "unknown or ambiguous option %s", word);
    return error_fix(error, "see twinlight %s --help", table->command);
}

bool options_parse(const OptionTable *table, int argc, char **argv, OptionSetter set, void *context, int *first_operand,
                   Error *error)
{
    GetoptTables tables;
    getopt_tables_fill(&tables, table);
    opterr = 0;
    optind = 0; /* glibc: start afresh */
    for (;;) {
        int code = getopt_long(argc, argv, tables.letters, tables.longs, NULL);
        if (code == -1)
            break;
        if (code == '?' || code == ':')
            return options_refuse(table, code, argv[optind - 1], error);
        int index = spec_index(table, code);
        if (optarg && !optarg[0]) {
            error_set(error, "option --%s has an empty value", table->specs[index].name);
            return error_fix(error, "write --%s=%s", table->specs[index].name, table->specs[index].argument);
        }
        if (!set(context, index, optarg, error))
            return false;
    }
    *first_operand = optind;
    return true;
}

void options_help(const OptionTable *table, FILE *stream)
{
    fprintf(stream, "Usage: twinlight %s\n%s\n\n", table->usage, table->summary);
    for (int i = 0; i < table->count; ++i) {
        const OptionSpec *spec = &table->specs[i];
        const char *argument = spec->argument ? spec->argument : "";
        bool optional = argument[0] == '[';
        char left[64];
        char letter[8] = "    ";
        if (spec->letter)
            snprintf(letter, sizeof letter, "-%c, ", spec->letter);
        snprintf(left, sizeof left, "%s--%s%s%s%s", letter, spec->name, optional ? "[" : "", argument[0] ? "=" : "",
                 optional ? argument + 1 : argument);
        fprintf(stream, "  %-28s  %s\n", left, spec->help);
    }
    if (table->footer)
        fprintf(stream, "\n%s\n", table->footer);
}
