#include "render/opening_search.h"

#include "base/sample_statistics.h"
#include "geometry/ray.h"

#include <float.h>
#include <math.h>

/* Planes per axis and cells per side of a search, and how often it is repeated in closer planes and smaller cells. */
#define PLANES 32
#define CELLS 12
#define REFINEMENTS 5

/* A search leaves out this part of the rays at either end of an axis, and goes beyond the others' origins by that
 * part of what they span. */
#define OUTSIDE 0.02
#define BEYOND 0.5

/* A search is quicker if it disregards rectangles that most rays cross at a smaller cosine. */
#define COSINE_LOW 0.05

/* Ranges are those of about so many rays. */
#define RANGE_RAYS 256

/* A rectangle is widened on each side by this part of its extent, and that over the number of rays. */
#define MARGIN 0.02
#define MARGIN_RAYS 2.0

double vec3_along(Vec3 v, int axis)
{
    return (double)vec3_component(v, (uint)axis);
}

/* Where the ray's line crosses the plane; false if it is parallel to it. */
static bool crossing(const FarRay *ray, int axis, double at, double place[2])
{
    double cosine = vec3_along(ray->direction, axis), along = (at - vec3_along(ray->origin, axis)) / cosine;
    for (int k = 0; k < 2; ++k) {
        int other = (axis + 1 + k) % 3;
        place[k] = vec3_along(ray->origin, other) + along * vec3_along(ray->direction, other);
    }
    return isfinite(place[0]) && isfinite(place[1]);
}

static bool inside(const Rectangle *rectangle, const double place[2])
{
    return place[0] >= rectangle->low[0] && place[0] <= rectangle->high[0] && place[1] >= rectangle->low[1] &&
           place[1] <= rectangle->high[1];
}

bool ray_group_crosses(const RayGroup *group, const FarRay *ray, const Rectangle *rectangle, double place[2])
{
    return ray->group == group->number && crossing(ray, rectangle->axis, rectangle->at, place) &&
           inside(rectangle, place);
}

/* Sums over the cells before (i, j): weights, and weights times cosine. */
typedef struct CellSums {
    double weight[CELLS + 1][CELLS + 1], projected[CELLS + 1][CELLS + 1];
} CellSums;

static void sums_make(const RaySample *sample, const RayGroup *group, const Rectangle *window, CellSums *sums)
{
    *sums = (CellSums){0};
    for (size_t i = 0; i < sample->count; ++i) {
        double place[2];
        int cell[2];
        if (!ray_group_crosses(group, &sample->rays[i], window, place))
            continue;
        for (int k = 0; k < 2; ++k) {
            double part = (place[k] - window->low[k]) / (window->high[k] - window->low[k]);
            cell[k] = part < 1.0 ? (int)(part * CELLS) : CELLS - 1;
        }
        double weight = (double)sample->rays[i].weight;
        sums->weight[cell[0] + 1][cell[1] + 1] += weight;
        sums->projected[cell[0] + 1][cell[1] + 1] += weight * fabs(vec3_along(sample->rays[i].direction, window->axis));
    }
    for (int i = 1; i <= CELLS; ++i)
        for (int j = 1; j <= CELLS; ++j) {
            sums->weight[i][j] += sums->weight[i - 1][j] + sums->weight[i][j - 1] - sums->weight[i - 1][j - 1];
            sums->projected[i][j] +=
                sums->projected[i - 1][j] + sums->projected[i][j - 1] - sums->projected[i - 1][j - 1];
        }
}

static double cells_sum(double sums[CELLS + 1][CELLS + 1], int i0, int i1, int j0, int j1)
{
    return sums[i1][j1] - sums[i0][j1] - sums[i1][j0] + sums[i0][j0];
}

/* By how much the log-likelihood per ray of the group grows by a rectangle of the cells i0 <= i < i1, j0 <= j < j1. */
static double cells_gain(const RayGroup *group, CellSums *sums, double cell_area, int i0, int i1, int j0, int j1)
{
    double weight = cells_sum(sums->weight, i0, i1, j0, j1), projected = cells_sum(sums->projected, i0, i1, j0, j1);
    if (!(weight > 0.0 && projected > 0.0))
        return 0.0;
    double area = cell_area * ((i1 - i0) * (j1 - j0)) * (projected / weight), part = weight / group->weight;
    double rest = part < 1.0 ? (1.0 - part) * log(1.0 - part) : 0.0;
    return part * log(part * group->area / area) + rest;
}

