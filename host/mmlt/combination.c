#include "mmlt/combination.h"

#include "mmlt/combination_tile.h"
#include "mmlt/tuning.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool combination_init(Combination *combination, const Film *film, Error *error)
{
    *combination = (Combination){0};
    for (int i = 0; i < 2; ++i) {
        combination->size[i] = film->crop[i + 2] - film->crop[i];
        combination->patches[i] = (combination->size[i] + PATCH_SIDE - 1) / PATCH_SIDE;
        combination->tiles[i] = (combination->size[i] + TILE_SIDE - 1) / TILE_SIDE;
    }
    size_t tiles = combination_tile_count(combination);
    combination->threads = 1;
    combination->exponents[0] = combination->exponents[1] = combination->chains_correlation = 1.0;
    combination->known = calloc(tiles, sizeof *combination->known);
    combination->rows = calloc((size_t)combination->tiles[1], sizeof *combination->rows);
    combination->ratios = malloc(tiles * sizeof *combination->ratios);
    combination->tile_sums = malloc(tiles * sizeof *combination->tile_sums);
    combination->patch_sums = malloc(combination_patch_count(combination) * sizeof *combination->patch_sums);
    for (int i = 0; i < 2; ++i)
        combination->earlier[i] = calloc(combination_patch_count(combination), sizeof *combination->earlier[i]);
    if (!combination->known || !combination->rows || !combination->ratios || !combination->tile_sums ||
        !combination->patch_sums || !combination->earlier[0] || !combination->earlier[1])
        return error_memory(error, tiles * sizeof *combination->known, "tiles");
    for (int s = 0; s < SERIES_COUNT; ++s)
        if (!pixel_series_init(&combination->light[s], combination_patch_count(combination), 1, true, error) ||
            !pixel_series_init(&combination->sums[s], combination_tile_count(combination), 1, true, error))
            return false;
    return pixel_series_init(&combination->direct, combination_patch_count(combination), 1, true, error) &&
           pixel_series_init(&combination->rare_whole, 1, 1, true, error);
}

static void shareable_destroy(Combination *combination)
{
    free(combination->known);
    free(combination->rows);
    free(combination->ratios);
    free(combination->tile_sums);
    free(combination->patch_sums);
}

void combination_share(Combination *combination, const Combination *other)
{
    shareable_destroy(combination);
    combination->known = other->known;
    combination->rows = other->rows;
    combination->ratios = other->ratios;
    combination->tile_sums = other->tile_sums;
    combination->patch_sums = other->patch_sums;
    combination->shares = true;
}

void combination_destroy(Combination *combination)
{
    for (int s = 0; s < SERIES_COUNT; ++s) {
        pixel_series_destroy(&combination->light[s]);
        pixel_series_destroy(&combination->sums[s]);
    }
    pixel_series_destroy(&combination->direct);
    pixel_series_destroy(&combination->rare_whole);
    if (!combination->shares)
        shareable_destroy(combination);
    free(combination->earlier[0]);
    free(combination->earlier[1]);
    *combination = (Combination){0};
}

void combination_archive(Archive *archive, Combination *combination)
{
    for (int s = 0; s < SERIES_COUNT; ++s) {
        pixel_series_archive(archive, &combination->light[s]);
        pixel_series_archive(archive, &combination->sums[s]);
    }
    pixel_series_archive(archive, &combination->direct);
    pixel_series_archive(archive, &combination->rare_whole);
    if (!combination->shares)
        archive_bytes(archive, combination->known, combination_tile_count(combination) * sizeof *combination->known);
    for (int i = 0; i < 2; ++i)
        archive_bytes(archive, combination->earlier[i],
                      combination_patch_count(combination) * sizeof *combination->earlier[i]);
    ARCHIVE_FIELD(archive, combination->earlier_samples);
    ARCHIVE_FIELD(archive, combination->exponents);
    archive_flags(archive, combination->ready, SERIES_COUNT, "which variances are known");
    ARCHIVE_FIELD(archive, combination->chains_correlation);
    ARCHIVE_FIELD(archive, combination->rare_chains);
    ARCHIVE_FIELD(archive, combination->rare_paths);
    ARCHIVE_FIELD(archive, combination->best);
    ARCHIVE_FIELD(archive, combination->best_others);
    ARCHIVE_FIELD(archive, combination->weight);
    ARCHIVE_FIELD(archive, combination->paths_rare);
    archive_flags(archive, &combination->bidirectional_better, 1, "whether bidirectional path tracing is better");
    archive_flags(archive, &combination->rare_missed, 1, "whether path tracing misses rare light");
}

/* ---- a generation ------------------------------------------------------------------------------------------------ */

/* Whether the variances of all estimators that have samples are known; of bidirectional path tracing they need not
 * be. */
static bool combination_known(const Combination *combination, const double samples[ESTIMATOR_COUNT])
{
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        if (s != ESTIMATOR_BIDIRECTIONAL && samples[s] > 0.0 && !combination->ready[s])
            return false;
    return !combination->paths_trusted || samples[ESTIMATOR_CHAINS] <= 0.0 ||
           pixel_series_pictures(&combination->sums[ESTIMATOR_CHAINS], 0) >= CHAINS_KNOWN;
}

