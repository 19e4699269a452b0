#include "mmlt/test_combination_model.h"

#include "mmlt/tuning.h"

/* The pools' part of the time of pools and chains together if only these matter (test_plan in
 * mmlt/test_combination.c). */
#define POOL_TIME 0.45

double octaves(Known *known, double most)
{
    return exp2(most * (2.0 * test_random_unit(&known->state) - 1.0));
}

void known_tell(Known *known, double range)
{
    for (size_t i = 0; i < combination_tile_count(&known->combination); ++i) {
        CombinationTile *tile = &known->combination.known[i];
        for (int s = 0; s < SERIES_COUNT; ++s)
            tile->spread[s] = octaves(known, range);
        tile->direct = octaves(known, range);
        tile->light = octaves(known, 3.0);
    }
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        known->combination.sums[s].weight[0] = (float)octaves(known, 3.0);
    known->combination.rare_chains = octaves(known, range);
    known->combination.rare_paths = octaves(known, range);
    known->combination.chains_correlation = 2.0 * octaves(known, 1.0);
}

void known_init(Known *known, unsigned seed)
{
    Error error = {0};
    *known = (Known){.state = seed};
    ck_assert(film_init(&known->film, WIDTH, HEIGHT, (const int[4]){0, 0, WIDTH, HEIGHT}, &error));
    ck_assert(film_light_reserve(&known->film, &error));
    ck_assert(film_rare_reserve(&known->film, &error));
    ck_assert(combination_init(&known->combination, &known->film, &error));
    for (int s = 0; s < SERIES_COUNT; ++s)
        known->combination.ready[s] = s != ESTIMATOR_BIDIRECTIONAL;
    known_tell(known, 3.0);
}

void known_destroy(Known *known)
{
    film_destroy(&known->film);
    combination_destroy(&known->combination);
}

double rare_weight(const Combination *all, const CombinationTile *tile, const double samples[ESTIMATOR_COUNT],
                   double factor)
{
    if (all->hidden)
        return 0.0;
    double doubt = 2.0 * all->chains_correlation / samples[ESTIMATOR_CHAINS],
           chains = doubt * tile->spread[SERIES_RARE], all_chains = doubt * factor * all->rare_chains;
    return fmin(chains / (chains + tile->spread[SERIES_PATHS_RARE] / samples[ESTIMATOR_PATHS]),
                all_chains / (all_chains + all->rare_paths / samples[ESTIMATOR_PATHS]));
}

double combined_variance(const TileTerms *terms, double w, double c)
{
    const CombinationTile *tile = terms->tile;
    const double *samples = terms->samples, v = terms->v;
    double by_chains = terms->correlation * tile->spread[SERIES_RARE] / samples[ESTIMATOR_CHAINS],
           rare =
               v * v * tile->spread[SERIES_PATHS_RARE] / samples[ESTIMATOR_PATHS] + (1.0 - v) * (1.0 - v) * by_chains;
    double others = c * c * tile->spread[ESTIMATOR_CHAINS] / samples[ESTIMATOR_CHAINS] +
                    (1.0 - c) * (1.0 - c) * tile->spread[ESTIMATOR_POOL] / samples[ESTIMATOR_POOL] +
                    tile->spread[SERIES_EXCESS] / samples[ESTIMATOR_CHAINS];
    others *= terms->correlation;
    double paths = tile->spread[ESTIMATOR_PATHS] / samples[ESTIMATOR_PATHS] + rare;
    if (!(w > 0.0))
        return others; /* also if path tracing has no samples */
    return (1.0 - w) * (1.0 - w) * others + w * w * paths +
           2.0 * w * (1.0 - w) * c * (1.0 - v) * fmin(by_chains, others);
}

double weight_search(const TileTerms *terms, bool of_paths, double c)
{
    double low = 0.0, high = 1.0;
    for (int step = 0; step < 100; ++step) {
        double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        double at_a = of_paths ? combined_variance(terms, a, c) : combined_variance(terms, 0.0, a);
        double at_b = of_paths ? combined_variance(terms, b, c) : combined_variance(terms, 0.0, b);
        *(at_a < at_b ? &high : &low) = at_a < at_b ? b : a;
    }
    return 0.5 * (low + high);
}

double least_variance(const TileTerms *terms, double *w, double *c)
{
    *c = weight_search(terms, false, 0.0);
    *w = weight_search(terms, true, *c);
    return combined_variance(terms, *w, *c);
}

double dark_square(const Combination *combination)
{
    double light = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        light += combination->known[i].light / (double)combination_tile_count(combination);
    return DARK_PART * light * light;
}

double chains_vary(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                   const double costs[ESTIMATOR_COUNT])
{
    double a = POOL_TIME * POOL_TIME, b = (1.0 - POOL_TIME) * (1.0 - POOL_TIME);
    double pools = (double)combination->sums[ESTIMATOR_POOL].weight[0],
           steps = (double)combination->sums[ESTIMATOR_CHAINS].weight[0];
    double now =
        a * samples[ESTIMATOR_CHAINS] * costs[ESTIMATOR_CHAINS] / (samples[ESTIMATOR_POOL] * costs[ESTIMATOR_POOL]) + b;
    double before = a * steps * costs[ESTIMATOR_CHAINS] / (pools * costs[ESTIMATOR_POOL]) + b;
    return now / before;
}

CombinationTile tile_with(const Combination *combination, size_t tile, double factor)
{
    CombinationTile varied = combination->known[tile];
    varied.spread[ESTIMATOR_CHAINS] *= factor;
    varied.spread[SERIES_EXCESS] *= factor;
    varied.spread[SERIES_RARE] *= factor;
    return varied;
}

double picture_error(const Combination *combination, const double samples[ESTIMATOR_COUNT],
                     const double costs[ESTIMATOR_COUNT])
{
    double sum = 0.0, w, c, factor = chains_vary(combination, samples, costs), dark = dark_square(combination);
    for (size_t i = 0; i < combination_tile_count(combination); ++i) {
        const CombinationTile tile = tile_with(combination, i, factor);
        const TileTerms terms = {&tile, samples, rare_weight(combination, &tile, samples, factor),
                                 combination->chains_correlation};
        sum += (least_variance(&terms, &w, &c) + tile.direct / samples[ESTIMATOR_PATHS]) /
               (tile.light * tile.light + dark);
    }
    return sum;
}
