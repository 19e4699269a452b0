/* Trilinear interpolation in double precision, against which media of grids are tested. */
#ifndef TWINLIGHT_TESTS_GEOMETRY_TRILINEAR_H
#define TWINLIGHT_TESTS_GEOMETRY_TRILINEAR_H

#include "math/platform.h"

#include <math.h>

/* Word `word` of the sample at an index, which may be any: 0 where there is none. */
typedef double SampleValue(const void *context, const int index[3], uint word);

/* The value at a point: samples lie at origin + spacing * (index + 1 - low). */
static inline double trilinear_value(const double p[3], const double origin[3], const double spacing[3], float low,
                                     SampleValue *value, const void *context, uint word)
{
    int cell[3];
    double f[3], sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        double x = (p[i] - origin[i]) / spacing[i] + (double)low - 1.0;
        cell[i] = (int)floor(x);
        f[i] = x - cell[i];
    }
    for (int corner = 0; corner < 8; ++corner) {
        int index[3];
        double weight = 1.0;
        for (int i = 0; i < 3; ++i) {
            index[i] = cell[i] + (corner >> i & 1);
            weight *= corner >> i & 1 ? f[i] : 1.0 - f[i];
        }
        sum += weight * value(context, index, word);
    }
    return sum;
}

#endif
