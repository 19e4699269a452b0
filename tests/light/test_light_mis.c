/* MIS weights: sums, limits, and range. */
#include "light/test_light.h"
#include "path/mis.h"
#include "support/test_util.h"

START_TEST(test_against_long_double)
{
    for (int i = -30; i <= 30; ++i)
        for (int j = -30; j <= 30; ++j) {
            long double a = powl(10.0L, i) * 1.7L, b = powl(10.0L, j) * 0.6L;
            float fa = (float)a, fb = (float)b;
            long double power = a * a / (a * a + b * b), balance = a / (a + b);
            ck_assert_double_lt(fabs((double)mis_power(fa, fb) - (double)power), 3e-7);
            ck_assert_double_lt(fabs((double)mis_balance(fa, fb) - (double)balance), 2e-7);
            ck_assert_double_lt(fabs((double)mis_power(fa, fb) + (double)mis_power(fb, fa) - 1.0), 3e-7);
            ck_assert_double_lt(fabs((double)mis_balance(fa, fb) + (double)mis_balance(fb, fa) - 1.0), 3e-7);
        }
}
END_TEST

START_TEST(test_limits)
{
    const float infinity = FLOAT_INFINITY, tiny = bits_float(1u);
    ck_assert((mis_power(0.0f, 1.0f) == 0.0f) && (mis_power(1.0f, 0.0f) == 1.0f));
    ck_assert((mis_power(0.0f, 0.0f) == 0.0f));
    ck_assert((mis_power(infinity, 1.0f) == 1.0f) && (mis_power(1.0f, infinity) == 0.0f));
    ck_assert((mis_power(infinity, infinity) == 0.5f) && (mis_balance(infinity, infinity) == 0.5f));
    ck_assert((mis_power(FLOAT_MAX, FLOAT_MAX) == 0.5f) && (mis_power(tiny, tiny) == 0.5f));
    ck_assert((mis_power(tiny, FLOAT_MAX) == 0.0f) && (mis_power(FLOAT_MAX, tiny) == 1.0f));
}
END_TEST

TCase *mis_case(void)
{
    TCase *tcase = tcase_create("mis");
    tcase_add_test(tcase, test_against_long_double);
    tcase_add_test(tcase, test_limits);
    return tcase;
}
