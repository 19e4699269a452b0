#include "backend/bvh_tree.h"

#include <stdlib.h>
#include <string.h>

/* Relative costs of a node and of a primitive in the surface area heuristic. */
#define COST_NODE 1.0f
#define COST_ITEM 1.0f

/* Number of leaf items that are intersected at the cost of one. */
#define COST_BLOCK 2

bool bvh_boxes_create(BvhBoxes *boxes, size_t capacity, Error *error)
{
    size_t bytes = (capacity + 1) * sizeof *boxes->boxes;
    boxes->count = 0;
    boxes->boxes = aligned_alloc(64, (bytes + 63) / 64 * 64);
    return boxes->boxes || error_memory(error, bytes, "the boxes of a hierarchy");
}

void bvh_boxes_add(BvhBoxes *boxes, Box box, BvhItem item)
{
    boxes->boxes[boxes->count++] = (struct RTCBuildPrimitive){.lower_x = box.low[0],
                                                              .lower_y = box.low[1],
                                                              .lower_z = box.low[2],
                                                              .geomID = item.instance,
                                                              .upper_x = box.high[0],
                                                              .upper_y = box.high[1],
                                                              .upper_z = box.high[2],
                                                              .primID = item.id};
}

void bvh_boxes_destroy(BvhBoxes *boxes)
{
    free(boxes->boxes);
    memset(boxes, 0, sizeof *boxes);
}

/* ---- callbacks of Embree, from many threads ---------------------------------------------------------------------- */

static void *build_node(RTCThreadLocalAllocator allocator, unsigned children, void *context)
{
    (void)context;
    BvhTreeNode *node = rtcThreadLocalAlloc(allocator, offsetof(BvhTreeNode, item), 16);
    node->child_count = children;
    node->item_count = 0;
    return node;
}

static void build_children(void *pointer, void **children, unsigned count, void *context)
{
    BvhTreeNode *node = pointer;
    (void)context;
    for (unsigned i = 0; i < count; ++i)
        node->child[i] = children[i];
}

static void build_bounds(void *pointer, const struct RTCBounds **bounds, unsigned count, void *context)
{
    BvhTreeNode *node = pointer;
    (void)context;
    for (unsigned i = 0; i < count; ++i)
        node->box[i] = *bounds[i];
}

static void *build_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *boxes, size_t count,
                        void *context)
{
    (void)context;
    BvhTreeNode *node = rtcThreadLocalAlloc(allocator, sizeof *node, 16);
    node->child_count = 0;
    node->item_count = (uint)count;
    for (size_t i = 0; i < count; ++i)
        node->item[i] = (BvhItem){.instance = boxes[i].geomID, .id = boxes[i].primID};
    return node;
}

BvhTreeNode *bvh_tree_build(RTCBVH bvh, BvhBoxes *boxes, uint max_depth)
{
    struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.bvh = bvh;
    arguments.primitives = boxes->boxes;
    arguments.primitiveCount = boxes->count;
    arguments.primitiveArrayCapacity = boxes->count;
    arguments.maxBranchingFactor = BVH_WIDTH;
    arguments.maxDepth = max_depth;
    arguments.sahBlockSize = COST_BLOCK;
    arguments.maxLeafSize = BVH_LEAF_ITEMS;
    arguments.traversalCost = COST_NODE;
    arguments.intersectionCost = COST_ITEM;
    arguments.createNode = build_node;
    arguments.setNodeChildren = build_children;
    arguments.setNodeBounds = build_bounds;
    arguments.createLeaf = build_leaf;
    return rtcBuildBVH(&arguments);
}

BvhTreeSize bvh_tree_size(const BvhTreeNode *node)
{
    BvhTreeSize size = {.items = node->item_count};
    if (node->child_count == 0)
        return size;
    size.nodes = 1;
    for (uint i = 0; i < node->child_count; ++i) {
        BvhTreeSize child = bvh_tree_size(node->child[i]);
        size.nodes += child.nodes;
        size.items += child.items;
        size.depth = child.depth > size.depth ? child.depth : size.depth;
        size.stack = child.stack > size.stack ? child.stack : size.stack;
    }
    ++size.depth;
    size.stack += node->child_count - 1;
    return size;
}
