/* Triangles in groups of four near one another, stored corner by corner and axis by axis, so that one vector operation
 * does what the shared test does for one triangle. Embree sees a group as one primitive: a quarter of the calls back
 * and a quarter of the hierarchy. The lanes compute the very numbers of triangle_query (additions and products of the
 * same operands in the same order), so that grouping changes no bit of any hit. */
#ifndef TWINLIGHT_TRIANGLE_CLUSTER_H
#define TWINLIGHT_TRIANGLE_CLUSTER_H

#include <embree3/rtcore.h> /* before any shared header: its floats are floats in every build */

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
    LaneMask solid; /* triangle_normal is not zero */
    uint primitive[CLUSTER_LANES]; /* NONE in unused lanes, whose corners are all zero */
} TriangleCluster;

/* Groups the `count` triangles `primitives` of the scene by Embree's surface area heuristic. *clusters has to be
 * freed. */
bool triangle_clusters_build(RTCDevice device, const SceneView *scene, const uint *primitives, uint count,
                             TriangleCluster **clusters, uint *cluster_count, Error *error);

Box triangle_cluster_box(const TriangleCluster *cluster);

/* Replaces *best by the first hit of the group's triangles when one comes before. */
bool triangle_cluster_intersect(const SceneView *scene, const TriangleCluster *cluster, uint instance,
                                const RayQuery *query, Hit *best);

/* Whether any of them lies between the ends of the ray. */
bool triangle_cluster_occludes(const SceneView *scene, const TriangleCluster *cluster, const RayQuery *query);

#endif
