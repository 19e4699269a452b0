#include "render/photon_map.h"

#include "render/photon_grid.h"
#include "render/photon_lobe.h"
#include "render/photon_pass.h"
#include "render/photon_paths.h"

#include <stdatomic.h>
#include <stdlib.h>

/* Traces the neighbours of paths[first ... last - 1], and makes photons of those whose neighbours all arrive the same
 * way. */
static bool neighbours_trace(PhotonPass *pass, const PhotonLights *lights, const PhotonPath *paths, uint count,
                             PhotonRecords *records, Error *error)
{
    bool whole = true;
    for (uint i = 0; i < count; ++i)
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k) {
            PhotonPath neighbour = photon_neighbour(lights, &paths[i], k);
            photon_pass_follow(pass, i * PHOTON_NEIGHBOURS + k, &neighbour);
        }
    if (!photon_pass_run(pass, count * PHOTON_NEIGHBOURS, &whole, error))
        return false;
    for (uint i = 0; i < count && whole; ++i) {
        PhotonPath neighbours[PHOTON_NEIGHBOURS];
        bool same = true;
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k)
            same = photon_pass_get(pass, i * PHOTON_NEIGHBOURS + k, &neighbours[k]) &&
                   neighbours[k].vertices == paths[i].vertices && neighbours[k].lobes == paths[i].lobes && same;
        if (same && photon_differences(lights, &paths[i], neighbours, &records->records[records->count]))
            ++records->count;
    }
    return true;
}

static bool records_make(PhotonPass *pass, const PhotonLights *lights, uint count, PhotonRecords *records, Error *error)
{
    PhotonPath *paths = malloc(count * sizeof *paths);
    uint found = 0, each = PASS_PATHS / PHOTON_NEIGHBOURS;
    bool done = paths ? photon_paths_find(pass, lights, count, paths, &found, error)
                      : error_memory(error, count * sizeof *paths, "photons");
    for (uint i = 0; i < found && done; i += each)
        done = neighbours_trace(pass, lights, paths + i, found - i < each ? found - i : each, records, error);
    free(paths);
    return done;
}

/* PhotonMap.number of the next map; 0 is none's. */
static atomic_uint next_number = 1;

bool photon_map_make(const RenderRun *run, const Scene *scene, uint count, PhotonMap *map, Error *error)
{
    PhotonPass pass = {0};
    PhotonLights lights = {0};
    PhotonRecords records = {0};
    *map = (PhotonMap){0};
    if (count == 0 || !scene_has_delta(scene))
        return true;
    records.records = malloc(count * sizeof *records.records);
    bool done = records.records || error_memory(error, count * sizeof *records.records, "photons");
    done = done && photon_lights_init(&lights, scene, error) && photon_pass_init(&pass, run, error) &&
           (lights.aims.count == 0 || records_make(&pass, &lights, count, &records, error)) &&
           (records.count == 0 || photon_grid_make(&records, &lights, map, error));
    map->number = atomic_fetch_add(&next_number, 1);
    photon_pass_destroy(&pass);
    photon_lights_destroy(&lights);
    free(records.records);
    return done;
}

void photon_map_destroy(PhotonMap *map)
{
    free(map->words);
    *map = (PhotonMap){0};
}
