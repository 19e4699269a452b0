/* The commands of the program: what main hands them and how they end. */
#ifndef TWINLIGHT_COMMAND_COMMAND_H
#define TWINLIGHT_COMMAND_COMMAND_H

#include "backend/table.h"
#include "base/exit_status.h"
#include "base/options.h"

/* The status of a command whose options did not come to OPTIONS_READ. */
static inline int options_status(OptionsEnd end)
{
    return end == OPTIONS_HELPED ? EXIT_OK : EXIT_USAGE;
}

/* A command gets argv[0] = its own name. It returns an exit status; when that is EXIT_FAILED or EXIT_USAGE, `error`
 * says why, or is empty when the command's own output has. */
int cmd_render(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_bench(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_devices(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_pyramid(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_info(const BackendTable *backends, int argc, char **argv, Error *error);

#endif
