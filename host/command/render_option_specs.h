/* Names and help of the options of `twinlight render`. */
#ifndef TWINLIGHT_COMMAND_RENDER_OPTION_SPECS_H
#define TWINLIGHT_COMMAND_RENDER_OPTION_SPECS_H

#include "command/render_options.h"

extern const OptionSpec RENDER_OPTION_SPECS[RENDER_OPTION_COUNT];

#endif
