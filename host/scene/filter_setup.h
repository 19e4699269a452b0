/* Tables that the pixel filter is drawn from. */
#ifndef TWINLIGHT_SCENE_FILTER_SETUP_H
#define TWINLIGHT_SCENE_FILTER_SETUP_H

#include "scene/scene.h"

/* The filter at the offset x from its centre, along one axis, as pbrt-v4 defines it up to a constant factor: box,
 * triangle (radius - |x|), gaussian minus its value at the radius, Mitchell and Netravali's cubic stretched to the
 * radius ("Reconstruction Filters in Computer Graphics", SIGGRAPH 1988), sinc windowed by a Lanczos sinc of width
 * tau. */
double filter_evaluate(const FilterSettings *settings, double radius, double x);

/* Appends the tables to `lookup` (floats) and fills `out`. Fails on a radius or width that is not positive, and on a
 * filter whose integral is not. */
bool filter_setup(const FilterSettings *settings, Array *lookup, PixelFilter *out, Error *error);

#endif
