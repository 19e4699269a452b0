#include "kernel_scene.h"

#include <stdlib.h>
#include <string.h>

/* FrameParams are copied for every chunk of items. */
_Static_assert(sizeof(FrameParams) <= 1024, "parameters that only some passes need belong in Guide");

struct KernelScene {
    BackendScene view;
};

KernelScene *kernel_scene_create(const BackendScene *scene, Error *error)
{
    KernelScene *out = malloc(sizeof *out);
    if (out)
        out->view = *scene;
    else
        error_memory(error, sizeof *out, "the CPU backend");
    return out;
}

void kernel_scene_destroy(KernelScene *scene)
{
    free(scene);
}

const BackendScene *kernel_scene_view(const KernelScene *scene)
{
    return &scene->view;
}

size_t kernel_frame_bytes(void)
{
    return 0;
}

void *kernel_frame(const KernelScene *scene, FrameParams *frame, void *storage)
{
    (void)scene;
    (void)storage;
    return frame;
}

size_t kernel_guide_bytes(void)
{
    return 0;
}

void *kernel_guide(const Guide *guide, void *storage)
{
    (void)storage;
    return (void *)(uintptr_t)guide; /* the array of arguments cannot express const */
}

uint *kernel_state_create(size_t words)
{
    size_t bytes = (words * sizeof(uint) + 63) / 64 * 64;
    uint *out = aligned_alloc(64, bytes);
    if (out)
        memset(out, 0, bytes);
    return out;
}
