/* The layout of the map of caustic photons (path/photon.h): BUFFER_PHOTONS holds the codes of all, sorted within each
 * group, then PHOTON_WORDS words of each, then a directory of each group that has any: for every cell of
 * PhotonParams.directory_level, in the order of codes, the first photon of the group that is in that cell or behind it,
 * and last the end of the group. */
#ifndef TWINLIGHT_LAYOUT_PHOTON_MAP_H
#define TWINLIGHT_LAYOUT_PHOTON_MAP_H

#include "math/vec.h"

/* The grid has 2^PHOTON_LEVELS cells per side at its finest level. */
#define PHOTON_LEVELS 20u
#define PHOTON_CELLS (1u << PHOTON_LEVELS)

#define PHOTON_CODE_WORDS 2u /* of a code, the lower half first */

#define PHOTON_POINT 0u /* where it has arrived, 3 */
#define PHOTON_DIRECTION 3u /* where it came from, unit, 3 */
#define PHOTON_BY_PLACE 6u /* slopes of the direction per unit of displacement across it, 2 rows of a pair each */
#define PHOTON_SPREAD 8u /* of the slopes: lower triangular, 3 */
#define PHOTON_LIGHT 11u /* a light of no extent; NONE: any other */
#define PHOTON_WORDS 12u

/* Smooth specular vertices that a caustic path may have between its light and its receiver. */
#define CAUSTIC_VERTICES 7u

/* Photons of different lights without extent, and those that came by different kinds of path, are in groups of their
 * own, so that rare ones are not lost among many; the last group has the rest. */
#define PHOTON_GROUPS 4u

typedef struct PhotonParams {
    uint count; /* 0: there are none */
    uint everywhere; /* 1: receivers where light subpaths could be connected draw, too (path/caustic_rest.h) */
    uint first[PHOTON_GROUPS + 1u]; /* photon of each group, and behind the last */
    uint level[PHOTON_GROUPS]; /* at which the cells of a group hold some photons each */
    uint directory_level; /* 0: there are no directories */
    uint directory[PHOTON_GROUPS]; /* where that of each group begins, in words */
    Vec3 origin; /* corner of the grid */
    float cells_per_unit; /* of the finest level */
    /* Lights of no extent count as a sphere of this radius, or as a cone of this sine, where photons find them. */
    float point_radius;
    float distant_sine;
} PhotonParams;

#endif
