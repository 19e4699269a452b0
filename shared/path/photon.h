/* Caustic photons: where light subpaths have arrived through smooth specular surfaces, and from which direction. Camera
 * subpaths draw directions by them (path/caustic.h).
 *
 * A photon knows how the direction towards its light changes with the place, the light's point kept, and with the
 * light's point, the place kept, so that it predicts the directions that show the light from places nearby. The
 * photons are sorted by the Morton code of their cell (Morton 1966) in a grid of PHOTON_CELLS cells per side; a cell
 * of a coarser level is a contiguous range of them, which directories shorten the search for. The host makes them
 * before a rendering (host/render/photon_map.c). */
#ifndef TWINLIGHT_PATH_PHOTON_H
#define TWINLIGHT_PATH_PHOTON_H

#include "layout/photon_map.h"
#include "layout/scene_view.h"
#include "math/warp.h"

/* A cell of which at least PHOTONS_LEAST photons are in one of the eight cells of the next level is too coarse for a
 * place in that one. Of more than PHOTONS_MOST photons of a cell, evenly spaced ones stand for all. */
#define PHOTONS_LEAST 4u
#define PHOTONS_MOST 8u

/* Predicted directions this far from the photon's own, in cosines, are not drawn. */
#define PHOTON_COSINE_MIN 0.05f

/* Lobes are mixed with wider ones: their part, and their width. */
#define PHOTON_WIDE_PART (1.0f / 32.0f)
#define PHOTON_WIDE 8.0f

/* Of the nearest cell beside a place's own that has any, at most so many stand for all, and they are drawn by so many
 * times as often as those of its own: near a border the photons of one cell may all be on one side of an edge. */
#define PHOTONS_BESIDE_MOST 4u
#define PHOTONS_BESIDE_WEIGHT 0.5f

/* Photons of a group in a cell: `number` of them, first, first + every, ... */
typedef struct PhotonSet {
    uint first, every, number;
    uint shift; /* the cell has 2^shift finest ones */
} PhotonSet;

/* Those for a place: for each group two sets, of the cell that it is in and of the one beside that. */
#define PHOTON_SETS (2u * PHOTON_GROUPS)

typedef struct PhotonSets {
    PhotonSet sets[PHOTON_SETS];
    float weight; /* sum of the weights of sets that have any; 0: none has */
} PhotonSets;

/* The directions that a photon predicts for a place. With (a, b) = (w.t, w.b) / w.n the slopes of w in the frame of the
 * photon's own direction n, z = spread^-1 ((a, b) - centre) has the density 1 / (pi (1 + |z|^4)^(3/2)), which is even
 * where the light is, mixed with 1 / (pi (1 + |z|^2)^2) of PHOTON_WIDE times the spread, whose tails bound what
 * directions far from the prediction contribute. */
typedef struct PhotonLobe {
    Frame frame;
    float a, b; /* centre */
    float spread_aa, spread_ba, spread_bb; /* lower triangular */
    uint light; /* PHOTON_LIGHT */
} PhotonLobe;

