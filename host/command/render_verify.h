/* `twinlight render --verify`: no picture, but a proof that two backends compute the same. */
#ifndef TWINLIGHT_COMMAND_RENDER_VERIFY_H
#define TWINLIGHT_COMMAND_RENDER_VERIFY_H

#include "command/render_options.h"
#include "render/render.h"

/* Compares every device of the command with the CPU backend on the scene's samples. Says what agreed. */
bool render_verify(const RenderCommand *command, const Integrator *integrator, const Scene *scene,
                   const RenderOptions *options, Error *error);

#endif
