/* Light transport algorithms. An integrator is a list of steps over items, where an item is one path or one pair of
 * subpaths. */
#ifndef TWINLIGHT_RENDER_INTEGRATOR_H
#define TWINLIGHT_RENDER_INTEGRATOR_H

#include "backend/backend.h"
#include "path/mis.h"

struct RenderRun;

typedef struct Integrator {
    const char *name; /* name for --integrator */
    const char *summary;
    int depth_limit; /* most segments of a path */
    uint strategies; /* STRATEGIES_* */
    bool guides; /* supports light guides (light/light_guide.h), which options can turn off */
    /* Records the steps for paths of up to frame->max_depth segments; free with step_list_destroy. NULL if `render` is
     * set. */
    bool (*list)(FrameParams *frame, StepList *list, Error *error);
    /* Replaces the default loop, which runs passes of `list` over all pixels (render/render.h); may be NULL. */
    bool (*render)(struct RenderRun *run, Error *error);
} Integrator;

const Integrator *integrator_pt(void);
const Integrator *integrator_ibpt(void);
const Integrator *integrator_bdpt(void);
const Integrator *integrator_mmlt(void);

/* Finds an integrator by name; NULL with an error that lists all. */
const Integrator *integrator_find(const char *name, Error *error);

#endif
