/* The commands of the program: what main hands them and how they end. */
#ifndef TWINLIGHT_COMMAND_H
#define TWINLIGHT_COMMAND_H

#include "backend.h"
#include "options.h"

/* Exit statuses. */
#define EXIT_OK 0
#define EXIT_FAILED 1 /* something outside the program was not as it should be */
#define EXIT_USAGE 2 /* the command line was not understood */
#define EXIT_STOPPED 130 /* ended early by a signal (interrupt.h), output written */

/* The status of a command whose options did not come to OPTIONS_READ. */
static inline int options_status(OptionsEnd end)
{
    return end == OPTIONS_HELPED ? EXIT_OK : EXIT_USAGE;
}

/* A backend that this build lacks; an array of them ends with name NULL. */
typedef struct BackendLeftOut {
    const char *name;
    const char *why;
    const char *fix;
} BackendLeftOut;

/* The backends of this build, the default one first. Only main.c fills it. */
typedef struct BackendTable {
    const BackendInterface *const *backends;
    int count;
    const BackendLeftOut *left_out; /* NULL: none */
} BackendTable;

/* A command gets argv[0] = its own name. It returns an exit status; when that is EXIT_FAILED or EXIT_USAGE, `error`
 * says why, or is empty when the command's own output has. */
int cmd_render(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_bench(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_devices(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_pyramid(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_info(const BackendTable *backends, int argc, char **argv, Error *error);

#endif
