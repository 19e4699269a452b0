#include "triangle_cluster.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* ---- building ---------------------------------------------------------------------------------------------------- */

typedef struct ClusterBuild {
    const SceneView *scene;
    TriangleCluster *clusters;
    atomic_uint count;
} ClusterBuild;

static void cluster_set(TriangleCluster *cluster, int lane, const SceneView *scene, uint id)
{
    Primitive primitive = scene->primitives[id];
    const uint corners[3] = {primitive.a, primitive.b, primitive.c};
    cluster->primitive[lane] = id;
    for (int k = 0; k < 3; ++k) {
        Vec3 p = scene->positions[corners[k]];
        cluster->corner[k][0][lane] = p.x;
        cluster->corner[k][1][lane] = p.y;
        cluster->corner[k][2][lane] = p.z;
    }
    Vec3 normal =
        triangle_normal(scene->positions[primitive.a], scene->positions[primitive.b], scene->positions[primitive.c]);
    cluster->solid[lane] = vec3_is_zero(normal) ? 0 : -1;
}

static void *build_leaf(RTCThreadLocalAllocator allocator, const struct RTCBuildPrimitive *primitives, size_t count,
                        void *context)
{
    ClusterBuild *build = context;
    (void)allocator;
    TriangleCluster *cluster = &build->clusters[atomic_fetch_add(&build->count, 1)];
    memset(cluster, 0, sizeof *cluster);
    for (int lane = 0; lane < CLUSTER_LANES; ++lane)
        cluster->primitive[lane] = NONE;
    for (size_t i = 0; i < count; ++i)
        cluster_set(cluster, (int)i, build->scene, primitives[i].primID);
    return cluster;
}

/* Only the leaves are used; Embree insists on nodes that are not NULL. */
static void *build_node(RTCThreadLocalAllocator allocator, unsigned children, void *context)
{
    (void)allocator;
    (void)children;
    return context;
}

static void build_children(void *node, void **children, unsigned count, void *context)
{
    (void)node;
    (void)children;
    (void)count;
    (void)context;
}

static void build_bounds(void *node, const struct RTCBounds **bounds, unsigned count, void *context)
{
    (void)node;
    (void)bounds;
    (void)count;
    (void)context;
}

static bool build_run(RTCDevice device, struct RTCBuildPrimitive *items, uint count, ClusterBuild *build)
{
    struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
    RTCBVH bvh = rtcNewBVH(device);
    arguments.bvh = bvh;
    arguments.primitives = items;
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = count;
    arguments.maxDepth = 64;
    arguments.sahBlockSize = CLUSTER_LANES;
    arguments.maxLeafSize = CLUSTER_LANES;
    arguments.traversalCost = 0.2f;
    arguments.intersectionCost = 1.0f;
    arguments.createNode = build_node;
    arguments.setNodeChildren = build_children;
    arguments.setNodeBounds = build_bounds;
    arguments.createLeaf = build_leaf;
    arguments.userPtr = build;
    bool built = rtcBuildBVH(&arguments) != NULL;
    rtcReleaseBVH(bvh);
    return built;
}

bool triangle_clusters_build(RTCDevice device, const SceneView *scene, const uint *primitives, uint count,
                             TriangleCluster **clusters, uint *cluster_count, Error *error)
{
    size_t item_bytes = ((size_t)count * sizeof(struct RTCBuildPrimitive) + 63) / 64 * 64;
    struct RTCBuildPrimitive *items = aligned_alloc(64, item_bytes);
    /* There may be one leaf per triangle; pages that no leaf is written to are never allocated. */
    TriangleCluster *out = aligned_alloc(64, ((size_t)count * sizeof *out + 63) / 64 * 64);
    if (!items || !out) {
        free(items);
        free(out);
        return error_memory(error, (size_t)count * sizeof *out, "groups of triangles");
    }
    for (uint i = 0; i < count; ++i) {
        Box box = primitive_box(scene, primitives[i]);
        items[i] = (struct RTCBuildPrimitive){.lower_x = box.low[0],
                                              .lower_y = box.low[1],
                                              .lower_z = box.low[2],
                                              .geomID = 0,
                                              .upper_x = box.high[0],
                                              .upper_y = box.high[1],
                                              .upper_z = box.high[2],
                                              .primID = primitives[i]};
    }
    ClusterBuild build = {.scene = scene, .clusters = out};
    bool built = build_run(device, items, count, &build);
    free(items);
    *clusters = out;
    *cluster_count = atomic_load(&build.count);
    return built || error_set(error, "Embree cannot group %u triangles", count);
}

