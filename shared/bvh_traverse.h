/* Rays through the hierarchy in BUFFER_BVH: two nested loops, one that descends through nodes and one over the
 * primitives of a leaf, with a bounded stack in private memory.
 *
 * The buffer is made of quads, four words that are read at once. Node n begins at quad n * BVH_NODE_QUADS; in the place
 * of node 0 is the header. A node has up to four children: quads 0 ... 5 are the low and high planes of their boxes along
 * x, y, z, a lane a child; quad 6 holds the children's words; quad 7 keeps nodes to a device's cache lines of 128 bytes.
 * Lanes without a child have a box that nothing meets. A child's word is the number of an inner node, or BVH_LEAF with
 * the number of items, less one, and the first of them. Item i, a primitive or an instance, begins at quad
 * i * BVH_ITEM_QUADS:
 *
 *     a.x b.x c.x 0   a.y b.y c.y 0   a.z b.z c.z 0   id shape_and_kind 0    0     a triangle's corners by axis
 *     0   0   0   0   0   0   0   0   0   0   0   0   id shape_and_kind 0    0     another primitive: see the scene
 *     0   0   0   0   0   0   0   0   0   0   0   0   id BVH_INSTANCE   root 0     an instance and its object's root
 *
 * A ray takes the axes in its own order (RayQuery), so it reads its quads in that order and permutes nothing.
 * An object's nodes lie together, children of a node side by side, and its items behind them.
 *
 * Boxes are widened by box_margin as backend_cpu's are, so whichever boxes a ray is found to meet, the answer is the
 * smallest (t, instance, primitive) of the shared primitive test, and the arithmetic of boxes decides no bit of it. */
#ifndef TWINLIGHT_BVH_TRAVERSE_H
#define TWINLIGHT_BVH_TRAVERSE_H

#include "primitive.h"

/* Entries of the stack. The build refuses what would need more. */
#define BVH_STACK 96u

#define BVH_NODE_QUADS 8u
#define BVH_ITEM_QUADS 4u
#define BVH_ITEM_TAG 3u /* quad of an item */

/* The word of the header that holds the world's root. */
#define BVH_ROOT 0u

/* Children. */
#define BVH_LEAF 0x80000000u
#define BVH_LEAF_COUNT_SHIFT 28
#define BVH_LEAF_COUNT_MASK 3u
#define BVH_LEAF_FIRST_MASK 0x0fffffffu
#define BVH_EMPTY 0xffffffffu /* nothing left, or nothing at all */
#define BVH_RETURN 0xfffffffeu /* on the stack: leave the instance */

/* What an item of an instance has for a tag: no kind of primitive. */
#define BVH_INSTANCE 0xffffffffu

#define BVH_MISS 0xffffffffu

/* ---- boxes ------------------------------------------------------------------------------------------------------- */

/* A ray as boxes see it. d is scaled by a power of two so that its largest component lies in [1, 2): reciprocals
 * neither overflow nor lose what is left of a very short one. */
typedef struct BvhRay {
    float ix, iy, iz; /* 1 / d */
    float ox, oy, oz; /* -o / d: a plane at p is met at p i + o, one instruction on a device */
    uint nx, ny, nz; /* the quad of a node with the planes that the ray meets first; the others are in quad n ^ 1 */
    float scale; /* t of boxes over t of the ray */
} BvhRay;

/* A component this small, beside one of 1 or more, is taken for its size: within the scene that moves no point of the
 * ray by anything near the margin of boxes. */
#define BVH_SMALL 8.6736173798840355e-19f /* 2^-60 */

SHARED_FUNCTION float bvh_reciprocal(float d)
{
    float size = float_max(float_abs(d), BVH_SMALL);
    return 1.0f / (d < 0.0f ? -size : size);
}

