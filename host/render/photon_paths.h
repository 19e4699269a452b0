/* Finds light subpaths that arrive at a receiver through smooth specular surfaces. They are drawn from the lights, half
 * of them aimed at such surfaces; where too few of these arrive, more are drawn between those that have: they need no
 * known density (path/caustic_rest.h), and most of them arrive, but they make clusters of photons, and gaps. */
#ifndef TWINLIGHT_RENDER_PHOTON_PATHS_H
#define TWINLIGHT_RENDER_PHOTON_PATHS_H

#include "base/key_sort.h"
#include "render/photon_lobe.h"
#include "render/photon_pass.h"

typedef struct PhotonSearch {
    PhotonPass *pass;
    const PhotonLights *lights;
    PhotonPath *paths; /* that have been found */
    uint found, most;
    uint drawn; /* from the lights */
    uint number; /* of the next subpath */
    KeyedItem *order; /* PhotonPaths, by their light and then by their place */
    uint ordered; /* paths that are in it */
    bool whole; /* false: stopped */
} PhotonSearch;

/* For at most `most` subpaths. Call photon_search_destroy even on failure. */
bool photon_search_init(PhotonSearch *search, PhotonPass *pass, const PhotonLights *lights, uint most, Error *error);
void photon_search_destroy(PhotonSearch *search);

/* Finds more, until there are `wanted` <= most or too few arrive. */
bool photon_search_run(PhotonSearch *search, uint wanted, Error *error);

#endif
