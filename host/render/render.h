/* Renders a finished scene on one backend: runs passes until the budget is spent and saves the film from time to
 * time. */
#ifndef TWINLIGHT_RENDER_RENDER_H
#define TWINLIGHT_RENDER_RENDER_H

#include "backend/group.h"
#include "render/chain_statistics.h"
#include "render/integrator.h"
#include "render/job.h"
#include "render/run.h"
#include "scene/scene.h"

#define DIAGNOSTIC_NAMES_MAX 16

/* The outcome of a rendering; diagnostics are the kernels' counters (layout/diagnostics.h). */
typedef struct RenderResult {
    RenderTotals totals; /* from which the next three and the diagnostics follow */
    uint64_t samples; /* paths; MMLT: work in samples of path tracing */
    double samples_per_pixel;
    double seconds; /* of rendering alone, photons included */
    bool stopped; /* by options->stop */
    uint photons;
    uint openings; /* layout/openings.h */
    BackendStatistics backend;
    ChainStatistics chains;
    ErrorWatch error;
    bool error_reached; /* the goal of options->error */
    int diagnostic_count;
    const char *diagnostic_names[DIAGNOSTIC_NAMES_MAX];
    uint64_t diagnostics[DIAGNOSTIC_NAMES_MAX];
} RenderResult;

/* Sets what follows from totals over an image of `pixels`. */
void render_result_totals(RenderResult *result, RenderTotals totals, uint64_t pixels);

/* What to render, on what, and how. */
typedef struct RenderTask {
    const Integrator *integrator;
    const Scene *scene; /* finished */
    BackendMember backend; /* open on the scene */
    const RenderOptions *options;
    bool keep_quantum; /* of the film; otherwise a pilot (film_pilot_run) sets it */
    const RenderCallbacks *callbacks; /* may be NULL */
} RenderTask;

/* Number of caustic photons that a rendering asks for: none for images by depth, which have no layer for what photons
 * bring, and none where chains alone are shown, since path tracing draws by photons. */
unsigned render_photons(const Integrator *integrator, const RenderOptions *options, uint64_t pixels);

/* Finds the openings of a run (render/openings.h), if its light subpaths are to start through them. */
bool render_openings_find(RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error);

/* Makes the photons of a run, to be destroyed by photon_map_destroy (render/photon_map.h): run->photons, none if there
 * are none to be found, and their parameters in the run's frame. */
bool render_photons_make(RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error);

/* Fills in *frame for the scene and the options, starting at the first item. max_depth is limited to what the
 * integrator supports. */
void render_frame(const Integrator *integrator, const Scene *scene, const RenderOptions *options, FrameParams *frame);

/* Renders into `film`, which must be initialised with the scene's size and crop. On failure the film holds what was
 * finished, and *result says how much that is. */
bool render_film(const RenderTask *task, Film *film, RenderResult *result, Error *error);

#endif
