/* Trees of boxes by Embree's builder, before they are flattened. */
#ifndef TWINLIGHT_BACKEND_BVH_TREE_H
#define TWINLIGHT_BACKEND_BVH_TREE_H

#include "base/error.h"
#include "geometry/box.h"

#include <embree3/rtcore.h>

#define BVH_WIDTH 4
#define BVH_LEAF_ITEMS 4

/* What the tree is over: `id` is a primitive or, when `instance` is 1, an instance. */
typedef struct BvhItem {
    uint instance;
    uint id;
} BvhItem;

/* An inner node, or a leaf when child_count is 0. */
typedef struct BvhTreeNode {
    uint child_count;
    uint item_count;
    struct BvhTreeNode *child[BVH_WIDTH];
    struct RTCBounds box[BVH_WIDTH]; /* of the children */
    BvhItem item[BVH_LEAF_ITEMS];
} BvhTreeNode;

/* The boxes that a tree is made over; `count` of them, with room for as many as bvh_boxes_create was asked for. */
typedef struct BvhBoxes {
    struct RTCBuildPrimitive *boxes;
    size_t count;
} BvhBoxes;

bool bvh_boxes_create(BvhBoxes *boxes, size_t capacity, Error *error);
void bvh_boxes_add(BvhBoxes *boxes, Box box, BvhItem item);
void bvh_boxes_destroy(BvhBoxes *boxes);

/* A tree of at most `max_depth` levels of inner nodes, roughly the best by the surface area heuristic as long as that
 * leaves it far from this depth. NULL when Embree cannot make one. It lives in `bvh`. The boxes may change places. */
BvhTreeNode *bvh_tree_build(RTCBVH bvh, BvhBoxes *boxes, uint max_depth);

/* Sizes of a tree. */
typedef struct BvhTreeSize {
    size_t nodes; /* inner */
    size_t items;
    uint depth; /* levels of inner nodes */
    uint stack; /* siblings that may wait at one time */
} BvhTreeSize;
BvhTreeSize bvh_tree_size(const BvhTreeNode *node);

#endif
