/* MIS weights of the three strategies of instant bidirectional path tracing (a light is hit, a point on a light is
 * sampled, the light subpath is connected to the lens) from running products, so that a path's state does not grow with
 * its length. Equal to path/strategy.h with STRATEGIES_IBPT, which needs the densities of every vertex. */
#ifndef TWINLIGHT_PATH_IB_WEIGHT_H
#define TWINLIGHT_PATH_IB_WEIGHT_H

#include "path/bd_state.h"
#include "path/mis.h"
#include "path/strategy.h"

/* Fields after those of path/bd_state.h. v_1, v_2 ... v_j are the walk's vertices, and r_i is the density of v_i by the
 * other side over that by its own: known once the walk has left v_{i+1}. */
#define IB_PRODUCT BD_RECEIVER /* r_1 r_2 ... r_{j-2}: value, exponent */
#define IB_OWN (BD_RECEIVER + 2u) /* density of v_j, by its own side */
#define IB_OWN_BEFORE (BD_RECEIVER + 3u) /* that of v_{j-1} */
#define IB_FIRST_RATIO (BD_RECEIVER + 4u) /* r_0, that of y_0, on the light's side, once the walk has left y_1 */
#define IB_FIRST_DELTA (BD_RECEIVER + 5u) /* 1: v_1 scattered by a delta lobe */
#define IB_HEADER_WORDS (BD_RECEIVER + 6u)

SHARED_FUNCTION Scaled ib_product_load(__global const uint *paths, uint stride, uint item)
{
    Scaled product;
    product.value = state_load_float(paths, stride, IB_PRODUCT, item);
    product.exponent = (int)state_load(paths, stride, IB_PRODUCT + 1u, item);
    return product;
}

SHARED_FUNCTION void ib_product_store(__global uint *paths, uint stride, uint item, Scaled product)
{
    state_store_float(paths, stride, IB_PRODUCT, item, product.value);
    state_store(paths, stride, IB_PRODUCT + 1u, item, (uint)product.exponent);
}

SHARED_FUNCTION Scaled scaled_ratio(float numerator, float denominator)
{
    return scaled_divide(scaled_from(numerator), scaled_from(denominator));
}

/* r_1 ... r_j. last, before: the densities of v_j and v_{j-1} by the other side. */
SHARED_FUNCTION Scaled ib_product_to(__global const uint *paths, uint stride, uint item, uint j, float last,
                                     float before)
{
    Scaled product = scaled_ratio(last, state_load_float(paths, stride, IB_OWN, item));
    if (j >= 2u)
        product = scaled_multiply(product, scaled_ratio(before, state_load_float(paths, stride, IB_OWN_BEFORE, item)));
    return j >= 3u ? scaled_multiply(product, ib_product_load(paths, stride, item)) : product;
}

/* Adds another strategy; density: its path density over that of the strategy that made the path. */
SHARED_FUNCTION void ib_take(MisSum *sum, uint set, uint s, uint k, bool possible, Scaled density)
{
    if (!possible || !strategy_taken(set, s, k))
        return;
    sum->term = scaled_from(1.0f);
    mis_sum_take(sum, density);
}

/* s = 0: z_k has hit a light. last_delta: z_{k-1} scattered by a delta lobe. */
SHARED_FUNCTION float ib_weight_met(__global const FrameParams *frame, __global const uint *paths, uint item, uint k,
                                    bool last_delta, const StrategyEnds *ends)
{
    uint stride = frame->pass.stride;
    MisSum sum = mis_sum_begin(frame->path.mis_exponent);
    Scaled drawn = scaled_multiply(scaled_ratio(ends->light_z1, state_load_float(paths, stride, IB_OWN, item)),
                                   scaled_from(ends->connect));
    ib_take(&sum, frame->path.strategies, 1u, k, !last_delta, drawn);
    if (k >= 2u)
        ib_take(&sum, frame->path.strategies, k, k, state_load(paths, stride, IB_FIRST_DELTA, item) == 0u,
                ib_product_to(paths, stride, item, k, ends->light_z1, ends->light_z2));
    return mis_sum_weight(&sum, scaled_from(1.0f));
}

/* s = 1: a light was drawn for z_{k-1}. */
SHARED_FUNCTION float ib_weight_drawn(__global const FrameParams *frame, __global const uint *paths, uint item, uint k,
                                      const StrategyEnds *ends)
{
    uint stride = frame->pass.stride;
    MisSum sum = mis_sum_begin(frame->path.mis_exponent);
    ib_take(&sum, frame->path.strategies, 0u, k, ends->hittable, scaled_ratio(ends->camera_y1, ends->own_y0));
    ib_take(&sum, frame->path.strategies, k, k, k == 2u || state_load(paths, stride, IB_FIRST_DELTA, item) == 0u,
            ib_product_to(paths, stride, item, k - 1u, ends->light_z1, ends->light_z2));
    return mis_sum_weight(&sum, scaled_from(ends->connect));
}

/* t = 1: y_{k-1} seen from the lens. */
SHARED_FUNCTION float ib_weight_seen(__global const FrameParams *frame, __global const uint *paths, uint item, uint k,
                                     const StrategyEnds *ends)
{
    uint stride = frame->pass.stride;
    MisSum sum = mis_sum_begin(frame->path.mis_exponent);
    Scaled drawn = ib_product_to(paths, stride, item, k - 1u, ends->camera_y1, ends->camera_y2);
    Scaled met = scaled_multiply(
        drawn, k == 2u ? scaled_ratio(ends->camera_y2, state_load_float(paths, stride, IB_OWN_BEFORE, item))
                       : scaled_from(state_load_float(paths, stride, IB_FIRST_RATIO, item)));
    ib_take(&sum, frame->path.strategies, 1u, k, k == 2u || state_load(paths, stride, IB_FIRST_DELTA, item) == 0u,
            scaled_multiply(drawn, scaled_from(ends->connect)));
    ib_take(&sum, frame->path.strategies, 0u, k, ends->hittable, met);
    return mis_sum_weight(&sum, scaled_from(1.0f));
}

/* Updates the products when the walk leaves v_j, j >= 1. other: the density of v_{j-1} by the other side. */
SHARED_FUNCTION void ib_leave(__global uint *paths, uint stride, uint item, uint side, uint j, float other, bool delta)
{
    float before = state_load_float(paths, stride, IB_OWN_BEFORE, item);
    if (j == 1u) {
        state_store(paths, stride, IB_FIRST_DELTA, item, delta ? 1u : 0u);
        ib_product_store(paths, stride, item, scaled_from(1.0f));
        if (side == SIDE_LIGHT)
            state_store_float(paths, stride, IB_FIRST_RATIO, item, scaled_float(scaled_ratio(other, before)));
    } else {
        ib_product_store(paths, stride, item,
                         scaled_multiply(ib_product_load(paths, stride, item), scaled_ratio(other, before)));
    }
    state_store_float(paths, stride, IB_OWN_BEFORE, item, state_load_float(paths, stride, IB_OWN, item));
}

#endif
