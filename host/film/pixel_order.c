#include "film/pixel_order.h"

#include <math.h>
#include <stdint.h>

/* 1 / p and 1 / p^2 of the plastic number p = 1.3247...: how much later in the order the next pixel is, and the one
 * below. */
#define STEP_RIGHT 0.7548776662466927
#define STEP_DOWN 0.5698402909980532

/* 1 / golden ratio. */
#define STEP_GOLDEN 0.6180339887498949

/* Among so many numbers there is one without common factor with any of 32 bits. */
#define CANDIDATES_LEAST 64u

/* The inverse of a modulo n (extended Euclid), 0 < a < n; 0 when they have a common factor. */
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

/* Pixel p is visited as number p * t mod n, so t is how much later the next one is, and width * t the one below: t
 * begins at the right part of n and goes on until the latter is right, too, which takes no more than a number for every
 * row. */
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
