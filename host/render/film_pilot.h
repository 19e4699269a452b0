/* The pilot: a few paths that say how bright the picture is, before the film has its quantum. */
#ifndef TWINLIGHT_RENDER_FILM_PILOT_H
#define TWINLIGHT_RENDER_FILM_PILOT_H

#include "render/integrator.h"
#include "render/run.h"
#include "scene/scene.h"

/* The number of the pilot's samples, which no image reaches. */
#define PILOT_SAMPLE 0xffff0000u

/* Sets the quantum of run->film from the mean radiance of 4096 paths of the integrator's strategies, with those that
 * `strategy` and `unweighted` leave out; where they see nothing, from the power of the lights. It is that of the whole
 * film, so that a crop has the quantum and with it the bits of the whole picture, and depends on scene, integrator,
 * depth and seed alone. */
bool film_pilot_run(const RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error);

#endif
