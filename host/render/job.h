/* What is asked of a rendering. */
#ifndef TWINLIGHT_RENDER_JOB_H
#define TWINLIGHT_RENDER_JOB_H

#include "film/film.h"

#include <stdatomic.h>
#include <stdio.h>

/* How chains lie in memory: by depth and strategy, by depth, or as they were drawn. */
typedef enum ChainOrder { CHAIN_ORDER_STRATEGY, CHAIN_ORDER_DEPTH, CHAIN_ORDER_NONE } ChainOrder;

/* How chains are run (mmlt/integrator_mmlt.c). Zeros: the defaults. */
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
    bool unguided; /* directions do not count from lights */
    bool chains_only; /* the pool's samples are not shown (mmlt/combination.h) */
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

#endif