Box triangle_cluster_box(const TriangleCluster *cluster)
{
    Box box = box_empty();
    for (int lane = 0; lane < CLUSTER_LANES && cluster->primitive[lane] != NONE; ++lane)
        for (int k = 0; k < 3; ++k)
            box_add(&box, vec3(cluster->corner[k][0][lane], cluster->corner[k][1][lane], cluster->corner[k][2][lane]));
    return box;
}

/* ---- ray queries ------------------------------------------------------------------------------------------------- */

/* The ShearedCorner of four triangles. */
typedef struct ShearedLanes {
    Lanes x, y, z;
} ShearedLanes;

typedef struct ClusterTest {
    Lanes edge_b, edge_c, area, t;
    unsigned sure; /* bit i: candidate i is a hit, but for alpha; others are left to triangle_query */
} ClusterTest;

/* Bit i is set where lane i of the mask is. */
static inline unsigned lanes_bits(LaneMask mask)
{
#if defined(__SSE__) && CLUSTER_LANES == 4 && !defined(PLATFORM_DOUBLE)
    return (unsigned)__builtin_ia32_movmskps((Lanes)mask);
#endif
    unsigned bits = 0;
    for (int lane = 0; lane < CLUSTER_LANES; ++lane)
        bits |= (mask[lane] != 0 ? 1u : 0u) << lane;
    return bits;
}

/* a > b ? a : b */
static inline Lanes lanes_max(Lanes a, Lanes b)
{
#if defined(__SSE__) && CLUSTER_LANES == 4 && !defined(PLATFORM_DOUBLE)
    return __builtin_ia32_maxps(a, b);
#endif
    LaneMask more = a > b;
    return (Lanes)(((LaneMask)a & more) | ((LaneMask)b & ~more));
}

/* a < b ? a : b */
static inline Lanes lanes_min(Lanes a, Lanes b)
{
#if defined(__SSE__) && CLUSTER_LANES == 4 && !defined(PLATFORM_DOUBLE)
    return __builtin_ia32_minps(a, b);
#endif
    LaneMask less = a < b;
    return (Lanes)(((LaneMask)a & less) | ((LaneMask)b & ~less));
}

static inline Lanes lanes_abs(Lanes a)
{
#ifdef PLATFORM_DOUBLE
    return (Lanes)((LaneMask)a & INT64_MAX);
#else
    return (Lanes)((LaneMask)a & INT32_MAX);
#endif
}

/* triangle_shear of one corner of four triangles. */
static inline ShearedLanes lanes_shear(const Lanes corner[3], const RayQuery *query)
{
    ShearedLanes out;
    Lanes z = corner[query->kz] - query->oz;
    out.x = (corner[query->kx] - query->ox) - query->sx * z;
    out.y = (corner[query->ky] - query->oy) - query->sy * z;
    out.z = query->sz * z;
    return out;
}

static inline Lanes lanes_edge(const ShearedLanes *p, const ShearedLanes *q)
{
    return p->x * q->y - p->y * q->x;
}

static inline Lanes lanes_extent(const ShearedLanes *p)
{
    return lanes_max(lanes_abs(p->x), lanes_abs(p->y));
}

/* triangle_t_error of four triangles. */
static inline Lanes lanes_t_error(const ShearedLanes corner[3], const RayQuery *query)
{
    Lanes extent = lanes_max(lanes_extent(&corner[0]), lanes_max(lanes_extent(&corner[1]), lanes_extent(&corner[2])));
    Lanes depth = lanes_max(lanes_abs(corner[0].z), lanes_max(lanes_abs(corner[1].z), lanes_abs(corner[2].z)));
    Lanes reach = depth + float_abs(query->sz) * (vec3_max_abs(query->o) + vec3_max_abs(query->error));
    return TRIANGLE_ULPS_T * FLOAT_EPSILON * extent * extent * reach;
}

/* The lanes in which box_admits_hit of the triangle's box leaves t as it is. */
static inline LaneMask lanes_in_box(const TriangleCluster *cluster, const RayQuery *query, Lanes t)
{
    const float o[3] = {query->o.x, query->o.y, query->o.z}, d[3] = {query->d.x, query->d.y, query->d.z};
    Lanes low[3], high[3], largest = {0.0f};
    for (int i = 0; i < 3; ++i) {
        Lanes a = cluster->corner[0][i], b = cluster->corner[1][i], c = cluster->corner[2][i];
        low[i] = lanes_min(a, lanes_min(b, c));
        high[i] = lanes_max(a, lanes_max(b, c));
        largest = lanes_max(largest, lanes_max(lanes_abs(low[i]), lanes_abs(high[i])));
    }
    Lanes margin = HIT_ULPS * FLOAT_EPSILON * (largest + vec3_max_abs(query->o));
    LaneMask inside = ~(LaneMask){0};
    for (int i = 0; i < 3; ++i) {
        Lanes along = t * d[i];
        inside = inside & (along >= (low[i] - o[i]) - margin) & (along <= (high[i] - o[i]) + margin);
    }
    return inside;
}

