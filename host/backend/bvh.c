#include "backend/bvh.h"

#include "backend/bvh_tree.h"
#include "backend/instance_bounds.h"
#include "base/timing.h"
#include "geometry/bvh_traverse.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Depth limit of the first attempt, which leaves the surface area heuristic a free choice. Embree reserves eight levels
 * of it. */
#define DEPTH_FREE 64u

/* Stack entries besides waiting siblings: BVH_EMPTY at the bottom; inside an instance, the rest of the leaf and
 * BVH_RETURN. */
#define STACK_BOTTOM 1u
#define STACK_INSTANCE 2u

#define NODE_WORDS (4u * BVH_NODE_QUADS)
#define ITEM_WORDS (4u * BVH_ITEM_QUADS)
#define BUFFER_ALIGNMENT 128u
#define ITEMS_MAX (BVH_LEAF_FIRST_MASK - 16u)

typedef struct BuiltObject {
    Box box; /* without margin */
    uint root; /* BVH_EMPTY for an empty object */
    BvhTreeSize size;
} BuiltObject;

typedef struct Builder {
    RTCDevice device;
    SceneView view;
    size_t object_count, instance_count;
    BuiltObject *objects;
    uint stack; /* stack size of the traversal, entries */
    float origin_ulps; /* largest of all instances, for the buffer's header */
    Bvh *bvh;
    size_t capacity; /* words */
    char failure[256]; /* Embree's first error message */
} Builder;

/* ---- the buffer -------------------------------------------------------------------------------------------------- */

static bool words_reserve(Builder *builder, size_t words, Error *error)
{
    Bvh *bvh = builder->bvh;
    if (words <= builder->capacity)
        return true;
    size_t capacity = words > builder->capacity * 3 / 2 ? words : builder->capacity * 3 / 2;
    capacity = (capacity + NODE_WORDS - 1) / NODE_WORDS * NODE_WORDS;
    uint *larger = aligned_alloc(BUFFER_ALIGNMENT, capacity * sizeof *larger);
    if (!larger)
        return error_memory(error, capacity * sizeof *larger, "the hierarchy of the scene");
    if (bvh->words)
        memcpy(larger, bvh->words, bvh->word_count * sizeof *larger);
    free(bvh->words);
    bvh->words = larger;
    builder->capacity = capacity;
    return true;
}

/* Pads the buffer with zeros to a multiple of `unit` words; returns its size in units. */
static size_t words_align(Bvh *bvh, size_t unit)
{
    size_t end = (bvh->word_count + unit - 1) / unit * unit;
    memset(bvh->words + bvh->word_count, 0, (end - bvh->word_count) * sizeof *bvh->words);
    bvh->word_count = end;
    return end / unit;
}

/* Write positions for the nodes and items of one tree. */
typedef struct Flattener {
    const SceneView *view;
    const BuiltObject *objects;
    uint *words;
    uint next_node, next_item;
} Flattener;

static void corner_write(uint *out, Vec3 p)
{
    out[0] = float_bits(p.x);
    out[4] = float_bits(p.y);
    out[8] = float_bits(p.z);
}

static void item_write(const Flattener *flattener, uint *out, BvhItem item)
{
    const SceneView *view = flattener->view;
    uint *tag = out + 4 * BVH_ITEM_TAG;
    memset(out, 0, ITEM_WORDS * sizeof *out);
    tag[0] = item.id;
    if (item.instance) {
        tag[1] = BVH_INSTANCE;
        tag[2] = flattener->objects[view->instances[item.id].object].root;
        return;
    }
    Primitive primitive = view->primitives[item.id];
    tag[1] = primitive.shape_and_kind;
    if (primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_TRIANGLE)
        return;
    corner_write(out, view->positions[primitive.a]);
    corner_write(out + 1, view->positions[primitive.b]);
    corner_write(out + 2, view->positions[primitive.c]);
}

static uint leaf_write(Flattener *flattener, const BvhTreeNode *leaf)
{
    uint first = flattener->next_item;
    assert(leaf->item_count > 0 && leaf->item_count <= BVH_LEAF_ITEMS);
    for (uint i = 0; i < leaf->item_count; ++i)
        item_write(flattener, flattener->words + (size_t)(first + i) * ITEM_WORDS, leaf->item[i]);
    flattener->next_item += leaf->item_count;
    return BVH_LEAF | (leaf->item_count - 1u) << BVH_LEAF_COUNT_SHIFT | first;
}

/* Writes the planes of child `lane`; for no child an empty box, which a ray leaves before it enters. */
static void planes_write(uint *node, uint lane, const struct RTCBounds *box)
{
    const float inf = FLOAT_INFINITY;
    const float low[3] = {box ? box->lower_x : inf, box ? box->lower_y : inf, box ? box->lower_z : inf};
    const float high[3] = {box ? box->upper_x : -inf, box ? box->upper_y : -inf, box ? box->upper_z : -inf};
    for (uint axis = 0; axis < 3; ++axis) {
        node[8 * axis + lane] = float_bits(low[axis]);
        node[8 * axis + 4 + lane] = float_bits(high[axis]);
    }
}

