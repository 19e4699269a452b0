#include "film/pixel_order.h"

#include <math.h>
#include <stdint.h>

/* 1 / p and 1 / p^2 of the plastic number p = 1.3247...: distance in the order, as a fraction of n, from a pixel to its
 * right neighbour and to the one below. */
#define STEP_RIGHT 0.7548776662466927
#define STEP_DOWN 0.5698402909980532

/* 1 / golden ratio. */
#define STEP_GOLDEN 0.6180339887498949

/* This many consecutive numbers always include one coprime to any given 32-bit number. */
#define CANDIDATES_LEAST 64u

/* Inverse of a modulo n (extended Euclidean algorithm), 0 < a < n; 0 if they are not coprime. */
static uint inverse(uint a, uint n)
{
    int64_t before = 0, now = 1;
    uint rest = n, divisor = a;
    while (divisor > 1) {
        int64_t next = before - (int64_t)(rest / divisor) * now;
        uint left = rest % divisor;
        before = now;
        now = next;
        rest = divisor;
        divisor = left;
    }
    if (divisor == 0)
        return 0;
    return (uint)(now < 0 ? now + (int64_t)n : now);
}

/* Pixel p is visited as number p * t mod n, so its right neighbour comes t and the one below width * t visits later.
 * The candidates for t start at STEP_RIGHT * n; among them the one whose width * t is nearest to STEP_DOWN * n mod n
 * wins. Consecutive t move width * t / n by 1 / height, so `height` candidates cover all its values. */
uint pixel_order_stride(uint width, uint height)
{
    uint n = width * height, candidates = height > CANDIDATES_LEAST ? height : CANDIDATES_LEAST, best = 1;
    double least = 2.0;
    for (uint i = 0; i < candidates; ++i) {
        uint t = (uint)((uint64_t)(STEP_RIGHT * n) + i) % n;
        double down = (double)((uint64_t)width * t % n) / n, away = fabs(down - STEP_DOWN);
        away = fmin(away, 1.0 - away);
        uint stride = t > 0 && away < least ? inverse(t, n) : 0;
        if (stride > 0) {
            least = away;
            best = stride;
        }
    }
    return best;
}

uint pixel_order_stride_of(uint n)
{
    uint stride = (uint)(STEP_GOLDEN * n);
    stride = stride > 0 ? stride : 1;
    while (n > 1 && inverse(stride % n, n) == 0)
        ++stride;
    return stride;
}
