/* Whether the photons of a map are worth their time. */
#ifndef TWINLIGHT_RENDER_PHOTON_WORTH_H
#define TWINLIGHT_RENDER_PHOTON_WORTH_H

#include "render/run.h"

/* Sets *part: the part of a path's light that directions drawn by run->photons bring, on average (docs/CAUSTICS.md,
 * "What it is worth"), by 32768 paths, or one for each pixel, with and without them; 0 if there are none. everywhere:
 * drawn at all receivers, and not only where no light subpath can make the path (PhotonParams). The same on all
 * backends, and for a crop as for the whole picture. Fails if the backend does or out of memory. */
bool photon_map_part(const RenderRun *run, bool everywhere, double *part, Error *error);

/* How many photons may be made of `most`, if the first few bring this part: fewer if that is little. */
uint photon_map_most(uint most, double part);

/* Whether that is enough. True if there are no photons, or some are of lights without extent, which nothing else
 * finds. */
bool photon_map_worth(const PhotonMap *photons, double part);

#endif
