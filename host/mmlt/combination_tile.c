#include "mmlt/combination_tile.h"

#include "mmlt/combination_rare.h"
#include "mmlt/tuning.h"

#include <math.h>

/* ---- a tile ------------------------------------------------------------------------------------------------------ */

/* A variance in the range where weights in inverse proportion to it are numbers; NaN counts as none. */
static double spread_clamp(double spread)
{
    return fmin(fmax(spread, SPREAD_MIN), SPREAD_MAX);
}

/* The weight of one estimate against another, in inverse proportion to their variances. */
static double weight_against(double own, double other)
{
    return spread_clamp(other) / (spread_clamp(own) + spread_clamp(other));
}

/* The terms for these numbers of samples. The largest weight that path tracing's own rare light may have in a tile,
 * against the chains', is that by the variances of all tiles together: a tile states too small a variance as long as it
 * has not met one of the paths, which are fireflies. factor: of the chains' variance. */
static CombinationTerms others_terms(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                                     double factor)
{
    CombinationTerms terms = {.samples = samples, .correlation = combination->chains_correlation};
    if (!(samples[ESTIMATOR_PATHS] > 0.0) || combination_rare_hidden(combination))
        return terms;
    const double own = combination->rare_paths / samples[ESTIMATOR_PATHS],
                 chains =
                     RARE_DOUBT * terms.correlation * factor * combination->rare_chains / samples[ESTIMATOR_CHAINS];
    terms.rare_most = combination->paths_trusted ? 1.0 : weight_against(own, chains);
    return terms;
}

/* Combines two estimates: chains and pool plus excess, of variance a, and path tracing plus rare, of variance b. Rare
 * light is path tracing's own, of weight v, and the chains'. The latter and the excess come from the same chains, hence
 * the covariance c. The weight w of the second estimate minimises (1 - w)^2 a + w^2 b + 2 w (1 - w) c, the variance of
 * the whole tile's mean: hence the correlation. Weights are in [0, 1] for any variances, those that are infinite or NaN
 * included. Path tracing alone shows all light. */
static TileCombination others_combination(const CombinationTile *tile, const CombinationTerms *terms)
{
    const double *spread = tile->spread, *samples = terms->samples;
    if (!(samples[ESTIMATOR_CHAINS] > 0.0))
        return (TileCombination){.paths = 1.0,
                                 .paths_rare = 1.0,
                                 .variance = (fmax(spread[ESTIMATOR_PATHS], SPREAD_MIN) + spread[SERIES_PATHS_RARE]) /
                                             samples[ESTIMATOR_PATHS]};
    double by_chains = samples[ESTIMATOR_CHAINS] / spread_clamp(spread[ESTIMATOR_CHAINS]);
    double by_pool = samples[ESTIMATOR_POOL] / spread_clamp(spread[ESTIMATOR_POOL]);
    double a = terms->correlation * (1.0 / (by_chains + by_pool) + spread[SERIES_EXCESS] / samples[ESTIMATOR_CHAINS]);
    TileCombination best = {.chains = by_chains / (by_chains + by_pool), .variance = a};
    if (!(samples[ESTIMATOR_PATHS] > 0.0))
        return best;
    double rare = terms->correlation * spread[SERIES_RARE] / samples[ESTIMATOR_CHAINS],
           own = spread[SERIES_PATHS_RARE] / samples[ESTIMATOR_PATHS],
           v = fmin(weight_against(own, RARE_DOUBT * rare), terms->rare_most),
           c = (1.0 - v) * best.chains * fmin(rare, a);
    double b = fmax(spread[ESTIMATOR_PATHS], SPREAD_MIN) / samples[ESTIMATOR_PATHS] + (1.0 - v) * (1.0 - v) * rare +
               v * v * own,
           both = a + b - 2.0 * c;
    best.paths_rare = v;
    best.paths = both > 0.0 ? fmin(fmax((a - c) / both, 0.0), 1.0) : 0.0;
    best.variance = (1.0 - best.paths) * (1.0 - best.paths) * a + best.paths * best.paths * b +
                    2.0 * best.paths * (1.0 - best.paths) * c;
    return best;
}

