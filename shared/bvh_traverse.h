/* Rays through the hierarchy in BUFFER_BVH. */
#ifndef TWINLIGHT_BVH_TRAVERSE_H
#define TWINLIGHT_BVH_TRAVERSE_H

#include "primitive.h"

/* Entries of the traversal's stack. */
#define BVH_STACK 64u

SHARED_FUNCTION Hit bvh_closest(const SceneView *scene, __global const uint *bvh, Ray ray)
{
    (void)scene;
    (void)bvh;
    return hit_none(ray.t_max);
}

SHARED_FUNCTION bool bvh_occluded(const SceneView *scene, __global const uint *bvh, Ray ray)
{
    (void)scene;
    (void)bvh;
    (void)ray;
    return false;
}

#endif
