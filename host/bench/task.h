/* A rendering of `twinlight bench`: named after everything it depends on, made unless it exists, recorded. */
#ifndef TWINLIGHT_BENCH_TASK_H
#define TWINLIGHT_BENCH_TASK_H

#include "bench/bench.h"

/* A scene being rendered. */
typedef struct BenchWorkshop {
    Bench *bench;
    BenchScene *scene;
    Scene data;
    const BackendChoices *choices; /* what `backend` was opened for; NULL: it is not open */
    BackendMember backend;
    double load, build; /* seconds of the scene and of `backend` */
} BenchWorkshop;

/* A rendering to make. */
typedef struct BenchTask {
    const Integrator *integrator;
    const BackendChoices *backend;
    double seconds;
    uint64_t seed;
    const char *what; /* for messages: "run 1 of 4" */
} BenchTask;

/* A distinct seed per rendering, from the user's seed, a name, the time and a number. */
uint64_t bench_task_seed(const BenchOptions *options, const char *integrator, double seconds, int number);

/* The path of the image: readable names and a hash of scene, options, program and machine, so that renderings by
 * another program or machine are not reused. */
void bench_task_image(const BenchWorkshop *shop, const BenchTask *task, char path[PATH_MAX]);

/* Makes the image at `path` and its record unless they exist; *record receives it. If a signal comes before or during
 * the rendering, *finished is set to false and nothing is written. */
bool bench_task_run(BenchWorkshop *shop, const BenchTask *task, const char *path, BenchRecord *record, bool *finished,
                    Error *error);

#endif
