/* The program's commands: what main passes to them and how they end. */
#ifndef TWINLIGHT_COMMAND_COMMAND_H
#define TWINLIGHT_COMMAND_COMMAND_H

#include "backend/table.h"
#include "base/exit_status.h"
#include "base/options.h"

/* The exit status of a command whose options ended in anything but OPTIONS_READ. */
static inline int options_status(OptionsEnd end)
{
    return end == OPTIONS_HELPED ? EXIT_OK : EXIT_USAGE;
}

/* A command gets its own name as argv[0] and returns an exit status. On EXIT_FAILED and EXIT_USAGE `error` says why,
 * unless the command's own output has already. */
int cmd_render(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_merge(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_bench(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_devices(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_pyramid(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_convert(const BackendTable *backends, int argc, char **argv, Error *error);
int cmd_info(const BackendTable *backends, int argc, char **argv, Error *error);

#endif