/* Writes `tree` as node `place`; its inner children get consecutive nodes after those already allocated. */
static void node_write(Flattener *flattener, const BvhTreeNode *tree, uint place)
{
    uint *node = flattener->words + (size_t)place * NODE_WORDS, word[BVH_WIDTH] = {0};
    memset(node, 0, NODE_WORDS * sizeof *node);
    for (uint i = 0; i < BVH_WIDTH; ++i)
        planes_write(node, i, i < tree->child_count ? &tree->box[i] : NULL);
    for (uint i = 0; i < tree->child_count; ++i)
        word[i] = tree->child[i]->child_count > 0 ? flattener->next_node++ : leaf_write(flattener, tree->child[i]);
    memcpy(node + 24, word, sizeof word);
    for (uint i = 0; i < tree->child_count; ++i)
        if (tree->child[i]->child_count > 0)
            node_write(flattener, tree->child[i], word[i]);
}

static bool tree_flatten(Builder *builder, BuiltObject *object, const BvhTreeNode *tree, Error *error)
{
    Bvh *bvh = builder->bvh;
    size_t words = object->size.nodes * NODE_WORDS + object->size.items * ITEM_WORDS + NODE_WORDS + ITEM_WORDS;
    size_t items_end = (bvh->word_count + words) / ITEM_WORDS;
    if (items_end > ITEMS_MAX) {
        error_set(error, "the scene's hierarchy takes more than %zu bytes", (size_t)ITEMS_MAX * ITEM_WORDS * 4);
        return error_fix(error, "render with --backend=cpu");
    }
    if (!words_reserve(builder, bvh->word_count + words, error))
        return false;
    Flattener flattener = {.view = &builder->view, .objects = builder->objects, .words = bvh->words};
    flattener.next_node = (uint)words_align(bvh, NODE_WORDS);
    bvh->word_count += object->size.nodes * NODE_WORDS;
    flattener.next_item = (uint)words_align(bvh, ITEM_WORDS);
    bvh->word_count += object->size.items * ITEM_WORDS;
    if (tree->child_count == 0)
        object->root = leaf_write(&flattener, tree);
    else {
        object->root = flattener.next_node++;
        node_write(&flattener, tree, object->root);
    }
    bvh->node_count += (uint)object->size.nodes;
    bvh->item_count += (uint)object->size.items;
    return true;
}

/* ---- objects ----------------------------------------------------------------------------------------------------- */

/* Stack entries that object `index` may use: half of what instancing leaves, or, for the world (index 0, built last),
 * what the deepest object leaves. */
static uint object_stack(const Builder *builder, size_t index)
{
    uint taken = STACK_BOTTOM, deepest = 0;
    if (builder->instance_count > 0)
        taken += STACK_INSTANCE;
    uint left = builder->stack > taken ? builder->stack - taken : 0;
    if (index > 0)
        return left / 2;
    for (size_t i = 1; i < builder->object_count; ++i)
        if (builder->objects[i].size.stack > deepest)
            deepest = builder->objects[i].size.stack;
    return left - deepest;
}

static bool embree_failed(const Builder *builder, size_t count, Error *error)
{
    return error_set(error, "Embree cannot build a hierarchy over %zu boxes: %s", count,
                     builder->failure[0] ? builder->failure : "no reason given");
}

/* Builds the best tree if it is shallow enough for the stack, else one with a depth limit, below which nodes are split
 * in halves. */
static bool object_tree(Builder *builder, size_t index, RTCBVH bvh, BvhBoxes *boxes, Error *error)
{
    BuiltObject *object = &builder->objects[index];
    uint stack = object_stack(builder, index);
    BvhTreeNode *tree = bvh_tree_build(bvh, boxes, DEPTH_FREE);
    if (!tree)
        return embree_failed(builder, boxes->count, error);
    object->size = bvh_tree_size(tree);
    if (object->size.stack > stack) {
        tree = bvh_tree_build(bvh, boxes, stack / (BVH_WIDTH - 1));
        object->size = tree ? bvh_tree_size(tree) : object->size;
        if (!tree || object->size.stack > stack) {
            error_set(error, "the hierarchy over %zu primitives and instances is too deep for a stack of %u entries",
                      boxes->count, builder->stack);
            return error_fix(error, "render with --backend=cpu");
        }
    }
    return tree_flatten(builder, object, tree, error);
}

