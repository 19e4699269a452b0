#include "render/photon_map.h"

#include "base/log.h"
#include "base/parallel.h"
#include "render/photon_grid.h"
#include "render/photon_lobe.h"
#include "render/photon_pass.h"
#include "render/photon_paths.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

/* Photons at first, and how many times as many follow, about ... */
#define PHOTONS_FIRST 32768u
#define PHOTONS_GROWTH 4u

/* ... while more than this part of the directions that they predict misses the light, and it is so much smaller than
 * with the fewer before, or at first with every PHOTONS_GROWTH-th: where surfaces are not smooth between photons, more
 * predict hardly better. */
#define MISSED_ENOUGH 0.015
#define MISSED_SHRINKS 0.6

/* A map as large as is allowed of which more than this part misses gets a warning. */
#define MISSED_TOO_OFTEN 0.5

/* Subpaths that a thread deals with at a time. */
#define BATCH_PART 1024u

typedef struct PhotonMaker {
    PhotonPass pass;
    PhotonLights lights;
    PhotonSearch search;
    PhotonRecords records;
    uint traced; /* subpaths whose neighbours have been traced */
    uint most; /* photons */
    PhotonLimit limit;
    void *context; /* of `limit` */
} PhotonMaker;

/* The next subpaths, whose neighbours are being traced. */
typedef struct PhotonBatch {
    PhotonMaker *maker;
    const PhotonPath *paths;
    PhotonRecord *records; /* of the same subpaths; number NONE: there is none */
    uint count;
} PhotonBatch;

static uint part_end(const PhotonBatch *batch, size_t part)
{
    const uint end = (uint)(part + 1) * BATCH_PART;
    return end < batch->count ? end : batch->count;
}

static void neighbours_begin(void *context, size_t part)
{
    const PhotonBatch *batch = context;
    for (uint i = (uint)part * BATCH_PART; i < part_end(batch, part); ++i)
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k) {
            PhotonPath neighbour = photon_neighbour(&batch->maker->lights, &batch->paths[i], k);
            photon_pass_follow(&batch->maker->pass, i * PHOTON_NEIGHBOURS + k, &neighbour);
        }
}

/* Makes photons of subpaths whose neighbours have all arrived the same way. */
static void neighbours_end(void *context, size_t part)
{
    const PhotonBatch *batch = context;
    for (uint i = (uint)part * BATCH_PART; i < part_end(batch, part); ++i) {
        const PhotonPath *path = &batch->paths[i];
        PhotonPath neighbours[PHOTON_NEIGHBOURS];
        bool same = true;
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k)
            same = photon_pass_get(&batch->maker->pass, i * PHOTON_NEIGHBOURS + k, &neighbours[k]) &&
                   neighbours[k].vertices == path->vertices && neighbours[k].lobes == path->lobes && same;
        if (!same || !photon_differences(&batch->maker->lights, path, neighbours, &batch->records[i]))
            batch->records[i].number = NONE;
    }
}

/* Traces the neighbours of the next `count` subpaths, and makes photons of them. */
static bool neighbours_trace(PhotonMaker *maker, uint count, Error *error)
{
    PhotonRecords *records = &maker->records;
    PhotonBatch batch = {maker, maker->search.paths + maker->traced, records->records + maker->traced, count};
    const size_t parts = (count + BATCH_PART - 1) / BATCH_PART;
    parallel_run(parts, records->threads, neighbours_begin, &batch);
    if (!photon_pass_run(&maker->pass, count * PHOTON_NEIGHBOURS, &maker->search.whole, error))
        return false;
    maker->traced += count;
    if (!maker->search.whole)
        return true;
    parallel_run(parts, records->threads, neighbours_end, &batch);
    for (uint i = 0; i < count; ++i)
        if (batch.records[i].number != NONE)
            records->records[records->count++] = batch.records[i];
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
    maker->records =
        (PhotonRecords){.records = malloc(count * sizeof *maker->records.records), .threads = run->film->threads};
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

/* Whether a map can be made: there are records, and there was no stop. */
static bool has_records(const PhotonMaker *maker)
{
    return maker->records.count > 0 && maker->search.whole;
}

/* PhotonMap.number of the next map; 0 is none's. */
static atomic_uint next_number = 1;

/* Makes a map of all records. *missed: photon_grid_make; 0 if there can be none. */
static bool map_fill(PhotonMaker *maker, PhotonMap *map, double *missed, Error *error)
{
    *missed = 0.0;
    photon_map_destroy(map);
    bool done = !has_records(maker) || photon_grid_make(&maker->records, &maker->lights, map, missed, error);
    map->number = atomic_fetch_add(&next_number, 1);
    return done;
}

/* *missed: photon_grid_missed of every PHOTONS_GROWTH-th record; 0 as above. */
static bool missed_by_fewer(PhotonMaker *maker, double *missed, Error *error)
{
    *missed = 0.0;
    return !has_records(maker) || photon_grid_missed(&maker->records, &maker->lights, PHOTONS_GROWTH, missed, error);
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

/* Makes a map of few photons, then of more until they are enough, maker->most at most, or no more are found. */
static bool maker_run(PhotonMaker *maker, PhotonMap *map, Error *error)
{
    const uint first = PHOTONS_FIRST < maker->most ? PHOTONS_FIRST : maker->most;
    double missed = 0.0;
    for (uint wanted = first; wanted > 0;) {
        if (!records_make(maker, wanted, error) || (wanted == first && !missed_by_fewer(maker, &missed, error)))
            return false;
        const double by_fewer = missed;
        if (!map_fill(maker, map, &missed, error))
            return false;
        const uint found = maker->search.found;
        uint next = found < wanted ? 0 : photon_count_next(found, maker->most, missed, by_fewer);
        if (next > 0 && wanted == first && maker->limit) {
            if (!maker->limit(maker->context, &maker->most, error))
                return false;
            next = photon_count_next(found, maker->most, missed, by_fewer);
        }
        if (wanted == maker->most || found >= maker->most)
            missed_warn(map, maker->most, missed);
        wanted = next;
    }
    return true;
}

bool photon_map_make(const RenderRun *run, const Scene *scene, uint count, PhotonLimit limit, void *context,
                     PhotonMap *map, Error *error)
{
    PhotonMaker maker = {.most = count, .limit = limit, .context = context};
    *map = (PhotonMap){0};
    if (count == 0 || !scene_has_delta(scene))
        return true;
    bool done =
        maker_init(&maker, run, scene, count, error) && (maker.lights.aims.count == 0 || maker_run(&maker, map, error));
    maker_destroy(&maker);
    return done;
}

void photon_map_destroy(PhotonMap *map)
{
    free(map->words);
    *map = (PhotonMap){0};
}
