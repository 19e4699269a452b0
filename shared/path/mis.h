/* Weights of multiple importance sampling: the one place where they are computed (Veach, "Robust Monte Carlo Methods
 * for Light Transport Simulation", 1997, section 9.2).
 *
 * A path of k segments is made by strategies (s, t): s vertices from the light, t from the camera. Path tracing uses s
 * <= 1: for s = 0, a direction drawn from the BSDF hits a light; for s = 1, a point drawn on a light is connected. Both
 * sample the same last vertex, so their ratio of densities is a ratio of solid-angle densities at the vertex before
 * it. */
#ifndef TWINLIGHT_PATH_MIS_H
#define TWINLIGHT_PATH_MIS_H

#include "math/scaled.h"

/* pdf_b / pdf_a with the exact limits: +inf where pdf_a is zero, and 1 where both are infinite. Neither may be NaN or
 * negative; both zero gives +inf (weight 0: a strategy that cannot make the sample has no say). */
SHARED_FUNCTION float mis_ratio(float pdf_a, float pdf_b)
{
    if (!(pdf_a > 0.0f))
        return FLOAT_INFINITY;
    if (!float_finite(pdf_a))
        return float_finite(pdf_b) ? 0.0f : 1.0f;
    return pdf_b / pdf_a;
}

/* Balance heuristic (Veach, equation 9.8) for a sample of strategy a that b could have made: pa / (pa + pb), as
 * 1 / (1 + pb / pa) so that no sum of densities overflows. */
SHARED_FUNCTION float mis_balance(float pdf_a, float pdf_b)
{
    return 1.0f / (1.0f + mis_ratio(pdf_a, pdf_b));
}

/* Power heuristic with exponent 2 (Veach, section 9.2.4): pa^2 / (pa^2 + pb^2). The square of the ratio may overflow
 * to infinity or vanish, and then the weight is 0 or 1, which is right to rounding. */
SHARED_FUNCTION float mis_power(float pdf_a, float pdf_b)
{
    float ratio = mis_ratio(pdf_a, pdf_b);
    return 1.0f / (1.0f + ratio * ratio);
}

/* ---- many strategies --------------------------------------------------------------------------------------------- */

/* Which strategies an integrator uses. A path of one segment, light seen directly, is made by s = 0 alone. */
#define STRATEGY_HIT 0x1u /* s = 0: the camera's path hits a light */
#define STRATEGY_LIGHT 0x2u /* s = 1: a point on a light is drawn for the last vertex but one */
#define STRATEGY_CAMERA 0x4u /* t = 1, s >= 2: the light's path is connected to the lens */
#define STRATEGY_INNER 0x8u /* s >= 2, t >= 2 */
#define STRATEGY_CAMERA_DIRECT 0x10u /* t = 1, s = 2: STRATEGY_CAMERA for paths of two segments */
#define STRATEGIES_PT (STRATEGY_HIT | STRATEGY_LIGHT)
#define STRATEGIES_IBPT (STRATEGIES_PT | STRATEGY_CAMERA | STRATEGY_CAMERA_DIRECT)
#define STRATEGIES_BDPT (STRATEGIES_IBPT | STRATEGY_INNER)

/* Whether the set has the strategy with s light vertices for paths of k segments (s <= k). */
SHARED_FUNCTION bool strategy_taken(uint set, uint s, uint k)
{
    uint camera = k == 2u ? STRATEGY_CAMERA_DIRECT : STRATEGY_CAMERA;
    uint kind = s == 0u ? STRATEGY_HIT : s == 1u ? STRATEGY_LIGHT : s == k ? camera : STRATEGY_INNER;
    return (set & kind) != 0u && (k > 1u || s == 0u);
}

/* Sum of powers of p_i / p_s over strategies i != s, where s made the path. Densities of a path's vertices: camera[i]
 * is that of x_i as the camera's path makes it, light[i] as the light's path does, both per area (per solid angle for a
 * vertex at infinity). Then p_{i+1} / p_i = light[k - i] / camera[k - i], so the terms are running products from s in
 * both directions (Veach, section 10.2.1). Exponent 1 (balance heuristic) or 2 (power heuristic). */
typedef struct MisSum {
    Scaled term; /* p_i / p_s for the strategy i reached so far */
    Scaled sum;
    uint exponent;
} MisSum;

SHARED_FUNCTION MisSum mis_sum_begin(uint exponent)
{
    MisSum sum;
    sum.term = scaled_from(1.0f);
    sum.sum = scaled_zero();
    sum.exponent = exponent;
    return sum;
}

/* Moves on to the next strategy in one direction: its density is numerator / denominator times that of the last. */
SHARED_FUNCTION void mis_sum_step(MisSum *sum, float numerator, float denominator)
{
    sum->term = scaled_multiply(sum->term, scaled_divide(scaled_from(numerator), scaled_from(denominator)));
}

SHARED_FUNCTION Scaled mis_sum_power(const MisSum *sum, Scaled a)
{
    return sum->exponent == 2u ? scaled_multiply(a, a) : a;
}

/* Adds the strategy reached, which is one of the set. factor: what its density has besides the running product. Returns
 * its term. */
SHARED_FUNCTION Scaled mis_sum_take(MisSum *sum, Scaled factor)
{
    Scaled part = mis_sum_power(sum, scaled_multiply(sum->term, factor));
    sum->sum = scaled_add(sum->sum, part);
    return part;
}

/* Back to the strategy that made the path, to continue in the other direction. */
SHARED_FUNCTION void mis_sum_turn(MisSum *sum)
{
    sum->term = scaled_from(1.0f);
}

/* part / (own + sum of the others). factor: that of the strategy that made the path. */
SHARED_FUNCTION float mis_sum_part(const MisSum *sum, Scaled factor, Scaled part)
{
    return scaled_float(scaled_divide(part, scaled_add(mis_sum_power(sum, factor), sum->sum)));
}

/* The weight of the strategy that made the path. */
SHARED_FUNCTION float mis_sum_weight(const MisSum *sum, Scaled factor)
{
    return mis_sum_part(sum, factor, mis_sum_power(sum, factor));
}

#endif
