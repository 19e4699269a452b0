/* Finds light subpaths that arrive at a receiver through smooth specular surfaces. The first are drawn from the lights,
 * half of them aimed at such surfaces. More are drawn between those that have arrived: they need no known density (path/caustic_rest.h), and most of them
 * arrive, where few of the first do. */
#ifndef TWINLIGHT_RENDER_PHOTON_PATHS_H
#define TWINLIGHT_RENDER_PHOTON_PATHS_H

#include "render/photon_lobe.h"
#include "render/photon_pass.h"

/* Fills paths with up to `count` of them; *found: how many, 0 on a stop. */
bool photon_paths_find(PhotonPass *pass, const PhotonLights *lights, uint count, PhotonPath *paths, uint *found,
                       Error *error);

#endif
