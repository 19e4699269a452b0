/* Loops over the items of each kernel in a list, for the translation units that define the kernels. */
#ifndef TWINLIGHT_KERNEL_LOOP_H
#define TWINLIGHT_KERNEL_LOOP_H

/* The view that kernels use instead of making their own: making one costs as much as loading a vertex, and compilers do
 * not hoist it out of the loop. */
#define KERNEL_SCENE(frame, geometry, tables, texels)                                                                  \
    const SceneView *scene = ((void)(frame), (void)(geometry), (void)(tables), (void)(texels), &kernel_scene)
#define KERNEL_SCENE_GUIDED(frame, guided_by, geometry, tables, texels)                                                \
    const SceneView *scene =                                                                                           \
        ((void)(frame), (void)(guided_by), (void)(geometry), (void)(tables), (void)(texels), &kernel_scene)

#define KERNEL_SCENE_PHOTONS(frame, guided_by, photon_map, geometry, tables, texels)                                   \
    const SceneView *scene = ((void)(frame), (void)(guided_by), (void)(photon_map), (void)(geometry), (void)(tables),  \
                              (void)(texels), &kernel_scene)

/* Kernels in the loops of a chunk know their stride at compile time. Translation units whose kernels also run on other
 * buffers, in tests, define KERNEL_ANY_STRIDE. */
#ifndef KERNEL_ANY_STRIDE
#include "chunk.h"
#define STATE_STRIDE CHUNK_STRIDE
#define STRIDE_IS_KNOWN(frame) ((frame)->pass.stride == CHUNK_STRIDE)
#else
#define STRIDE_IS_KNOWN(frame) ((frame) != NULL)
#endif

#include "backend/backend.h"
#include "layout/kernel_list.h"
#include "layout/scene_view.h"

#include <assert.h>

/* The scene of the running loop. */
static _Thread_local SceneView kernel_scene __attribute__((unused));

typedef void KernelLoop(void *const *buffers, const uint *items, uint count);

#define KERNEL_DECLARE(name, n, ...)                                                                                   \
    KernelLoop kernel_loop_##name, kernel_plain_##name, kernel_wide_##name, kernel_wide_plain_##name;
KERNEL_LIST(KERNEL_DECLARE)
#undef KERNEL_DECLARE

#define ARGUMENTS_2(a, b) buffers[a], buffers[b]
#define ARGUMENTS_3(a, b, c) ARGUMENTS_2(a, b), buffers[c]
#define ARGUMENTS_4(a, b, c, d) ARGUMENTS_3(a, b, c), buffers[d]
#define ARGUMENTS_5(a, b, c, d, e) ARGUMENTS_4(a, b, c, d), buffers[e]
#define ARGUMENTS_6(a, b, c, d, e, f) ARGUMENTS_5(a, b, c, d, e), buffers[f]
#define ARGUMENTS_7(a, b, c, d, e, f, g) ARGUMENTS_6(a, b, c, d, e, f), buffers[g]
#define ARGUMENTS_8(a, b, c, d, e, f, g, h) ARGUMENTS_7(a, b, c, d, e, f, g), buffers[h]
#define ARGUMENTS_9(a, b, c, d, e, f, g, h, i) ARGUMENTS_8(a, b, c, d, e, f, g, h), buffers[i]
#define ARGUMENTS_10(a, b, c, d, e, f, g, h, i, j) ARGUMENTS_9(a, b, c, d, e, f, g, h, i), buffers[j]
#define ARGUMENTS_11(a, b, c, d, e, f, g, h, i, j, k) ARGUMENTS_10(a, b, c, d, e, f, g, h, i, j), buffers[k]

#define ARGUMENTS_12(a, b, c, d, e, f, g, h, i, j, k, l) ARGUMENTS_11(a, b, c, d, e, f, g, h, i, j, k), buffers[l]

/* A translation unit that is compiled with other options defines other names. */
#ifndef KERNEL_LOOP_NAME
#define KERNEL_LOOP_NAME(name) kernel_loop_##name
#endif

/* One loop per kernel, with the kernel inlined into it. */
#define KERNEL_LOOP(name, n, ...)                                                                                      \
    void KERNEL_LOOP_NAME(name)(void *const *buffers, const uint *items, uint count)                                   \
    {                                                                                                                  \
        assert(STRIDE_IS_KNOWN((const FrameParams *)buffers[BUFFER_FRAME]));                                           \
        kernel_scene = scene_view(buffers[BUFFER_FRAME], buffers[BUFFER_GEOMETRY], buffers[BUFFER_TABLES],             \
                                  buffers[BUFFER_TEXELS]);                                                             \
        kernel_scene.guide = buffers[BUFFER_GUIDE];                                                                    \
        kernel_scene.photons = buffers[BUFFER_PHOTONS];                                                                \
        for (uint i = 0; i < count; ++i) {                                                                             \
            platform_item = items ? items[i] : i;                                                                      \
            name(ARGUMENTS_##n(__VA_ARGS__));                                                                          \
        }                                                                                                              \
    }
#endif
