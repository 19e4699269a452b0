/* In a building most walls, floors and ceilings are parallel or perpendicular to each other (a "Manhattan world":
 * Coughlan and Yuille 1999). The first axis is the normal that most others are parallel to, the second is that of those
 * perpendicular to it. */
#include "render/opening_frame.h"

#include "geometry/ray.h"

#include <math.h>
#include <stdbool.h>

/* Cosine of the angle (2.6 degrees) within which normals count as parallel, and sine of that within which they count as
 * perpendicular. */
#define PARALLEL 0.999f
#define PERPENDICULAR 0.05f

/* About how many normals are tried as an axis. */
#define CANDIDATES 256

/* An axis this near to one of the world is that axis. */
#define WORLD_COSINE (1.0f - 1e-6f)

static bool votes(Vec3 normal, Vec3 axis, const Vec3 *perpendicular)
{
    return float_abs(vec3_dot(normal, axis)) > PARALLEL &&
           (!perpendicular || float_abs(vec3_dot(normal, *perpendicular)) < PERPENDICULAR);
}

/* The mean of the normals that vote for an axis, whichever way they point; how many they are. */
static size_t axis_mean(const Vec3 *normals, size_t count, Vec3 axis, const Vec3 *perpendicular, Vec3 *mean)
{
    size_t found = 0;
    Vec3 sum = vec3_splat(0.0f);
    for (size_t i = 0; i < count; ++i)
        if (votes(normals[i], axis, perpendicular)) {
            ++found;
            sum = vec3_mad(sum, vec3_dot(normals[i], axis) > 0.0f ? 1.0f : -1.0f, normals[i]);
        }
    if (found > 0)
        *mean = vec3_normalize(sum);
    return found;
}

/* The axis with the most votes, of those perpendicular to another if that is not NULL. False if there is none. */
static bool axis_find(const Vec3 *normals, size_t count, const Vec3 *perpendicular, Vec3 *axis)
{
    size_t most = 0;
    for (size_t i = 0; i < count; i += count / CANDIDATES + 1) {
        Vec3 mean;
        size_t found = axis_mean(normals, count, normals[i], perpendicular, &mean);
        if (found > most) {
            most = found;
            *axis = mean;
        }
    }
    return most > 0;
}

/* The part of v that is perpendicular to n, a unit vector. */
static Vec3 perpendicular_part(Vec3 v, Vec3 n)
{
    return vec3_normalize(vec3_mad(v, -vec3_dot(v, n), n));
}

static Vec3 world_axis(uint axis)
{
    return vec3(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f);
}

/* The world axis that is least parallel to v. */
static Vec3 world_axis_beside(Vec3 v)
{
    uint least = 0;
    for (uint axis = 1; axis < 3; ++axis)
        if (float_abs(vec3_component(v, axis)) < float_abs(vec3_component(v, least)))
            least = axis;
    return world_axis(least);
}

/* Takes the vector that is nearest to a world axis out of `left` of them, pointing along it. */
static Vec3 axis_take(Vec3 *vectors, size_t *left, uint axis)
{
    size_t best = 0;
    for (size_t i = 1; i < *left; ++i)
        if (float_abs(vec3_component(vectors[i], axis)) > float_abs(vec3_component(vectors[best], axis)))
            best = i;
    Vec3 taken = vectors[best];
    vectors[best] = vectors[--*left];
    return vec3_component(taken, axis) < 0.0f ? vec3_negate(taken) : taken;
}

Frame opening_frame(const Vec3 *normals, size_t count)
{
    const Frame world = {world_axis(0), world_axis(1), world_axis(2)};
    Vec3 axes[3];
    size_t left = 3;
    if (!axis_find(normals, count, NULL, &axes[0]))
        return world;
    if (!axis_find(normals, count, &axes[0], &axes[1]))
        axes[1] = world_axis_beside(axes[0]);
    axes[1] = perpendicular_part(axes[1], axes[0]);
    axes[2] = vec3_cross(axes[0], axes[1]);
    Frame frame;
    frame.t = axis_take(axes, &left, 0);
    frame.b = axis_take(axes, &left, 1);
    frame.n = vec3_cross(frame.t, frame.b);
    bool same = frame.t.x > WORLD_COSINE && frame.b.y > WORLD_COSINE && frame.n.z > WORLD_COSINE;
    return same ? world : frame;
}
