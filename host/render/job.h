/* The options of a rendering, and its callbacks. */
#ifndef TWINLIGHT_RENDER_JOB_H
#define TWINLIGHT_RENDER_JOB_H

#include "film/film.h"
#include "layout/diagnostics.h"

#include <stdatomic.h>
#include <stdio.h>

/* Order of chains in memory: by depth and strategy, by depth, or as drawn. */
typedef enum ChainOrder { CHAIN_ORDER_STRATEGY, CHAIN_ORDER_DEPTH, CHAIN_ORDER_NONE } ChainOrder;

/* Options of Markov chains (mmlt/integrator_mmlt.c). Zero means the default. */
typedef struct ChainOptions {
    unsigned chains; /* at once */
    unsigned steps; /* per chain between two pools */
    unsigned pool; /* samples per pool */
    /* the scheme of Frolov 2018: one pool, then large steps; otherwise every generation has a new pool */
    bool paper;
    double large_step; /* probability, for `paper` */
    unsigned mutations; /* MUTATION_* as bits */
    ChainOrder order;
    bool ungrouped; /* each chain chooses its own kind of mutation */
    bool shiftless; /* no shifts (chain/shift.h) */
    bool unguided; /* no light guides (light/light_guide.h) */
    bool chains_only; /* show chains and direct light only; no combination (mmlt/combination.h) */
    /* For tests: 1 + ESTIMATOR_*, to show that estimator and what it leaves to chains, or SHOWN_PATHS_ALONE
     * (mmlt/combination_learn.h); 0: all. */
    int shown;
    bool photons_everywhere; /* for tests: path tracing draws by photons at all receivers, whatever they bring */
} ChainOptions;

/* As many photons as the integrator draws by if nothing else is said. */
#define PHOTONS_DEFAULT 0xffffffffu

/* Largest number of photons that can be asked for. */
#define PHOTONS_MOST_ALLOWED 1048576u

/* --checkpoint, --checkpoint-every, --resume (render/checkpoint.h). */
typedef struct CheckpointOptions {
    const char *file; /* where checkpoints are written; NULL: nowhere */
    double every; /* seconds between two */
    const char *resume; /* the checkpoint to go on from; NULL: none */
    bool anew; /* if there is no such file, the rendering starts anew */
} CheckpointOptions;

/* --error, --error-percentile, --error-of (render/error_watch.h). */
typedef struct ErrorGoal {
    double goal; /* largest relative error of the picture when it is done; 0: none */
    double percentile; /* of the pixels or tiles in order of their errors; 0: root mean square */
    bool blocks; /* of the means of tiles, not of pixels */
    double scale; /* of the picture that is written */
} ErrorGoal;

/* --shard=NUMBER/COUNT: which share of the picture is rendered (render/shard.h). */
typedef struct Shard {
    unsigned number; /* 1 ... count */
    unsigned count; /* 0: the whole picture is rendered */
} Shard;

typedef struct RenderOptions {
    unsigned first_sample; /* of every pixel; a run over [a, b) and one over [b, c) merge to one over [a, c) */
    unsigned samples; /* per pixel, of the whole picture; 0: no limit but `seconds` */
    Shard shard;
    double seconds; /* 0: no limit but `samples` */
    ErrorGoal error; /* a further limit; needs `layers` */
    int max_depth; /* segments, >= 1 */
    uint64_t seed;
    unsigned photons; /* of caustics, at most (path/photon.h); 0: none; PHOTONS_DEFAULT */
    unsigned reconstruction; /* RECONSTRUCTION_* (layout/frame_params.h), where the film allows it: render_frame */
    bool no_openings; /* light subpaths do not start through openings (layout/openings.h) */
    bool independent; /* samples of a pixel are not stratified (path/path_random.h) */
    bool balance; /* balance heuristic; otherwise the power heuristic */
    bool only_strategy; /* show one strategy only */
    unsigned strategy[2]; /* s, t */
    bool unweighted; /* with MIS weight 1 */
    ChainOptions chains;
    /* --dump-bad: receives a line of JSON per chain that met a non-finite contribution; NULL: none */
    FILE *bad_chains;
    /* in: .wanted; out: the layers, to be destroyed by the caller; NULL: none */
    struct RenderLayers *layers;
    double save_every; /* seconds between calls of `save`; 0: never */
    CheckpointOptions checkpoint;
    const char *pilot; /* checkpoint of a rendering from which a shard of mmlt takes what it has learnt; NULL: none */
    /* set to 1 by a signal handler: return at once with the samples finished so far; NULL: never */
    const atomic_int *stop;
} RenderOptions;

typedef struct RenderProgress {
    double elapsed; /* seconds */
    double fraction; /* of the budget, 0 ... 1 */
    uint64_t samples; /* paths; MMLT: work in samples of path tracing */
    uint64_t rays;
    double fraction_before; /* what of `fraction` and `samples` is of earlier runs (--resume) */
    uint64_t samples_before;
    double error; /* estimated relative error, if there is a goal; 0 before the first estimate */
    double left; /* estimated seconds until the last pass ends, the one under way included; negative: not known */
    bool finishing; /* the pass or generation under way is the last, as far as can be told */
} RenderProgress;

/* What has been done, in all runs of a rendering that was interrupted and resumed. */
typedef struct RenderTotals {
    uint64_t done; /* paths in the film; MMLT: its work (estimators_work) */
    double seconds;
    unsigned samples; /* RenderOptions.samples of the latest run */
    unsigned photons; /* asked for by the first run */
    uint64_t closest_rays, shadow_rays;
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
} RenderTotals;

struct RenderRun;

typedef struct RenderCallbacks {
    /* A few times a second, and when parts of a generation begin or end; may be NULL. */
    void (*progress)(void *context, const RenderProgress *progress);
    /* Called as soon as there is an image, then every save_every seconds, also after failures; may be NULL. */
    bool (*save)(void *context, const Film *film, const RenderTotals *totals, Error *error);
    /* Called after `progress`: between passes, when nothing changes the film and its layers; may be NULL. The film may
     * have to be brought up to date (render_run_gather). */
    void (*publish)(void *context, struct RenderRun *run, const RenderProgress *progress);
    void *context;
} RenderCallbacks;

#endif
