/* Media whose coefficients vary: factors of a medium's coefficients, given by samples on a grid.
 *
 * In a grid's own coordinates, sample i of an axis lies at i + 1. Between samples factors are interpolated trilinearly,
 * and beyond the outermost they fall to 0 within one unit; outside of the grid's box, which is as pbrt has it
 * (MediumGrid), there is no medium. Along a ray a factor is a cubic in each cell between eight samples, which Gauss's
 * rule with two points integrates exactly. So an optical depth has no error but that of rounding, and the distance at
 * which it has a given value is found by inverting the integral in a single cell: no other random numbers are needed.
 *
 * Cells are stored in bricks of 8 x 8 x 8, each with the 9 x 9 x 9 samples at their corners: words of `texels`. Bricks
 * whose samples are all 0 are not stored, and a ray crosses one in a single step. */
#ifndef TWINLIGHT_GEOMETRY_MEDIUM_GRID_H
#define TWINLIGHT_GEOMETRY_MEDIUM_GRID_H

#include "geometry/ray.h"
#include "layout/scene_view.h"

#define GRID_BRICK 8 /* cells along an edge */
#define GRID_EDGE 9 /* samples along it */
#define GRID_BRICK_SAMPLES 729

/* Words of a sample: 1, a factor of all coefficients; or 6: of extinction and of scattering, each red, green and
 * blue. */
#define GRID_COLORS(grid) ((grid)->words == 1u ? 1u : 3u)

/* A cell, by its lower corner. */
typedef struct GridCell {
    int x, y, z;
} GridCell;

/* Bricks along an axis of `samples`. */
SHARED_FUNCTION uint grid_bricks(uint samples)
{
    return samples / GRID_BRICK + 1u;
}

/* ---- factors ----------------------------------------------------------------------------------------------------- */

/* First word of the samples of the brick that contains a cell; NONE if they are all 0. */
SHARED_FUNCTION uint grid_brick(const SceneView *scene, __global const MediumGrid *grid, GridCell cell)
{
    uint x = (uint)cell.x / GRID_BRICK, y = (uint)cell.y / GRID_BRICK, z = (uint)cell.z / GRID_BRICK;
    return scene->texels[grid->bricks + x + grid_bricks(grid->size_x) * (y + grid_bricks(grid->size_y) * z)];
}

/* The samples at `at` and `step` words further, interpolated. */
SHARED_FUNCTION float grid_lerp(__global const uint *at, uint step, float t)
{
    return (1.0f - t) * bits_float(at[0]) + t * bits_float(at[step]);
}

/* Word `word` of the factors at p in a cell of the stored brick `brick`. */
SHARED_FUNCTION float grid_value(const SceneView *scene, __global const MediumGrid *grid, uint brick, GridCell cell,
                                 uint word, Vec3 p)
{
    uint x = grid->words, y = GRID_EDGE * x, z = GRID_EDGE * y;
    uint i = (uint)cell.x % GRID_BRICK, j = (uint)cell.y % GRID_BRICK, k = (uint)cell.z % GRID_BRICK;
    __global const uint *at = scene->texels + (brick + i * x + j * y + k * z + word);
    float fx = float_clamp(p.x - (float)cell.x, 0.0f, 1.0f), fy = float_clamp(p.y - (float)cell.y, 0.0f, 1.0f),
          fz = float_clamp(p.z - (float)cell.z, 0.0f, 1.0f);
    float low = (1.0f - fy) * grid_lerp(at, x, fx) + fy * grid_lerp(at + y, x, fx);
    float high = (1.0f - fy) * grid_lerp(at + z, x, fx) + fy * grid_lerp(at + z + y, x, fx);
    return (1.0f - fz) * low + fz * high;
}

/* The cell along an axis of `samples` that contains x. */
SHARED_FUNCTION int grid_cell_along(float x, uint samples)
{
    return (int)float_clamp(float_floor(x), 0.0f, (float)samples);
}

SHARED_FUNCTION GridCell grid_cell(__global const MediumGrid *grid, Vec3 p)
{
    GridCell cell;
    cell.x = grid_cell_along(p.x, grid->size_x);
    cell.y = grid_cell_along(p.y, grid->size_y);
    cell.z = grid_cell_along(p.z, grid->size_z);
    return cell;
}

/* The factors of extinction at a point of the world or, with `scattering`, of scattering. A point outside of the grid's
 * box is moved to it. */
SHARED_FUNCTION_APART Vec3 grid_factors(const SceneView *scene, uint number, Vec3 point, bool scattering)
{
    __global const MediumGrid *grid = scene->grids + number;
    Vec3 p = affine_point(grid->grid_from_world, point);
    p.x = float_clamp(p.x, grid->low, grid->low + (float)grid->size_x);
    p.y = float_clamp(p.y, grid->low, grid->low + (float)grid->size_y);
    p.z = float_clamp(p.z, grid->low, grid->low + (float)grid->size_z);
    GridCell cell = grid_cell(grid, p);
    uint brick = grid_brick(scene, grid, cell);
    if (brick == NONE)
        return vec3_splat(0.0f);
    if (GRID_COLORS(grid) == 1u)
        return vec3_splat(grid_value(scene, grid, brick, cell, 0u, p));
    uint word = scattering ? 3u : 0u;
    return vec3(grid_value(scene, grid, brick, cell, word, p), grid_value(scene, grid, brick, cell, word + 1u, p),
                grid_value(scene, grid, brick, cell, word + 2u, p));
}

