/* One rendering of `twinlight bench`: named after all that it depends on, made unless it is there, recorded. */
#ifndef TWINLIGHT_BENCH_TASK_H
#define TWINLIGHT_BENCH_TASK_H

#include "bench/bench.h"

/* A scene while it is rendered. */
typedef struct BenchWorkshop {
    Bench *bench;
    BenchScene *scene;
    Scene data;
    const BackendChoices *choices; /* that `backend` was opened on; NULL: none is open */
    BackendMember backend;
    double load, build; /* seconds */
} BenchWorkshop;

/* One rendering: what it is and where it goes. */
typedef struct BenchTask {
    const Integrator *integrator;
    const BackendChoices *backend;
    double seconds;
    uint64_t seed;
    const char *what; /* for the user: "run 1 of 4" */
} BenchTask;

/* A seed of its own for every rendering: of the user's seed, a name, and the rest. */
uint64_t bench_task_seed(const BenchOptions *options, const char *integrator, double seconds, int number);

/* Where the image goes: words for the eye, and a key of scene, options, program and machine, so that what was made by
 * another program or elsewhere is not taken for this one's. */
void bench_task_image(const BenchWorkshop *shop, const BenchTask *task, char path[PATH_MAX]);

/* Makes the image of `path` and its record unless they are there. *finished becomes false, and nothing is written, when
 * a signal came before or while it was rendered. */
bool bench_task_run(BenchWorkshop *shop, const BenchTask *task, const char *path, BenchRecord *record, bool *finished,
                    Error *error);

#endif
