/* Emission of media that varies: what a grid emits along a ray.
 *
 * A medium emits Medium.emission times the factor of the emission's own grid (MediumGrid.emission), whose words are
 *   1: emitted radiance, or with a table a temperature
 *   2: a temperature and a factor of the radiance of its black body
 *   6: absorption and radiance, each red, green and blue,
 * and, but for 6 words, times the factor of extinction. The integral of transmittance times emission is taken cell by
 * cell of the grid of extinction. There extinction is a cubic, which four values determine, so that the optical depth up
 * to a point has no error but that of rounding; Gauss's rule with three points is applied to pieces of the cell over
 * which neither transmittance nor the radiance of a black body changes much more than by a factor of e. The error is
 * below 1e-3 of the integral (tests/geometry/test_grid_emission.c). */
#ifndef TWINLIGHT_GEOMETRY_GRID_EMISSION_H
#define TWINLIGHT_GEOMETRY_GRID_EMISSION_H

#include "geometry/medium_grid.h"
#include "math/elementary.h"

/* ---- black bodies ------------------------------------------------------------------------------------------------ */

/* Radiance of black bodies whose spectrum has the maximum 1, as pbrt has it: a table in `lookup` of red, green and blue
 * at T = MIDDLE x / (1 - x) kelvin for x = 0, 1 / ROWS ... 1, interpolated linearly. */
#define BLACKBODY_ROWS 2048u
#define BLACKBODY_MIDDLE 1000.0f
#define BLACKBODY_WORDS (3u * (BLACKBODY_ROWS + 1u))

SHARED_FUNCTION Vec3 blackbody_radiance(const SceneView *scene, uint table, float kelvin)
{
    float x = float_max(kelvin, 0.0f) / (float_max(kelvin, 0.0f) + BLACKBODY_MIDDLE) * (float)BLACKBODY_ROWS;
    float row = float_min(float_floor(x), (float)(BLACKBODY_ROWS - 1u)), t = x - row;
    __global const float *a = scene->lookup + table + 3u * (uint)row;
    return vec3((1.0f - t) * a[0] + t * a[3], (1.0f - t) * a[1] + t * a[4], (1.0f - t) * a[2] + t * a[5]);
}

/* ---- factors of emission ----------------------------------------------------------------------------------------- */

/* A ray in the coordinates of the emission's grid, by the distance from its origin in the world. */
typedef struct EmissionRay {
    __global const MediumGrid *grid;
    Vec3 start, step;
} EmissionRay;

SHARED_FUNCTION EmissionRay emission_ray(const SceneView *scene, uint number, Vec3 o, Vec3 w)
{
    EmissionRay ray;
    ray.grid = scene->grids + number;
    ray.start = affine_point(ray.grid->grid_from_world, o);
    ray.step = affine_vector(ray.grid->grid_from_world, w);
    return ray;
}

/* The samples' words `word` to `word` + count - 1 at a distance, up to three; 0 outside of the grid. */
SHARED_FUNCTION Vec3 emission_words(const SceneView *scene, const EmissionRay *ray, float distance, uint word,
                                    uint count)
{
    __global const MediumGrid *grid = ray->grid;
    Vec3 p = vec3_mad(ray->start, distance, ray->step), value = vec3_splat(0.0f);
    if (!(p.x >= 0.0f && p.x <= (float)grid->size_x + 1.0f && p.y >= 0.0f && p.y <= (float)grid->size_y + 1.0f &&
          p.z >= 0.0f && p.z <= (float)grid->size_z + 1.0f))
        return value;
    GridCell cell = grid_cell(grid, p);
    uint brick = grid_brick(scene, grid, cell);
    if (brick == NONE)
        return value;
    value.x = grid_value(scene, grid, brick, cell, word, p);
    if (count > 1u)
        value.y = grid_value(scene, grid, brick, cell, word + 1u, p);
    if (count > 2u)
        value.z = grid_value(scene, grid, brick, cell, word + 2u, p);
    return value;
}

SHARED_FUNCTION float emission_kelvin(__global const MediumGrid *grid, float factor)
{
    return factor * grid->kelvin_scale + grid->kelvin_offset;
}

/* What Medium.emission is multiplied by; `extinction`: the factor of extinction there. */
SHARED_FUNCTION Vec3 emission_factor(const SceneView *scene, const EmissionRay *ray, float distance, Vec3 extinction)
{
    uint words = ray->grid->words;
    if (words == 6u)
        return vec3_mul(emission_words(scene, ray, distance, 0u, 3u), emission_words(scene, ray, distance, 3u, 3u));
    Vec3 value = emission_words(scene, ray, distance, 0u, words);
    if (ray->grid->table == NONE)
        return vec3_scale(extinction, value.x);
    Vec3 radiance = blackbody_radiance(scene, ray->grid->table, emission_kelvin(ray->grid, value.x));
    return vec3_mul(extinction, vec3_scale(radiance, words == 2u ? value.y : 1.0f));
}

