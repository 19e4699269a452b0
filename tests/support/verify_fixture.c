#include "support/verify_fixture.h"

#include "backend/step_recorder.h"
#include "backend_cpu.h"
#include "support/test_util.h"

#include <stdlib.h>

/* ---- pairs ------------------------------------------------------------------------------------------------------- */

void verify_pair_open(const RenderSetup setups[2], VerifyPair *pair)
{
    const RenderOptions options = {.max_depth = setups->max_depth, .seed = setups->seed, .balance = setups->balance};
    const Integrator *integrator = setups->integrator ? setups->integrator : integrator_pt();
    Error error = {0};
    fixture_scene(setups, &pair->scene);
    for (int i = 0; i < 2; ++i) {
        BackendMember *side = &pair->sides[i];
        side->interface = setups[i].backend ? setups[i].backend : backend_cpu();
        side->backend = fixture_open(&setups[i], &pair->scene, &error);
        ck_assert_msg(side->backend != NULL, "%s", error.message);
    }
    render_frame(integrator, &pair->scene, &options, &pair->frame);
    ck_assert_msg(integrator->list(&pair->frame, &pair->list, &error), "%s", error.message);
}

void verify_pair_close(VerifyPair *pair)
{
    for (int i = 0; i < 2; ++i)
        pair->sides[i].interface->close(pair->sides[i].backend);
    step_list_destroy(&pair->list);
    scene_destroy(&pair->scene);
}

/* ---- faults ------------------------------------------------------------------------------------------------------ */

static Fault fault;
static const BackendInterface *healthy;

typedef struct FaultSink {
    StateSink sink;
    void *context;
    const FrameParams *frame;
} FaultSink;

static void fault_sink(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride)
{
    const FaultSink *faulty = context;
    uint item = fault.item - faulty->frame->pass.first_item;
    if (buffer == fault.buffer && item >= first && item < first + count)
        ((uint *)(uintptr_t)words)[(size_t)fault.field * stride + item - first] ^= 1u;
    faulty->sink(faulty->context, buffer, words, first, count, stride);
}

static bool fault_inspect(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink,
                          void *context, Error *error)
{
    bool reached = false;
    for (size_t i = 0; i < list->count; ++i)
        reached = reached || (list->steps[i].kind == fault.kind &&
                              (fault.kind != STEP_KERNEL || list->steps[i].kernel == fault.kernel));
    FaultSink faulty = {sink, context, frame};
    return reached ? healthy->inspect(backend, frame, list, fault_sink, &faulty, error)
                   : healthy->inspect(backend, frame, list, sink, context, error);
}

BackendInterface fault_backend(const BackendInterface *of, const Fault *planted)
{
    BackendInterface faulty = *of;
    faulty.inspect = fault_inspect;
    healthy = of;
    fault = *planted;
    return faulty;
}

/* ---- skips ------------------------------------------------------------------------------------------------------- */

static bool unskipped_inspect(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink,
                              void *context, Error *error)
{
    StepList patient = *list;
    Step *steps = calloc(list->count, sizeof *steps);
    ck_assert(steps != NULL);
    for (size_t i = 0; i < list->count; ++i) {
        steps[i] = list->steps[i];
        if (steps[i].kind == STEP_SKIP_IF_IDLE)
            steps[i].target = (unsigned)i + 1;
    }
    patient.steps = steps;
    bool done = healthy->inspect(backend, frame, &patient, sink, context, error);
    free(steps);
    return done;
}

BackendInterface unskipping_backend(const BackendInterface *of)
{
    BackendInterface patient = *of;
    patient.inspect = unskipped_inspect;
    healthy = of;
    return patient;
}
