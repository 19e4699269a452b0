/* Reads the shape "curve": Bezier and B-spline curves of degree 2 and 3. */
#ifndef TWINLIGHT_PBRT_CURVE_H
#define TWINLIGHT_PBRT_CURVE_H

#include "pbrt/shape_add.h"

/* Types flat and cylinder become curves, type ribbon becomes bilinear patches. */
bool curve_read(PbrtImport *im, ParamList *list, const ShapeContext *context);

#endif
