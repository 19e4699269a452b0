/* Writes the strands of hair.pbrt: three locks of hair, as cubic B-splines. usage: make_hair, into gzip -9n */
#include "math/rng.h"

#include <math.h>
#include <stdio.h>

enum { LOCKS = 3, STRANDS = 700, POINTS = 9 };

#define TAU 6.283185307179586

/* Where a lock begins and how far it sways. */
typedef struct Lock {
    double x, z, sway, phase, twist, length;
} Lock;

static const Lock LOCK[LOCKS] = {
    {-0.42, 0.05, 0.11, 0.3, 2.2, 1.45}, {0.02, -0.08, 0.14, 2.4, -1.8, 1.6}, {0.45, 0.04, 0.10, 4.1, 2.6, 1.4}};

/* Uniform in (0, 1): number k of strand i. */
static double number(uint32_t i, uint32_t k)
{
    Random4 random = random_four(i, k / 4u, 0u, 0u, 1u, 2u);
    return (double)random_float(random.x[k % 4u]);
}

/* Point j of a strand: it winds around the lock's axis, more tightly further down, and strays a little. */
static void strand_point(const Lock *lock, uint32_t i, int j, double p[3])
{
    double s = ((double)j - 1.0) / (POINTS - 3), along = lock->length * (0.92 + 0.16 * number(i, 0));
    double around = TAU * number(i, 1) + lock->twist * s, radius = 0.2 * sqrt(number(i, 2)) * (1.0 - 0.55 * s * s);
    double stray = 0.05 * s * s, swing = TAU * (0.8 * s) + lock->phase;
    p[0] =
        lock->x + lock->sway * sin(swing) * s + radius * cos(around) + stray * (number(i, 4 + 2 * (uint32_t)j) - 0.5);
    p[1] = 1.8 - along * s;
    p[2] =
        lock->z + lock->sway * cos(swing) * s + radius * sin(around) + stray * (number(i, 5 + 2 * (uint32_t)j) - 0.5);
}

int main(void)
{
    puts("Attribute \"shape\" \"string basis\" \"bspline\" \"float width0\" 0.005 \"float width1\" 0.0015");
    for (uint32_t i = 0; i < LOCKS * STRANDS; ++i) {
        fputs("Shape \"curve\" \"point3 P\" [", stdout);
        for (int j = 0; j < POINTS; ++j) {
            double p[3];
            strand_point(&LOCK[i / STRANDS], i, j, p);
            printf(" %.3f %.3f %.3f", p[0], p[1], p[2]);
        }
        puts(" ]");
    }
    return 0;
}
