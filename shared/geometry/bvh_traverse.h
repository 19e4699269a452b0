/* Rays through the hierarchy in BUFFER_BVH: two nested loops, one that descends through nodes and one over the
 * primitives of a leaf, with a bounded stack in private memory.
 *
 * The buffer is made of quads, four words that are read at once. Node n begins at quad n * BVH_NODE_QUADS; the header
 * takes the place of node 0. A node has up to four children: quads 0 ... 5 are the low and high planes of their boxes
 * along x, y, z, one lane per child; quad 6 holds the children's words; quad 7 pads nodes to a device's cache lines of
 * 128 bytes. Lanes without a child have a box that no ray hits. A child's word is the number of an inner node, or
 * BVH_LEAF with the number of items, less one, and the first of them. Item i, a primitive or an instance, begins at
 * quad i * BVH_ITEM_QUADS:
 *
 *     a.x b.x c.x 0   a.y b.y c.y 0   a.z b.z c.z 0   id shape_and_kind 0    0     a triangle's corners by axis
 *     0   0   0   0   0   0   0   0   0   0   0   0   id shape_and_kind 0    0     another primitive: see the scene
 *     0   0   0   0   0   0   0   0   0   0   0   0   id BVH_INSTANCE   root 0     an instance and its object's root
 *
 * A ray takes the axes in its own order (RayQuery), so it reads the quads of an item in that order and permutes
 * nothing. The nodes of an object are consecutive, with the children of a node side by side, and its items follow them.
 *
 * Boxes are widened by box_margin for their own coordinates, rays add the margin for their origins (bvh_ray), and hits
 * lie in boxes (box_admits_hit). So the answer is the smallest (t, instance, primitive) of the shared primitive test,
 * whatever the rounding of box tests. */
#ifndef TWINLIGHT_GEOMETRY_BVH_TRAVERSE_H
#define TWINLIGHT_GEOMETRY_BVH_TRAVERSE_H

#include "geometry/primitive.h"

/* Entries of the stack. The build refuses hierarchies that would need more. */
#define BVH_STACK 96u

#define BVH_NODE_QUADS 8u
#define BVH_ITEM_QUADS 4u
#define BVH_ITEM_TAG 3u /* the quad of an item with its tag */

/* Words of the header: the world's root, and the bits of bvh_ray's origin_ulps in world space. In the space of an
 * object that is BOX_ULPS. */
#define BVH_ROOT 0u
#define BVH_ORIGIN_ULPS 1u

/* Words of children. */
#define BVH_LEAF 0x80000000u
#define BVH_LEAF_COUNT_SHIFT 28
#define BVH_LEAF_COUNT_MASK 3u
#define BVH_LEAF_FIRST_MASK 0x0fffffffu
#define BVH_EMPTY 0xffffffffu /* nothing left, or nothing at all */
#define BVH_RETURN 0xfffffffeu /* on the stack: leave the instance */

/* Tag of an instance's item; no primitive has this kind. */
#define BVH_INSTANCE 0xffffffffu

#define BVH_MISS 0xffffffffu

/* ---- boxes ------------------------------------------------------------------------------------------------------- */

/* A ray as box tests need it. d is scaled by a power of two so that its largest component lies in [1, 2): the
 * reciprocals neither overflow nor lose the precision of a very short d. */
typedef struct BvhRay {
    float ix, iy, iz; /* 1 / d */
    /* -o / d, lowered (n) or raised (f) by the possible rounding error of the origin: a plane at p is entered at p i +
     * n, one instruction on a device, and left at p i + f. */
    float n_x, n_y, n_z, f_x, f_y, f_z;
    uint nx, ny, nz; /* the quad of a node with the planes where the ray enters; those where it leaves: quad n ^ 1 */
    float scale; /* t of boxes over t of the ray */
} BvhRay;

/* A component of d smaller than this, beside one of 1 or more, is replaced by it. That moves no point of the ray by
 * more than 2^-60 of its distance from the origin, far below the margin of boxes. */
#define BVH_SMALL 8.6736173798840355e-19f /* 2^-60 */

SHARED_FUNCTION float bvh_reciprocal(float d)
{
    float size = float_max(float_abs(d), BVH_SMALL);
    return 1.0f / (d < 0.0f ? -size : size);
}

