/* Whether the photons of a map are worth their time. */
#ifndef TWINLIGHT_RENDER_PHOTON_WORTH_H
#define TWINLIGHT_RENDER_PHOTON_WORTH_H

#include "render/run.h"

/* Sets *worth: whether directions drawn by run->photons bring enough of the picture's light (docs/CAUSTICS.md, "What it
 * is worth"), by 32768 paths, or one for each pixel, with and without them. True if there are none, or some are of
 * lights without extent, which nothing else finds. The same on all backends, and for a crop as for the whole picture.
 * Fails if the backend does or out of memory. */
bool photon_map_worth(const RenderRun *run, bool *worth, Error *error);

#endif
