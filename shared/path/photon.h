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

/* The code of no cell. */
#define PHOTON_OUTSIDE (~(ulong)0u)

/* x, of 21 bits at most, with two zeros above each bit. */
SHARED_FUNCTION ulong photon_code_part(uint x)
{
    ulong wide = x;
    wide = (wide | wide << 32) & 0x001f00000000ffffu;
    wide = (wide | wide << 16) & 0x001f0000ff0000ffu;
    wide = (wide | wide << 8) & 0x100f00f00f00f00fu;
    wide = (wide | wide << 4) & 0x10c30c30c30c30c3u;
    return (wide | wide << 2) & 0x1249249249249249u;
}

/* The Morton code of a cell. */
SHARED_FUNCTION ulong photon_code_of(uint x, uint y, uint z)
{
    return photon_code_part(x) | photon_code_part(y) << 1 | photon_code_part(z) << 2;
}

/* p in units of the finest cells. */
SHARED_FUNCTION Vec3 photon_cell(PhotonParams params, Vec3 p)
{
    return vec3_scale(vec3_sub(p, params.origin), params.cells_per_unit);
}

/* The Morton code of the finest cell that p is in; PHOTON_OUTSIDE outside the grid. */
SHARED_FUNCTION ulong photon_code(PhotonParams params, Vec3 p)
{
    Vec3 cell = photon_cell(params, p);
    float most = (float)PHOTON_CELLS;
    if (!(cell.x >= 0.0f && cell.y >= 0.0f && cell.z >= 0.0f && cell.x < most && cell.y < most && cell.z < most))
        return PHOTON_OUTSIDE;
    return photon_code_of((uint)cell.x, (uint)cell.y, (uint)cell.z);
}

/* The code of photon `index`. */
SHARED_FUNCTION ulong photon_code_at(__global const uint *photons, uint index)
{
    return photons[2u * index] | (ulong)photons[2u * index + 1u] << 32;
}

/* Where the words of photon `index` of so many begin; of photon `count`, the end of all. */
SHARED_FUNCTION size_t photon_record_at(uint count, uint index)
{
    return (size_t)count * PHOTON_CODE_WORDS + (size_t)index * PHOTON_WORDS;
}

SHARED_FUNCTION __global const uint *photon_record(__global const uint *photons, uint count, uint index)
{
    return photons + photon_record_at(count, index);
}

/* The first of the sorted codes first ... last - 1 that is not below `code`. */
SHARED_FUNCTION uint photon_find(__global const uint *photons, uint first, uint last, ulong code)
{
    while (first < last) {
        uint middle = first + (last - first) / 2u;
        if (photon_code_at(photons, middle) < code)
            first = middle + 1u;
        else
            last = middle;
    }
    return first;
}

/* Of so many photons it takes less time to look at all than to search. */
#define PHOTONS_COUNTED 32u

/* Narrows the photons *first ... *last - 1 to those whose codes are cell ... next - 1. */
SHARED_FUNCTION void photon_narrow(__global const uint *photons, ulong cell, ulong next, uint *first, uint *last)
{
    uint begin = *first, end = *last, before = 0u, within = 0u;
    if (end - begin > PHOTONS_COUNTED) {
        *first = photon_find(photons, begin, end, cell);
        *last = photon_find(photons, *first, end, next);
        return;
    }
    for (uint i = begin; i < end; ++i) {
        ulong code = photon_code_at(photons, i);
        before += code < cell ? 1u : 0u;
        within += code < next ? 1u : 0u;
    }
    *first = begin + before;
    *last = begin + within;
}

/* The least range *first ... *last - 1 of the group's photons known to have those of the codes low ... high: from the
 * directory, if there is one. */
SHARED_FUNCTION void photon_known(PhotonParams params, __global const uint *photons, uint group, ulong low, ulong high,
                                  uint *first, uint *last)
{
    *first = params.first[group];
    *last = params.first[group + 1u];
    if (params.directory_level > 0u) {
        uint entry_shift = 3u * (PHOTON_LEVELS - params.directory_level);
        __global const uint *directory = photons + params.directory[group];
        *first = directory[(uint)(low >> entry_shift)];
        *last = directory[(uint)(high >> entry_shift) + 1u];
    }
}

