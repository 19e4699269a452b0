#include "mmlt/combination_rare.h"

#include "mmlt/tuning.h"

#include <float.h>
#include <math.h>

/* The mean of a series in the whole image, in luminances summed over its pixels. */
static double image_light(const Combination *combination, int s)
{
    double sum = 0.0;
    for (size_t i = 0; i < combination_tile_count(combination); ++i)
        sum += (double)combination->sums[s].mean[i];
    return sum;
}

/* Variances of tiles do not tell how well the whole is known, since errors of chains are alike in many tiles. So the
 * whole has a series of its own. Its latest picture is what has changed the mean of the tiles since; none that is too
 * bright for a series. */
static void image_learn(Combination *combination)
{
    PixelSeries *whole = &combination->rare_whole;
    double weight = pixel_series_weight(&combination->sums[SERIES_RARE], 0), before = pixel_series_weight(whole, 0);
    if (!(weight > before))
        return;
    double light = weight * image_light(combination, SERIES_RARE) - before * (double)whole->mean[0],
           latest = light / (weight - before);
    if (!(fabs(latest) < (double)FLT_MAX))
        return;
    float picture = (float)latest;
    pixel_series_add(whole, &picture, NULL, weight - before);
}

void combination_rare_update(Combination *combination)
{
    image_learn(combination);
    PixelStatistics chains = pixel_series_statistics(&combination->rare_whole, NULL, 0);
    double light = (double)combination_tile_count(combination) * combination_mean_light(combination),
           error = RARE_MISSED_DEVIATIONS * sqrt(chains.spread / chains.weight),
           doubt = fmax(error, RARE_MISSED_PART * light), own = image_light(combination, SERIES_PATHS_RARE);
    combination->rare_missed = chains.pictures > 1 && (error > RARE_KNOWN_PART * light || own < chains.mean - doubt);
}

bool combination_rare_hidden(const Combination *combination)
{
    return !combination->paths_trusted && (combination->hidden || combination->rare_missed);
}
