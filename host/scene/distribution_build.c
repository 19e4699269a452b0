#include "scene/distribution_build.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* ---- alias tables ---------------------------------------------------------------------------------------------- */

typedef struct AliasWork {
    double *rest; /* remaining weight of each index, in units of a bucket: weight / mean */
    uint *order; /* two stacks: indices below one bucket from the left, the others from the right */
    size_t small, large; /* sizes of the stacks */
    size_t n;
    double rounding; /* sum of (q as float - q) so far, kept below 2^-24 by choosing how to round */
} AliasWork;

/* Compensated summation (Neumaier 1974): a relative error of 1e-11 in the mean would add up over a million buckets and
 * show in the last ones. */
static bool alias_sum(const double *weights, size_t n, double *sum, uint *heaviest, Error *error)
{
    double total = 0.0, lost = 0.0;
    *heaviest = 0;
    for (size_t i = 0; i < n; ++i) {
        if (!(weights[i] >= 0.0) || isinf(weights[i])) {
            error_set(error, "weight %zu of a distribution is %g", i, weights[i]);
            return error_fix(error, "weights must be finite and not negative");
        }
        double next = total + weights[i];
        lost += total >= weights[i] ? (total - next) + weights[i] : (weights[i] - next) + total;
        total = next;
        if (weights[i] > weights[*heaviest])
            *heaviest = (uint)i;
    }
    *sum = total + lost;
    if (total > 0.0 && !isinf(total))
        return true;
    error_set(error, total > 0.0 ? "the weights of a distribution have an infinite sum"
                                 : "no weight of a distribution is positive");
    return error_fix(error, "give at least one entry a positive, finite weight");
}

static void alias_push(AliasWork *work, uint i)
{
    if (work->rest[i] < 1.0)
        work->order[work->small++] = i;
    else
        work->order[work->n - ++work->large] = i;
}

/* Rounds q up or down to a float such that errors cancel, instead of accumulating in the buckets filled last. */
static float alias_round(AliasWork *work, double q)
{
    float rounded = (float)q;
    if ((double)rounded - q > 0.0 && work->rounding > 0.0)
        rounded = nextafterf(rounded, 0.0f);
    else if ((double)rounded - q < 0.0 && work->rounding < 0.0)
        rounded = nextafterf(rounded, 1.0f);
    work->rounding += (double)rounded - q;
    return rounded;
}

/* Fills the buckets of small indices with the excess of large ones. An index of weight 0 gets q = 0. */
static void alias_fill(AliasWork *work, uint heaviest, AliasBucket *out)
{
    while (work->small > 0 && work->large > 0) {
        uint small = work->order[--work->small];
        uint large = work->order[work->n - work->large--];
        out[small].q = alias_round(work, work->rest[small]);
        out[small].alias = large;
        work->rest[large] -= 1.0 - (double)out[small].q;
        alias_push(work, large);
    }
    for (; work->large > 0; --work->large) {
        uint i = work->order[work->n - work->large];
        out[i].q = 1.0f;
        out[i].alias = i;
    }
    /* rounding left these without a partner: they are empty, or full to within 1e-7 */
    for (; work->small > 0; --work->small) {
        uint i = work->order[work->small - 1];
        out[i].q = (float)work->rest[i];
        out[i].alias = heaviest;
    }
}

bool alias_build(const double *weights, size_t n, AliasBucket *out, Error *error)
{
    if (n == 0 || n >= NONE)
        return error_set(error, "a distribution of %zu entries", n);
    double sum = 0.0;
    uint heaviest;
    if (!alias_sum(weights, n, &sum, &heaviest, error))
        return false;
    AliasWork work = {.n = n};
    work.rest = malloc(n * sizeof *work.rest);
    work.order = malloc(n * sizeof *work.order);
    bool ok = work.rest && work.order;
    if (ok) {
        for (size_t i = 0; i < n; ++i) {
            work.rest[i] = weights[i] / sum * (double)n;
            alias_push(&work, (uint)i);
        }
        alias_fill(&work, heaviest, out);
    } else {
        error_memory(error, n * (sizeof *work.rest + sizeof *work.order), "an alias table");
    }
    free(work.rest);
    free(work.order);
    return ok;
}

