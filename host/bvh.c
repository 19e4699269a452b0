#include "bvh.h"

#include "bvh_traverse.h"

#include <stdlib.h>
#include <string.h>

bool bvh_build_bounded(const BackendScene *scene, uint stack, Bvh *bvh, Error *error)
{
    (void)scene;
    (void)stack;
    memset(bvh, 0, sizeof *bvh);
    return error_set(error, "the hierarchy cannot be built yet");
}

bool bvh_build(const BackendScene *scene, Bvh *bvh, Error *error)
{
    return bvh_build_bounded(scene, BVH_STACK, bvh, error);
}

void bvh_destroy(Bvh *bvh)
{
    free(bvh->words);
    memset(bvh, 0, sizeof *bvh);
}
