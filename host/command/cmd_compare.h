/* `twinlight compare`: figures of error between two pictures. */
#ifndef TWINLIGHT_COMMAND_CMD_COMPARE_H
#define TWINLIGHT_COMMAND_CMD_COMPARE_H

#include "base/error.h"

/* argv[0] is the subcommand's name. Returns the exit status: 0; 1 when an image cannot be read or written or the sizes
 * differ; 2 for wrong usage. For 1 and 2 `error` says why. */
int cmd_compare(int argc, char **argv, Error *error);

#endif