/* The photons *first ... *last - 1 of the group in the cell of 2^shift finest ones from `cell` on. */
SHARED_FUNCTION void photon_cell_find(PhotonParams params, __global const uint *photons, uint group, ulong cell,
                                      uint shift, uint *first, uint *last)
{
    ulong next = cell + ((ulong)1u << shift);
    photon_known(params, photons, group, cell, next - 1u, first, last);
    if (params.directory_level == 0u || shift < 3u * (PHOTON_LEVELS - params.directory_level))
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

/* The first photon of a group that is not before the code. */
SHARED_FUNCTION uint photon_position(PhotonParams params, __global const uint *photons, uint group, ulong code)
{
    uint first, last;
    photon_known(params, photons, group, code, code, &first, &last);
    return photon_find(photons, first, last, code);
}

/* The least cell that holds two codes has 2^shift finest ones. differ: the bits in which they differ. */
SHARED_FUNCTION uint photon_shift(ulong differ)
{
    uint shift = 0u;
    for (; differ != 0u; differ >>= 3)
        shift += 3u;
    return shift;
}

/* As photon_find, of codes from which on all others are not below `code`; searches from there, in steps that double,
 * since it is seldom far. */
SHARED_FUNCTION uint photon_find_before(__global const uint *photons, uint first, uint from, ulong code)
{
    uint step = 1u;
    while (from - first >= step && photon_code_at(photons, from - step) >= code) {
        from -= step;
        step *= 2u;
    }
    return photon_find(photons, from - first >= step ? from - step + 1u : first, from, code);
}

/* The same, of codes before which all others are below `code`. */
SHARED_FUNCTION uint photon_find_behind(__global const uint *photons, uint from, uint last, ulong code)
{
    uint step = 1u;
    while (last - from >= step && photon_code_at(photons, from + step - 1u) < code) {
        from += step;
        step *= 2u;
    }
    return photon_find(photons, from, last - from >= step ? from + step - 1u : last, code);
}

/* The photons of a group, which has some, for a place with the code `code`: those of the cell of the usual level that
 * it is in, or of the finest one that has PHOTONS_LEAST, or, where that of the usual level has none, of the least that
 * has any. In the order of codes those that share most of it are next to it. */
SHARED_FUNCTION PhotonSet photon_set(PhotonParams params, __global const uint *photons, uint group, ulong code)
{
    uint begin = params.first[group], end = params.first[group + 1u];
    uint at = photon_position(params, photons, group, code), before = at, after = at, nearest = 0u;
    ulong differ = 0u; /* bits in which the next photon's code differs */
    for (uint k = 0u; k < PHOTONS_LEAST; ++k) {
        ulong below = before > begin ? code ^ photon_code_at(photons, before - 1u) : PHOTON_OUTSIDE;
        ulong above = after < end ? code ^ photon_code_at(photons, after) : PHOTON_OUTSIDE;
        differ = below < above ? below : above;
        if (below < above)
            --before;
        else if (after < end)
            ++after;
        if (k == 0u)
            nearest = photon_shift(differ);
    }
    uint usual = 3u * (PHOTON_LEVELS - params.level[group]), enough = photon_shift(differ);
    uint shift = enough < usual ? enough : usual;
    shift = shift > nearest ? shift : nearest;
    ulong cell = code >> shift << shift;
    return photon_set_of(photon_find_before(photons, begin, at, cell),
                         photon_find_behind(photons, at, end, cell + ((ulong)1u << shift)), PHOTONS_MOST, shift);
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
        ulong code = photon_code_of(corner[0], corner[1], corner[2]);
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
    ulong code = params.count > 0u ? photon_code(params, p) : PHOTON_OUTSIDE;
    found.weight = 0.0f;
    for (uint group = 0u; group < PHOTON_GROUPS; ++group) {
        PhotonSet own = photon_set_of(0u, 0u, 1u, 0u), beside = own;
        if (code != PHOTON_OUTSIDE && params.first[group] < params.first[group + 1u]) {
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

/* Two numbers in a word: the upper halves of floats, with seven bits of mantissa. */
SHARED_FUNCTION Vec2 photon_pair(uint word)
{
    return vec2(bits_float(word & 0xffff0000u), bits_float(word << 16));
}

/* What photon `index` predicts for the place p. */
SHARED_FUNCTION PhotonLobe photon_lobe(PhotonParams params, __global const uint *photons, uint index, Vec3 p)
{
    __global const uint *record = photon_record(photons, params.count, index);
    PhotonLobe lobe;
    lobe.frame = frame_from_normal(photon_vector(record, PHOTON_DIRECTION));
    Vec3 moved = frame_to_local(lobe.frame, vec3_sub(p, photon_vector(record, PHOTON_POINT)));
    Vec2 by_place[2] = {photon_pair(record[PHOTON_BY_PLACE]), photon_pair(record[PHOTON_BY_PLACE + 1u])};
    lobe.a = by_place[0].x * moved.x + by_place[0].y * moved.y;
    lobe.b = by_place[1].x * moved.x + by_place[1].y * moved.y;
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
