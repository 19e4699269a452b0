/* `twinlight bench`: compares integrators by error against time, in a report.
 *
 * Renderings are made first (bench/renderings.c). Each is kept as an EXR with a record beside it (bench/record.c), so
 * that a second call does not repeat it. They are then compared with the scene's reference (bench/analysis.c), and the
 * report is written from the results (bench/report.c, bench/pictures.c, bench/tables.c). */
#ifndef TWINLIGHT_BENCH_BENCH_H
#define TWINLIGHT_BENCH_BENCH_H

#include "backend/choice.h"
#include "base/sample_statistics.h"
#include "compare/display_error.h"
#include "render/render.h"

#include <limits.h>

#define BENCH_INTEGRATORS_MAX 8
#define BENCH_TIMES_MAX 16
#define BENCH_BACKENDS_MAX 4
#define BENCH_SERIES_MAX (BENCH_INTEGRATORS_MAX * BENCH_BACKENDS_MAX)
#define BENCH_PATCHES_MAX 8
#define BENCH_SCENES_MAX 64
#define BENCH_RUNS_MAX 1000
#define BENCH_NAME_MAX 80

typedef struct BenchPatch {
    char name[BENCH_NAME_MAX];
    int x, y, width, height; /* pixels */
} BenchPatch;

typedef struct BenchOptions {
    const Integrator *integrators[BENCH_INTEGRATORS_MAX]; /* others are compared with the first */
    int integrator_count;
    double times[BENCH_TIMES_MAX]; /* seconds, ascending */
    int time_count;
    int runs; /* per integrator, backend and time */
    BackendChoices backends[BENCH_BACKENDS_MAX];
    int backend_count;
    const char *references[BENCH_SCENES_MAX]; /* in the order of the scenes; missing ones are rendered */
    int reference_count;
    const Integrator *reference_integrator;
    double reference_seconds; /* of both halves together; 0: 8 times the longest of `times` */
    BenchPatch patches[BENCH_PATCHES_MAX];
    int patch_count;
    int max_depth; /* 0: the scene's */
    int resolution[2]; /* 0: the scene's */
    uint64_t seed;
    int threads; /* 0: one for each processor */
    DisplaySettings display;
    bool lenient, quiet;
    const char *output; /* ends in .html */
    const char *scenes[BENCH_SCENES_MAX];
    int scene_count;
} BenchOptions;

/* Statistics of a rendering, kept in a file (bench/record.h). */
typedef struct BenchRecord {
    double seconds; /* rendering alone */
    /* seconds: loading the scene and building its acceleration structure, once for all renderings; writing the image */
    double load, build, write;
    double samples_per_pixel, ray_seconds;
    uint64_t samples, closest_rays, shadow_rays, threads;
    uint64_t saturated, not_finite, diagnostics; /* should all be 0 */
    char device[256];
    ChainStatistics chains;
} BenchRecord;

/* Error of a rendering against the reference. */
typedef struct BenchFigures {
    double rel_mse, rel_mse_trimmed, mape, flip, ssim;
    double mean_ratio; /* mean of the image over that of the reference */
    double patches[BENCH_PATCHES_MAX]; /* relMSE of each patch */
} BenchFigures;

typedef struct BenchRun {
    int series, time, number; /* indices: of the series; into BenchOptions.times; among `runs` */
    uint64_t seed;
    bool finished; /* the members below are set */
    char image[PATH_MAX]; /* EXR */
    BenchRecord record;
    BenchFigures figures;
} BenchRun;

/* Quantiles over several runs. */
typedef struct BenchBand {
    double low, median, high; /* 10 %, 50 %, 90 % */
} BenchBand;

/* All runs of a series with one time. */
typedef struct BenchGroup {
    int runs; /* finished ones */
    BenchBand seconds, samples_per_pixel, rel_mse, rel_mse_trimmed, mape, flip, ssim;
    double samples_per_second, rays_per_second; /* medians */
    double mean_ratio, mean_ratio_error; /* mean over the runs, and its standard error (NaN for one run) */
    double variance; /* relative, per run: mean over pixels of s^2 / (R^2 + 0.01); NaN for a single run */
    double efficiency; /* 1 / (variance x seconds) */
    /* relMSE of the mean of all runs less variance / runs: bias^2 plus the reference's error; NaN for a single run */
    double bias;
    double patches[BENCH_PATCHES_MAX]; /* medians of relMSE */
    const BenchRun *typical; /* the run with the relMSE closest to the median */
} BenchGroup;

/* One integrator on one backend. */
typedef struct BenchSeries {
    const Integrator *integrator;
    const BackendChoices *backend;
    char name[BENCH_NAME_MAX];
    BenchGroup groups[BENCH_TIMES_MAX];
    SampleLine by_time, by_samples; /* log10 of relMSE against log10 of seconds and of samples, over all runs */
    double equal_seconds; /* to reach the first series' error at the longest common time; NaN: unknown */
    bool extrapolated; /* equal_seconds is outside the measured times */
    double speedup; /* the first series' seconds over equal_seconds */
} BenchSeries;

/* The reference of a scene. */
typedef struct BenchReference {
    char path[PATH_MAX]; /* "": none yet */
    char origin[256]; /* description for the report */
    double own_error; /* relMSE caused by its own noise; NaN: unknown */
} BenchReference;

typedef struct BenchScene {
    const char *path;
    char name[BENCH_NAME_MAX]; /* folder and file name without its ending; unique */
    int width, height, max_depth;
    size_t primitives, lights;
    uint64_t key; /* hash of everything its picture depends on */
    BenchReference reference;
    BenchSeries series[BENCH_SERIES_MAX];
    int series_count;
    BenchRun *runs;
    int run_count;
} BenchScene;

typedef struct Bench {
    BenchOptions options;
    char folder[PATH_MAX]; /* for the renderings, beside the report */
    char command[1024]; /* the command line */
    BenchScene scenes[BENCH_SCENES_MAX];
    double planned, done; /* nominal seconds of this call's renderings: all, and those done */
    double spent; /* actual seconds of those done */
    int renderings_planned, renderings_done;
} Bench;

#endif
