/* The grid of photons, and how widely each spreads the directions that it predicts. */
#ifndef TWINLIGHT_RENDER_PHOTON_GRID_H
#define TWINLIGHT_RENDER_PHOTON_GRID_H

#include "render/photon_lobe.h"

/* Sets the grid's place around `count` points, at least one, `stride` bytes apart. */
void photon_grid_bounds(const Vec3 *first, size_t stride, uint count, PhotonParams *params);

/* Sorts the records, at least one, and fills *map with them; free its words with photon_map_destroy. */
bool photon_grid_make(PhotonRecords *records, const PhotonLights *lights, PhotonMap *map, Error *error);

#endif
