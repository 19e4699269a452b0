/* Grids of media from their samples: the bricks that geometry/medium_grid.h reads. */
#ifndef TWINLIGHT_SCENE_GRID_BUILD_H
#define TWINLIGHT_SCENE_GRID_BUILD_H

#include "base/matrix.h"
#include "geometry/box.h"
#include "scene/scene.h"

/* Samples along an axis, so that coordinates in cells are exact to 1/1000; and in all. */
#define GRID_SIZE_MAX 16384u
#define GRID_SAMPLES_MAX 0x40000000u

typedef struct GridSource {
    uint size[3]; /* samples along x, y and z; of all three 1 more with `ends` */
    uint ends; /* 1: there is a sample at the upper end of each axis of the box, whose index is `size`; low must be 1 */
    uint words; /* of a sample: GRID_COLORS, or those of a grid of emission */
    float low; /* MediumGrid.low */
    Matrix grid_from_world;
    /* Writes the sample at an index: `words` numbers, finite and not negative. */
    void (*sample)(const void *context, const uint index[3], float *out);
    /* Whether all samples from `low` to `high`, both included, are 0; NULL: ask `sample`. */
    bool (*empty)(const void *context, const uint low[3], const uint high[3]);
    const void *context;
} GridSource;

/* Appends a grid to scene->grids, and its bricks to scene->texels: 4 bytes for each 512 samples, and 2916 times `words`
 * for each of these bricks that is not 0 throughout. *number: what Medium.grid is to be. The factors of each word are
 * divided by the largest, which is left in largest[0 ... words - 1]. Fails if memory or indices of 32 bits do not
 * suffice. */
bool grid_add(Scene *scene, const GridSource *source, uint *number, float *largest, Error *error);

/* Temperatures in kelvin: scale * sample + offset, scale not negative. */
typedef struct GridKelvin {
    float scale, offset;
} GridKelvin;

/* Appends a grid of the emission of the medium of grid `number` (geometry/grid_emission.h), as grid_add does. kelvin:
 * the samples' first words are temperatures; else NULL. */
bool grid_emission_add(Scene *scene, uint number, const GridSource *source, const GridKelvin *kelvin, float *largest,
                       Error *error);

/* The bounds of a grid's box in the world. */
Box grid_box(const MediumGrid *grid);

#endif
