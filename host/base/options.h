/* Options and operands of a command line, GNU style: long options (which may be shortened while they stay unique), a
 * few letters, operands anywhere, "--" ends the options. One table describes a command's options to the parser and to
 * --help, which every command has. */
#ifndef TWINLIGHT_BASE_OPTIONS_H
#define TWINLIGHT_BASE_OPTIONS_H

#include "base/error.h"

/* Of one command, --help among them. */
#define OPTION_SPECS_MAX 64

typedef struct OptionSpec {
    const char *name; /* without dashes */
    char letter; /* 0: none */
    const char *argument; /* what --help calls the value; NULL: takes none; "[FILE]": may be left out */
    const char *help;
} OptionSpec;

typedef struct OptionTable {
    const char *command; /* "render" */
    const char *usage; /* what follows "twinlight " */
    const char *summary;
    const OptionSpec *specs;
    int count; /* < OPTION_SPECS_MAX */
    const char *footer; /* NULL or text after the options */
} OptionTable;

/* Takes option `index` of the table. `value` is NULL when none was given. */
typedef bool (*OptionSetter)(void *context, int index, const char *value, Error *error);

typedef enum OptionsEnd {
    OPTIONS_WRONG, /* with an error */
    OPTIONS_READ,
    OPTIONS_HELPED /* --help was among them and the help has been printed on standard output */
} OptionsEnd;

/* Calls `set` for every option of argv[1 ...] in order and moves the operands to the end of argv, from
 * *first_operand on. Stops at the first failure. Not thread-safe (getopt_long). */
OptionsEnd options_parse(const OptionTable *table, int argc, char **argv, OptionSetter set, void *context,
                         int *first_operand, Error *error);

/* The scene of a command that takes one: the only operand. */
bool options_scene(const OptionTable *table, int argc, char **argv, int first_operand, const char **scene,
                   Error *error);

#endif
