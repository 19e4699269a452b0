/* Command-line parsing, GNU style: long options (abbreviations allowed while unambiguous), a few letters, operands
 * anywhere, "--" ends the options. One table per command drives both the parser and --help, which every command has. */
#ifndef TWINLIGHT_BASE_OPTIONS_H
#define TWINLIGHT_BASE_OPTIONS_H

#include "base/error.h"

/* Maximum number of options of a command, --help included. */
#define OPTION_SPECS_MAX 64

typedef struct OptionSpec {
    const char *name; /* without dashes */
    char letter; /* 0: none */
    const char *argument; /* name of the value in --help; NULL: takes none; "[FILE]": optional */
    const char *help; /* NULL: accepted, but neither listed nor suggested (deprecated) */
} OptionSpec;

typedef struct OptionTable {
    const char *command; /* "render" */
    const char *usage; /* what follows "twinlight " */
    const char *summary;
    const OptionSpec *specs;
    int count; /* < OPTION_SPECS_MAX */
    const char *footer; /* text after the options, or NULL */
} OptionTable;

/* Sets option `index` of the table. `value` is NULL if none was given. */
typedef bool (*OptionSetter)(void *context, int index, const char *value, Error *error);

typedef enum OptionsEnd {
    OPTIONS_WRONG, /* failed, `error` filled */
    OPTIONS_READ,
    OPTIONS_HELPED /* --help was given and has been printed on standard output */
} OptionsEnd;

/* Calls `set` for every option of argv[1 ...] in order and moves the operands to the end of argv, where they begin at
 * *first_operand. Stops at the first failure. Not thread-safe (getopt_long). */
OptionsEnd options_parse(const OptionTable *table, int argc, char **argv, OptionSetter set, void *context,
                         int *first_operand, Error *error);

/* Gets the only operand of a command that takes one scene; fails if there are none or several. */
bool options_scene(const OptionTable *table, int argc, char **argv, int first_operand, const char **scene,
                   Error *error);

#endif