/* o, d: traceable (ray_traceable). origin_ulps: additional margin that boxes need for this ray, in units of
 * FLOAT_EPSILON times the origin's largest coordinate; boxes already have the margin for their own coordinates. */
SHARED_FUNCTION BvhRay bvh_ray(Vec3 o, Vec3 d, float origin_ulps)
{
    BvhRay ray;
    uint exponent = float_bits(vec3_max_abs(d)) & 0x7f800000u;
    float stretch = bits_float(0x7f000000u - exponent);
    ray.scale = bits_float(exponent != 0u ? exponent : 0x00400000u);
    ray.ix = bvh_reciprocal(d.x * stretch);
    ray.iy = bvh_reciprocal(d.y * stretch);
    ray.iz = bvh_reciprocal(d.z * stretch);
    float error = origin_ulps * FLOAT_EPSILON * vec3_max_abs(o);
    ray.n_x = -(o.x * ray.ix) - error * float_abs(ray.ix);
    ray.n_y = -(o.y * ray.iy) - error * float_abs(ray.iy);
    ray.n_z = -(o.z * ray.iz) - error * float_abs(ray.iz);
    ray.f_x = -(o.x * ray.ix) + error * float_abs(ray.ix);
    ray.f_y = -(o.y * ray.iy) + error * float_abs(ray.iy);
    ray.f_z = -(o.z * ray.iz) + error * float_abs(ray.iz);
    /* By the signs of the reciprocals: scaling may have cost a denormal component of d its sign. */
    ray.nx = ray.ix < 0.0f ? 1u : 0u;
    ray.ny = ray.iy < 0.0f ? 3u : 2u;
    ray.nz = ray.iz < 0.0f ? 5u : 4u;
    return ray;
}

/* For each child: the t at which the ray enters its box, as bits that order like numbers, with the child's lane in the
 * lowest two; BVH_MISS if the ray does not enter it before `limit`. */
SHARED_FUNCTION Uint4 bvh_node_keys(__global const Float4 *node, const BvhRay *ray, float limit)
{
    Float4 near_x = float4_mad(node[ray->nx], ray->ix, ray->n_x);
    Float4 far_x = float4_mad(node[ray->nx ^ 1u], ray->ix, ray->f_x);
    Float4 near_y = float4_mad(node[ray->ny], ray->iy, ray->n_y);
    Float4 far_y = float4_mad(node[ray->ny ^ 1u], ray->iy, ray->f_y);
    Float4 near_z = float4_mad(node[ray->nz], ray->iz, ray->n_z);
    Float4 far_z = float4_mad(node[ray->nz ^ 1u], ray->iz, ray->f_z);
    Float4 enter = float4_max(float4_max(near_x, near_y), float4_max(near_z, float4_splat(0.0f)));
    Float4 leave = float4_min(float4_min(far_x, far_y), float4_min(far_z, float4_splat(limit)));
    Uint4 key = (float4_bits(enter) & 0x7ffffffcu) | uint4_make(0u, 1u, 2u, 3u);
    return key | ~float4_at_most(enter, leave);
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

/* A child that waits to be visited. */
typedef struct BvhEntry {
    uint word; /* of a child */
    float enter; /* where the ray enters it, in t of boxes; 0: must be visited in any case */
} BvhEntry;

/* State of a traversal, except for its stack: an array that is indexed at run time lives in memory, and would take the
 * rest of a struct with it. */
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

/* Pops the next child that the ray enters before the limit. The lowest entry is BVH_EMPTY at 0, which ends every
 * walk. */
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

/* Tests the node's children: returns the nearest and pushes the others, the next nearest on top. Their entry distances
 * are stored without the lane bits of the keys, which could make them up to three floats larger. */
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
        bvh_push(walk, stack, children[fourth & 3u], bits_float(fourth & ~3u));
    if (third != BVH_MISS)
        bvh_push(walk, stack, children[third & 3u], bits_float(third & ~3u));
    if (second != BVH_MISS)
        bvh_push(walk, stack, children[second & 3u], bits_float(second & ~3u));
    return children[first & 3u];
}