/* ---- a ray's way through the cells ------------------------------------------------------------------------------- */

/* A ray in a grid's coordinates, of which distances in the world are the parameter. */
typedef struct GridRay {
    Vec3 start; /* where it enters the box, or begins in it */
    Vec3 step; /* per distance */
    Vec3 inverse; /* 1 / step; infinite if a coordinate does not change */
    float begin; /* distance from its origin to `start` */
    float length; /* of the part in the box; not above 0 if it misses that */
} GridRay;

/* Limits begin and end to the part of a line between two planes. */
SHARED_FUNCTION void grid_clip(float o, float inverse, float low, float high, float *begin, float *end)
{
    float a = (low - o) * inverse, b = (high - o) * inverse;
    if (float_finite(inverse)) {
        *begin = float_max(*begin, float_min(a, b));
        *end = float_min(*end, float_max(a, b));
    } else if (!(o >= low && o <= high)) {
        *end = -1.0f;
    }
}

/* The ray from o in the direction w (unit), both of the world, up to `distance`, which may be infinite. */
SHARED_FUNCTION GridRay grid_ray(__global const MediumGrid *grid, Vec3 o, Vec3 w, float distance)
{
    GridRay ray;
    float end = float_min(distance, FLOAT_MAX), low = grid->low;
    ray.start = affine_point(grid->grid_from_world, o);
    ray.step = affine_vector(grid->grid_from_world, w);
    ray.inverse = vec3(1.0f / ray.step.x, 1.0f / ray.step.y, 1.0f / ray.step.z);
    ray.begin = 0.0f;
    grid_clip(ray.start.x, ray.inverse.x, low, low + (float)grid->size_x, &ray.begin, &end);
    grid_clip(ray.start.y, ray.inverse.y, low, low + (float)grid->size_y, &ray.begin, &end);
    grid_clip(ray.start.z, ray.inverse.z, low, low + (float)grid->size_z, &ray.begin, &end);
    ray.length = end - ray.begin;
    ray.start = vec3_mad(ray.start, ray.begin, ray.step);
    return ray;
}

/* The distance at which a ray crosses the further of two planes. */
SHARED_FUNCTION float grid_plane(float start, float inverse, int low, int high)
{
    return float_finite(inverse) ? ((float)(inverse > 0.0f ? high : low) - start) * inverse : FLOAT_INFINITY;
}

/* The distance at which the ray leaves the cube of `size` cells at *corner, which becomes the next one. */
SHARED_FUNCTION float grid_leave(const GridRay *ray, int size, GridCell *corner)
{
    float x = grid_plane(ray->start.x, ray->inverse.x, corner->x, corner->x + size);
    float y = grid_plane(ray->start.y, ray->inverse.y, corner->y, corner->y + size);
    float z = grid_plane(ray->start.z, ray->inverse.z, corner->z, corner->z + size);
    float first = float_min(x, float_min(y, z));
    if (x == first)
        corner->x += ray->inverse.x > 0.0f ? size : -size;
    else if (y == first)
        corner->y += ray->inverse.y > 0.0f ? size : -size;
    else
        corner->z += ray->inverse.z > 0.0f ? size : -size;
    return first;
}

typedef struct GridWalk {
    GridRay ray;
    GridCell brick, next_brick; /* by their lowest cells */
    GridCell next; /* cell */
    uint samples; /* first word of the brick's samples, or NONE */
    float at; /* distance from ray.start that the walk has reached */
    float leave; /* and at which it leaves the brick */
    /* Where the walk is: */
    GridCell cell;
    float from, to; /* distances from ray.start */
} GridWalk;

/* Whether a cell lies in the cube of `size` cells at `corner`. */
SHARED_FUNCTION bool grid_holds(GridCell corner, uint size, GridCell cell)
{
    return (uint)(cell.x - corner.x) < size && (uint)(cell.y - corner.y) < size && (uint)(cell.z - corner.z) < size;
}

/* Goes to the next brick; false if that is outside of the grid. */
SHARED_FUNCTION bool grid_walk_enter(const SceneView *scene, __global const MediumGrid *grid, GridWalk *walk)
{
    GridCell brick = walk->next_brick;
    if ((uint)brick.x > grid->size_x || (uint)brick.y > grid->size_y || (uint)brick.z > grid->size_z)
        return false;
    walk->brick = brick;
    float leave = grid_leave(&walk->ray, GRID_BRICK, &walk->next_brick);
    walk->leave = float_min(leave, walk->ray.length);
    walk->samples = grid_brick(scene, grid, brick);
    Vec3 p = vec3_mad(walk->ray.start, walk->at, walk->ray.step);
    walk->next.x = (int)float_clamp(float_floor(p.x), (float)brick.x, (float)(brick.x + GRID_BRICK - 1));
    walk->next.y = (int)float_clamp(float_floor(p.y), (float)brick.y, (float)(brick.y + GRID_BRICK - 1));
    walk->next.z = (int)float_clamp(float_floor(p.z), (float)brick.z, (float)(brick.z + GRID_BRICK - 1));
    return true;
}

