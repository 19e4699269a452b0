/* Checks whether the options of the command line are compatible with each other and with the integrator, and applies
 * those that replace settings of the scene. */
#ifndef TWINLIGHT_COMMAND_RENDER_SETTINGS_H
#define TWINLIGHT_COMMAND_RENDER_SETTINGS_H

#include "command/render_options.h"

/* Checks --strategy, --heuristic, --unweighted, the options of chains and those of checkpoints. */
bool render_settings_check(const RenderCommand *command, const Integrator *integrator, Error *error);

/* Sets *wanted to the image's layers (LAYER_BIT). Fails if the integrator does not have one that was asked for. */
bool render_settings_layers(const RenderCommand *command, const Integrator *integrator, unsigned *wanted, Error *error);

/* Applies size, crop and depth from the command line, where given, and limits the depth to the integrator's. */
bool render_settings_apply(const RenderCommand *command, const Integrator *integrator, Scene *scene, Error *error);

#endif