/* ---- piecewise-constant densities over the square --------------------------------------------------------------- */

#define CDF_STEPS 8388608.0 /* 2^23: number of values of random_float */
#define DISTRIBUTION_SIZE_MAX (1u << 20)

/* Fills cdf[0 ... n] for n weights with the given sum: every positive weight gets one step of 2^-23, and the remaining
 * steps are distributed in proportion. All zeros if the sum is zero. */
static void cdf_fill(const double *weights, uint n, double sum, float *cdf)
{
    double positive = 0.0;
    for (uint i = 0; i < n; ++i)
        positive += weights[i] > 0.0 ? 1.0 : 0.0;
    double running = 0.0, seen = 0.0;
    cdf[0] = 0.0f;
    for (uint i = 0; i < n; ++i) {
        running += weights[i];
        seen += weights[i] > 0.0 ? 1.0 : 0.0;
        double share = sum > 0.0 ? floor((CDF_STEPS - positive) * fmin(running / sum, 1.0) + 0.5) : 0.0;
        cdf[i + 1] = (float)((seen + share) / CDF_STEPS);
    }
    assert(positive == 0.0 || cdf[n] == 1.0f);
}

/* Copies a row of weights to `row` as doubles and sums them; fails for an invalid weight. */
static bool row_load(const float *weights, uint width, uint y, double *row, double *sum, Error *error)
{
    *sum = 0.0;
    for (uint x = 0; x < width; ++x) {
        row[x] = (double)weights[x];
        if (!(row[x] >= 0.0) || isinf(row[x])) {
            error_set(error, "weight (%u, %u) of a distribution is %g", x, y, row[x]);
            return error_fix(error, "weights must be finite and not negative");
        }
        *sum += row[x];
    }
    return true;
}

/* `work` has room for height + width doubles. */
static bool distribution2d_fill(const float *weights, uint width, uint height, double *work, float *cdfs, Error *error)
{
    double total = 0.0;
    double *row_sums = work, *row = work + height;
    for (uint y = 0; y < height; ++y) {
        if (!row_load(weights + (size_t)y * width, width, y, row, &row_sums[y], error))
            return false;
        cdf_fill(row, width, row_sums[y], cdfs + height + 1 + (size_t)y * (width + 1));
        total += row_sums[y];
    }
    cdf_fill(row_sums, height, total, cdfs);
    return true;
}

bool distribution2d_build(const float *weights, uint width, uint height, Array *lookup, Distribution2D *out,
                          Error *error)
{
    assert(lookup->element_size == sizeof(float));
    if (width == 0 || height == 0 || width > DISTRIBUTION_SIZE_MAX || height > DISTRIBUTION_SIZE_MAX)
        return error_set(error, "a distribution of %u x %u cells; 1 to %u a side are possible", width, height,
                         DISTRIBUTION_SIZE_MAX);
    size_t first = lookup->count;
    size_t count = (size_t)height + 1 + (size_t)height * (width + 1);
    if (first + count > NONE)
        return error_set(error, "lookup tables of %zu numbers do not fit 32-bit indices", first + count);
    double *work = malloc(((size_t)width + height) * sizeof *work);
    if (!work)
        return error_memory(error, ((size_t)width + height) * sizeof *work, "a distribution");
    float *cdfs = array_grow(lookup, count, error);
    bool ok = cdfs && distribution2d_fill(weights, width, height, work, cdfs, error);
    free(work);
    if (!ok) {
        lookup->count = first;
        return false;
    }
    *out = (Distribution2D){width, height, (uint)first, (uint)(first + height + 1)};
    return true;
}