SHARED_FUNCTION GridWalk grid_walk_begin(__global const MediumGrid *grid, Vec3 o, Vec3 w, float distance)
{
    GridWalk walk = {0};
    walk.ray = grid_ray(grid, o, w, distance);
    GridCell first = grid_cell(grid, walk.ray.start);
    walk.next_brick.x = first.x - first.x % GRID_BRICK;
    walk.next_brick.y = first.y - first.y % GRID_BRICK;
    walk.next_brick.z = first.z - first.z % GRID_BRICK;
    walk.samples = NONE;
    return walk;
}

/* Goes on to the next cell of a stored brick; false if there is none. */
SHARED_FUNCTION bool grid_walk_next(const SceneView *scene, __global const MediumGrid *grid, GridWalk *walk)
{
    while (walk->samples == NONE || !(walk->at < walk->leave) || !grid_holds(walk->brick, GRID_BRICK, walk->next)) {
        walk->at = float_max(walk->at, walk->leave);
        if (!(walk->at < walk->ray.length) || !grid_walk_enter(scene, grid, walk))
            return false;
    }
    walk->cell = walk->next;
    walk->from = walk->at;
    float leave = grid_leave(&walk->ray, 1, &walk->next), end = float_min(leave, walk->leave);
    walk->to = float_max(walk->at, end);
    walk->at = walk->to;
    return true;
}

/* ---- integrals --------------------------------------------------------------------------------------------------- */

/* Word `word` of the factors in the walk's cell. s: distance from ray.start. */
SHARED_FUNCTION float grid_walk_value(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk,
                                      uint word, float s)
{
    return grid_value(scene, grid, walk->samples, walk->cell, word, vec3_mad(walk->ray.start, s, walk->ray.step));
}

/* Its integral over the first h of the walk's way through its cell. */
SHARED_FUNCTION float grid_walk_integral(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk,
                                         uint word, float h)
{
    return 0.5f * h *
           (grid_walk_value(scene, grid, walk, word, walk->from + 0.211324865f * h) +
            grid_walk_value(scene, grid, walk, word, walk->from + 0.788675135f * h));
}

/* The integrals of the factors of extinction. */
SHARED_FUNCTION Vec3 grid_walk_integrals(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk,
                                         float h)
{
    float first = grid_walk_integral(scene, grid, walk, 0u, h);
    if (GRID_COLORS(grid) == 1u)
        return vec3_splat(first);
    return vec3(first, grid_walk_integral(scene, grid, walk, 1u, h), grid_walk_integral(scene, grid, walk, 2u, h));
}

/* Steps of Newton's method at most. From a quartic's fourfold root, the worst case, each reduces the distance by a
 * quarter. */
#define GRID_STEPS 32

/* The part of the walk's way of length `most` through its cell over which the factor has the integral `wanted`, to one
 * part in a million. */
SHARED_FUNCTION float grid_walk_invert(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk,
                                       uint word, float wanted, float most)
{
    float low = 0.0f, high = most, h = most;
    for (int i = 0; i < GRID_STEPS; ++i) {
        float over = grid_walk_integral(scene, grid, walk, word, h) - wanted;
        if (float_abs(over) <= 1e-6f * wanted)
            return h;
        if (over > 0.0f)
            high = h;
        else
            low = h;
        float next = h - over / grid_walk_value(scene, grid, walk, word, walk->from + h);
        h = next > low && next < high ? next : 0.5f * (low + high);
    }
    return h;
}

/* Integrals of the factors of extinction along a ray. */
typedef struct GridColumn {
    Vec3 sums;
    float distance; /* from the ray's origin at which the integral of one colour has reached a target, */
    bool reached; /* if it has */
} GridColumn;

/* Of the ray from o along w (unit) up to `distance`, which may be infinite, or to where the integral of colour
 * `channel` reaches `target`. */
SHARED_FUNCTION_APART GridColumn grid_column(const SceneView *scene, uint number, Vec3 o, Vec3 w, float distance,
                                             uint channel, float target)
{
    __global const MediumGrid *grid = scene->grids + number;
    uint word = GRID_COLORS(grid) == 1u ? 0u : channel;
    GridColumn column = {0};
    GridWalk walk = grid_walk_begin(grid, o, w, distance);
    while (grid_walk_next(scene, grid, &walk)) {
        float h = walk.to - walk.from, rest = target - vec3_component(column.sums, channel);
        Vec3 more = grid_walk_integrals(scene, grid, &walk, h);
        column.reached = rest < vec3_component(more, channel);
        if (column.reached) {
            h = grid_walk_invert(scene, grid, &walk, word, rest, h);
            column.distance = walk.ray.begin + (walk.from + h);
            more = grid_walk_integrals(scene, grid, &walk, h);
        }
        column.sums = vec3_add(column.sums, more);
        if (column.reached)
            break;
    }
    return column;
}

#endif
