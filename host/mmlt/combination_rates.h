/* How a combination would divide work between its estimators: from the variances of their samples in all tiles. */
#ifndef TWINLIGHT_MMLT_COMBINATION_RATES_H
#define TWINLIGHT_MMLT_COMBINATION_RATES_H

#include "mmlt/combination.h"

/* Samples of path tracing, of pools and of bidirectional path tracing per step of a chain. */
typedef struct StepRates {
    double paths, pool, bidirectional;
} StepRates;

/* Saves rates that a plan has, or restores such: those that combination_rates can find, of a pool at least
 * POOL_PER_STEP. */
void step_rates_archive(Archive *archive, StepRates *rates); /* of path tracing and pools */
void step_rate_archive_bidirectional(Archive *archive, StepRates *rates);

/* The rates of least relative error of the whole picture at equal time; zeros until variances are known. Generations
 * are compared with this division of work from then on. */
StepRates combination_rates(Combination *combination);

/* Square error of path tracing alone, relative to that of the best division of the same work, which
 * combination_rates has found; infinite if that is not known, or if light may be hidden from it. */
double combination_alone_error(const Combination *combination);

#endif
