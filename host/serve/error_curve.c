#include "serve/error_curve.h"

#include <math.h>

bool error_curve_due(const ErrorCurve *curve, double seconds)
{
    double last = curve->count > 0 ? curve->points[curve->count - 1].seconds : 0.0;
    return seconds > 0.0 && (curve->count == 0 || seconds >= last + fmax(1.0, 0.05 * last));
}

void error_curve_add(ErrorCurve *curve, double seconds, double error)
{
    if (curve->count == ERROR_CURVE_POINTS) {
        curve->count = ERROR_CURVE_POINTS / 2;
        for (size_t i = 0; i < curve->count; ++i)
            curve->points[i] = curve->points[2 * i + 1];
    }
    curve->points[curve->count++] = (ErrorPoint){seconds, error};
}
