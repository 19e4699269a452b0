#include "backend/shares.h"

#include <math.h>

/* Weight of the latest pass in a member's measured speed: averages over a few passes, so that one outlier has little
 * effect. */
#define SPEED_BLEND 0.3

/* Least share of a member, relative to the mean: a member that was slow once must be measured again. */
#define SHARE_MIN 0.02

static double mean_speed(const double *speeds, size_t count)
{
    double known = 0.0;
    size_t measured = 0;
    for (size_t i = 0; i < count; ++i) {
        known += speeds[i];
        measured += speeds[i] > 0.0;
    }
    return measured > 0 ? known / (double)measured : 1.0;
}

static double weight_of(double speed, double mean)
{
    return speed > 0.0 ? fmax(speed, SHARE_MIN * mean) : mean;
}

void shares_make(const double *speeds, size_t count, uint items, uint *starts)
{
    double mean = mean_speed(speeds, count), sum = 0.0, before = 0.0;
    for (size_t i = 0; i < count; ++i)
        sum += weight_of(speeds[i], mean);
    starts[0] = 0;
    for (size_t i = 0; i < count; ++i) {
        before += weight_of(speeds[i], mean);
        double grains = floor((double)items * (before / sum) / SHARE_GRAIN + 0.5);
        double end = grains * SHARE_GRAIN;
        starts[i + 1] = i + 1 == count || end > items ? items : (uint)end;
    }
}

void shares_learn(double *speed, uint64_t items, double seconds)
{
    double latest = (double)items / fmax(seconds, 1e-6);
    *speed = *speed > 0.0 ? *speed + SPEED_BLEND * (latest - *speed) : latest;
}