/* The lanes with which triangle_query would continue. Does its first half, and computes t as triangle_finish does: t
 * must be ahead of the origin and, unless box_admits_hit would move it, not beyond t_best. This nearly always rejects
 * the triangle that a ray starts on. Of the other candidates nearly all are hits inside their boxes and far from the
 * ray's ends; test->sure says which are. */
static inline unsigned cluster_candidates(const TriangleCluster *cluster, const RayQuery *query, float t_best,
                                          ClusterTest *test)
{
    ShearedLanes corner[3];
    Lanes zero = {0.0f};
    for (int k = 0; k < 3; ++k)
        corner[k] = lanes_shear(cluster->corner[k], query);
    Lanes a = lanes_edge(&corner[1], &corner[2]), b = lanes_edge(&corner[2], &corner[0]),
          c = lanes_edge(&corner[0], &corner[1]), area = a + b + c;
    LaneMask negative = (a < zero) | (b < zero) | (c < zero), positive = (a > zero) | (b > zero) | (c > zero);
    LaneMask met = ~(negative & positive) & ((area > zero) | (area < zero)) & cluster->solid;
    if (lanes_bits(met) == 0)
        return 0;
    Lanes volume = a * corner[0].z + b * corner[1].z + c * corner[2].z, t = volume / area;
    met = met & (t > zero);
    if (lanes_bits(met) == 0)
        return 0;
    LaneMask in_box = lanes_in_box(cluster, query, t);
    unsigned candidates = lanes_bits(met & ((t <= zero + t_best) | ~in_box));
    if (candidates == 0)
        return 0;
    Lanes error = lanes_t_error(corner, query), t_max = zero + query->t_max;
    LaneMask ends = (lanes_abs(volume) <= error) | ((t_max - t) * lanes_abs(area) <= error);
    *test = (ClusterTest){b, c, area, t, lanes_bits(~ends & (t < t_max) & in_box) & candidates};
    return candidates;
}

/* Whether the candidate in a lane is a hit. */
static inline bool cluster_finish(const SceneView *scene, const TriangleCluster *cluster, const ClusterTest *test,
                                  int lane, const RayQuery *query, Hit *hit)
{
    uint id = cluster->primitive[lane];
    if ((test->sure >> lane & 1u) == 0u)
        return primitive_query(scene, id, query, hit);
    hit->t = test->t[lane];
    hit->u = test->edge_b[lane] / test->area[lane];
    hit->v = test->edge_c[lane] / test->area[lane];
    if (!SCENE_HAS(scene, FEATURE_ALPHA))
        return true;
    Primitive primitive = scene->primitives[id];
    return !(primitive.shape_and_kind & PRIMITIVE_ALPHA_BIT) ||
           primitive_alpha_keeps(scene, query, id, &primitive, hit);
}

bool triangle_cluster_intersect(const SceneView *scene, const TriangleCluster *cluster, uint instance,
                                const RayQuery *query, Hit *best)
{
    ClusterTest test;
    bool improved = false;
    unsigned candidates = cluster_candidates(cluster, query, best->t, &test);
    for (; candidates != 0; candidates &= candidates - 1) {
        int lane = __builtin_ctz(candidates);
        Hit hit = hit_none(query->t_max);
        if (cluster_finish(scene, cluster, &test, lane, query, &hit))
            improved |= hit_improve(best, hit, instance, cluster->primitive[lane]);
    }
    return improved;
}

bool triangle_cluster_occludes(const SceneView *scene, const TriangleCluster *cluster, const RayQuery *query)
{
    ClusterTest test;
    unsigned candidates = cluster_candidates(cluster, query, query->t_max, &test);
    if (candidates != 0 && test.sure != 0 && !SCENE_HAS(scene, FEATURE_ALPHA))
        return true;
    for (; candidates != 0; candidates &= candidates - 1) {
        Hit hit = hit_none(query->t_max);
        if (cluster_finish(scene, cluster, &test, __builtin_ctz(candidates), query, &hit))
            return true;
    }
    return false;
}