/* ---- cells ------------------------------------------------------------------------------------------------------- */

/* A cell's extinction, by colour, along a ray: a polynomial of x, from 0 to 1. */
typedef struct CellCubic {
    Vec3 c0, c1, c2, c3;
} CellCubic;

SHARED_FUNCTION Vec3 grid_walk_values(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk,
                                      float s)
{
    float first = grid_walk_value(scene, grid, walk, 0u, s);
    if (GRID_COLORS(grid) == 1u)
        return vec3_splat(first);
    return vec3(first, grid_walk_value(scene, grid, walk, 1u, s), grid_walk_value(scene, grid, walk, 2u, s));
}

SHARED_FUNCTION CellCubic cell_cubic(const SceneView *scene, __global const MediumGrid *grid, const GridWalk *walk)
{
    float h = walk->to - walk->from;
    Vec3 a = grid_walk_values(scene, grid, walk, walk->from);
    Vec3 b = grid_walk_values(scene, grid, walk, walk->from + 0.333333333f * h);
    Vec3 c = grid_walk_values(scene, grid, walk, walk->from + 0.666666667f * h);
    Vec3 d = grid_walk_values(scene, grid, walk, walk->to);
    CellCubic cubic;
    cubic.c0 = a;
    cubic.c1 = vec3_mad(vec3_mad(vec3_mad(d, -5.5f, a), 9.0f, b), -4.5f, c);
    cubic.c2 = vec3_scale(vec3_mad(vec3_mad(vec3_mad(d, -2.0f, a), 5.0f, b), -4.0f, c), -4.5f);
    cubic.c3 = vec3_scale(vec3_mad(vec3_mad(vec3_mad(d, -1.0f, a), 3.0f, b), -3.0f, c), 4.5f);
    return cubic;
}

SHARED_FUNCTION Vec3 cell_value(const CellCubic *cubic, float x)
{
    return vec3_mad(cubic->c0, x, vec3_mad(cubic->c1, x, vec3_mad(cubic->c2, x, cubic->c3)));
}

/* Its integral from 0 to x. */
SHARED_FUNCTION Vec3 cell_integral(const CellCubic *cubic, float x)
{
    Vec3 upper = vec3_mad(vec3_scale(cubic->c2, 0.333333333f), 0.25f * x, cubic->c3);
    return vec3_scale(vec3_mad(cubic->c0, x, vec3_mad(vec3_scale(cubic->c1, 0.5f), x, upper)), x);
}

/* ---- pieces ------------------------------------------------------------------------------------------------------ */

/* Logarithms of the ratios by which transmittance and the radiance of a black body may change over a piece. */
#define PIECE_DEPTH 1.5f
#define PIECE_RADIANCE 1.5f

/* Optical depth behind which nothing is seen: exp(-21) is below 1e-9. */
#define EMISSION_DEPTH_MAX 21.0f

/* Second radiation constant over 450 nm, in kelvin: the logarithm of radiance in the blue is -SLOPE / T - 5 ln T. */
#define BLACKBODY_SLOPE 32000.0f

/* The shortest piece, as a part of a cell: 2^-20. */
#define PIECE_SHORTEST 9.5367431640625e-7f

/* A cell under way. */
typedef struct EmissionCell {
    CellCubic cubic;
    float from, h; /* distances: of its begin from the ray's origin, of its end from that */
    Vec3 coefficient; /* of extinction, times h */
    Vec3 depth; /* optical depth at its begin */
} EmissionCell;

/* Whether a colour's light from the optical depth `from` reaches the origin, while it loses too much up to `to`. */
SHARED_FUNCTION bool piece_opaque(float from, float to)
{
    return from < EMISSION_DEPTH_MAX && to - from > PIECE_DEPTH;
}

/* Below this temperature black bodies are too dark, beside the hottest of the grid, to be seen. */
SHARED_FUNCTION float kelvin_dark(__global const MediumGrid *grid)
{
    return float_min(0.6f * emission_kelvin(grid, 1.0f), 900.0f);
}

SHARED_FUNCTION bool kelvins_differ(float a, float b, float dark)
{
    float most = float_max(a, b);
    return most > dark && float_abs(a - b) * (BLACKBODY_SLOPE + 5.0f * most) > PIECE_RADIANCE * most * most;
}

/* Distance from a place to the next plane of samples across an axis, at least a thousandth of a cell. */
SHARED_FUNCTION float emission_plane(float p, float step)
{
    float along = float_abs(step), place = step < 0.0f ? -p : p;
    return along > 0.0f ? (float_floor(place + 1.001f) - place) / along : FLOAT_INFINITY;
}

