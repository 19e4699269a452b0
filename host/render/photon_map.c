#include "render/photon_map.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "path/photon_path.h"
#include "render/photon_grid.h"
#include "render/photon_lobe.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Light subpaths of a pass, and of all passes for each photon wanted: where most light meets no specular surface, fewer
 * photons must do. */
#define PASS_PATHS 65536u
#define PATHS_PER_PHOTON 16u

/* After this many passes without a photon there are none. */
#define BLACK_PASSES 4u

typedef struct PhotonPass {
    const RenderRun *run;
    StepList list;
    uint *words; /* PHOTON_PATH_WORDS fields of PASS_PATHS items */
} PhotonPass;

static bool pass_init(PhotonPass *pass, const RenderRun *run, Error *error)
{
    Recorder recorder;
    size_t bytes = (size_t)PASS_PATHS * PHOTON_PATH_WORDS * sizeof *pass->words;
    *pass = (PhotonPass){.run = run, .words = malloc(bytes)};
    if (!pass->words)
        return error_memory(error, bytes, "photons");
    if (!recorder_init(&recorder, 2 + 3 * (CAUSTIC_VERTICES + 1), error))
        return false;
    recorder_kernel(&recorder, KERNEL_photon_start, false);
    recorder_walk(&recorder, CAUSTIC_VERTICES + 1, KERNEL_photon_walk, KERNEL_COUNT);
    recorder_kernel(&recorder, KERNEL_photon_end, false);
    pass->list = recorder_list(&recorder, PHOTON_PATH_WORDS, NULL, 0);
    pass->list.words_per_item[BUFFER_SHADOWS] = 0;
    pass->list.words_per_item[BUFFER_SPLATS] = 0;
    pass->list.pass_words = pass->words;
    pass->list.pass_fields = PHOTON_PATH_WORDS;
    pass->list.pass_stride = PASS_PATHS;
    return true;
}

static void pass_destroy(PhotonPass *pass)
{
    step_list_destroy(&pass->list);
    free(pass->words);
}

static void no_splats(void *context, const uint *splats, uint count, uint stride)
{
    (void)context, (void)splats, (void)count, (void)stride;
}

/* Traces the first `count` items. *whole: set to false by a stop. */
static bool pass_run(PhotonPass *pass, uint count, bool *whole, Error *error)
{
    const RenderRun *run = pass->run;
    const SplatSink sink = {.splats = no_splats, .whole = true};
    FrameParams frame = run->frame;
    uint64_t delivered = 0;
    frame.pass.first_item = 0;
    frame.pass.item_count = count;
    if (!run->interface->run(run->backend, &frame, &pass->list, &sink, render_run_stop(run), &delivered, error))
        return false;
    *whole = delivered == count;
    return true;
}

static void word_put(PhotonPass *pass, uint field, uint item, uint word)
{
    pass->words[(size_t)field * PASS_PATHS + item] = word;
}

static void vector_put(PhotonPass *pass, uint field, uint item, Vec3 v)
{
    word_put(pass, field, item, float_bits(v.x));
    word_put(pass, field + 1, item, float_bits(v.y));
    word_put(pass, field + 2, item, float_bits(v.z));
}

static uint word_get(const PhotonPass *pass, uint field, uint item)
{
    return pass->words[(size_t)field * PASS_PATHS + item];
}

static Vec3 vector_get(const PhotonPass *pass, uint field, uint item)
{
    return vec3(bits_float(word_get(pass, field, item)), bits_float(word_get(pass, field + 1, item)),
                bits_float(word_get(pass, field + 2, item)));
}

/* Reads item `item` of a finished pass; false if it has not arrived. */
static bool path_get(const PhotonPass *pass, uint item, PhotonPath *path)
{
    path->number = word_get(pass, PHOTON_PATH_NUMBER, item);
    path->light = word_get(pass, PHOTON_PATH_EMITTER, item);
    path->vertices = word_get(pass, PHOTON_PATH_VERTICES, item);
    path->lobes = word_get(pass, PHOTON_PATH_LOBES, item);
    path->origin = vector_get(pass, PHOTON_PATH_ORIGIN, item);
    path->first = vector_get(pass, PHOTON_PATH_FIRST, item);
    path->point = vector_get(pass, PHOTON_PATH_POINT, item);
    path->last = vector_get(pass, PHOTON_PATH_LAST, item);
    return word_get(pass, PHOTON_PATH_ARRIVED, item) != 0;
}

/* Draws light subpaths until `count` have arrived at a receiver or PATHS_PER_PHOTON times as many have been drawn. */
static bool paths_find(PhotonPass *pass, uint count, PhotonPath *paths, uint *found, Error *error)
{
    bool whole = true;
    uint64_t most = ((uint64_t)count * PATHS_PER_PHOTON + PASS_PATHS - 1) / PASS_PATHS;
    *found = 0;
    for (uint number = 0; number < most && *found < count && (*found > 0 || number < BLACK_PASSES); ++number) {
        memset(pass->words, 0, (size_t)PASS_PATHS * PHOTON_PATH_WORDS * sizeof *pass->words);
        for (uint i = 0; i < PASS_PATHS; ++i) {
            word_put(pass, PHOTON_PATH_NUMBER, i, number * PASS_PATHS + i);
            word_put(pass, PHOTON_PATH_EMITTER, i, NONE);
        }
        if (!pass_run(pass, PASS_PATHS, &whole, error))
            return false;
        if (!whole) {
            *found = 0;
            break;
        }
        for (uint i = 0; i < PASS_PATHS && *found < count; ++i)
            *found += path_get(pass, i, &paths[*found]);
    }
    return true;
}

/* Traces the neighbours of paths[first ... last - 1], and makes photons of those whose neighbours all arrive the same
 * way. */
static bool neighbours_trace(PhotonPass *pass, const PhotonLights *lights, const PhotonPath *paths, uint count,
                             PhotonRecords *records, Error *error)
{
    bool whole = true;
    for (uint i = 0; i < count; ++i)
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k) {
            PhotonPath neighbour = photon_neighbour(lights, &paths[i], k);
            uint item = i * PHOTON_NEIGHBOURS + k;
            word_put(pass, PHOTON_PATH_NUMBER, item, neighbour.number);
            word_put(pass, PHOTON_PATH_EMITTER, item, neighbour.light);
            vector_put(pass, PHOTON_PATH_ORIGIN, item, neighbour.origin);
            vector_put(pass, PHOTON_PATH_FIRST, item, neighbour.first);
        }
    if (!pass_run(pass, count * PHOTON_NEIGHBOURS, &whole, error))
        return false;
    for (uint i = 0; i < count && whole; ++i) {
        PhotonPath neighbours[PHOTON_NEIGHBOURS];
        bool same = true;
        for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k)
            same = path_get(pass, i * PHOTON_NEIGHBOURS + k, &neighbours[k]) &&
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
    bool done =
        paths ? paths_find(pass, count, paths, &found, error) : error_memory(error, count * sizeof *paths, "photons");
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
    done = done && photon_lights_init(&lights, scene, error) && pass_init(&pass, run, error) &&
           records_make(&pass, &lights, count, &records, error) &&
           (records.count == 0 || photon_grid_make(&records, &lights, map, error));
    map->number = atomic_fetch_add(&next_number, 1);
    pass_destroy(&pass);
    photon_lights_destroy(&lights);
    free(records.records);
    return done;
}

void photon_map_destroy(PhotonMap *map)
{
    free(map->words);
    *map = (PhotonMap){0};
}
