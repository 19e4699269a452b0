/* The error of a rendering against time, from its halves: two pictures of the same expectation with independent
 * errors. */
#ifndef TWINLIGHT_SERVE_ERROR_CURVE_H
#define TWINLIGHT_SERVE_ERROR_CURVE_H

#include <stdbool.h>
#include <stddef.h>

#define ERROR_CURVE_POINTS 256

typedef struct ErrorPoint {
    double seconds, error;
} ErrorPoint;

typedef struct ErrorCurve {
    ErrorPoint points[ERROR_CURVE_POINTS];
    size_t count;
} ErrorCurve;

/* Whether a point at this time would be far enough from the last: a twentieth of the time later, and a second. */
bool error_curve_due(const ErrorCurve *curve, double seconds);

/* Adds a point. A full curve loses every second one first. */
void error_curve_add(ErrorCurve *curve, double seconds, double error);

#endif
