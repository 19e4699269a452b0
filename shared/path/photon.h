/* Caustic photons: where light subpaths have arrived through smooth specular surfaces, and from which direction. Camera
 * subpaths draw directions by them (path/caustic.h).
 *
 * A photon knows how the direction towards its light changes with the place, the light's point kept, and with the
 * light's point, the place kept, so that it predicts the directions that show the light from places nearby. The host
 * makes them before a rendering (host/render/photon_map.c). */
#ifndef TWINLIGHT_PATH_PHOTON_H
#define TWINLIGHT_PATH_PHOTON_H

#include "layout/scene_view.h"
#include "math/warp.h"
#include "path/photon_cells.h"

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

/* A group is drawn by in proportion to how densely its photons lie around a place, which is what its light brings
 * there, plus this part of that of all groups together: a few photons tell their density badly. */
#define PHOTONS_GROUP_LEAST (1.0f / 32.0f)

/* Photons of a group in a cell: `number` of them, first, first + every, ... */
typedef struct PhotonSet {
    uint first, every, number;
    uint shift; /* the cell has 2^shift finest ones */
    float weight; /* if it has any */
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

/* The photons first ... last - 1, or at most `most` that stand for them. Their weight is their number per area of the
 * cell's face, since they lie on surfaces. */
SHARED_FUNCTION PhotonSet photon_set_of(uint first, uint last, uint most, uint shift)
{
    float side = (float)(1u << shift / 3u);
    PhotonSet set = {first, 1u, 0u, shift, (float)(last - first) / (side * side)};
    if (first == last)
        return set;
    set.every = (last - first + most - 1u) / most;
    set.number = (last - first + set.every - 1u) / set.every;
    return set;
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

/* Adds to the weights of the groups' own sets what each has at least, sets those of the sets beside, and adds up those
 * of sets that have photons. */
SHARED_FUNCTION void photon_sets_weigh(PhotonSets *found)
{
    float sum = 0.0f;
    for (uint group = 0u; group < PHOTON_GROUPS; ++group)
        sum += found->sets[2u * group].weight;
    found->weight = 0.0f;
    for (uint set = 0u; set < PHOTON_SETS; ++set) {
        PhotonSet own = found->sets[set];
        own.weight = set % 2u == 0u ? own.weight + PHOTONS_GROUP_LEAST * sum
                                    : PHOTONS_BESIDE_WEIGHT * found->sets[set - 1u].weight;
        found->sets[set] = own;
        found->weight += own.number > 0u ? own.weight : 0.0f;
    }
}

/* The photons for the place p. */
SHARED_FUNCTION PhotonSets photon_sets(PhotonParams params, __global const uint *photons, Vec3 p)
{
    PhotonSets found;
    ulong code = params.count > 0u ? photon_code(params, p) : PHOTON_OUTSIDE;
    for (uint group = 0u; group < PHOTON_GROUPS; ++group) {
        PhotonSet own = photon_set_of(0u, 0u, 1u, 0u), beside = own;
        if (code != PHOTON_OUTSIDE && params.first[group] < params.first[group + 1u]) {
            own = photon_set(params, photons, group, code);
            beside = photon_set_beside(params, photons, group, photon_cell(params, p), own.shift);
        }
        found.sets[2u * group] = own;
        found.sets[2u * group + 1u] = beside;
    }
    photon_sets_weigh(&found);
    return found;
}

/* A photon of the sets, of which there is one: its set by weight, in that uniformly. u: uniform in [0, 1). */
SHARED_FUNCTION uint photon_choose(const PhotonSets *found, float u)
{
    uint chosen = 0u;
    u *= found->weight;
    for (uint i = 0u; i < PHOTON_SETS; ++i) {
        PhotonSet set = found->sets[i];
        if (set.number == 0u)
            continue;
        float part = float_clamp(u / set.weight, 0.0f, 1.0f);
        uint k = (uint)(part * (float)set.number);
        if (u >= 0.0f) /* the last set whose share begins at u or below */
            chosen = set.first + (k < set.number ? k : set.number - 1u) * set.every;
        u -= set.weight;
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
            density += set.weight / found->weight * (sum / (float)set.number);
    }
    return density;
}

#endif
