/* Where caustic photons are (path/photon.h): in the cells of a grid, by whose Morton codes (Morton 1966) they are
 * sorted. A cell of a coarser level is a contiguous range of them, which directories shorten the search for. */
#ifndef TWINLIGHT_PATH_PHOTON_CELLS_H
#define TWINLIGHT_PATH_PHOTON_CELLS_H

#include "layout/photon_map.h"
#include "math/vec.h"

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

#endif