/* Makes *best the best rectangle of the window's cells, if that is better. */
static void window_search(const RaySample *sample, const RayGroup *group, const Rectangle *window, Rectangle *best)
{
    CellSums sums;
    double side[2];
    for (int k = 0; k < 2; ++k)
        side[k] = (window->high[k] - window->low[k]) / CELLS;
    if (!(side[0] > 0.0 && side[1] > 0.0))
        return;
    sums_make(sample, group, window, &sums);
    double most = log(group->area / (COSINE_LOW * side[0] * side[1]));
    for (int i0 = 0; i0 < CELLS; ++i0)
        for (int i1 = i0 + 1; i1 <= CELLS; ++i1)
            for (int j0 = 0; j0 < CELLS; ++j0)
                for (int j1 = j0 + 1; j1 <= CELLS; ++j1) {
                    if (cells_sum(sums.weight, i0, i1, j0, j1) * most <= best->gain * group->weight)
                        continue; /* whatever their area */
                    double gain = cells_gain(group, &sums, side[0] * side[1], i0, i1, j0, j1);
                    if (gain <= best->gain)
                        continue;
                    *best = (Rectangle){.axis = window->axis,
                                        .at = window->at,
                                        .low = {window->low[0] + i0 * side[0], window->low[1] + j0 * side[1]},
                                        .high = {window->low[0] + i1 * side[0], window->low[1] + j1 * side[1]},
                                        .gain = gain};
                }
}

/* The range of values without the outermost, widened by `beyond` of it on either side. */
static void range_of(double *values, size_t count, double beyond, double *low, double *high)
{
    double first = sample_quantile(values, count, OUTSIDE), last = sample_quantile(values, count, 1.0 - OUTSIDE);
    *low = first - beyond * (last - first);
    *high = last + beyond * (last - first);
}

/* The window of a plane that most of the group's rays cross. */
static Rectangle window_of(const RaySample *sample, const RayGroup *group, int axis, double at)
{
    Rectangle window = {.axis = axis, .at = at};
    for (int k = 0; k < 2; ++k) {
        size_t count = 0;
        double place[2];
        for (size_t i = 0; i < sample->count; i += sample->count / RANGE_RAYS + 1)
            if (sample->rays[i].group == group->number && crossing(&sample->rays[i], axis, at, place))
                sample->values[count++] = place[k];
        if (count > 0)
            range_of(sample->values, count, 0.01, &window.low[k], &window.high[k]);
    }
    return window;
}

/* The best rectangle for a part of the group in evenly spaced planes. *step: from one to the next. */
static Rectangle planes_search(const RaySample *sample, const RayGroup *group, double *step)
{
    Rectangle best = {.gain = 0.0};
    for (int axis = 0; axis < 3; ++axis) {
        double low, high, before = best.gain;
        size_t count = 0;
        for (size_t i = 0; i < sample->count; ++i)
            if (sample->rays[i].group == group->number)
                sample->values[count++] = vec3_along(sample->rays[i].origin, axis);
        range_of(sample->values, count, BEYOND, &low, &high);
        for (int plane = 0; plane < PLANES; ++plane) {
            Rectangle window = window_of(sample, group, axis, low + (high - low) * (plane + 0.5) / PLANES);
            window_search(sample, group, &window, &best);
        }
        if (best.gain > before)
            *step = (high - low) / PLANES;
    }
    return best;
}

/* Searches again around the best rectangle, in ever closer planes and smaller cells. */
static Rectangle refined(const RaySample *sample, const RayGroup *group, Rectangle best, double step)
{
    for (int i = 0; i < REFINEMENTS; ++i) {
        Rectangle window = best;
        double at = best.at;
        for (int k = 0; k < 2; ++k) {
            double margin = (best.high[k] - best.low[k]) / (CELLS - 2);
            window.low[k] -= margin;
            window.high[k] += margin;
        }
        step *= 0.5;
        for (int plane = -2; plane <= 2; ++plane) {
            window.at = at + plane * step;
            window_search(sample, group, &window, &best);
        }
    }
    return best;
}

/* Shrinks the rectangle to the group's rays that cross it and widens it by the margin; how many these are. */
static size_t rectangle_shrink(const RaySample *sample, const RayGroup *group, Rectangle *rectangle)
{
    double low[2] = {DBL_MAX, DBL_MAX}, high[2] = {-DBL_MAX, -DBL_MAX};
    size_t count = 0;
    for (size_t i = 0; i < sample->count; ++i) {
        double place[2];
        if (!ray_group_crosses(group, &sample->rays[i], rectangle, place))
            continue;
        ++count;
        for (int k = 0; k < 2; ++k) {
            low[k] = fmin(low[k], place[k]);
            high[k] = fmax(high[k], place[k]);
        }
    }
    for (int k = 0; k < 2 && count > 0; ++k) {
        double margin = (MARGIN + MARGIN_RAYS / (double)count) * (high[k] - low[k]);
        rectangle->low[k] = low[k] - margin;
        rectangle->high[k] = high[k] + margin;
    }
    return count;
}

void group_search(const RaySample *sample, RayGroup *group)
{
    double step = 0.0;
    group->weight = 0.0;
    group->count = 0;
    group->next = (Rectangle){.gain = 0.0};
    for (size_t i = 0; i < sample->count; ++i)
        if (sample->rays[i].group == group->number) {
            group->weight += (double)sample->rays[i].weight;
            ++group->count;
        }
    if (group->count < RAYS_MIN)
        return;
    Rectangle best = planes_search(sample, group, &step);
    if (best.gain > 0.0)
        best = refined(sample, group, best, step);
    if (best.gain > 0.0 && rectangle_shrink(sample, group, &best) >= RAYS_MIN && best.high[0] > best.low[0] &&
        best.high[1] > best.low[1])
        group->next = best;
}