SHARED_FUNCTION void bvh_walk_space(BvhWalk *walk, RayQuery query, uint instance, float origin_ulps)
{
    walk->query = query;
    walk->instance = instance;
    walk->boxes = bvh_ray(query.o, query.d, origin_ulps);
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

/* triangle_query on an item, one lane per corner: the same numbers from the same operands, and whether the hit counts.
 * A cheap rejection comes first that the test would make later: all corners behind the origin. */
SHARED_FUNCTION bool bvh_triangle_query(const SceneView *scene, __global const Float4 *quads, const RayQuery *query,
                                        uint id, Hit *hit)
{
    Float4 sx = float4_splat(query->sx), sy = float4_splat(query->sy), sz = float4_splat(query->sz);
    Float4 z = quads[query->kz] - float4_splat(query->oz);
    Float4 x = (quads[query->kx] - float4_splat(query->ox)) - sx * z;
    Float4 y = (quads[query->ky] - float4_splat(query->oy)) - sy * z;
    z = sz * z;
    ShearedTriangle sheared;
    sheared.a = bvh_corner(x, y, z, 0u);
    sheared.b = bvh_corner(x, y, z, 1u);
    sheared.c = bvh_corner(x, y, z, 2u);
    sheared.e = triangle_edges(sheared.a, sheared.b, sheared.c);
    float area = sheared.e.a + sheared.e.b + sheared.e.c;
    if (!triangle_contains(sheared.e) || !(area > 0.0f || area < 0.0f))
        return false;
    if (!(float_max(float_max(sheared.a.z, sheared.b.z), sheared.c.z) > 0.0f))
        return false;
    x = quads[0];
    y = quads[1];
    z = quads[2];
    Vec3 a = vec3(lane_of(x, 0), lane_of(y, 0), lane_of(z, 0)), b = vec3(lane_of(x, 1), lane_of(y, 1), lane_of(z, 1)),
         c = vec3(lane_of(x, 2), lane_of(y, 2), lane_of(z, 2));
    return triangle_finish(a, b, c, &sheared, query, hit) && primitive_triangle_counts(scene, id, a, b, c, query, hit);
}

#define BVH_FEATURES_CURVED (FEATURE_BILINEAR | FEATURES_QUADRIC | FEATURE_CURVE)

/* The hit of a primitive's item; *id: the primitive. */
SHARED_FUNCTION bool bvh_item_query(const SceneView *scene, __global const Float4 *quads, const RayQuery *query,
                                    Hit *hit, uint *id)
{
    __global const uint *tag = (__global const uint *)(quads + BVH_ITEM_TAG);
    *id = tag[0];
    if (SCENE_HAS(scene, BVH_FEATURES_CURVED) && tag[1] >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_TRIANGLE)
        return primitive_query_curved(scene, tag[0], query, hit);
    return bvh_triangle_query(scene, quads, query, tag[0], hit);
}

/* Enters instance `id`. rest: what is left of the leaf, to be visited afterwards (BVH_EMPTY: nothing). False if the ray
 * cannot be traced in the instance's space. */
SHARED_FUNCTION bool bvh_instance_enter(const SceneView *scene, BvhWalk *walk, BvhEntry *stack, uint id, uint rest)
{
    RayQuery query = ray_query_transform(scene->instances[id].object_from_world, &walk->query);
    if (!ray_traceable(query.o, query.d))
        return false;
    if (rest != BVH_EMPTY)
        bvh_push(walk, stack, rest, 0.0f);
    bvh_push(walk, stack, BVH_RETURN, 0.0f);
    bvh_walk_space(walk, query, id, BOX_ULPS);
    return true;
}

/* Tests the items of a leaf. Returns the word to continue with; BVH_EMPTY if `any` hit suffices and one is found. */
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
        if (!bvh_item_query(scene, quads, &walk->query, &hit, &id))
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

/* The closest hit, or if `any`, some primitive that the ray hits. */
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
    bvh_walk_space(&walk, ray_query(ray), NONE, bits_float(words[BVH_ORIGIN_ULPS]));
    uint word = words[BVH_ROOT];
    while (word != BVH_EMPTY) {
        while ((word & BVH_LEAF) == 0u)
            word = bvh_descend(bvh, word, &walk, stack);
        if (SCENE_HAS(scene, FEATURE_INSTANCE) && word == BVH_RETURN) {
            bvh_walk_space(&walk, ray_query(ray), NONE, bits_float(words[BVH_ORIGIN_ULPS]));
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

/* Whether the ray hits anything. */
SHARED_FUNCTION bool bvh_occluded(const SceneView *scene, __global const uint *bvh, Ray ray)
{
    return bvh_walk(scene, bvh, ray, true).primitive != NONE;
}

#endif