/* o, d: traceable (ray_traceable). */
SHARED_FUNCTION BvhRay bvh_ray(Vec3 o, Vec3 d)
{
    BvhRay ray;
    uint exponent = float_bits(vec3_max_abs(d)) & 0x7f800000u;
    float stretch = bits_float(0x7f000000u - exponent);
    ray.scale = bits_float(exponent != 0u ? exponent : 0x00400000u);
    ray.ix = bvh_reciprocal(d.x * stretch);
    ray.iy = bvh_reciprocal(d.y * stretch);
    ray.iz = bvh_reciprocal(d.z * stretch);
    ray.ox = -(o.x * ray.ix);
    ray.oy = -(o.y * ray.iy);
    ray.oz = -(o.z * ray.iz);
    ray.nx = d.x < 0.0f ? 1u : 0u;
    ray.ny = d.y < 0.0f ? 3u : 2u;
    ray.nz = d.z < 0.0f ? 5u : 4u;
    return ray;
}

/* For each child: where the ray enters its box, as bits that order like numbers, with the child's lane in the lowest
 * two; BVH_MISS where it does not enter it before `limit`. */
SHARED_FUNCTION Uint4 bvh_node_keys(__global const Float4 *node, const BvhRay *ray, float limit)
{
    Float4 near_x = float4_mad(node[ray->nx], ray->ix, ray->ox);
    Float4 far_x = float4_mad(node[ray->nx ^ 1u], ray->ix, ray->ox);
    Float4 near_y = float4_mad(node[ray->ny], ray->iy, ray->oy);
    Float4 far_y = float4_mad(node[ray->ny ^ 1u], ray->iy, ray->oy);
    Float4 near_z = float4_mad(node[ray->nz], ray->iz, ray->oz);
    Float4 far_z = float4_mad(node[ray->nz ^ 1u], ray->iz, ray->oz);
    Float4 enter = float4_max(float4_max(near_x, near_y), float4_max(near_z, float4_splat(0.0f)));
    Float4 leave = float4_min(float4_min(far_x, far_y), float4_min(far_z, float4_splat(limit)));
    Uint4 key = (float4_bits(enter) & 0x7ffffffcu) | uint4_make(0u, 1u, 2u, 3u);
    return key | ~float4_at_most(enter, leave);
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

/* What waits to be done. */
typedef struct BvhEntry {
    uint word; /* of a child */
    float enter; /* where the ray enters it, in t of boxes; 0 for what must be done in any case */
} BvhEntry;

/* One traversal under way, but for the stack: an array whose index is known at run time only lies in memory, and what
 * shares a struct with it would too. */
typedef struct BvhWalk {
    BvhRay boxes; /* the ray in the space of `instance` */
    RayQuery query; /* the same for primitives */
    uint instance; /* NONE in the world */
    float limit; /* best.t in t of boxes */
    Hit best;
    uint waiting; /* entries of the stack */
} BvhWalk;

SHARED_FUNCTION void bvh_push(BvhWalk *walk, BvhEntry *stack, uint word, float enter)
{
    stack[walk->waiting].word = word;
    stack[walk->waiting].enter = enter;
    ++walk->waiting;
}

/* The next child that the ray enters before the limit. The lowest entry is BVH_EMPTY at 0, which ends every walk. */
SHARED_FUNCTION uint bvh_pop(BvhWalk *walk, const BvhEntry *stack)
{
    do
        --walk->waiting;
    while (stack[walk->waiting].enter > walk->limit);
    return stack[walk->waiting].word;
}

SHARED_FUNCTION uint uint_lower(uint a, uint b)
{
    return a < b ? a : b;
}

SHARED_FUNCTION uint uint_upper(uint a, uint b)
{
    return a < b ? b : a;
}

/* Meets the node's children: the nearest is returned, the others wait on the stack, the next nearest on top. */
SHARED_FUNCTION uint bvh_descend(__global const Float4 *bvh, uint node, BvhWalk *walk, BvhEntry *stack)
{
    __global const Float4 *quads = bvh + node * BVH_NODE_QUADS;
    __global const uint *children = (__global const uint *)(quads + 6);
    Uint4 keys = bvh_node_keys(quads, &walk->boxes, walk->limit);
    uint a = uint_lower(lane_of(keys, 0), lane_of(keys, 1)), b = uint_upper(lane_of(keys, 0), lane_of(keys, 1));
    uint c = uint_lower(lane_of(keys, 2), lane_of(keys, 3)), d = uint_upper(lane_of(keys, 2), lane_of(keys, 3));
    uint first = uint_lower(a, c), fourth = uint_upper(b, d);
    a = uint_upper(a, c);
    b = uint_lower(b, d);
    uint second = uint_lower(a, b), third = uint_upper(a, b);
    if (first == BVH_MISS)
        return bvh_pop(walk, stack);
    if (fourth != BVH_MISS)
        bvh_push(walk, stack, children[fourth & 3u], bits_float(fourth));
    if (third != BVH_MISS)
        bvh_push(walk, stack, children[third & 3u], bits_float(third));
    if (second != BVH_MISS)
        bvh_push(walk, stack, children[second & 3u], bits_float(second));
    return children[first & 3u];
}

SHARED_FUNCTION void bvh_walk_space(BvhWalk *walk, RayQuery query, uint instance)
{
    walk->query = query;
    walk->instance = instance;
    walk->boxes = bvh_ray(query.o, query.d);
    walk->limit = walk->best.t * walk->boxes.scale;
}

SHARED_FUNCTION ShearedCorner bvh_corner(Float4 x, Float4 y, Float4 z, uint k)
{
    ShearedCorner corner;
    corner.x = k == 0u ? lane_of(x, 0) : k == 1u ? lane_of(x, 1) : lane_of(x, 2);
    corner.y = k == 0u ? lane_of(y, 0) : k == 1u ? lane_of(y, 1) : lane_of(y, 2);
    corner.z = k == 0u ? lane_of(z, 0) : k == 1u ? lane_of(z, 1) : lane_of(z, 2);
    return corner;
}

/* triangle_query on an item, a corner a lane: the same numbers from the same operands. Two cheap reasons to give up
 * come first that it would find later, or that a hit is not closer than t_best: all corners behind the origin, or all
 * beyond t_best by more than rounding. */
SHARED_FUNCTION bool bvh_triangle_query(__global const Float4 *quads, const RayQuery *query, float t_best, Hit *hit)
{
    Float4 sx = float4_splat(query->sx), sy = float4_splat(query->sy), sz = float4_splat(query->sz);
    Float4 z = quads[query->kz] - float4_splat(query->oz);
    Float4 x = (quads[query->kx] - float4_splat(query->ox)) - sx * z;
    Float4 y = (quads[query->ky] - float4_splat(query->oy)) - sy * z;
    z = sz * z;
    ShearedCorner a = bvh_corner(x, y, z, 0u), b = bvh_corner(x, y, z, 1u), c = bvh_corner(x, y, z, 2u);
    TriangleEdges edges = triangle_edges(a, b, c);
    float area = edges.a + edges.b + edges.c;
    if (!triangle_contains(edges) || !(area > 0.0f || area < 0.0f))
        return false;
    if (!(float_max(float_max(a.z, b.z), c.z) > 0.0f) ||
        float_min(float_min(a.z, b.z), c.z) > t_best * (1.0f + 16.0f * FLOAT_EPSILON))
        return false;
    x = quads[0];
    y = quads[1];
    z = quads[2];
    return triangle_finish(
        vec3(lane_of(x, 0), lane_of(y, 0), lane_of(z, 0)), vec3(lane_of(x, 1), lane_of(y, 1), lane_of(z, 1)),
        vec3(lane_of(x, 2), lane_of(y, 2), lane_of(z, 2)), a, b, c, edges, query, &hit->t, &hit->u, &hit->v);
}

#define BVH_FEATURES_CURVED (FEATURE_BILINEAR | FEATURE_SPHERE | FEATURE_DISK)

/* The hit of a primitive's item; *id is which. */
SHARED_FUNCTION bool bvh_item_query(const SceneView *scene, __global const Float4 *quads, const RayQuery *query,
                                    float t_best, Hit *hit, uint *id)
{
    __global const uint *tag = (__global const uint *)(quads + BVH_ITEM_TAG);
    *id = tag[0];
    if (SCENE_HAS(scene, BVH_FEATURES_CURVED) && tag[1] >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_TRIANGLE)
        return primitive_query_curved(scene, tag[0], query, hit);
    return bvh_triangle_query(quads, query, t_best, hit) && primitive_keeps(scene, query, tag[0], hit);
}

/* Into instance `id`, whose object has the root `root`, with what is left of the leaf (BVH_EMPTY: nothing) to be done after
 * it. False when the ray cannot be traced there. */
SHARED_FUNCTION bool bvh_instance_enter(const SceneView *scene, BvhWalk *walk, BvhEntry *stack, uint id, uint rest)
{
    RayQuery query = ray_query_transform(scene->instances[id].object_from_world, &walk->query);
    if (!ray_traceable(query.o, query.d))
        return false;
    if (rest != BVH_EMPTY)
        bvh_push(walk, stack, rest, 0.0f);
    bvh_push(walk, stack, BVH_RETURN, 0.0f);
    bvh_walk_space(walk, query, id);
    return true;
}

/* Asks the items of a leaf. Returns the word to go on with; BVH_EMPTY when `any` hit was asked for and is found. */
SHARED_FUNCTION uint bvh_leaf(const SceneView *scene, __global const Float4 *bvh, uint word, bool any, BvhWalk *walk,
                              BvhEntry *stack)
{
    uint item = word & BVH_LEAF_FIRST_MASK, end = item + (word >> BVH_LEAF_COUNT_SHIFT & BVH_LEAF_COUNT_MASK) + 1u;
    for (; item < end; ++item) {
        __global const Float4 *quads = bvh + item * BVH_ITEM_QUADS;
        __global const uint *tag = (__global const uint *)(quads + BVH_ITEM_TAG);
        if (SCENE_HAS(scene, FEATURE_INSTANCE) && tag[1] == BVH_INSTANCE) {
            uint left = end - item - 1u;
            uint rest = left == 0u ? BVH_EMPTY : BVH_LEAF | (left - 1u) << BVH_LEAF_COUNT_SHIFT | (item + 1u);
            if (bvh_instance_enter(scene, walk, stack, tag[0], rest))
                return tag[2];
            continue;
        }
        Hit hit = hit_none(walk->query.t_max);
        uint id;
        if (!bvh_item_query(scene, quads, &walk->query, walk->best.t, &hit, &id))
            continue;
        if (any) {
            walk->best.primitive = id;
            return BVH_EMPTY;
        }
        if (hit_improve(&walk->best, hit, walk->instance, id))
            walk->limit = walk->best.t * walk->boxes.scale;
    }
    return bvh_pop(walk, stack);
}

/* The closest hit, or when `any` is asked for, some primitive that lies within the ray. */
SHARED_FUNCTION Hit bvh_walk(const SceneView *scene, __global const uint *words, Ray ray, bool any)
{
    __global const Float4 *bvh = (__global const Float4 *)words;
    BvhWalk walk;
    BvhEntry stack[BVH_STACK];
    walk.best = hit_none(ray.t_max);
    if (!ray_traceable(ray.o, ray.d))
        return walk.best;
    walk.waiting = 0u;
    bvh_push(&walk, stack, BVH_EMPTY, 0.0f);
    bvh_walk_space(&walk, ray_query(ray), NONE);
    uint word = words[BVH_ROOT];
    while (word != BVH_EMPTY) {
        while ((word & BVH_LEAF) == 0u)
            word = bvh_descend(bvh, word, &walk, stack);
        if (SCENE_HAS(scene, FEATURE_INSTANCE) && word == BVH_RETURN) {
            bvh_walk_space(&walk, ray_query(ray), NONE);
            word = bvh_pop(&walk, stack);
        } else if (word != BVH_EMPTY)
            word = bvh_leaf(scene, bvh, word, any, &walk, stack);
    }
    return walk.best;
}

/* The smallest (t, instance, primitive) on the ray; primitive NONE for a miss. ray.t_max > 0. */
SHARED_FUNCTION Hit bvh_closest(const SceneView *scene, __global const uint *bvh, Ray ray)
{
    return bvh_walk(scene, bvh, ray, false);
}

/* Whether anything lies within the ray. */
SHARED_FUNCTION bool bvh_occluded(const SceneView *scene, __global const uint *bvh, Ray ray)
{
    return bvh_walk(scene, bvh, ray, true).primitive != NONE;
}

#endif
