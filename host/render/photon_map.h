/* Makes the map of caustic photons (path/photon.h) before a rendering: traces light subpaths through smooth specular
 * surfaces, finds by finite differences how the direction of each changes with the place and with the light's point,
 * and sorts them into a grid. */
#ifndef TWINLIGHT_RENDER_PHOTON_MAP_H
#define TWINLIGHT_RENDER_PHOTON_MAP_H

#include "render/run.h"
#include "scene/scene.h"

/* May lower *most, the number of photons that a map may have, according to what its first few photons bring. */
typedef bool (*PhotonLimit)(void *context, uint *most, Error *error);

/* Fills *map with up to `count` photons; none if the scene has no smooth specular surface, if none arrive, or on a
 * stop. limit: called before there are more than the first few; NULL: none. Warns if as many as that predict their
 * lights badly. run->frame must be complete but for `photons`. Call photon_map_destroy even on failure. */
bool photon_map_make(const RenderRun *run, const Scene *scene, uint count, PhotonLimit limit, void *context,
                     PhotonMap *map, Error *error);
void photon_map_destroy(PhotonMap *map);

/* How many photons are to be made, at most `most`, when there are `found`, of whose predicted directions the part
 * `missed` misses the light, and `by_fewer` with about a quarter of them; 0: these are enough. */
uint photon_count_next(uint found, uint most, double missed, double by_fewer);

#endif
