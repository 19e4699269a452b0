/* The MIS weight of one bidirectional strategy among those of its set, from the densities of the path's vertices in
 * both directions (Veach 1997, section 10.2; path/mis.h). */
#ifndef TWINLIGHT_PATH_STRATEGY_H
#define TWINLIGHT_PATH_STRATEGY_H

#include "path/bd_state.h"
#include "path/mis.h"

/* Densities that only the connection determines, whose ends are y_{s-1} and z_{t-1}: per area, or for a light at
 * infinity per solid angle. Those that do not exist (s or t too small) are not read. */
typedef struct StrategyEnds {
    float light_z1; /* of z_{t-1}, made from y_{s-1}; s = 0: of emitting there */
    float light_z2; /* of z_{t-2}, made from z_{t-1} */
    float camera_y1; /* of y_{s-1}, made from z_{t-1} */
    float camera_y2; /* of y_{s-2}, made from y_{s-1} */
    float own_y0; /* s = 1: of emitting from the point drawn */
    float connect; /* density of drawing the path's point on the light for its neighbour, over that of emitting there */
    bool hittable; /* paths can hit the light */
} StrategyEnds;

/* Where the densities of an item are: those of y_0 ... and z_1 ..., each word at stride. Stored in full, a vertex has
 * DENSITY_WORDS words. Compact, it has one, since only the ratio of its two densities counts; except for the last two
 * vertices of a side, whose density by the other side only the connection determines. */
typedef struct DensityView {
    __global const uint *light, *camera;
    uint stride, item;
    uint light_delta, camera_delta; /* bit i: the vertex scattered by a delta lobe */
    bool compact;
    uint light_end, camera_end; /* compact: from this index on a vertex has its own density, before it the ratio */
} DensityView;

/* The densities of vertex i by its own side and by the other, up to a factor common to both. */
SHARED_FUNCTION float density_own(const DensityView *view, uint side, uint i)
{
    __global const uint *words = side == SIDE_LIGHT ? view->light : view->camera;
    uint index = side == SIDE_LIGHT ? i : i - 1u;
    if (!view->compact)
        return state_load_float(words, view->stride, index * DENSITY_WORDS + DENSITY_OWN, view->item);
    uint end = side == SIDE_LIGHT ? view->light_end : view->camera_end;
    return i >= end ? state_load_float(words, view->stride, index, view->item) : 1.0f;
}

SHARED_FUNCTION float density_other(const DensityView *view, uint side, uint i)
{
    __global const uint *words = side == SIDE_LIGHT ? view->light : view->camera;
    uint index = side == SIDE_LIGHT ? i : i - 1u;
    return state_load_float(words, view->stride, view->compact ? index : index * DENSITY_WORDS + DENSITY_OTHER,
                            view->item);
}

/* MIS weights of a path. */
typedef struct StrategyWeights {
    float own; /* of the strategy that made it */
    float path_tracing; /* sum over the strategies of path tracing, s <= 1 */
} StrategyWeights;

/* Counts the strategy with s vertices from the light. *path_tracing: sum over those of path tracing. */
SHARED_FUNCTION void strategy_sum_take(MisSum *sum, Scaled *path_tracing, uint s, float connect)
{
    Scaled part = mis_sum_take(sum, scaled_from(s == 1u ? connect : 1.0f));
    if (s < 2u)
        *path_tracing = scaled_add(*path_tracing, part);
}

/* Whether the edge between vertices i and i - 1 can be a connection: neither scattered by a delta lobe. Vertex 0, the
 * side's end, never does. */
SHARED_FUNCTION bool edge_connectable(uint delta, uint i)
{
    uint ends = (1u << i) | (i > 1u ? 1u << (i - 1u) : 0u);
    return (delta & ends) == 0u;
}

/* Adds the strategies with more vertices from the light than s: t' = t - 1 ... 1. */
SHARED_FUNCTION void strategy_sum_camera(MisSum *sum, Scaled *path_tracing, uint set, uint s, uint t,
                                         const DensityView *view, const StrategyEnds *ends)
{
    uint k = s + t - 1u;
    for (uint i = t - 1u; i >= 1u; --i) {
        float light = i == t - 1u ? ends->light_z1 : i == t - 2u ? ends->light_z2 : density_other(view, SIDE_CAMERA, i);
        mis_sum_step(sum, light, density_own(view, SIDE_CAMERA, i));
        uint other = k - i + 1u;
        if (strategy_taken(set, other, k) && edge_connectable(view->camera_delta, i))
            strategy_sum_take(sum, path_tracing, other, ends->connect);
    }
}

/* Adds those with fewer: s' = s - 1 ... 0. */
SHARED_FUNCTION void strategy_sum_light(MisSum *sum, Scaled *path_tracing, uint set, uint s, uint t,
                                        const DensityView *view, const StrategyEnds *ends)
{
    uint k = s + t - 1u;
    for (uint i = s; i-- > 0u;) {
        float camera = i == s - 1u   ? ends->camera_y1
                       : i + 2u == s ? ends->camera_y2
                                     : density_other(view, SIDE_LIGHT, i);
        float light = s == 1u ? ends->own_y0 : density_own(view, SIDE_LIGHT, i);
        mis_sum_step(sum, camera, light);
        bool possible = i > 0u ? edge_connectable(view->light_delta, i) : ends->hittable;
        if (strategy_taken(set, i, k) && possible)
            strategy_sum_take(sum, path_tracing, i, ends->connect);
    }
}

/* MIS weights of the strategy (s, t), t >= 1. exponent: 1 for the balance heuristic, 2 for the power heuristic. */
SHARED_FUNCTION StrategyWeights strategy_weights(uint set, uint exponent, uint s, uint t, const DensityView *view,
                                                 const StrategyEnds *ends)
{
    MisSum sum = mis_sum_begin(exponent);
    Scaled factor = scaled_from(s == 1u ? ends->connect : 1.0f), path_tracing = scaled_zero();
    DensityView path = *view;
    /* The lobes by which walks left the two ends are not those of the connection. */
    path.camera_delta &= (1u << (t - 1u)) - 1u;
    path.light_delta &= s > 0u ? (1u << (s - 1u)) - 1u : 0u;
    strategy_sum_camera(&sum, &path_tracing, set, s, t, &path, ends);
    mis_sum_turn(&sum);
    strategy_sum_light(&sum, &path_tracing, set, s, t, &path, ends);
    if (s < 2u)
        path_tracing = scaled_add(path_tracing, mis_sum_power(&sum, factor));
    StrategyWeights weights;
    weights.own = mis_sum_weight(&sum, factor);
    weights.path_tracing = mis_sum_part(&sum, factor, path_tracing);
    return weights;
}

#endif
