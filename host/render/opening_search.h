/* Searches a sample of rays for the rectangle that many of them cross (render/opening_fit.h). */
#ifndef TWINLIGHT_RENDER_OPENING_SEARCH_H
#define TWINLIGHT_RENDER_OPENING_SEARCH_H

#include "math/vec.h"

#include <stdbool.h>
#include <stddef.h>

/* A ray from infinity that brings light where it is wanted. */
typedef struct FarRay {
    Vec3 origin, direction; /* where it arrives, and the way back; direction unit */
    float weight; /* how much light; > 0 */
    uint group; /* used by openings_fit */
} FarRay;

/* A rectangle must be crossed by that many rays. */
#define RAYS_MIN 32

/* A rectangle perpendicular to an axis. */
typedef struct Rectangle {
    int axis;
    double at; /* coordinate along it */
    double low[2], high[2]; /* along the next two axes in cyclic order */
    double gain; /* of the log-likelihood, per ray of its group */
} Rectangle;

/* Rays that start through the same area. */
typedef struct RayGroup {
    uint number; /* FarRay.group */
    size_t count;
    double weight; /* of its rays */
    double area; /* perpendicular to them, on average */
    Rectangle rectangle; /* of all groups but the first */
    Rectangle next; /* the best for a part of it; its `gain` is 0 if there is none */
} RayGroup;

typedef struct RaySample {
    FarRay *rays;
    size_t count;
    double weight; /* of all */
    double *values; /* room for one per ray */
} RaySample;

/* The component of v along axis 0, 1 or 2. */
double vec3_along(Vec3 v, int axis);

/* Whether the ray is of the group and its line crosses the rectangle; if so, where. */
bool ray_group_crosses(const RayGroup *group, const FarRay *ray, const Rectangle *rectangle, double place[2]);

/* Sets the group's number of rays, their weight and the best rectangle for a part of it. */
void group_search(const RaySample *sample, RayGroup *group);

#endif
