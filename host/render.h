/* Renders a finished scene on one backend: passes until the budget is spent, the film saved now and then. */
#ifndef TWINLIGHT_RENDER_H
#define TWINLIGHT_RENDER_H

#include "backend.h"
#include "film.h"
#include "scene.h"

#define DIAGNOSTIC_NAMES_MAX 16

typedef struct RenderOptions {
    unsigned first_sample; /* of every pixel; a run over [a, b) and one over [b, c) merge to one over [a, c) */
    unsigned samples; /* per pixel; 0: no limit but `seconds` */
    double seconds; /* 0: no limit but `samples` */
    int max_depth; /* path segments, >= 1 */
    uint64_t seed;
    double save_every; /* seconds between calls of `save`; 0: never */
    const atomic_int *stop; /* becomes 1 by a signal: finish what is begun and return */
} RenderOptions;

typedef struct RenderProgress {
    double elapsed; /* seconds of rendering */
    double fraction; /* 0 ... 1 of the budget */
    uint64_t samples; /* paths finished */
    uint64_t rays;
} RenderProgress;

typedef struct RenderCallbacks {
    void (*progress)(void *context, const RenderProgress *progress); /* a few times a second; may be NULL */
    bool (*save)(void *context, const Film *film, Error *error); /* every save_every seconds; may be NULL */
    void *context;
} RenderCallbacks;

/* What happened inside the kernels: names from diagnostics.h. */
typedef struct RenderResult {
    uint64_t samples; /* paths */
    double samples_per_pixel;
    double seconds; /* rendering alone */
    bool stopped; /* by options->stop */
    BackendStatistics backend;
    int diagnostic_count;
    const char *diagnostic_names[DIAGNOSTIC_NAMES_MAX];
    uint64_t diagnostics[DIAGNOSTIC_NAMES_MAX];
} RenderResult;

/* Path tracing's list of steps, to be freed by step_list_destroy, and its frame for all items from the first on. */
bool render_pt_list(const Scene *scene, const RenderOptions *options, StepList *list, FrameParams *frame, Error *error);
void step_list_destroy(StepList *list);

/* Path tracing (integrator_pt.c). `film` must be initialised with the scene's size and crop; its quantum is set from
 * a pilot of the scene unless `keep_quantum`. */
bool render_pt(const Scene *scene, const BackendInterface *interface, Backend *backend, const RenderOptions *options,
               bool keep_quantum, const RenderCallbacks *callbacks, Film *film, RenderResult *result, Error *error);

#endif
