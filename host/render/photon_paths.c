#include "render/photon_paths.h"

#include "path/path_random.h"
#include "path/photon.h"
#include "render/photon_grid.h"

#include <stdlib.h>

/* Most subpaths that are drawn from the lights, and between those that have arrived, for each that is wanted. */
#define DRAWN_FIRST 4u
#define DRAWN_BETWEEN 4u

/* After this many without an arrival there are none. */
#define BLACK_PATHS 262144u

/* Subpaths on either side of one in that order that count as its neighbours. */
#define NEAR 8

static uint at_most(uint a, uint b)
{
    return a < b ? a : b;
}

/* Random numbers of a subpath, beside those of kernels/photon.cl. */
static Random4 search_random(const PhotonSearch *search, uint number)
{
    const FrameParams *frame = &search->pass->run->frame;
    return random_four(number, 0u, 1u, PATH_STREAM_PHOTON, frame->pass.seed_low, frame->pass.seed_high);
}

/* Traces the first `count` items of the pass, and keeps those that arrive. */
static bool search_trace(PhotonSearch *search, uint count, Error *error)
{
    if (!photon_pass_run(search->pass, count, &search->whole, error))
        return false;
    search->number += count;
    for (uint i = 0; i < count && search->found < search->most; ++i)
        search->found += photon_pass_get(search->pass, i, &search->paths[search->found]);
    return true;
}

/* Item `item` of the next pass: a subpath from the lights, every other one aimed. */
static void search_draw(PhotonSearch *search, uint item, uint number)
{
    double u[4];
    if (item % 2u == 0u) {
        photon_pass_draw(search->pass, item, number);
        return;
    }
    Random4 random = search_random(search, number);
    for (int k = 0; k < 4; ++k)
        u[k] = (double)random_float(random.x[k]);
    photon_pass_aim(search->pass, item, number, smooth_boxes_point(&search->lights->aims, u));
}

/* Draws subpaths from the lights until `wanted` have arrived, DRAWN_FIRST times as many at most. */
static bool search_lights(PhotonSearch *search, uint wanted, Error *error)
{
    uint64_t most = (uint64_t)wanted * DRAWN_FIRST;
    while (search->whole && search->drawn < most && search->found < wanted &&
           (search->found > 0 || search->drawn < BLACK_PATHS)) {
        for (uint i = 0; i < PASS_PATHS; ++i)
            search_draw(search, i, search->number + i);
        if (!search_trace(search, PASS_PATHS, error))
            return false;
        search->drawn += PASS_PATHS;
    }
    return true;
}

static const PhotonPath *order_path(const PhotonSearch *search, uint at)
{
    return search->order[at].item;
}

/* Sorts the paths that have arrived by their light, and then by the Morton code of the place. */
static bool search_order(PhotonSearch *search, Error *error)
{
    PhotonParams params;
    photon_grid_bounds(&search->paths[0].point, sizeof *search->paths, search->found, &params);
    for (uint i = 0; i < search->found; ++i) {
        PhotonPath *path = &search->paths[i];
        search->order[i] = (KeyedItem){photon_code(params, path->point), path};
    }
    search->ordered = search->found;
    bool sorted = key_sort(search->order, search->ordered);
    for (uint i = 0; i < search->ordered; ++i)
        search->order[i].key = order_path(search, i)->light;
    return (sorted && key_sort(search->order, search->ordered)) ||
           error_memory(error, search->ordered * sizeof *search->order, "photons");
}

/* A neighbour of place `at` in the order, or its own path where there is none. */
static const PhotonPath *order_neighbour(const PhotonSearch *search, uint at, uint random)
{
    int step = (int)(random % (2u * NEAR + 1u)) - NEAR;
    int64_t other = (int64_t)at + step;
    bool near = other >= 0 && other < (int64_t)search->ordered &&
                order_path(search, (uint)other)->light == order_path(search, at)->light;
    return order_path(search, near ? (uint)other : at);
}

/* Some of the way from v towards a and b, or away from them. */
static Vec3 step_between(Vec3 v, Vec3 a, Vec3 b, const uint random[2])
{
    Vec3 step = vec3_scale(vec3_sub(a, v), 1.5f * random_float(random[0]) - 0.5f);
    return vec3_mad(step, 1.5f * random_float(random[1]) - 0.5f, vec3_sub(b, v));
}

/* Where the first ray is closest to the middle of the specular surfaces. */
static Vec3 path_crossing(const PhotonSearch *search, const PhotonPath *path)
{
    return vec3_mad(path->origin, photon_path_along(search->lights, path), path->first);
}

/* A subpath between that of place `at` in the order and two neighbours, from the same point of the light or, from
 * infinity, in the same direction. */
static PhotonPath path_between(const PhotonSearch *search, uint at, uint number)
{
    Random4 random = search_random(search, number);
    PhotonPath path = *order_path(search, at);
    const PhotonPath *a = order_neighbour(search, at, random.x[0]), *b = order_neighbour(search, at, random.x[1]);
    if (photon_light_is_far(search->lights, path.light))
        path.origin = vec3_add(path.origin, step_between(path_crossing(search, &path), path_crossing(search, a),
                                                         path_crossing(search, b), &random.x[2]));
    else
        path.first = vec3_normalize(vec3_add(path.first, step_between(path.first, a->first, b->first, &random.x[2])));
    path.number = number;
    return path;
}

/* Draws subpaths between those that have arrived until there are `wanted`. */
static bool search_between(PhotonSearch *search, uint wanted, Error *error)
{
    uint64_t most = (uint64_t)wanted * DRAWN_BETWEEN;
    uint next = 0;
    for (uint64_t drawn = 0; search->whole && drawn < most && search->found < wanted;) {
        if (search->found >= 2 * search->ordered) {
            if (!search_order(search, error))
                return false;
            next = 0;
        }
        uint batch = at_most(PASS_PATHS, 2 * search->ordered);
        for (uint i = 0; i < batch; ++i, ++next) {
            PhotonPath path = path_between(search, next % search->ordered, search->number + i);
            photon_pass_follow(search->pass, i, &path);
        }
        drawn += batch;
        if (!search_trace(search, batch, error))
            return false;
    }
    return true;
}

bool photon_search_init(PhotonSearch *search, PhotonPass *pass, const PhotonLights *lights, uint most, Error *error)
{
    *search = (PhotonSearch){.pass = pass,
                             .lights = lights,
                             .paths = malloc(most * sizeof *search->paths),
                             .most = most,
                             .order = malloc(most * sizeof *search->order),
                             .whole = true};
    return (search->paths && search->order) ||
           error_memory(error, most * (sizeof *search->paths + sizeof *search->order), "photons");
}

void photon_search_destroy(PhotonSearch *search)
{
    free(search->paths);
    free(search->order);
    *search = (PhotonSearch){0};
}

bool photon_search_run(PhotonSearch *search, uint wanted, Error *error)
{
    return search_lights(search, wanted, error) && (search->found == 0 || search_between(search, wanted, error));
}