/* Every third bit of a number of ten bits. */
SHARED_FUNCTION uint photon_code_part(uint x)
{
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

/* p in units of the finest cells. */
SHARED_FUNCTION Vec3 photon_cell(PhotonParams params, Vec3 p)
{
    return vec3_scale(vec3_sub(p, params.origin), params.cells_per_unit);
}

/* The Morton code of the finest cell that p is in; NONE outside the grid. */
SHARED_FUNCTION uint photon_code(PhotonParams params, Vec3 p)
{
    Vec3 cell = photon_cell(params, p);
    float most = (float)PHOTON_CELLS;
    if (!(cell.x >= 0.0f && cell.y >= 0.0f && cell.z >= 0.0f && cell.x < most && cell.y < most && cell.z < most))
        return NONE;
    return photon_code_part((uint)cell.x) | photon_code_part((uint)cell.y) << 1 | photon_code_part((uint)cell.z) << 2;
}

/* The first of the sorted codes first ... last - 1 that is not below `code`. */
SHARED_FUNCTION uint photon_find(__global const uint *photons, uint first, uint last, uint code)
{
    while (first < last) {
        uint middle = first + (last - first) / 2u;
        if (photons[middle] < code)
            first = middle + 1u;
        else
            last = middle;
    }
    return first;
}

/* Of so many photons it takes less time to look at all than to search. */
#define PHOTONS_COUNTED 32u

/* Narrows the photons *first ... *last - 1 to those whose codes are cell ... next - 1. */
SHARED_FUNCTION void photon_narrow(__global const uint *photons, uint cell, uint next, uint *first, uint *last)
{
    uint begin = *first, end = *last, before = 0u, within = 0u;
    if (end - begin > PHOTONS_COUNTED) {
        *first = photon_find(photons, begin, end, cell);
        *last = photon_find(photons, *first, end, next);
        return;
    }
    for (uint i = begin; i < end; ++i) {
        before += photons[i] < cell ? 1u : 0u;
        within += photons[i] < next ? 1u : 0u;
    }
    *first = begin + before;
    *last = begin + within;
}

/* The photons *first ... *last - 1 of the group in the cell of 2^shift finest ones from `cell` on. */
SHARED_FUNCTION void photon_cell_find(PhotonParams params, __global const uint *photons, uint group, uint cell,
                                      uint shift, uint *first, uint *last)
{
    uint next = cell + (1u << shift);
    *first = params.first[group];
    *last = params.first[group + 1u];
    if (params.directory_level > 0u) {
        uint entry_shift = 3u * (PHOTON_LEVELS - params.directory_level);
        __global const uint *directory = photons + params.directory[group];
        *first = directory[cell >> entry_shift];
        *last = directory[((next - 1u) >> entry_shift) + 1u];
        if (shift >= entry_shift)
            return;
    }
    photon_narrow(photons, cell, next, first, last);
}

/* The photons first ... last - 1, or at most `most` that stand for them. */
SHARED_FUNCTION PhotonSet photon_set_of(uint first, uint last, uint most, uint shift)
{
    PhotonSet set = {first, 1u, 0u, shift};
    if (first == last)
        return set;
    set.every = (last - first + most - 1u) / most;
    set.number = (last - first + set.every - 1u) / set.every;
    return set;
}

/* The photons of a group for a place with the code `code`: those of the finest cell around it that has enough. */
SHARED_FUNCTION PhotonSet photon_set(PhotonParams params, __global const uint *photons, uint group, uint code)
{
    uint shift = 3u * (PHOTON_LEVELS - params.level[group]);
    uint first = 0u, last = 0u;
    for (; first == last && shift <= 3u * PHOTON_LEVELS; shift += 3u) {
        uint cell = code >> shift << shift;
        photon_cell_find(params, photons, group, cell, shift, &first, &last);
    }
    for (shift -= 3u; first != last && shift > 0u; shift -= 3u) {
        uint cell = code >> (shift - 3u) << (shift - 3u);
        uint inner = first, inner_end = last;
        photon_narrow(photons, cell, cell + (1u << (shift - 3u)), &inner, &inner_end);
        if (inner_end - inner < PHOTONS_LEAST)
            break;
        first = inner;
        last = inner_end;
    }
    return photon_set_of(first, last, PHOTONS_MOST, shift);
}

/* The photons of a group in a cell of 2^shift finest ones that shares a face with the one that `cell` (photon_cell) is
 * in: of those that have any, the nearest. */
SHARED_FUNCTION PhotonSet photon_set_beside(PhotonParams params, __global const uint *photons, uint group, Vec3 cell,
                                            uint shift)
{
    PhotonSet set = photon_set_of(0u, 0u, 1u, shift);
    float place[3] = {cell.x, cell.y, cell.z}, part[3];
    uint bits = shift / 3u, size = 1u << bits, corner[3], left = 7u; /* of axes, a bit each */
    for (uint axis = 0u; axis < 3u; ++axis) {
        corner[axis] = (uint)place[axis] >> bits << bits;
        part[axis] = (place[axis] - (float)corner[axis]) / (float)size;
    }
    while (set.number == 0u && left != 0u) {
        uint nearest = 0u;
        float least = 1.0f;
        for (uint axis = 0u; axis < 3u; ++axis) {
            float away = float_min(part[axis], 1.0f - part[axis]);
            if ((left & 1u << axis) != 0u && away < least) {
                nearest = axis;
                least = away;
            }
        }
        left &= ~(1u << nearest);
        uint own = corner[nearest], beside = part[nearest] < 0.5f ? own - size : own + size;
        if (beside >= PHOTON_CELLS) /* outside the grid; also below it */
            continue;
        corner[nearest] = beside;
        uint code = photon_code_part(corner[0]) | photon_code_part(corner[1]) << 1 | photon_code_part(corner[2]) << 2;
        corner[nearest] = own;
        uint first, last;
        photon_cell_find(params, photons, group, code, shift, &first, &last);
        set = photon_set_of(first, last, PHOTONS_BESIDE_MOST, shift);
    }
    return set;
}

/* The weight of a set that has any photons. */
SHARED_FUNCTION float photon_set_weight(PhotonParams params, uint set)
{
    return params.weight[set / 2u] * (set % 2u == 0u ? 1.0f : PHOTONS_BESIDE_WEIGHT);
}

/* The photons for the place p. */
SHARED_FUNCTION PhotonSets photon_sets(PhotonParams params, __global const uint *photons, Vec3 p)
{
    PhotonSets found;
    uint code = params.count > 0u ? photon_code(params, p) : NONE;
    found.weight = 0.0f;
    for (uint group = 0u; group < PHOTON_GROUPS; ++group) {
        PhotonSet own = photon_set_of(0u, 0u, 1u, 0u), beside = own;
        if (code != NONE && params.first[group] < params.first[group + 1u]) {
            own = photon_set(params, photons, group, code);
            beside = photon_set_beside(params, photons, group, photon_cell(params, p), own.shift);
        }
        found.sets[2u * group] = own;
        found.sets[2u * group + 1u] = beside;
    }
    for (uint set = 0u; set < PHOTON_SETS; ++set)
        if (found.sets[set].number > 0u)
            found.weight += photon_set_weight(params, set);
    return found;
}

/* A photon of the sets, of which there is one: its set by weight, in that uniformly. u: uniform in [0, 1). */
SHARED_FUNCTION uint photon_choose(PhotonParams params, const PhotonSets *found, float u)
{
    uint chosen = 0u;
    u *= found->weight;
    for (uint i = 0u; i < PHOTON_SETS; ++i) {
        PhotonSet set = found->sets[i];
        float weight = photon_set_weight(params, i);
        if (set.number == 0u)
            continue;
        float part = float_clamp(u / weight, 0.0f, 1.0f);
        uint k = (uint)(part * (float)set.number);
        if (u >= 0.0f) /* the last set whose share begins at u or below */
            chosen = set.first + (k < set.number ? k : set.number - 1u) * set.every;
        u -= weight;
    }
    return chosen;
}

SHARED_FUNCTION Vec3 photon_vector(__global const uint *record, uint field)
{
    return vec3(word_float(record + field), word_float(record + field + 1u), word_float(record + field + 2u));
}

/* What photon `index` predicts for the place p. */
SHARED_FUNCTION PhotonLobe photon_lobe(PhotonParams params, __global const uint *photons, uint index, Vec3 p)
{
    __global const uint *record = photons + params.count + (size_t)index * PHOTON_WORDS;
    PhotonLobe lobe;
    lobe.frame = frame_from_normal(photon_vector(record, PHOTON_DIRECTION));
    Vec3 moved = frame_to_local(lobe.frame, vec3_sub(p, photon_vector(record, PHOTON_POINT)));
    lobe.a = word_float(record + PHOTON_BY_PLACE) * moved.x + word_float(record + PHOTON_BY_PLACE + 1u) * moved.y;
    lobe.b = word_float(record + PHOTON_BY_PLACE + 2u) * moved.x + word_float(record + PHOTON_BY_PLACE + 3u) * moved.y;
    lobe.spread_aa = word_float(record + PHOTON_SPREAD);
    lobe.spread_ba = word_float(record + PHOTON_SPREAD + 1u);
    lobe.spread_bb = word_float(record + PHOTON_SPREAD + 2u);
    lobe.light = record[PHOTON_LIGHT];
    return lobe;
}

/* Density per solid angle of drawing w (unit) from the lobe. A cosine to the power of three turns the density of slopes
 * into one of directions. */
SHARED_FUNCTION float photon_lobe_density(const PhotonLobe *lobe, Vec3 w)
{
    Vec3 framed = frame_to_local(lobe->frame, w);
    if (!(framed.z > PHOTON_COSINE_MIN))
        return 0.0f;
    float x = (framed.x / framed.z - lobe->a) / lobe->spread_aa;
    float y = (framed.y / framed.z - lobe->b - lobe->spread_ba * x) / lobe->spread_bb;
    float square = x * x + y * y, narrow = 1.0f + square * square,
          wide = 1.0f + square * (1.0f / (PHOTON_WIDE * PHOTON_WIDE));
    float mixed = (1.0f - PHOTON_WIDE_PART) / (narrow * float_sqrt(narrow)) +
                  PHOTON_WIDE_PART / (PHOTON_WIDE * PHOTON_WIDE) / (wide * wide);
    float slopes = INV_PI * mixed / (lobe->spread_aa * lobe->spread_bb);
    return slopes / (framed.z * framed.z * framed.z);
}

/* Draws a direction from the lobe; false if it is too far from the photon's own. v = |z|^2 has the distribution
 * function v / (1 + v^2)^(1/2) in the narrow part, and in the wide one, v in units of PHOTON_WIDE^2, v / (1 + v); the
 * squared radius of a point of a disk is uniform. */
SHARED_FUNCTION bool photon_lobe_sample(const PhotonLobe *lobe, Vec2 u, Vec3 *w)
{
    float radius, scale;
    bool wide = u.x < PHOTON_WIDE_PART;
    float part = wide ? u.x / PHOTON_WIDE_PART : (u.x - PHOTON_WIDE_PART) / (1.0f - PHOTON_WIDE_PART);
    Vec2 disk = warp_disk_polar(vec2(part, u.y), &radius);
    float drawn = radius * radius;
    if (wide)
        scale = PHOTON_WIDE / float_sqrt((1.0f - radius) * (1.0f + radius));
    else
        scale = 1.0f / float_sqrt(float_sqrt((1.0f - drawn) * (1.0f + drawn)));
    float x = disk.x * scale, y = disk.y * scale;
    Vec3 framed = vec3(lobe->a + lobe->spread_aa * x, lobe->b + (lobe->spread_ba * x + lobe->spread_bb * y), 1.0f);
    *w = vec3_normalize(frame_to_world(lobe->frame, framed));
    return 1.0f > PHOTON_COSINE_MIN * vec3_length(framed);
}

/* Density per solid angle with which photon_choose and photon_lobe_sample give the direction w at p, counting photons
 * of one light of no extent alone, or (light NONE) those of all others. */
SHARED_FUNCTION float photon_density(PhotonParams params, __global const uint *photons, const PhotonSets *found, Vec3 p,
                                     Vec3 w, uint light)
{
    float density = 0.0f;
    for (uint i = 0u; i < PHOTON_SETS; ++i) {
        PhotonSet set = found->sets[i];
        float sum = 0.0f;
        for (uint k = 0u; k < set.number; ++k) {
            PhotonLobe lobe = photon_lobe(params, photons, set.first + k * set.every, p);
            if (lobe.light == light)
                sum += photon_lobe_density(&lobe, w);
        }
        if (sum > 0.0f)
            density += photon_set_weight(params, i) / found->weight * (sum / (float)set.number);
    }
    return density;
}

#endif
