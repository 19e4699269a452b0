/* Weights of multiple importance sampling: the one place where they are computed (Veach, "Robust Monte Carlo Methods
 * for Light Transport Simulation", 1997, section 9.2).
 *
 * A path of k segments is made by strategies (s, t): s vertices from the light, t from the camera. Path tracing takes
 * {s <= 1}: s = 0, the BSDF's direction hits a light; s = 1, a point on a light is drawn and connected. Both sample
 * the same last vertex, so their ratio of densities is a ratio of solid-angle densities at the vertex before it. */
#ifndef TWINLIGHT_MIS_H
#define TWINLIGHT_MIS_H

#include "platform.h"

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

#endif