/* Sets the tile's weights, which add up to 1. Until variances are known, they are proportional to work, and chains have
 * the weight of the pool they start from; rare light is the chains' alone. So a large picture, of which the first pools
 * visit few pixels, shows mostly path tracing at first, and nothing else where that is trusted with rare light. */
static void weights_set(const Combination *combination, CombinationTile *tile, bool known,
                        const CombinationTerms *terms)
{
    const int shown = combination->shown;
    const double *samples = terms->samples;
    memset(tile->weight, 0, sizeof tile->weight);
    tile->paths_rare = 0.0;
    const bool trusted = shown == 0 && !known && combination->paths_trusted;
    const bool alone = shown == SHOWN_PATHS_ALONE || trusted || !(samples[ESTIMATOR_CHAINS] > 0.0);
    if (alone && samples[ESTIMATOR_PATHS] > 0.0) {
        tile->weight[ESTIMATOR_PATHS] = tile->paths_rare = 1.0;
    } else if (shown > 0 && shown <= ESTIMATOR_COUNT && samples[shown - 1] > 0.0) {
        tile->weight[shown - 1] = 1.0;
    } else if (known) {
        TileCombination best = tile_combination(tile, terms);
        const double others = 1.0 - best.bidirectional;
        tile->weight[ESTIMATOR_BIDIRECTIONAL] = best.bidirectional;
        tile->weight[ESTIMATOR_PATHS] = others * best.paths;
        tile->weight[ESTIMATOR_CHAINS] = others * (1.0 - best.paths) * best.chains;
        tile->weight[ESTIMATOR_POOL] = others * (1.0 - best.paths) * (1.0 - best.chains);
        tile->paths_rare = best.paths_rare;
    } else {
        double pool = estimator_cost(ESTIMATOR_POOL) * samples[ESTIMATOR_POOL];
        double paths = FIRST_PATHS * estimator_cost(ESTIMATOR_PATHS) * samples[ESTIMATOR_PATHS];
        double bidirectional = estimator_work(ESTIMATOR_BIDIRECTIONAL, samples);
        double all = 2.0 * pool + paths + bidirectional;
        tile->weight[ESTIMATOR_CHAINS] = tile->weight[ESTIMATOR_POOL] = pool / all;
        tile->weight[ESTIMATOR_PATHS] = paths / all;
        tile->weight[ESTIMATOR_BIDIRECTIONAL] = bidirectional / all;
    }
}

/* Weight of a generation's picture in that of all: in inverse proportion to its variance, as its work is if all divide
 * work alike. Generations in which work was divided otherwise, such as those without path tracing, count by the error
 * expected of that, relative to the best division without bidirectional path tracing, so that those before and with it
 * compare; and, but for bidirectional path tracing, less while variances are not known. */
static double generation_worth(const Combination *combination, const double samples[ESTIMATOR_COUNT], bool known)
{
    double work = estimators_work(samples), bidirectional = estimator_work(ESTIMATOR_BIDIRECTIONAL, samples),
           best[ESTIMATOR_COUNT], most = bidirectional > 0.0 ? WORTH_BIDIRECTIONAL_MOST : WORTH_MOST;
    if (!known || !(combination->best[ESTIMATOR_PATHS] > 0.0) ||
        (bidirectional > 0.0 && !combination->ready[ESTIMATOR_BIDIRECTIONAL]))
        return FIRST_WORTH * (work - bidirectional) + bidirectional;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        best[s] = combination->best_others[s] * work / estimators_work(combination->best_others);
    double own = combination_error(combination, samples, false, 1);
    return own > 0.0 ? work * fmin(combination_error(combination, best, false, 1) / own, most) : work;
}

static void weights_average(Combination *combination)
{
    const double part = 1.0 / (double)combination_tile_count(combination);
    memset(combination->weight, 0, sizeof combination->weight);
    combination->paths_rare = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        for (int s = 0; s < ESTIMATOR_COUNT; ++s)
            combination->weight[s] += combination->known[i].weight[s] * part;
        combination->paths_rare += combination->known[i].paths_rare * part;
    }
}

uint64_t combination_weights_set(Combination *combination, const double samples[ESTIMATOR_COUNT])
{
    double shown[ESTIMATOR_COUNT];
    memcpy(shown, samples, sizeof shown);
    if (combination->bidirectional_trial)
        shown[ESTIMATOR_BIDIRECTIONAL] = 0.0;
    bool known = combination_known(combination, shown);
    const CombinationTerms terms = combination_terms(combination, shown, 1.0, 1);
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        weights_set(combination, &combination->known[i], known, &terms);
    weights_average(combination);
    return (uint64_t)fmax(1.0, rint(generation_worth(combination, shown, known)));
}

void combination_errors(const Combination *combination, const double samples[ESTIMATOR_COUNT], double *errors)
{
    double light = combination_mean_light(combination);
    const CombinationTerms terms = combination_terms(combination, samples, 1.0, 1);
    bool known = combination_known(combination, samples) && light > 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile *tile = &combination->known[i];
        errors[i] = known ? tile_combination(tile, &terms).variance / tile_relative_square(tile, light) : 0.0;
    }
}
