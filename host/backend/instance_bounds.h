/* Bounds of instances in world space that are conservative for every traversal (shared/geometry/box.h). Header only,
 * because one of its users is also compiled with double in place of float. */
#ifndef TWINLIGHT_BACKEND_INSTANCE_BOUNDS_H
#define TWINLIGHT_BACKEND_INSTANCE_BOUNDS_H

#include "geometry/box.h"

#include <math.h>

/* The primitives of an instance are intersected in object space, with origin and direction transformed by the
 * instance's float matrix M and translation b, and rounded. Let |.| be the largest coordinate and E = FLOAT_EPSILON. An
 * accepted hit at P = o + t d, mapped to object space exactly, lies within
 *
 *     E (7.5 (|B| + |o'|) + 2 (|M| |o| + |b|) + 1.5 |M| t |d|)
 *
 * of the object's box B: the terms are box_admits_hit with o', the four roundings of o', and the three of d'. With
 * |o'| <= |M| |o| + |b| and t |d| <= |P| + |o| this is at most
 *
 *     E (7.5 |B| + 9.5 |b| + 1.5 |M| |P|)  +  E 11 |M| |o|.
 *
 * The inverse of M maps the term in o to 11 |M^-1| |M| E |o| in world space. */
typedef struct InstanceBounds {
    Box box; /* includes every margin that does not depend on the ray's origin */
    float origin_ulps; /* margin that does, in units of FLOAT_EPSILON times the origin's largest coordinate */
} InstanceBounds;

/* Covers the rounding of the bounds computed here. */
#define INSTANCE_SLACK 1.001

/* Limit of a box and of its margin: Embree drops boxes that extend beyond 1.844e18. */
#define INSTANCE_BOX_MAX 0.9e18

/* Row-major inverse of the upper left 3x3 part of `a`; false if it is singular. */
static inline bool instance_invert(const Affine *a, double out[9])
{
    double m[9], determinant = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m[3 * i + j] = (double)a->m[4 * i + j];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            int r = (j + 1) % 3, s = (j + 2) % 3, c = (i + 1) % 3, e = (i + 2) % 3;
            out[3 * i + j] = m[3 * r + c] * m[3 * s + e] - m[3 * r + e] * m[3 * s + c];
        }
    for (int j = 0; j < 3; ++j)
        determinant += m[j] * out[3 * j];
    for (int i = 0; i < 9; ++i)
        out[i] /= determinant;
    return isfinite(determinant) && determinant != 0.0;
}

/* Largest absolute row sum. */
static inline double rows_norm(const double *rows, int stride)
{
    double largest = 0.0;
    for (int i = 0; i < 3; ++i)
        largest = fmax(largest, fabs(rows[stride * i]) + fabs(rows[stride * i + 1]) + fabs(rows[stride * i + 2]));
    return largest;
}

/* Box of the exact preimage under `a` of `object`, inflated by `margin` first. */
static inline void instance_image(const Affine *a, const double inverse[9], const Box *object, double margin,
                                  double low[3], double high[3])
{
    for (int i = 0; i < 3; ++i) {
        low[i] = (double)INFINITY;
        high[i] = (double)-INFINITY;
    }
    for (int corner = 0; corner < 8; ++corner) {
        double p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = ((corner >> i & 1) != 0 ? (double)object->high[i] + margin : (double)object->low[i] - margin) -
                   (double)a->m[4 * i + 3];
        for (int i = 0; i < 3; ++i) {
            double x = inverse[3 * i] * p[0] + inverse[3 * i + 1] * p[1] + inverse[3 * i + 2] * p[2];
            low[i] = fmin(low[i], x);
            high[i] = fmax(high[i], x);
        }
    }
}

static inline double corners_largest(const double low[3], const double high[3])
{
    double largest = 0.0;
    for (int i = 0; i < 3; ++i)
        largest = fmax(largest, fmax(fabs(low[i]), fabs(high[i])));
    return largest;
}

/* `object`: box of the instance's object without margin, not empty. A singular transform gives a box of all space. */
static inline InstanceBounds instance_bounds(const Instance *instance, const Box *object)
{
    const Affine *a = &instance->object_from_world;
    InstanceBounds bounds = {.origin_ulps = BOX_ULPS};
    double inverse[9], low[3], high[3], rows[9], shift = 0.0, unit = (double)FLOAT_EPSILON * INSTANCE_SLACK;
    bool invertible = instance_invert(a, inverse);
    for (int i = 0; i < 9; ++i)
        rows[i] = (double)a->m[i / 3 * 4 + i % 3];
    for (int i = 0; i < 3; ++i)
        shift = fmax(shift, fabs((double)a->m[4 * i + 3]));
    instance_image(a, inverse, object, 0.0, low, high);
    double reach = corners_largest(low, high), norm = rows_norm(rows, 3);
    double margin = unit * (7.5 * (double)box_largest(object) + 9.5 * shift + 1.5 * norm * reach);
    instance_image(a, inverse, object, margin, low, high);
    double widened = unit * (double)BOX_ULPS * corners_largest(low, high);
    double origin = INSTANCE_SLACK * 11.0 * norm * rows_norm(inverse, 3) + (double)BOX_ULPS;
    bool bounded = invertible && isfinite(widened) && corners_largest(low, high) < INSTANCE_BOX_MAX && origin < 1e12;
    for (int i = 0; i < 3; ++i) {
        bounds.box.low[i] = (float)(bounded ? low[i] - widened : -INSTANCE_BOX_MAX);
        bounds.box.high[i] = (float)(bounded ? high[i] + widened : INSTANCE_BOX_MAX);
    }
    if (bounded)
        bounds.origin_ulps = (float)origin;
    return bounds;
}

/* Margin of the box for rays whose origins have no coordinate above `reach`. */
static inline float instance_margin(const InstanceBounds *bounds, float reach)
{
    return float_min(bounds->origin_ulps * FLOAT_EPSILON * reach, (float)INSTANCE_BOX_MAX);
}

/* Upper bound of the coordinates, in object space, of a ray origin whose world coordinates are at most `reach`. */
static inline float instance_reach(const Instance *instance, float reach)
{
    return (1.0f + 8.0f * FLOAT_EPSILON) *
           vec3_max_abs(affine_magnitude(instance->object_from_world, vec3(reach, reach, reach)));
}

#endif
