/* Renders a finished scene on one backend: passes until the budget is spent, the film saved now and then. */
#ifndef TWINLIGHT_RENDER_RENDER_H
#define TWINLIGHT_RENDER_RENDER_H

#include "render/chain_statistics.h"
#include "render/integrator.h"
#include "render/job.h"
#include "scene/scene.h"

#define DIAGNOSTIC_NAMES_MAX 16

/* What happened inside the kernels: names from layout/diagnostics.h. */
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
