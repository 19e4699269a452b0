/* Sampling tables of the pixel filter. */
#ifndef TWINLIGHT_SCENE_FILTER_SETUP_H
#define TWINLIGHT_SCENE_FILTER_SETUP_H

#include "scene/scene.h"

/* The filter at offset x from its centre along one axis, as defined by pbrt-v4 up to a constant factor: box, triangle
 * (radius - |x|), Gaussian minus its value at the radius, the cubic of Mitchell and Netravali stretched to the radius
 * ("Reconstruction Filters in Computer Graphics", SIGGRAPH 1988), sinc windowed by a Lanczos sinc of width tau. */
double filter_evaluate(const FilterSettings *settings, double radius, double x);

/* Appends the tables to `lookup` (floats) and fills `out`. Fails for a radius or width that is not positive, and for a
 * filter whose integral is not. */
bool filter_setup(const FilterSettings *settings, Array *lookup, PixelFilter *out, Error *error);

#endif
