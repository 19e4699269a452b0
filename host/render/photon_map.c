#include "render/photon_map.h"

#include "base/log.h"
#include "render/photon_grid.h"
#include "render/photon_lobe.h"
#include "render/photon_pass.h"
#include "render/photon_paths.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

/* Photons at first, and how many times as many follow ... */
#define PHOTONS_FIRST 32768u
#define PHOTONS_GROWTH 4u

/* ... while more than this part of the directions that they predict misses the light, and it is so much smaller than
 * with every PHOTONS_GROWTH-th of them: where surfaces are not smooth between photons, more predict hardly better. */
#define MISSED_ENOUGH 0.01
#define MISSED_SHRINKS 0.6

/* A map as large as is allowed of which more than this part misses gets a warning. */
#define MISSED_TOO_OFTEN 0.5

typedef struct PhotonMaker {
    PhotonPass pass;
    PhotonLights lights;
    PhotonSearch search;
    PhotonRecords records;
    uint traced; /* subpaths whose neighbours have been traced */
} PhotonMaker;

/* Traces the neighbours of the next `count` subpaths, and makes photons of those whose neighbours all arrive the same
 * way. */
static bool neighbours_trace(PhotonMaker *maker, uint count, Error *error)
{
    PhotonPass *pass = &maker->pass;
    const PhotonPath *paths = maker->search.paths + maker->traced;
    for (uint i = 0; i < count; ++i)
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k) {
            PhotonPath neighbour = photon_neighbour(&maker->lights, &paths[i], k);
            photon_pass_follow(pass, i * PHOTON_NEIGHBOURS + k, &neighbour);
        }
    if (!photon_pass_run(pass, count * PHOTON_NEIGHBOURS, &maker->search.whole, error))
        return false;
    maker->traced += count;
    for (uint i = 0; i < count && maker->search.whole; ++i) {
        PhotonPath neighbours[PHOTON_NEIGHBOURS];
        bool same = true;
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k)
            same = photon_pass_get(pass, i * PHOTON_NEIGHBOURS + k, &neighbours[k]) &&
                   neighbours[k].vertices == paths[i].vertices && neighbours[k].lobes == paths[i].lobes && same;
        PhotonRecord *record = &maker->records.records[maker->records.count];
        maker->records.count += same && photon_differences(&maker->lights, &paths[i], neighbours, record);
    }
    return true;
}

/* Finds subpaths until there are `wanted`, and makes photons of those that are new. */
static bool records_make(PhotonMaker *maker, uint wanted, Error *error)
{
    const uint each = PASS_PATHS / PHOTON_NEIGHBOURS;
    bool done = photon_search_run(&maker->search, wanted, error);
    while (done && maker->search.whole && maker->traced < maker->search.found) {
        uint left = maker->search.found - maker->traced;
        done = neighbours_trace(maker, left < each ? left : each, error);
    }
    return done;
}

static bool maker_init(PhotonMaker *maker, const RenderRun *run, const Scene *scene, uint count, Error *error)
{
    maker->records.records = malloc(count * sizeof *maker->records.records);
    if (!maker->records.records)
        return error_memory(error, count * sizeof *maker->records.records, "photons");
    return photon_lights_init(&maker->lights, scene, error) && photon_pass_init(&maker->pass, run, error) &&
           photon_search_init(&maker->search, &maker->pass, &maker->lights, count, error);
}

static void maker_destroy(PhotonMaker *maker)
{
    photon_search_destroy(&maker->search);
    photon_pass_destroy(&maker->pass);
    photon_lights_destroy(&maker->lights);
    free(maker->records.records);
}

/* Makes a map of all records. *missed: photon_grid_make; *by_fewer: the same by every PHOTONS_GROWTH-th. Both are 0 if
 * there are no records, or on a stop. */
static bool map_fill(PhotonMaker *maker, PhotonMap *map, double *missed, double *by_fewer, Error *error)
{
    *missed = *by_fewer = 0.0;
    photon_map_destroy(map);
    if (maker->records.count == 0 || !maker->search.whole)
        return true;
    return photon_grid_missed(&maker->records, &maker->lights, PHOTONS_GROWTH, by_fewer, error) &&
           photon_grid_make(&maker->records, &maker->lights, map, missed, error);
}

uint photon_count_next(uint found, uint most, double missed, double by_fewer)
{
    bool better = missed > MISSED_ENOUGH && missed < MISSED_SHRINKS * by_fewer;
    if (!better || found >= most)
        return 0;
    return found < most / PHOTONS_GROWTH ? PHOTONS_GROWTH * found : most;
}

/* Says that there are too few photons for the light that they know of. */
static void missed_warn(const PhotonMap *map, uint count, double missed)
{
    char fix[64] = "render for longer";
    if (map->params.count == 0 || !(missed > MISSED_TOO_OFTEN))
        return;
    if (count < PHOTONS_MOST_ALLOWED)
        snprintf(fix, sizeof fix, "render for longer, or with --photons=%u", PHOTONS_MOST_ALLOWED);
    log_message(LOG_WARNING,
                "%.0f %% of the directions that %u caustic photons predict miss the light: caustics will be noisy, and "
                "those of lights without extent incomplete: %s",
                100.0 * missed, map->params.count, fix);
}

/* Makes a map of few photons, then of more until they are enough, `count` at most, or no more are found. */
static bool maker_run(PhotonMaker *maker, uint count, PhotonMap *map, Error *error)
{
    uint wanted = PHOTONS_FIRST < count ? PHOTONS_FIRST : count;
    while (wanted > 0) {
        double missed, by_fewer;
        if (!records_make(maker, wanted, error) || !map_fill(maker, map, &missed, &by_fewer, error))
            return false;
        if (wanted == count)
            missed_warn(map, count, missed);
        uint found = maker->search.found;
        wanted = found < wanted ? 0 : photon_count_next(found, count, missed, by_fewer);
    }
    return true;
}

/* PhotonMap.number of the next map; 0 is none's. */
static atomic_uint next_number = 1;

bool photon_map_make(const RenderRun *run, const Scene *scene, uint count, PhotonMap *map, Error *error)
{
    PhotonMaker maker = {0};
    *map = (PhotonMap){0};
    if (count == 0 || !scene_has_delta(scene))
        return true;
    bool done = maker_init(&maker, run, scene, count, error) &&
                (maker.lights.aims.count == 0 || maker_run(&maker, count, map, error));
    map->number = atomic_fetch_add(&next_number, 1);
    maker_destroy(&maker);
    return done;
}

void photon_map_destroy(PhotonMap *map)
{
    free(map->words);
    *map = (PhotonMap){0};
}
