/* Turns ribbons, curves with a given normal, into bilinear patches. */
#ifndef TWINLIGHT_PBRT_RIBBON_H
#define TWINLIGHT_PBRT_RIBBON_H

#include "pbrt/shape_add.h"

/* Adds the ribbon along `count` > 0 segments. normals: three floats for each end of a segment, 3 (count + 1) in all;
 * between them the normal turns evenly. A patch deviates from the ribbon by at most 1/20 of its width. */
bool ribbon_add(PbrtImport *im, const ShapeContext *context, const Curve *segments, size_t count, const float *normals);

#endif
