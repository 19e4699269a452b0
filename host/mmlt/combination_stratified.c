#include "mmlt/combination_stratified.h"

#include "mmlt/tuning.h"

#include <math.h>

/* Path tracing of two replicas, or of both now and earlier. */
typedef struct Comparison {
    Combination *combination;
    const Combination *other;
    double indirect, direct; /* mean luminances of a patch */
    double shrink[2]; /* of indirect and direct light: 1 / earlier samples - 1 / all samples */
} Comparison;

/* ---- two sequences ----------------------------------------------------------------------------------------------- */

static void row_replicas(void *context, size_t row)
{
    const Comparison *comparison = context;
    const Combination *a = comparison->combination, *b = comparison->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect = pixel_series_compare(&a->light[ESTIMATOR_PATHS], &b->light[ESTIMATOR_PATHS], window,
                                                 DARK_PART * comparison->indirect * comparison->indirect);
    a->rows[row].direct =
        pixel_series_compare(&a->direct, &b->direct, window, DARK_PART * comparison->direct * comparison->direct);
}

/* ---- one sequence ------------------------------------------------------------------------------------------------ */

/* The mean over both replicas, which becomes the earlier one, compared with the latter. */
static PixelVariances mean_compare(const PixelSeries *a, const PixelSeries *b, float *earlier, RowRange patches,
                                   double dark, double shrink)
{
    PixelVariances sums = {0.0, 0.0};
    for (size_t i = patches.first; i < patches.end; ++i) {
        PixelStatistics now = pixel_series_statistics(a, b, i);
        double distance = now.mean - (double)earlier[i], square = now.mean * now.mean + dark;
        earlier[i] = (float)now.mean;
        if (square > 0.0) {
            sums.found += distance * distance / square;
            sums.stated += now.spread * shrink / square;
        }
    }
    return sums;
}

static void row_earlier(void *context, size_t row)
{
    const Comparison *comparison = context;
    Combination *a = comparison->combination;
    const Combination *b = comparison->other;
    RowRange patches = combination_row_patches(a, row);
    a->rows[row].indirect =
        mean_compare(&a->light[ESTIMATOR_PATHS], &b->light[ESTIMATOR_PATHS], a->earlier[0], patches,
                     DARK_PART * comparison->indirect * comparison->indirect, comparison->shrink[0]);
    a->rows[row].direct = mean_compare(&a->direct, &b->direct, a->earlier[1], patches,
                                       DARK_PART * comparison->direct * comparison->direct, comparison->shrink[1]);
}

/* Largest exponent of the variance of n samples, n^-exponent, that is told from others. */
#define EXPONENT_MOST 3.0

/* The exponent a of the variance V n^-a of a sequence's first n samples, from that of the difference between the means
 * of its first `few` and `many`, which for exchangeable parts is V few^-a - V many^-a, in units of what it is for a =
 * 1. */
static double exponent_of(double part, double few, double many)
{
    double low = 1.0, high = EXPONENT_MOST;
    for (int i = 0; i < 30; ++i) {
        double middle = 0.5 * (low + high);
        if (pow(few, -middle) - pow(many, -middle) > part * (1.0 / few - 1.0 / many))
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* ---- both -------------------------------------------------------------------------------------------------------- */

static void row_light(void *context, size_t row)
{
    const Comparison *comparison = context;
    const Combination *a = comparison->combination, *b = comparison->other;
    PixelWindow window = combination_row_window(a, row);
    a->rows[row].indirect_sum = pixel_series_sum(&a->light[ESTIMATOR_PATHS], &b->light[ESTIMATOR_PATHS], window);
    a->rows[row].direct_sum = pixel_series_sum(&a->direct, &b->direct, window);
}

/* Runs a comparison of every row. Returns the parts of the stated variances that are found. */
static StratifiedParts rows_compare(Comparison *comparison, ParallelPart *row_compare)
{
    Combination *combination = comparison->combination;
    PixelVariances indirect = {0.0, 0.0}, direct = {0.0, 0.0};
    comparison->indirect = comparison->direct = 0.0;
    combination_rows_run(combination, row_light, comparison);
    for (int row = 0; row < combination->tiles[1]; ++row) {
        comparison->indirect += combination->rows[row].indirect_sum / (double)combination->direct.pixels;
        comparison->direct += combination->rows[row].direct_sum / (double)combination->direct.pixels;
    }
    combination_rows_run(combination, row_compare, comparison);
    for (int row = 0; row < combination->tiles[1]; ++row) {
        indirect.found += combination->rows[row].indirect.found;
        indirect.stated += combination->rows[row].indirect.stated;
        direct.found += combination->rows[row].direct.found;
        direct.stated += combination->rows[row].direct.stated;
    }
    return (StratifiedParts){pixel_variances_left(indirect), pixel_variances_left(direct)};
}

/* Fewest samples per pixel of which a mean is kept to be compared with a later one. */
#define EARLIER_LEAST 4.0

/* Samples per pixel of a series of both replicas. */
static double samples_of(const Combination *combination, const PixelSeries *a, const PixelSeries *b)
{
    double pixels = (double)combination->size[0] * (double)combination->size[1];
    return (pixel_series_weight(a, 0) + pixel_series_weight(b, 0)) / pixels;
}

static StratifiedParts sequence_left(Combination *combination, const Combination *other)
{
    const double many[2] = {
        samples_of(combination, &combination->light[ESTIMATOR_PATHS], &other->light[ESTIMATOR_PATHS]),
        samples_of(combination, &combination->direct, &other->direct)};
    double *few = combination->earlier_samples, pixels = (double)combination->size[0] * (double)combination->size[1];
    Comparison comparison = {.combination = combination, .other = other};
    if (many[0] >= EARLIER_LEAST && many[0] >= 2.0 * few[0]) {
        bool earlier = few[0] > 0.0;
        for (int i = 0; i < 2; ++i)
            comparison.shrink[i] = earlier ? (1.0 / few[i] - 1.0 / many[i]) / pixels : 0.0;
        StratifiedParts parts = rows_compare(&comparison, row_earlier);
        if (earlier) {
            combination->exponents[0] = exponent_of(parts.indirect, few[0], many[0]);
            combination->exponents[1] = exponent_of(parts.direct, few[1], many[1]);
        }
        few[0] = many[0];
        few[1] = many[1];
    }
    return (StratifiedParts){pow(fmax(many[0], 1.0), 1.0 - combination->exponents[0]),
                             pow(fmax(many[1], 1.0), 1.0 - combination->exponents[1])};
}

StratifiedParts combination_stratified(Combination *combination, const Combination *other)
{
    Comparison comparison = {.combination = combination, .other = other};
    if (other == combination)
        return (StratifiedParts){1.0, 1.0};
    return combination->one_sequence ? sequence_left(combination, other) : rows_compare(&comparison, row_replicas);
}
