/* The pieces of a curve (Primitive.b) in clusters of up to eight consecutive ones, with their boxes. Embree sees a
 * cluster as one primitive, so its hierarchy is built over an eighth of the pieces; the boxes, which a device's
 * hierarchy has for single pieces, say which of them a ray may hit. Which hits count is the primitive's test alone, so
 * clustering changes no bit. */
#ifndef TWINLIGHT_CURVE_CLUSTER_H
#define TWINLIGHT_CURVE_CLUSTER_H

#include "geometry/bvh_traverse.h"

#define CURVE_CLUSTER_PIECES 8u

typedef struct CurveCluster {
    Float4 boxes[CURVE_CLUSTER_PIECES / 4][6]; /* of four pieces each, as in a node of a device's hierarchy */
    uint first, count; /* primitives */
} CurveCluster;

/* How many of the `left` primitives from `first` on belong into a cluster with it: pieces of one curve. 0 if it is no
 * curve. */
uint curve_cluster_count(const SceneView *scene, uint first, uint left);

/* Makes the cluster of `count` pieces and joins their boxes, without margin, to *box. */
void curve_cluster_set(CurveCluster *cluster, const SceneView *scene, uint first, uint count, Box *box);

/* The box of its pieces, with a margin for their own coordinates, but not for those of rays' origins. */
Box curve_cluster_box(const CurveCluster *cluster);

/* Replaces *best by the first hit on the cluster's pieces if that comes before it; returns whether it did. ray: of the
 * same ray as the query, with an origin_ulps of BOX_ULPS. */
bool curve_cluster_intersect(const SceneView *scene, const CurveCluster *cluster, uint instance, const RayQuery *query,
                             const BvhRay *ray, Hit *best);

/* Whether any of the pieces is hit between the ends of the ray. */
bool curve_cluster_occludes(const SceneView *scene, const CurveCluster *cluster, const RayQuery *query,
                            const BvhRay *ray);

#endif
