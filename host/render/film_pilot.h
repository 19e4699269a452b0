/* The pilot: a few paths that estimate the picture's brightness before the film has its quantum. */
#ifndef TWINLIGHT_RENDER_FILM_PILOT_H
#define TWINLIGHT_RENDER_FILM_PILOT_H

#include "render/integrator.h"
#include "render/run.h"
#include "scene/scene.h"

/* Sample number of the pilot's paths; above those of any image. */
#define PILOT_SAMPLE 0xffff0000u

/* The parameters of `items` paths over the whole film, with all strategies of the integrator. */
FrameParams pilot_frame(const RenderRun *run, const Integrator *integrator, uint items);

/* Renders the paths of a pilot_frame, by run->photons if the frame has any. Fails if the backend does or out of
 * memory. */
bool pilot_run(const RenderRun *run, const Integrator *integrator, FrameParams *frame, const SplatSink *sink,
               Error *error);

/* Sets the quantum of run->film from the mean radiance of 4096 paths over the whole film. They use all of the
 * integrator's strategies, even those excluded by `only_strategy`, and ignore `unweighted`. If all are black, the
 * lights' power is used instead. The quantum depends on scene, integrator, depth and seed only, so a crop has the same
 * bits as the whole picture. Fails if the backend does or out of memory. */
bool film_pilot_run(const RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error);

#endif
