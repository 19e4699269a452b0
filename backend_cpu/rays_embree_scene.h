/* What the parts of rays_embree.h share: the hierarchies, the walk of a ray through them, and Embree's callbacks. */
#ifndef TWINLIGHT_RAYS_EMBREE_SCENE_H
#define TWINLIGHT_RAYS_EMBREE_SCENE_H

#include <embree3/rtcore.h> /* before any shared header: its floats are floats in every build */

#include "rays_embree.h"

#include "backend/bvh.h"
#include "geometry/primitive.h"
#include "triangle_cluster.h"

#ifndef TWINLIGHT_DOUBLE /* boxes of pieces have only floats; in double, Embree sees each piece */
#include "curve_cluster.h"
#endif

#include <stdatomic.h>

/* The hierarchy of one Object. */
typedef struct ObjectRays {
    const RaysEmbree *rays;
    RTCScene scene;
    TriangleCluster *clusters; /* triangles */
    uint cluster_count;
#ifndef TWINLIGHT_DOUBLE
    CurveCluster *curves;
    uint curve_count;
#endif
    uint *others; /* primitives of other kinds */
    uint other_count;
    float reach; /* largest coordinate of ray origins, in the space of the object */
    Box box; /* without margin */
} ObjectRays;

struct RaysEmbree {
    RTCDevice device;
    SceneView view;
    ObjectRays *objects; /* [0]: the world */
    size_t object_count;
    size_t instance_count;
    float reach; /* largest coordinate of the origins of rays for Embree, in the world */
    Bvh outer; /* for rays from further out; empty where there are none */
    atomic_llong bytes;
    char failure[256]; /* Embree's first complaint */
};

/* What the callbacks reach through the context that Embree passes on. The hit is kept here and not in Embree's record;
 * Embree only learns the new end of the ray. */
typedef struct RayWalk {
    struct RTCIntersectContext context; /* first, so that Embree's pointer to it also points to the walk */
    const RaysEmbree *rays;
    const Ray *ray; /* NULL once `query` is made from it: many rays hit no box and never need one */
    RayQuery query;
#ifndef TWINLIGHT_DOUBLE
    BvhRay boxes; /* the ray for boxes of curves' pieces, if has_boxes */
    bool has_boxes;
#endif
    float t_scale; /* Embree's t over ours: embree_ray */
    uint instance;
    Hit best;
} RayWalk;

/* Embree replaces components of a direction below 10^-18 by that number, so a very short direction is scaled up by a
 * power of two, and t down: exact, and by 1 for nearly all rays. */
#define SHORT_DIRECTION 0x1p-40f
#define SHORT_STRETCH 0x1p100f

/* The ray, up to walk->best.t, in Embree's format. */
static inline struct RTCRay embree_ray(RayWalk *walk, Vec3 o, Vec3 d)
{
    bool is_short = vec3_max_abs(d) < SHORT_DIRECTION;
    float stretch = is_short ? SHORT_STRETCH : 1.0f;
    walk->t_scale = is_short ? 1.0f / SHORT_STRETCH : 1.0f;
    return (struct RTCRay){.org_x = o.x,
                           .org_y = o.y,
                           .org_z = o.z,
                           .dir_x = d.x * stretch,
                           .dir_y = d.y * stretch,
                           .dir_z = d.z * stretch,
                           .tnear = 0.0f,
                           .tfar = walk->best.t * walk->t_scale,
                           .mask = 0xffffffffu};
}

/* Callbacks for clusters of triangles, clusters of curves' pieces and other primitives, of which the user data are an
 * ObjectRays, and for instances, of which they are the RaysEmbree. */
void embree_cluster_bounds(const struct RTCBoundsFunctionArguments *args);
void embree_cluster_intersect(const struct RTCIntersectFunctionNArguments *args);
void embree_cluster_occluded(const struct RTCOccludedFunctionNArguments *args);
void embree_other_bounds(const struct RTCBoundsFunctionArguments *args);
void embree_other_intersect(const struct RTCIntersectFunctionNArguments *args);
void embree_other_occluded(const struct RTCOccludedFunctionNArguments *args);
void embree_instance_bounds(const struct RTCBoundsFunctionArguments *args);
void embree_instance_intersect(const struct RTCIntersectFunctionNArguments *args);
void embree_instance_occluded(const struct RTCOccludedFunctionNArguments *args);
#ifndef TWINLIGHT_DOUBLE
void embree_curve_bounds(const struct RTCBoundsFunctionArguments *args);
void embree_curve_intersect(const struct RTCIntersectFunctionNArguments *args);
void embree_curve_occluded(const struct RTCOccludedFunctionNArguments *args);
#endif

#endif
