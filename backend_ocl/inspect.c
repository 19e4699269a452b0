#include "inspect.h"

#include <stdlib.h>

static bool check(const Launcher *launcher, cl_int status, const char *what, Error *error)
{
    return status == CL_SUCCESS || ocl_fail(error, launcher->device->info.name, what, status);
}

static cl_mem state_buffer(const Launcher *launcher, const Batch *batch, int id)
{
    return id == BUFFER_SPLATS ? batch->memory->splats : launcher->memory->state[id];
}

static size_t state_bytes(const Batch *batch, const StepList *list, int id)
{
    return (size_t)batch->frame.pass.stride * list->words_per_item[id] * sizeof(uint);
}

static bool state_clear(Launcher *launcher, const Batch *batch, const StepList *list, Error *error)
{
    static const uint ZERO = 0;
    bool done = true;
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT && done; ++id)
        if (list->words_per_item[id] > 0)
            done = check(launcher,
                         clEnqueueFillBuffer(launcher->compute, state_buffer(launcher, batch, id), &ZERO, sizeof ZERO,
                                             0, state_bytes(batch, list, id), 0, NULL, NULL),
                         "clearing state", error);
    return done;
}

/* *words: a copy of a buffer, to be freed also on failure. */
static bool state_read(Launcher *launcher, const Batch *batch, const StepList *list, int id, uint **words, Error *error)
{
    size_t bytes = state_bytes(batch, list, id);
    *words = malloc(bytes);
    if (!*words)
        return error_memory(error, bytes, "a copy of the device's state");
    return check(launcher,
                 clEnqueueReadBuffer(launcher->compute, state_buffer(launcher, batch, id), CL_TRUE, 0, bytes, *words, 0,
                                     NULL, NULL),
                 "reading state", error);
}

bool inspect_batch(Launcher *launcher, Batch *batch, const StepList *list, uint first, StateSink sink, void *context,
                   Error *error)
{
    bool dropped; /* cannot happen: no stop flag is set */
    bool done = state_clear(launcher, batch, list, error) && batch_launch(launcher, batch, list, &dropped, error);
    clFinish(launcher->compute);
    cl_int status = clFinish(launcher->copy);
    done = done && check(launcher, status, "computing", error);
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT && done; ++id)
        if (list->words_per_item[id] > 0) {
            uint *words;
            done = state_read(launcher, batch, list, id, &words, error);
            if (done)
                sink(context, (BufferId)id, words, first, batch->frame.pass.item_count, batch->frame.pass.stride);
            free(words);
        }
    return done;
}
