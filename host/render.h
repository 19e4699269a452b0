/* Renders a finished scene on one backend: passes until the budget is spent, the film saved now and then. */
#ifndef TWINLIGHT_RENDER_H
#define TWINLIGHT_RENDER_H

#include "chain_seeds.h"
#include "chain_statistics.h"
#include "film.h"
#include "integrator.h"
#include "scene.h"

#include <stdio.h>

#define DIAGNOSTIC_NAMES_MAX 16

/* How chains are run (integrator_mmlt.c). Zeros: the defaults. */
typedef struct ChainOptions {
    unsigned chains; /* at a time */
    unsigned steps; /* of a chain between two pools */
    unsigned pool; /* samples of a pool */
    bool
        paper; /* one pool, and large steps within the chains, as Frolov 2018; else a new pool and new chains every time */
    double large_step; /* probability, of `paper` */
    unsigned mutations; /* bit MUTATION_* */
    ChainOrder order;
    bool ungrouped; /* every chain its own kind of mutation */
    bool shiftless; /* no step keeps the rest of the path */
    bool aimless; /* directions do not count from lights */
    bool unblended; /* the pool's samples are not shown (blend.h) */
    int shown; /* 1 + BLEND_*: that stream alone, with what it leaves to chains; 0: all. For tests */
} ChainOptions;

typedef struct RenderOptions {
    unsigned first_sample; /* of every pixel; a run over [a, b) and one over [b, c) merge to one over [a, c) */
    unsigned samples; /* per pixel; 0: no limit but `seconds` */
    double seconds; /* 0: no limit but `samples` */
    int max_depth; /* path segments, >= 1 */
    uint64_t seed;
    bool balance; /* balance heuristic; else the power heuristic */
    bool only_strategy; /* show one strategy alone: */
    unsigned strategy[2]; /* s, t */
    bool unweighted; /* its weights taken for 1 */
    ChainOptions chains;
    FILE *bad_chains; /* gets a line of JSON for every chain that met something not finite; NULL: nobody does */
    struct RenderLayers *layers; /* .wanted says what; filled in besides the film, to be destroyed. NULL: nothing */
    double save_every; /* seconds between calls of `save`; 0: never */
    const atomic_int *stop; /* becomes 1 by a signal: return what is finished, at once; NULL: never */
} RenderOptions;

typedef struct RenderProgress {
    double elapsed; /* seconds of rendering */
    double fraction; /* 0 ... 1 of the budget */
    uint64_t samples; /* paths finished */
    uint64_t rays;
} RenderProgress;

typedef struct RenderCallbacks {
    void (*progress)(void *context, const RenderProgress *progress); /* a few times a second; may be NULL */
    /* Every save_every seconds, and again when it fails; may be NULL. */
    bool (*save)(void *context, const Film *film, Error *error);
    void *context;
} RenderCallbacks;

/* What happened inside the kernels: names from diagnostics.h. */
typedef struct RenderResult {
    uint64_t samples; /* paths */
    double samples_per_pixel;
    double seconds; /* rendering alone */
    bool stopped; /* by options->stop */
    BackendStatistics backend;
    ChainStatistics chains;
    int diagnostic_count;
    const char *diagnostic_names[DIAGNOSTIC_NAMES_MAX];
    uint64_t diagnostics[DIAGNOSTIC_NAMES_MAX];
} RenderResult;

/* The frame of the scene for all items from the first on, its depth within the integrator's limit. */
void render_frame(const Integrator *integrator, const Scene *scene, const RenderOptions *options, FrameParams *frame);

/* `film` must be initialised with the scene's size and crop; its quantum is set from a pilot of the scene unless
 * `keep_quantum`. On failure the film holds what was finished, and *result says how much that is. */
bool render_film(const Integrator *integrator, const Scene *scene, const BackendInterface *interface, Backend *backend,
                 const RenderOptions *options, bool keep_quantum, const RenderCallbacks *callbacks, Film *film,
                 RenderResult *result, Error *error);

#endif
