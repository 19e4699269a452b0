/* Figures of a scene's renderings against its reference, and what they say together. */
#ifndef TWINLIGHT_BENCH_ANALYSIS_H
#define TWINLIGHT_BENCH_ANALYSIS_H

#include "bench/bench.h"

/* Fills in the figures of all finished runs, the groups and the series. Without a reference there are none. Fails when
 * an image cannot be read or has another size. */
bool bench_scene_analyse(const BenchOptions *options, BenchScene *scene, Error *error);

/* The longest time that every series has a run with; -1: there is none. */
int bench_common_time(const BenchOptions *options, const BenchScene *scene);

#endif
