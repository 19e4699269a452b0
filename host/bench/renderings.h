/* Makes a scene's renderings and its reference. */
#ifndef TWINLIGHT_BENCH_RENDERINGS_H
#define TWINLIGHT_BENCH_RENDERINGS_H

#include "bench/bench.h"

/* Fills in the scene and makes its renderings, all but those that are there from an earlier call. Returns true, too,
 * when a signal came: bench_analyse does with what is there. On failure the scene holds what was finished. */
bool bench_scene_render(Bench *bench, BenchScene *scene, const char *path, const char *reference, Error *error);
void bench_scene_destroy(BenchScene *scene);

/* Seconds that the renderings of one scene take when none is there, and their number. */
double bench_scene_seconds(const BenchOptions *options, bool has_reference, int *renderings);

#endif
