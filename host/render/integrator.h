/* Algorithms that light is carried by: each is a list of steps over items, one item a path or a pair of them. */
#ifndef TWINLIGHT_RENDER_INTEGRATOR_H
#define TWINLIGHT_RENDER_INTEGRATOR_H

#include "backend/backend.h"
#include "path/mis.h"

struct RenderRun;

typedef struct Integrator {
    const char *name; /* of --integrator */
    const char *summary;
    int depth_limit; /* the longest path in segments */
    uint strategies; /* STRATEGIES_* */
    bool guides; /* directions count from lights (light/light_guide.h), unless options say otherwise */
    /* Records the steps for paths of up to frame->max_depth segments, to be freed by step_list_destroy. */
    bool (*list)(FrameParams *frame, StepList *list, Error *error);
    /* Renders on its own terms; NULL: passes of `list` over the samples of all pixels (render/render.h). */
    bool (*render)(struct RenderRun *run, Error *error);
} Integrator;

/* X(name): every integrator, each made by integrator_name(). */
#define INTEGRATOR_LIST(X) X(pt) X(ibpt) X(bdpt) X(mmlt)

#define INTEGRATOR_DECLARE(name) const Integrator *integrator_##name(void);
INTEGRATOR_LIST(INTEGRATOR_DECLARE)
#undef INTEGRATOR_DECLARE

/* NULL with an error that lists what there is. */
const Integrator *integrator_find(const char *name, Error *error);

#endif
