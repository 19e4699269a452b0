/* Error metrics of a scene's renderings against its reference, and statistics over runs. */
#ifndef TWINLIGHT_BENCH_ANALYSIS_H
#define TWINLIGHT_BENCH_ANALYSIS_H

#include "bench/bench.h"

/* Sets the figures of all finished runs, groups and series. Does nothing without a reference. Fails if an image cannot
 * be read or has a different size, or out of memory. */
bool bench_scene_analyse(const BenchOptions *options, BenchScene *scene, Error *error);

/* Index of the longest time at which every series has a finished run; -1: there is none. */
int bench_common_time(const BenchOptions *options, const BenchScene *scene);

#endif