static void object_boxes(const Builder *builder, BuiltObject *object, Object record, BvhBoxes *boxes)
{
    object->box = box_empty();
    for (uint i = 0; i < record.primitive_count; ++i) {
        uint id = record.first_primitive + i;
        Box box = primitive_box(&builder->view, id);
        box_join(&object->box, &box);
        bvh_boxes_add(boxes, box_inflate(box, box_margin(&box, 0.0f)), (BvhItem){.instance = 0, .id = id});
    }
}

/* Adds the instances' boxes and raises *origin_ulps to the largest margin that rays of the world need for any of
 * them. */
static void instance_boxes(const Builder *builder, BvhBoxes *boxes, float *origin_ulps)
{
    for (uint i = 0; i < builder->instance_count; ++i) {
        const Instance *instance = &builder->view.instances[i];
        const BuiltObject *object = &builder->objects[instance->object];
        if (object->root == BVH_EMPTY)
            continue;
        InstanceBounds bounds = instance_bounds(instance, &object->box);
        *origin_ulps = float_max(*origin_ulps, bounds.origin_ulps);
        bvh_boxes_add(boxes, bounds.box, (BvhItem){.instance = 1, .id = i});
    }
}

static bool object_build(Builder *builder, size_t index, Error *error)
{
    BuiltObject *object = &builder->objects[index];
    Object record = builder->view.objects[index];
    size_t instances = index == 0 ? builder->instance_count : 0;
    BvhBoxes boxes = {0};
    object->root = BVH_EMPTY;
    if (!bvh_boxes_create(&boxes, record.primitive_count + instances, error))
        return false;
    object_boxes(builder, object, record, &boxes);
    if (instances > 0)
        instance_boxes(builder, &boxes, &builder->origin_ulps);
    bool built = true;
    if (boxes.count > 0) {
        RTCBVH bvh = rtcNewBVH(builder->device);
        built = object_tree(builder, index, bvh, &boxes, error);
        rtcReleaseBVH(bvh);
    }
    bvh_boxes_destroy(&boxes);
    return built;
}

/* ---- building ---------------------------------------------------------------------------------------------------- */

static void embree_error_callback(void *context, enum RTCError code, const char *text)
{
    Builder *builder = context;
    (void)code;
    if (builder->failure[0] == '\0')
        snprintf(builder->failure, sizeof builder->failure, "%s", text ? text : "unknown error");
}

static void builder_measure(Builder *builder)
{
    Bvh *bvh = builder->bvh;
    uint depth = 0, stack = 0;
    for (size_t i = 1; i < builder->object_count; ++i) {
        BvhTreeSize size = builder->objects[i].size;
        depth = size.depth > depth ? size.depth : depth;
        stack = size.stack + STACK_INSTANCE > stack ? size.stack + STACK_INSTANCE : stack;
    }
    bvh->max_depth = builder->objects[0].size.depth + depth;
    bvh->stack = STACK_BOTTOM + builder->objects[0].size.stack + stack;
}

static bool builder_run(Builder *builder, Error *error)
{
    builder->device = rtcNewDevice("set_affinity=0");
    if (!builder->device)
        return error_set(error, "cannot start Embree (error %d)", (int)rtcGetDeviceError(NULL));
    rtcSetDeviceErrorFunction(builder->device, embree_error_callback, builder);
    builder->objects = calloc(builder->object_count + 1, sizeof *builder->objects);
    if (!builder->objects)
        return error_memory(error, builder->object_count * sizeof *builder->objects, "the hierarchy of the scene");
    if (!words_reserve(builder, NODE_WORDS, error))
        return false;
    memset(builder->bvh->words, 0, NODE_WORDS * sizeof *builder->bvh->words);
    builder->bvh->word_count = NODE_WORDS;
    /* The world is built last: its instances need the boxes and roots of their objects. */
    for (size_t i = builder->object_count; i-- > 0;)
        if (!object_build(builder, i, error))
            return false;
    builder->bvh->words[BVH_ORIGIN_ULPS] = float_bits(builder->origin_ulps);
    builder->bvh->words[BVH_ROOT] = builder->object_count > 0 ? builder->objects[0].root : BVH_EMPTY;
    builder_measure(builder);
    return true;
}

bool bvh_build_bounded(const BackendScene *scene, uint stack, Bvh *bvh, Error *error)
{
    double begin = timing_now();
    Builder builder = {.view = scene_view(scene->frame, scene->geometry, scene->tables, scene->texels),
                       .object_count = scene->object_count,
                       .instance_count = scene->instance_count,
                       .stack = stack,
                       .origin_ulps = BOX_ULPS,
                       .bvh = bvh};
    memset(bvh, 0, sizeof *bvh);
    bool built = builder_run(&builder, error);
    if (builder.device)
        rtcReleaseDevice(builder.device);
    free(builder.objects);
    if (!built)
        bvh_destroy(bvh);
    bvh->build_seconds = timing_now() - begin;
    return built;
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
