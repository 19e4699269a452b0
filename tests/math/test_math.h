/* The test cases of the program test_math, one file per header under test. */
#ifndef TWINLIGHT_TESTS_MATH_TEST_MATH_H
#define TWINLIGHT_TESTS_MATH_TEST_MATH_H

#include "support/test_util.h"

#include "math/platform.h"

/* ck_assert_msg for loops: it does not message the parent process when the condition holds, which costs a
 * microsecond. */
#define test_require(condition, ...)                                                                                   \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            ck_abort_msg(__VA_ARGS__);                                                                                 \
    } while (0)

TCase *test_math_elementary(void);
TCase *test_math_elementary_pairs(void);
TCase *test_math_rng(void);
TCase *test_math_sobol(void);
TCase *test_math_warp(void);
TCase *test_math_sphere_maps(void);
TCase *test_math_alias(void);
TCase *test_math_distribution2d(void);

/* The tests' own generator, independent of the one under test (SplitMix64, Steele et al. 2014). */
static inline uint64_t test_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Uniform in (0, 1) on the grid of random_float. */
static inline float test_uniform(uint64_t *state)
{
    return ((float)(test_random(state) >> 41) + 0.5f) * 0x1p-23f;
}

/* The error of `ours` in units in the last place of `exact`. 0 if both are NaN (ours the canonical one), or if `exact`
 * rounds to infinity and ours is that infinity or the largest float; infinite if only one of the two is. */
static inline double test_ulp_error(float ours, double exact)
{
    if (isnan(exact) || isnan(ours))
        return isnan(exact) && float_bits(ours) == 0x7fc00000u ? 0.0 : HUGE_VAL;
    if (fabs(exact) >= 0x1.ffffffp127)
        return (exact > 0.0 ? ours : -ours) >= FLOAT_MAX ? 0.0 : HUGE_VAL;
    int exponent;
    frexp(exact, &exponent);
    return fabs((double)ours - exact) / ldexp(1.0, exponent - 24 < -149 ? -149 : exponent - 24);
}

#endif
