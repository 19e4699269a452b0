#include "mmlt/combination.h"

#include "camera/film_sum.h"
#include "mmlt/combination_rare.h"
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

/* The optimal combination for a tile, given the samples of each estimator. */
typedef struct TileCombination {
    /* weight of path tracing plus rare, against chains and pool plus excess */
    double paths;
    double chains; /* weight of the chains against the pool; both share the excess */
    double paths_rare; /* weight of path tracing's own rare light against the chains' */
    double bidirectional; /* weight of bidirectional path tracing against all others */
    double variance;
} TileCombination;

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

/* What the combinations of all tiles have in common. */
typedef struct CombinationTerms {
    const double *samples; /* of each estimator */
    double correlation; /* Combination.chains_correlation */
    double rare_most; /* largest weight of path tracing's own rare light */
    double bidirectional_most; /* largest weight of bidirectional path tracing */
    double bidirectional_first; /* its weight if its variance is not known */
} CombinationTerms;

/* The terms for these numbers of samples. The largest weight that path tracing's own rare light may have in a tile,
 * against the chains', is that by the variances of all tiles together: a tile states too small a variance as long as it
 * has not met one of the paths, which are fireflies. factor: of the chains' variance. */
static CombinationTerms others_terms(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                                     double factor)
{
    CombinationTerms terms = {.samples = samples, .correlation = combination->chains_correlation};
    if (samples[ESTIMATOR_PATHS] > 0.0 && !combination_rare_hidden(combination))
        terms.rare_most = weight_against(combination->rare_paths / samples[ESTIMATOR_PATHS],
                                         RARE_DOUBT * terms.correlation * factor * combination->rare_chains /
                                             samples[ESTIMATOR_CHAINS]);
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
static TileCombination tile_combination(const CombinationTile *tile, const CombinationTerms *terms)
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

static double bidirectional_work(const double samples[ESTIMATOR_COUNT])
{
    return estimator_cost(ESTIMATOR_BIDIRECTIONAL) * samples[ESTIMATOR_BIDIRECTIONAL];
}

/* The terms with bidirectional path tracing. If its variance is known: in no tile has it more weight than by the
 * variances of all tiles together, since it has fireflies. every: of one tile in so many. */
static CombinationTerms terms_of(const Combination *combination, const double samples[ESTIMATOR_COUNT], double factor,
                                 size_t every)
{
    CombinationTerms terms = others_terms(combination, samples, factor);
    double own = 0.0, others = 0.0, light = combination_mean_light(combination);
    if (!combination->ready[ESTIMATOR_BIDIRECTIONAL])
        terms.bidirectional_first = bidirectional_work(samples) / fmax(estimators_work(samples), SPREAD_MIN);
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

/* ---- errors ------------------------------------------------------------------------------------------------------ */

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

/* Relative square error of the picture (up to a constant factor) from this many samples of each estimator. with_direct:
 * of all light, and not just of what is combined. every: of one tile in so many. */
static double error_of(const Combination *combination, const double samples[ESTIMATOR_COUNT], bool with_direct,
                       size_t every)
{
    double sum = 0.0, light = combination_mean_light(combination), factor = chains_factor(combination, samples);
    const CombinationTerms terms = terms_of(combination, samples, factor, every);
    for (size_t i = 0; i < combination_tile_count(combination); i += every) {
        const CombinationTile tile = tile_varied(&combination->known[i], factor);
        double direct = with_direct ? tile.direct / samples[ESTIMATOR_PATHS] : 0.0;
        sum += (tile_combination(&tile, &terms).variance + direct) / tile_relative_square(&tile, light);
    }
    return sum;
}

/* Whether the variances of all estimators that have samples are known; of bidirectional path tracing they need not
 * be. */
static bool combination_known(const Combination *combination, const double samples[ESTIMATOR_COUNT])
{
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        if (s != ESTIMATOR_BIDIRECTIONAL && samples[s] > 0.0 && !combination->ready[s])
            return false;
    return true;
}

/* Sets the tile's weights, which add up to 1. Until variances are known, they are proportional to work, and chains have
 * the weight of the pool they start from; rare light is the chains' alone. So a large picture, of which the first pools
 * visit few pixels, shows mostly path tracing at first. */
static void weights_set(const Combination *combination, CombinationTile *tile, bool known,
                        const CombinationTerms *terms)
{
    const int shown = combination->shown;
    const double *samples = terms->samples;
    memset(tile->weight, 0, sizeof tile->weight);
    tile->paths_rare = 0.0;
    const bool alone = shown == SHOWN_PATHS_ALONE || !(samples[ESTIMATOR_CHAINS] > 0.0);
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
        double bidirectional = bidirectional_work(samples);
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
    double work = estimators_work(samples), bidirectional = bidirectional_work(samples), best[ESTIMATOR_COUNT],
           most = bidirectional > 0.0 ? WORTH_BIDIRECTIONAL_MOST : WORTH_MOST;
    if (!known || !(combination->best[ESTIMATOR_PATHS] > 0.0) ||
        (bidirectional > 0.0 && !combination->ready[ESTIMATOR_BIDIRECTIONAL]))
        return FIRST_WORTH * (work - bidirectional) + bidirectional;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        best[s] = combination->best_others[s] * work / estimators_work(combination->best_others);
    double own = error_of(combination, samples, false, 1);
    return own > 0.0 ? work * fmin(error_of(combination, best, false, 1) / own, most) : work;
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
    const CombinationTerms terms = terms_of(combination, shown, 1.0, 1);
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        weights_set(combination, &combination->known[i], known, &terms);
    weights_average(combination);
    return (uint64_t)fmax(1.0, rint(generation_worth(combination, shown, known)));
}

/* ---- how much of each -------------------------------------------------------------------------------------------- */

void combination_errors(const Combination *combination, const double samples[ESTIMATOR_COUNT], double *errors)
{
    double light = combination_mean_light(combination);
    const CombinationTerms terms = terms_of(combination, samples, 1.0, 1);
    bool known = combination_known(combination, samples) && light > 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile *tile = &combination->known[i];
        double square = tile->light * tile->light + DARK_PART * light * light;
        errors[i] = known ? tile_combination(tile, &terms).variance / square : 0.0;
    }
}

/* A division of work, and the error of the picture by it. */
typedef struct SearchBest {
    double samples[ESTIMATOR_COUNT], error;
} SearchBest;

/* Adopts a division of work if it has less error. work: parts of the estimators. */
static void search_try(const Combination *combination, size_t every, const double work[ESTIMATOR_COUNT],
                       SearchBest *best)
{
    SearchBest tried;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        tried.samples[s] = work[s] / estimator_cost((EstimatorKind)s);
    tried.error = error_of(combination, tried.samples, true, every);
    if (tried.error < best->error)
        *best = tried;
}

static int search_threads(const Combination *combination)
{
    return combination_tile_count(combination) < PLAN_TILES ? 1 : combination->threads;
}

/* The best division of work for each part of path tracing. Chains and pools have one part each or more, or half a part
 * each. */
typedef struct RatesSearch {
    const Combination *combination;
    size_t every;
    SearchBest best[PLAN_PARTS];
} RatesSearch;

static void rates_of_paths(void *context, size_t paths)
{
    RatesSearch *search = context;
    search->best[paths].error = HUGE_VAL;
    const size_t rest = PLAN_PARTS - paths, most = rest > 1 ? rest - 1 : 1;
    for (size_t pool = 1; paths > 0 && pool <= most; ++pool) {
        const double part = rest > 1 ? (double)pool : 0.5;
        const double work[ESTIMATOR_COUNT] = {(double)rest - part, part, (double)paths};
        search_try(search->combination, search->every, work, &search->best[paths]);
    }
}

/* More than any samples of an estimator per step of a chain: of PLAN_PARTS parts chains have more than one in
 * PLAN_PARTS of a part. */
static double rate_most(EstimatorKind kind)
{
    return PLAN_PARTS * PLAN_PARTS * estimator_cost(ESTIMATOR_CHAINS) / estimator_cost(kind);
}

void step_rates_archive(Archive *archive, StepRates *rates)
{
    const double least = estimator_cost(ESTIMATOR_CHAINS) / (PLAN_PARTS * estimator_cost(ESTIMATOR_PATHS));
    archive_doubles(archive, &rates->paths, 1, (NumberRange){least, rate_most(ESTIMATOR_PATHS)},
                    "samples of path tracing per step");
    archive_doubles(archive, &rates->pool, 1, (NumberRange){POOL_PER_STEP, rate_most(ESTIMATOR_POOL)},
                    "samples of a pool per step");
}

void step_rate_archive_bidirectional(Archive *archive, StepRates *rates)
{
    archive_doubles(archive, &rates->bidirectional, 1, (NumberRange){0.0, rate_most(ESTIMATOR_BIDIRECTIONAL)},
                    "samples of bidirectional path tracing per step");
}

/* The best division of work for each part of bidirectional path tracing, at least one. Chains and pools divide what path
 * tracing leaves as they do without it. */
typedef struct BidirectionalSearch {
    const Combination *combination;
    size_t every;
    double chains; /* their part of what chains and pools have together */
    SearchBest best[PLAN_PARTS];
} BidirectionalSearch;

static void rates_of_bidirectional(void *context, size_t parts)
{
    BidirectionalSearch *search = context;
    search->best[parts].error = HUGE_VAL;
    for (size_t paths = 1; parts > 0 && parts + paths < PLAN_PARTS; ++paths) {
        const double rest = (double)(PLAN_PARTS - parts - paths);
        const double work[ESTIMATOR_COUNT] = {search->chains * rest, (1.0 - search->chains) * rest, (double)paths,
                                              (double)parts};
        search_try(search->combination, search->every, work, &search->best[parts]);
    }
}

/* Divides work anew if that with bidirectional path tracing is better. */
static void bidirectional_divide(Combination *combination, size_t every, SearchBest *best)
{
    const double chains = estimator_cost(ESTIMATOR_CHAINS) * best->samples[ESTIMATOR_CHAINS],
                 pool = estimator_cost(ESTIMATOR_POOL) * best->samples[ESTIMATOR_POOL],
                 least = (combination->opened ? BIDIRECTIONAL_ERROR_OPENED : BIDIRECTIONAL_ERROR) * best->error;
    BidirectionalSearch search = {.combination = combination, .every = every, .chains = chains / (chains + pool)};
    combination->bidirectional_better = false;
    if (!combination->ready[ESTIMATOR_BIDIRECTIONAL])
        return;
    parallel_run(PLAN_PARTS, search_threads(combination), rates_of_bidirectional, &search);
    for (size_t parts = 1; parts < PLAN_PARTS; ++parts)
        if (search.best[parts].error < best->error && search.best[parts].error < least) {
            *best = search.best[parts];
            combination->bidirectional_better = true;
        }
}

StepRates combination_rates(Combination *combination)
{
    /* odd, so that it is no divisor of most widths */
    RatesSearch search = {.combination = combination, .every = combination_tile_count(combination) / PLAN_TILES | 1u};
    size_t best = 0;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        if (s != ESTIMATOR_BIDIRECTIONAL && !combination->ready[s])
            return (StepRates){0};
    parallel_run(PLAN_PARTS, search_threads(combination), rates_of_paths, &search);
    for (size_t paths = 1; paths < PLAN_PARTS; ++paths)
        if (search.best[paths].error < search.best[best].error)
            best = paths;
    if (best == 0)
        return (StepRates){0};
    const double *samples = search.best[best].samples;
    memcpy(combination->best_others, samples, sizeof search.best[best].samples);
    bidirectional_divide(combination, search.every, &search.best[best]);
    memcpy(combination->best, samples, sizeof search.best[best].samples);
    return (StepRates){.paths = samples[ESTIMATOR_PATHS] / samples[ESTIMATOR_CHAINS],
                       .pool = samples[ESTIMATOR_POOL] / samples[ESTIMATOR_CHAINS],
                       .bidirectional = samples[ESTIMATOR_BIDIRECTIONAL] / samples[ESTIMATOR_CHAINS]};
}

double combination_alone_error(const Combination *combination)
{
    const double *best = combination->best,
                 alone[ESTIMATOR_COUNT] = {[ESTIMATOR_PATHS] = estimators_work(best) / estimator_cost(ESTIMATOR_PATHS)};
    if (!(best[ESTIMATOR_PATHS] > 0.0) || combination_rare_hidden(combination))
        return HUGE_VAL;
    return error_of(combination, alone, true, 1) / fmax(error_of(combination, best, true, 1), SPREAD_MIN);
}
