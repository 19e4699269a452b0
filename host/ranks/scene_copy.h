/* The packed scene on ranks that have not read it. */
#ifndef TWINLIGHT_RANKS_SCENE_COPY_H
#define TWINLIGHT_RANKS_SCENE_COPY_H

#include "backend/backend.h"

typedef struct SceneCopy {
    FrameParams frame;
    uint *geometry, *tables, *texels;
    BackendScene scene; /* refers to the members above */
} SceneCopy;

/* On rank 0, and on each of the others: the scene goes to all. */
void scene_send(const BackendScene *scene);
bool scene_receive(SceneCopy *copy, Error *error);

void scene_copy_destroy(SceneCopy *copy);

#endif
