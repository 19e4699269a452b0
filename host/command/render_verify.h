/* `twinlight render --verify`: renders no picture, but checks that two backends compute the same bits. */
#ifndef TWINLIGHT_COMMAND_RENDER_VERIFY_H
#define TWINLIGHT_COMMAND_RENDER_VERIFY_H

#include "command/render_options.h"
#include "render/render.h"

/* Compares every device of the command with the CPU backend on the scene's samples, and logs what agreed. Fails at the
 * first difference, which `error` names. */
bool render_verify(const RenderCommand *command, const Integrator *integrator, const Scene *scene,
                   const RenderOptions *options, Error *error);

#endif
