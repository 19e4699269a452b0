/* Scene, frame and state as the kernels of this build have them: as the host does (kernel_scene.c), or with doubles for
 * floats (kernel_scene_double.c, --enable-double). */
#ifndef TWINLIGHT_KERNEL_SCENE_H
#define TWINLIGHT_KERNEL_SCENE_H

#include "backend/backend.h"

typedef struct KernelScene KernelScene;

/* NULL when out of memory. The scene's words are borrowed. */
KernelScene *kernel_scene_create(const BackendScene *scene, Error *error);
void kernel_scene_destroy(KernelScene *scene);

/* Its words, and the frame that it was made with. */
const BackendScene *kernel_scene_view(const KernelScene *scene);

/* The host's frame for kernels: itself, or a copy in `storage`, which has kernel_frame_bytes() and the alignment of a
 * double. */
size_t kernel_frame_bytes(void);
void *kernel_frame(const KernelScene *scene, FrameParams *frame, void *storage);

/* The same of a pass's guide. NULL: there is none. */
size_t kernel_guide_bytes(void);
void *kernel_guide(const Guide *guide, void *storage);

/* Zeroed words of state, to be freed with free(). NULL when there are too many. */
uint *kernel_state_create(size_t words);

#endif
