/* `twinlight compare`: error metrics between two images. */
#ifndef TWINLIGHT_COMMAND_CMD_COMPARE_H
#define TWINLIGHT_COMMAND_CMD_COMPARE_H

#include "base/error.h"

/* argv[0]: the command's name. Returns the exit status: EXIT_OK; EXIT_FAILED if an image cannot be read or written or
 * the sizes differ; EXIT_USAGE. For the last two `error` says why. */
int cmd_compare(int argc, char **argv, Error *error);

#endif
