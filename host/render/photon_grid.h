/* The grid of photons, and how widely each spreads the directions that it predicts. */
#ifndef TWINLIGHT_RENDER_PHOTON_GRID_H
#define TWINLIGHT_RENDER_PHOTON_GRID_H

#include "render/photon_lobe.h"

/* Sets the grid's place around `count` points, at least one, `stride` bytes apart. */
void photon_grid_bounds(const Vec3 *first, size_t stride, uint count, PhotonParams *params);

/* *missed: the part of the directions predicted by every `every`-th record, on average, that does not lead to the
 * light. There must be records. */
bool photon_grid_missed(PhotonRecords *records, const PhotonLights *lights, uint every, double *missed, Error *error);

/* Sorts the records, at least one, and fills *map with them; free its words with photon_map_destroy. *missed: as above,
 * of all. */
bool photon_grid_make(PhotonRecords *records, const PhotonLights *lights, PhotonMap *map, double *missed, Error *error);

#endif
