#include "curve_cluster.h"

#include <string.h>

/* ---- building ---------------------------------------------------------------------------------------------------- */

static bool primitive_is_piece(const SceneView *scene, uint id)
{
    return scene->primitives[id].shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_CURVE;
}

uint curve_cluster_count(const SceneView *scene, uint first, uint left)
{
    uint count = 0;
    if (!primitive_is_piece(scene, first))
        return 0;
    while (count < CURVE_CLUSTER_PIECES && count < left && primitive_is_piece(scene, first + count) &&
           scene->primitives[first + count].a == scene->primitives[first].a)
        ++count;
    return count;
}

static void cluster_box_set(CurveCluster *cluster, uint piece, const Box *box)
{
    Float4 *quads = cluster->boxes[piece / 4u];
    for (int axis = 0; axis < 3; ++axis) {
        quads[2 * axis][piece % 4u] = box->low[axis];
        quads[2 * axis + 1][piece % 4u] = box->high[axis];
    }
}

void curve_cluster_set(CurveCluster *cluster, const SceneView *scene, uint first, uint count, Box *box)
{
    const Box empty = box_empty();
    cluster->first = first;
    cluster->count = count;
    for (uint piece = 0; piece < CURVE_CLUSTER_PIECES; ++piece) {
        if (piece >= count) {
            cluster_box_set(cluster, piece, &empty);
            continue;
        }
        Box single = primitive_box(scene, first + piece);
        box_join(box, &single);
        single = box_inflate(single, box_margin(&single, 0.0f));
        cluster_box_set(cluster, piece, &single);
    }
}

Box curve_cluster_box(const CurveCluster *cluster)
{
    Box box = box_empty();
    for (uint piece = 0; piece < cluster->count; ++piece) {
        const Float4 *quads = cluster->boxes[piece / 4u];
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = float_min(box.low[axis], quads[2 * axis][piece % 4u]);
            box.high[axis] = float_max(box.high[axis], quads[2 * axis + 1][piece % 4u]);
        }
    }
    return box;
}

/* ---- ray queries ------------------------------------------------------------------------------------------------- */

/* Bit i is set where key i is not BVH_MISS, which alone has the highest bit. */
static inline uint keys_bits(Uint4 keys)
{
#ifdef __SSE__
    return ~(uint)__builtin_ia32_movmskps((Float4)keys) & 15u;
#else
    uint bits = 0;
    for (uint lane = 0; lane < 4u; ++lane)
        bits |= (~keys[lane] >> 31) << lane;
    return bits;
#endif
}

/* Bit i is set where the ray enters the box of piece i before `limit`, in t of boxes. */
static inline uint pieces_near(const CurveCluster *cluster, const BvhRay *ray, float limit)
{
    uint bits = keys_bits(bvh_node_keys(cluster->boxes[0], ray, limit));
    if (cluster->count > 4u)
        bits |= keys_bits(bvh_node_keys(cluster->boxes[1], ray, limit)) << 4;
    return bits;
}

bool curve_cluster_intersect(const SceneView *scene, const CurveCluster *cluster, uint instance, const RayQuery *query,
                             const BvhRay *ray, Hit *best)
{
    bool improved = false;
    for (uint near = pieces_near(cluster, ray, best->t * ray->scale); near != 0u; near &= near - 1u)
        improved |= primitive_intersect(scene, cluster->first + (uint)__builtin_ctz(near), instance, query, best);
    return improved;
}

bool curve_cluster_occludes(const SceneView *scene, const CurveCluster *cluster, const RayQuery *query,
                            const BvhRay *ray)
{
    for (uint near = pieces_near(cluster, ray, query->t_max * ray->scale); near != 0u; near &= near - 1u)
        if (primitive_occludes(scene, cluster->first + (uint)__builtin_ctz(near), query))
            return true;
    return false;
}
