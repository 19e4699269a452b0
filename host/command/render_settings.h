/* What a rendering is asked for: whether the options of the command line mean something together and to the integrator,
 * and what of the scene they replace. */
#ifndef TWINLIGHT_COMMAND_RENDER_SETTINGS_H
#define TWINLIGHT_COMMAND_RENDER_SETTINGS_H

#include "command/render_options.h"

/* --strategy, --heuristic, --unweighted and the options of chains. */
bool render_settings_check(const RenderCommand *command, const Integrator *integrator, Error *error);

/* Which layers the image will have (LAYER_BIT). */
bool render_settings_layers(const RenderCommand *command, const Integrator *integrator, unsigned *wanted, Error *error);

/* The command line's size, crop and depth where it has them, else the scene's, the depth within what the integrator
 * makes. */
bool render_settings_apply(const RenderCommand *command, const Integrator *integrator, Scene *scene, Error *error);

#endif
