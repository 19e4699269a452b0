#include "pbrt/polygon.h"

#include <math.h>

/* A polygon seen along an axis, such that it goes around counterclockwise. */
typedef struct Outline {
    const float *positions;
    const uint *corner;
    int x, y; /* axes of the plane */
    uint *next, *previous; /* of the corners that are left */
    uint *ear; /* 1: a triangle with both neighbours can be cut off */
} Outline;

/* Twice the area of the polygon projected along each axis (Newell's normal). */
static void newell_normal(const float *positions, const uint *corner, size_t count, double normal[3])
{
    normal[0] = normal[1] = normal[2] = 0.0;
    for (size_t i = 0; i < count; ++i) {
        const float *p = positions + 3 * (size_t)corner[i], *q = positions + 3 * (size_t)corner[(i + 1) % count];
        for (int k = 0; k < 3; ++k) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            normal[k] += ((double)p[u] - (double)q[u]) * ((double)p[v] + (double)q[v]);
        }
    }
}

static void outline_project(Outline *outline, size_t count)
{
    double normal[3];
    int axis = 0;
    newell_normal(outline->positions, outline->corner, count, normal);
    for (int k = 1; k < 3; ++k)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    bool facing = normal[axis] >= 0.0;
    outline->x = (axis + (facing ? 1 : 2)) % 3;
    outline->y = (axis + (facing ? 2 : 1)) % 3;
}

static double coordinate(const Outline *outline, uint i, int axis)
{
    return (double)outline->positions[3 * (size_t)outline->corner[i] + (size_t)axis];
}

/* Twice the area of the triangle of corners a, b, c; positive if counterclockwise. */
static double turn(const Outline *o, uint a, uint b, uint c)
{
    double x = coordinate(o, a, o->x), y = coordinate(o, a, o->y);
    return (coordinate(o, b, o->x) - x) * (coordinate(o, c, o->y) - y) -
           (coordinate(o, b, o->y) - y) * (coordinate(o, c, o->x) - x);
}

static bool same_place(const Outline *o, uint a, uint b)
{
    return coordinate(o, a, o->x) == coordinate(o, b, o->x) && coordinate(o, a, o->y) == coordinate(o, b, o->y);
}

/* Whether the triangle at corner i is inside the polygon: it turns left, and no other corner lies in it. */
static bool is_ear(const Outline *o, uint i)
{
    uint a = o->previous[i], c = o->next[i];
    if (!(turn(o, a, i, c) > 0.0))
        return false;
    for (uint p = o->next[c]; p != a; p = o->next[p])
        if (turn(o, a, i, p) >= 0.0 && turn(o, i, c, p) >= 0.0 && turn(o, c, a, p) >= 0.0 && !same_place(o, p, a) &&
            !same_place(o, p, i) && !same_place(o, p, c))
            return false;
    return true;
}

static bool fan_covers(const Outline *o, size_t count)
{
    for (uint i = 1; i + 1 < count; ++i)
        if (turn(o, 0, i, i + 1) < 0.0)
            return false;
    return true;
}

/* The next ear from corner `from` on; `from` itself if there is none, as in a polygon that crosses itself. */
static uint ear_find(const Outline *o, uint from, size_t left)
{
    uint i = from;
    for (size_t k = 0; k < left; ++k, i = o->next[i])
        if (o->ear[i] != 0u)
            return i;
    return from;
}

static void ears_clip(Outline *o, size_t count, uint *triangles)
{
    for (uint i = 0; i < count; ++i) {
        o->next[i] = i + 1 < count ? i + 1 : 0;
        o->previous[i] = i > 0 ? i - 1 : (uint)count - 1;
    }
    for (uint i = 0; i < count; ++i)
        o->ear[i] = is_ear(o, i);
    uint at = 0;
    for (size_t left = count; left >= 3; --left, triangles += 3) {
        uint i = ear_find(o, at, left), a = o->previous[i], c = o->next[i];
        triangles[0] = o->corner[a];
        triangles[1] = o->corner[i];
        triangles[2] = o->corner[c];
        o->next[a] = c;
        o->previous[c] = a;
        o->ear[a] = is_ear(o, a);
        o->ear[c] = is_ear(o, c);
        at = c;
    }
}

bool polygon_triangulate(const float *positions, const uint *corner, size_t count, uint *triangles, uint *scratch)
{
    Outline outline = {.positions = positions,
                       .corner = corner,
                       .next = scratch,
                       .previous = scratch + count,
                       .ear = scratch + 2 * count};
    outline_project(&outline, count);
    if (!fan_covers(&outline, count)) {
        if (count > POLYGON_CONCAVE_MAX)
            return false;
        ears_clip(&outline, count, triangles);
        return true;
    }
    for (size_t i = 0; i + 2 < count; ++i) {
        triangles[3 * i] = corner[0];
        triangles[3 * i + 1] = corner[i + 1];
        triangles[3 * i + 2] = corner[i + 2];
    }
    return true;
}
