/* What a combination (mmlt/combination.h) knows of its estimators, and how it learns that from every generation. */
#ifndef TWINLIGHT_MMLT_COMBINATION_LEARN_H
#define TWINLIGHT_MMLT_COMBINATION_LEARN_H

#include "base/parallel.h"
#include "film/pixel_series.h"
#include "mmlt/estimator.h"

#include <stdatomic.h>

#define TILE_SIDE 8 /* pixels a side */

/* Pixels a side of a patch. Variances are learnt of the light of patches, not of pixels, since the errors of chains are
 * alike in neighbouring pixels, and an eye or a denoiser sees those that are; docs/TUNING.md. */
#define PATCH_SIDE 4

/* Patches in a tile. */
#define TILE_PATCHES ((double)(TILE_SIDE * TILE_SIDE) / (PATCH_SIDE * PATCH_SIDE))

/* Avoids division by zero in tiles without variance or light (black ones). */
#define SPREAD_MIN 1e-30

/* Larger ones count as this: beyond it a number of samples over a variance may be zero. */
#define SPREAD_MAX 1e200

/* Three more series of pictures. From chains: light that pools leave out, and light that path tracing leaves out. From
 * path tracing: the latter. */
#define SERIES_EXCESS ESTIMATOR_COUNT
#define SERIES_RARE (ESTIMATOR_COUNT + 1)
#define SERIES_PATHS_RARE (ESTIMATOR_COUNT + 2)
#define SERIES_COUNT (ESTIMATOR_COUNT + 3)

/* Most images of an estimator that have series. */
#define ESTIMATOR_IMAGES 3

/* Combination.shown: path tracing with its own rare light. */
#define SHOWN_PATHS_ALONE (ESTIMATOR_COUNT + 1)

typedef struct CombinationTile {
    double spread[SERIES_COUNT]; /* variance of one sample, summed over the tile's patches (tiles_sum) */
    double direct; /* the same of direct light */
    double light, indirect; /* luminances summed over the tile's pixels */
    double weight[ESTIMATOR_COUNT]; /* of the latest generation */
    double paths_rare; /* the part of rare light that is path tracing's own */
} CombinationTile;

/* Partial sums of a row of tiles. They are added up in the order of rows, so that the result does not depend on
 * threads. */
typedef struct CombinationRow {
    double indirect_sum, direct_sum; /* of stratified path tracing ... */
    PixelVariances indirect, direct; /* ... and its variances (mmlt/combination_stratified.c) */
    size_t full; /* saturated pixels */
    double patches, tiles; /* the chains' variances of patches and of tiles (mmlt/combination_variances.c) */
} CombinationRow;

typedef struct Combination {
    int size[2], patches[2], tiles[2];
    PixelSeries light[SERIES_COUNT], sums[SERIES_COUNT]; /* luminances summed over patches, and over tiles */
    PixelSeries direct; /* over patches */
    PixelSeries rare_whole; /* SERIES_RARE, summed over the image (mmlt/combination_rare.c) */
    CombinationTile *known; /* one per tile; may be shared, see combination_share */
    CombinationRow *rows; /* scratch */
    double *ratios; /* scratch, one per tile */
    float *patch_sums, *tile_sums; /* scratch: an image, summed over patches and over tiles */
    bool shares; /* `known` and scratch are those of another combination */
    /* Path tracing of both replicas is one stratified sequence, not two (mmlt/paths_estimator.h). Then: the means of
     * its indirect and direct light over patches when they had `earlier_samples` per pixel (0: not yet), and the
     * exponent a of the variance V n^-a of n samples, from how these means have changed
     * (mmlt/combination_stratified.c). Direct light has the samples of bidirectional path tracing, too. */
    bool one_sequence;
    float *earlier[2];
    double earlier_samples[2], exponents[2];
    int threads; /* that make sums over images */
    bool ready[SERIES_COUNT]; /* the series' variances are known */
    double deviations[SERIES_COUNT]; /* standard errors that tell light from noise (MISSING_PROBABILITY) */
    /* Variance of the chains' light in a tile over the sum of those in its patches: 1 for errors that are independent
     * (or not known), TILE_PATCHES for errors that are alike. */
    double chains_correlation;
    double rare_chains, rare_paths; /* variances of rare light relative to all light, of all tiles together */
    /* Samples of each in the best division of work (combination_rates), and in the best without bidirectional path
     * tracing; 0: not known. */
    double best[ESTIMATOR_COUNT], best_others[ESTIMATOR_COUNT];
    double weight[ESTIMATOR_COUNT], paths_rare; /* of the latest generation, mean over the tiles */
    bool hidden; /* light that path tracing cannot find may exist: of rare light it shows only what it clamps */
    bool rare_missed; /* the same, since path tracing has found significantly less rare light than the chains have, or
                         theirs is not known well enough to tell */
    bool paths_trusted; /* path tracing draws by photons at all receivers: it misses no rare light, whatever is known */
    bool opened; /* light comes through openings */
    bool bidirectional_better; /* with some bidirectional path tracing the best division of work has less error */
    bool bidirectional_trial; /* that of the generation under way is a trial, which is not shown */
    int shown; /* for tests: 1 + the estimator with weight 1 in generations that have samples of it, or
                  SHOWN_PATHS_ALONE; 0: best weights */
} Combination;

/* Numbers of tiles and of patches, and the tiles of a pixel and of a patch (all numbered row by row within the
 * crop). */
size_t combination_tile_count(const Combination *combination);
size_t combination_patch_count(const Combination *combination);
size_t combination_tile_of(const Combination *combination, size_t pixel);
/* Where the run of pixels ends that begins with `pixel`, in the same row of the same square of `side` pixels. */
size_t combination_run_end(const Combination *combination, size_t pixel, size_t side);
size_t combination_tile_of_patch(const Combination *combination, size_t patch);

/* Calls part(context, row) for every row of tiles, several at a time in images large enough. */
void combination_rows_run(const Combination *combination, ParallelPart *part, void *context);

/* The patches of a row of tiles, as a window of their image. */
PixelWindow combination_row_window(const Combination *combination, size_t row);

/* The pixels, patches and tiles of a row of tiles: first ... end - 1. */
typedef struct RowRange {
    size_t first, end;
} RowRange;

RowRange combination_row_pixels(const Combination *combination, size_t row);
RowRange combination_row_patches(const Combination *combination, size_t row);
RowRange combination_row_tiles(const Combination *combination, size_t row);

/* Mean light of a tile, in luminances summed over its pixels. */
double combination_mean_light(const Combination *combination);

/* Images of an estimator in a generation, and where their luminances are summed: those that are learnt from its
 * film. */
typedef struct FilmLearning {
    Combination *combination;
    const Film *film;
    struct {
        double samples;
        const int64_t *sums, *less; /* less: what is not part of the image; NULL: all is */
        PixelSeries *patches, *tiles; /* tiles: may be NULL */
    } images[ESTIMATOR_IMAGES];
    int count;
} FilmLearning;

/* Begins with the images that a film of `samples` of an estimator holds: layers as in mmlt/combined_image.h. direct:
 * the number of samples of direct light, if the estimator is path tracing, of which there may be none then. */
void combination_learning_begin(FilmLearning *learning, Combination *combination, EstimatorKind kind, const Film *film,
                                double samples, double direct);

/* Adds a row of tiles of the images to the series. */
void combination_row_learn(const FilmLearning *learning, size_t row);

#endif
