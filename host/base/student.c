#include "base/student.h"

#include <math.h>

#define STEPS_MAX 500
#define TINY 1e-300
#define PRECISION 1e-15
#define BISECTIONS 64 /* more than the 53 bits of a double's significand */

/* Continued fraction of the incomplete beta function (DLMF 8.17.22), evaluated by the modified Lentz method, for
 * x < (a + 1) / (a + b + 2), where it converges fast. */
static double beta_fraction(double a, double b, double x)
{
    double c = 1.0, d = 0.0, value = 1.0;
    for (int i = 0; i < STEPS_MAX; ++i) {
        int pair = i / 2; /* even and odd terms have different formulas */
        double m = pair, numerator;
        if (i == 0)
            numerator = 1.0;
        else if (i % 2 == 0)
            numerator = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        else
            numerator = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 + numerator * d;
        d = 1.0 / (fabs(d) < TINY ? TINY : d);
        c = 1.0 + numerator / c;
        c = fabs(c) < TINY ? TINY : c;
        value *= c * d;
        if (fabs(c * d - 1.0) < PRECISION)
            break;
    }
    return value - 1.0;
}

/* I_x(a, b), the regularised incomplete beta function. y = 1 - x is passed separately, because it may be too small to
 * be computed by subtraction. */
static double beta_regularised(double a, double b, double x, double y)
{
    double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log(y));
    if (x < (a + 1.0) / (a + b + 2.0))
        return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, y) / b;
}

double student_two_sided(double t, double freedom)
{
    if (t == 0.0)
        return 1.0;
    if (isinf(t))
        return 0.0;
    double sum = freedom + t * t;
    return beta_regularised(0.5 * freedom, 0.5, freedom / sum, t * t / sum);
}

double student_threshold(double probability, double freedom)
{
    double low = 0.0, high = 1.0;
    while (student_two_sided(high, freedom) > probability)
        high *= 2.0;
    for (int i = 0; i < BISECTIONS; ++i) {
        double t = 0.5 * (low + high);
        *(student_two_sided(t, freedom) > probability ? &low : &high) = t;
    }
    return high;
}
