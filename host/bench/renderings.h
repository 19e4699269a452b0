/* Makes a scene's renderings and its reference. */
#ifndef TWINLIGHT_BENCH_RENDERINGS_H
#define TWINLIGHT_BENCH_RENDERINGS_H

#include "bench/bench.h"

/* Fills in `scene` and makes its renderings, except those that an earlier call has left. reference: file; NULL: render
 * it. Also returns true if a signal stopped it; bench_scene_analyse then works with what is finished. On failure the
 * scene holds what was finished. Free with bench_scene_destroy in any case. */
bool bench_scene_render(Bench *bench, BenchScene *scene, const char *path, const char *reference, Error *error);
void bench_scene_destroy(BenchScene *scene);

/* Seconds that a scene's renderings take if none exists yet, and their number. */
double bench_scene_seconds(const BenchOptions *options, bool has_reference, int *renderings);

#endif
