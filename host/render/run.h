/* A rendering under way, for integrators that have a loop of their own. */
#ifndef TWINLIGHT_RENDER_RUN_H
#define TWINLIGHT_RENDER_RUN_H

#include "backend/backend.h"
#include "render/chain_statistics.h"
#include "render/job.h"

typedef struct RenderRun {
    const BackendInterface *interface;
    Backend *backend;
    const RenderOptions *options;
    const RenderCallbacks *callbacks; /* may be NULL */
    FrameParams frame; /* render_frame */
    const Guide *guide; /* the scene's */
    Film *film;
    uint64_t crop_pixels;
    uint64_t done; /* samples in the film */
    double start, last_save;
    bool save_failed; /* the last one did */
    ChainStatistics chains;
} RenderRun;

/* Becomes 1 when the rendering is to end at once (options->stop), or stays 0. */
const atomic_int *render_run_stop(const RenderRun *run);

/* Adds splats to the film; frame.film_exponent must be its quantum_exponent. */
SplatSink render_run_sink(Film *film);

/* Calls `progress`. fraction: of the samples wanted; 0 where their number is not limited. */
void render_run_report(const RenderRun *run, double fraction);

/* Calls `save` when it is due. When that fails there is a warning, and it is tried again when the next one is due. */
void render_run_save_if_due(RenderRun *run);

#endif
