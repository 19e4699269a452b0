/* The generation under way, as the passes of its estimators need to know it. */
#ifndef TWINLIGHT_MMLT_GENERATION_H
#define TWINLIGHT_MMLT_GENERATION_H

#include "mmlt/scheme.h"
#include "render/run.h"

typedef struct Generation {
    RenderRun *run;
    uint index; /* 0, 1, ... */
    int replica; /* that it belongs to; always 0 with --mlt=scheme=paper, whose chains never restart */
    int other; /* the replica that it learns from */
    float clamp_threshold; /* of pools (path/partition.h) */
} Generation;

/* Generation `index`; its clamping threshold is left to the caller. */
Generation generation_at(RenderRun *run, const MmltScheme *scheme, uint index);

/* Uses of generation_random. */
#define GENERATION_RESAMPLING 0u
#define GENERATION_POOL_PLACE 1u
#define GENERATION_POOL_LIGHTS 2u /* and the next REPLICAS, one for each order of pixels */
#define GENERATION_TRIAL_PLACE (GENERATION_POOL_LIGHTS + REPLICAS + 1u)

/* A uniform number in (0, 1), a function of the seed, the generation's index (or another number) and the use. */
double generation_random(const RenderRun *run, uint index, uint use);

#endif
