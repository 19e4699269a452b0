/* Scene, frame and state in the format of this build's kernels: the host's (kernel_scene.c), or with doubles for floats
 * (kernel_scene_double.c, --enable-double). */
#ifndef TWINLIGHT_KERNEL_SCENE_H
#define TWINLIGHT_KERNEL_SCENE_H

#include "backend/backend.h"

typedef struct KernelScene KernelScene;

/* NULL when out of memory; *error says so. The scene's words are borrowed. */
KernelScene *kernel_scene_create(const BackendScene *scene, Error *error);
void kernel_scene_destroy(KernelScene *scene);

/* The words of the scene, and the frame that it was made with. */
const BackendScene *kernel_scene_view(const KernelScene *scene);

/* The host's frame as kernels need it: itself, or a copy in `storage`, which must have kernel_frame_bytes() bytes and
 * the alignment of a double. */
size_t kernel_frame_bytes(void);
void *kernel_frame(const KernelScene *scene, FrameParams *frame, void *storage);

/* The same for a pass's guide; NULL: it has none. */
size_t kernel_guide_bytes(void);
void *kernel_guide(const Guide *guide, void *storage);

/* Zeroed words of state, to be freed with free(). NULL when out of memory, or with doubles if there are more than
 * STATE_BLOCK has room for. */
uint *kernel_state_create(size_t words);

#endif
