/* Light transport algorithms. An integrator is a list of steps over items, where an item is one path or one pair of
 * subpaths. */
#ifndef TWINLIGHT_RENDER_INTEGRATOR_H
#define TWINLIGHT_RENDER_INTEGRATOR_H

#include "backend/backend.h"
#include "path/mis.h"
#include "render/job.h"

struct RenderRun;

typedef struct Integrator {
    const char *name; /* name for --integrator */
    const char *summary;
    int depth_limit; /* most segments of a path */
    uint strategies; /* STRATEGIES_* */
    bool photons; /* draws directions by caustic photons (path/caustic.h) if RenderOptions.photons says so */
    /* How many in a rendering of so many pixels that does not say; NULL: none. */
    unsigned (*photons_default)(const RenderOptions *options, uint64_t pixels);
    float roulette_scale; /* PathParams.roulette_scale of bidirectional walks; 0: that is 1 */
    bool guides; /* supports light guides (light/light_guide.h), which options can turn off */
    /* Records the steps for paths of up to frame->path.max_depth segments; free with step_list_destroy. NULL if
     * `render` is set. */
    bool (*list)(FrameParams *frame, StepList *list, Error *error);
    /* Replaces the default loop, which runs passes of `list` over all pixels (render/render.h), and restores and saves
     * its own state (checkpoint_restore, checkpoint_save_if_due, checkpoint_end in render/checkpoint.h); may be
     * NULL. */
    bool (*render)(struct RenderRun *run, Error *error);
} Integrator;

/* X(name): every integrator, each made by integrator_name(). */
#define INTEGRATOR_LIST(X) X(pt) X(ibpt) X(bdpt) X(mmlt)

#define INTEGRATOR_DECLARE(name) const Integrator *integrator_##name(void);
INTEGRATOR_LIST(INTEGRATOR_DECLARE)
#undef INTEGRATOR_DECLARE

/* Whether path tracing beside other estimators of mmlt shows light that is not direct and that these do not
 * (path/path_gather.h). */
bool pt_shows_more(const FrameParams *frame);

/* Finds an integrator by name; NULL with an error that lists all. */
const Integrator *integrator_find(const char *name, Error *error);

#endif
