/* Triangles in clusters of four neighbours, stored corner by corner and axis by axis, so that one vector operation does
 * what the shared test does for one triangle. Embree sees a cluster as one primitive: a quarter of the callbacks and a
 * quarter of the hierarchy. The lanes compute the very numbers of triangle_query (additions and products of the same
 * operands in the same order), so clustering changes no bit of any hit. */
#ifndef TWINLIGHT_TRIANGLE_CLUSTER_H
#define TWINLIGHT_TRIANGLE_CLUSTER_H

#include <embree3/rtcore.h> /* before any shared header, so that its floats are floats in every build */

#include "base/error.h"
#include "geometry/box.h"
#include "geometry/primitive.h"

#define CLUSTER_LANES 4

typedef float Lanes __attribute__((vector_size(sizeof(float) * CLUSTER_LANES)));
#ifdef PLATFORM_DOUBLE
typedef int64_t LaneMask __attribute__((vector_size(sizeof(float) * CLUSTER_LANES)));
#else
typedef int LaneMask __attribute__((vector_size(sizeof(float) * CLUSTER_LANES)));
#endif

typedef struct TriangleCluster {
    Lanes corner[3][3]; /* corner, axis */
    LaneMask solid; /* -1 where triangle_normal is not zero */
    uint primitive[CLUSTER_LANES]; /* NONE in unused lanes, whose corners are all zero */
} TriangleCluster;

/* Clusters the `count` triangles `primitives` of the scene by Embree's surface area heuristic. *clusters is to be freed
 * with free(). False on failure; *error says why. */
bool triangle_clusters_build(RTCDevice device, const SceneView *scene, const uint *primitives, uint count,
                             TriangleCluster **clusters, uint *cluster_count, Error *error);

Box triangle_cluster_box(const TriangleCluster *cluster);

/* Replaces *best by the first hit on the cluster's triangles if that comes before it; returns whether it did. */
bool triangle_cluster_intersect(const SceneView *scene, const TriangleCluster *cluster, uint instance,
                                const RayQuery *query, Hit *best);

/* Whether any of the triangles is hit between the ends of the ray. */
bool triangle_cluster_occludes(const SceneView *scene, const TriangleCluster *cluster, const RayQuery *query);

#endif