/* Adds bidirectional path tracing, whose errors are independent of those of the others. */
TileCombination tile_combination(const CombinationTile *tile, const CombinationTerms *terms)
{
    TileCombination best = others_combination(tile, terms);
    best.bidirectional = terms->bidirectional_first;
    if (!(terms->bidirectional_most > 0.0))
        return best;
    double own = tile->spread[ESTIMATOR_BIDIRECTIONAL] / terms->samples[ESTIMATOR_BIDIRECTIONAL],
           w = fmin(weight_against(own, best.variance), terms->bidirectional_most);
    best.bidirectional = w;
    best.variance = w * w * own + (1.0 - w) * (1.0 - w) * best.variance;
    return best;
}

/* A tile with the chains' variances times `factor`. */
static CombinationTile tile_varied(const CombinationTile *known, double factor)
{
    CombinationTile tile = *known;
    tile.spread[ESTIMATOR_CHAINS] *= factor;
    tile.spread[SERIES_EXCESS] *= factor;
    tile.spread[SERIES_RARE] *= factor;
    return tile;
}

/* If the variance of bidirectional path tracing is known: in no tile has it more weight than by the variances of all
 * tiles together, since it has fireflies. */
CombinationTerms combination_terms(const Combination *combination, const double samples[ESTIMATOR_COUNT], double factor,
                                   size_t every)
{
    CombinationTerms terms = others_terms(combination, samples, factor);
    double own = 0.0, others = 0.0, light = combination_mean_light(combination);
    if (!combination->ready[ESTIMATOR_BIDIRECTIONAL])
        terms.bidirectional_first =
            estimator_work(ESTIMATOR_BIDIRECTIONAL, samples) / fmax(estimators_work(samples), SPREAD_MIN);
    if (!(samples[ESTIMATOR_BIDIRECTIONAL] > 0.0) || !combination->ready[ESTIMATOR_BIDIRECTIONAL])
        return terms;
    for (size_t i = 0; i < combination_tile_count(combination); i += every) {
        const CombinationTile tile = tile_varied(&combination->known[i], factor);
        double square = tile_relative_square(&tile, light);
        own += tile.spread[ESTIMATOR_BIDIRECTIONAL] / square;
        others += others_combination(&tile, &terms).variance / square;
    }
    terms.bidirectional_most = weight_against(own / samples[ESTIMATOR_BIDIRECTIONAL], others);
    return terms;
}

/* ---- the picture -------------------------------------------------------------------------------------------------- */

/* Variance of a chain's step that pool_per_step pool samples accompany, relative to b, the variance within chains: 1 +
 * (a / b) (cost of all steps / cost of all pool samples). */
static double step_variance(double pool_per_step)
{
    const double root = POOL_PART / (1.0 - POOL_PART);
    return 1.0 + root * root * estimator_cost(ESTIMATOR_CHAINS) / (estimator_cost(ESTIMATOR_POOL) * pool_per_step);
}

/* Variance of a step under a plan, relative to its variance with the pools so far; 1 without chains. */
static double chains_factor(const Combination *combination, const double samples[ESTIMATOR_COUNT])
{
    if (!(samples[ESTIMATOR_CHAINS] > 0.0))
        return 1.0;
    double pools = pixel_series_weight(&combination->sums[ESTIMATOR_POOL], 0),
           steps = pixel_series_weight(&combination->sums[ESTIMATOR_CHAINS], 0);
    return step_variance(samples[ESTIMATOR_POOL] / samples[ESTIMATOR_CHAINS]) / step_variance(pools / steps);
}

double combination_error(const Combination *combination, const double samples[ESTIMATOR_COUNT], bool with_direct,
                         size_t every)
{
    double sum = 0.0, light = combination_mean_light(combination), factor = chains_factor(combination, samples);
    const CombinationTerms terms = combination_terms(combination, samples, factor, every);
    for (size_t i = 0; i < combination_tile_count(combination); i += every) {
        const CombinationTile tile = tile_varied(&combination->known[i], factor);
        double direct = with_direct ? tile.direct / (samples[ESTIMATOR_PATHS] + samples[ESTIMATOR_BIDIRECTIONAL]) : 0.0;
        sum += (tile_combination(&tile, &terms).variance + direct) / tile_relative_square(&tile, light);
    }
    return sum;
}
