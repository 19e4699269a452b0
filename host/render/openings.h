/* Finds the openings of a rendering (layout/openings.h): traces camera subpaths, connects them to the lights at
 * infinity, and fits rectangles to the connections that nothing blocks. */
#ifndef TWINLIGHT_RENDER_OPENINGS_H
#define TWINLIGHT_RENDER_OPENINGS_H

#include "render/run.h"
#include "scene/scene.h"

/* Sets run->frame.openings; none without lights at infinity, or on a stop. run->frame must be complete but for them and
 * `photons`. */
bool openings_find(RenderRun *run, const Scene *scene, Error *error);

#endif
