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

const Integrator *integrator_pt(void);
const Integrator *integrator_ibpt(void);
const Integrator *integrator_bdpt(void);
const Integrator *integrator_mmlt(void);

/* NULL with an error that lists what there is. */
const Integrator *integrator_find(const char *name, Error *error);

#endif