/* The longest piece from x, as a part of the cell: to its end or that of a cell of the emission's grid. */
SHARED_FUNCTION float piece_longest(const EmissionRay *ray, const EmissionCell *cell, float x)
{
    if (ray->grid->aligned != 0u)
        return 1.0f - x;
    Vec3 p = vec3_mad(ray->start, cell->from + x * cell->h, ray->step);
    float distance = float_min(emission_plane(p.x, ray->step.x),
                               float_min(emission_plane(p.y, ray->step.y), emission_plane(p.z, ray->step.z)));
    return float_max(float_min(1.0f - x, distance / cell->h), PIECE_SHORTEST);
}

/* Whether the cell's piece from x to x + length is to be divided. */
SHARED_FUNCTION bool piece_divides(const SceneView *scene, const EmissionRay *ray, const EmissionCell *cell, float x,
                                   float length)
{
    Vec3 a = vec3_add(cell->depth, vec3_mul(cell->coefficient, cell_integral(&cell->cubic, x)));
    Vec3 b = vec3_add(cell->depth, vec3_mul(cell->coefficient, cell_integral(&cell->cubic, x + length)));
    if (piece_opaque(a.x, b.x) || piece_opaque(a.y, b.y) || piece_opaque(a.z, b.z))
        return true;
    if (ray->grid->table == NONE)
        return false;
    float kelvins[3], dark = kelvin_dark(ray->grid);
    for (int i = 0; i < 3; ++i) {
        float distance = cell->from + (x + 0.5f * (float)i * length) * cell->h;
        kelvins[i] = emission_kelvin(ray->grid, emission_words(scene, ray, distance, 0u, 1u).x);
    }
    return kelvins_differ(kelvins[0], kelvins[1], dark) || kelvins_differ(kelvins[1], kelvins[2], dark);
}

/* The integral over a piece. */
SHARED_FUNCTION Vec3 piece_emission(const SceneView *scene, const EmissionRay *ray, const EmissionCell *cell, float x,
                                    float length)
{
    Vec3 sum = vec3_splat(0.0f);
    for (int i = 0; i < 3; ++i) {
        float at = x + length * (0.5f + 0.387298335f * (float)(i - 1));
        Vec3 factor = emission_factor(scene, ray, cell->from + at * cell->h, cell_value(&cell->cubic, at));
        if (vec3_is_zero(factor))
            continue;
        Vec3 depth = vec3_add(cell->depth, vec3_mul(cell->coefficient, cell_integral(&cell->cubic, at)));
        Vec3 seen = vec3(float_exp(-depth.x), float_exp(-depth.y), float_exp(-depth.z));
        sum = vec3_mad(sum, i == 1 ? 0.444444444f : 0.277777778f, vec3_mul(seen, factor));
    }
    return vec3_scale(sum, length * cell->h);
}

SHARED_FUNCTION Vec3 cell_emission(const SceneView *scene, const EmissionRay *ray, const EmissionCell *cell)
{
    Vec3 sum = vec3_splat(0.0f);
    float x = 0.0f;
    while (x < 1.0f) {
        float length = piece_longest(ray, cell, x);
        while (length > PIECE_SHORTEST && piece_divides(scene, ray, cell, x, length))
            length *= 0.5f;
        sum = vec3_add(sum, piece_emission(scene, ray, cell, x, length));
        x += length;
    }
    return sum;
}

/* The light that a medium whose emission varies emits towards o, from the ray's first `distance`, which may be
 * infinite, along w (unit). */
SHARED_FUNCTION_APART Vec3 grid_emission(const SceneView *scene, __global const Medium *medium, Vec3 o, Vec3 w,
                                         float distance)
{
    __global const MediumGrid *grid = scene->grids + (medium->grid - 1u);
    EmissionRay ray = emission_ray(scene, grid->emission - 1u, o, w);
    EmissionCell cell;
    Vec3 sum = vec3_splat(0.0f);
    cell.depth = sum;
    GridWalk walk = grid_walk_begin(grid, o, w, distance);
    while (grid_walk_next(scene, grid, &walk)) {
        if (cell.depth.x > EMISSION_DEPTH_MAX && cell.depth.y > EMISSION_DEPTH_MAX && cell.depth.z > EMISSION_DEPTH_MAX)
            break;
        cell.cubic = cell_cubic(scene, grid, &walk);
        cell.from = walk.ray.begin + walk.from;
        cell.h = walk.to - walk.from;
        cell.coefficient = vec3_scale(medium->extinction, cell.h);
        sum = vec3_add(sum, cell_emission(scene, &ray, &cell));
        cell.depth = vec3_add(cell.depth, vec3_mul(cell.coefficient, cell_integral(&cell.cubic, 1.0f)));
    }
    return vec3_mul(sum, medium->emission);
}

#endif
