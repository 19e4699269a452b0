/* The graphics state: transforms, attributes, and what AttributeBegin and AttributeEnd save and restore. */
#ifndef TWINLIGHT_PBRT_STATE_H
#define TWINLIGHT_PBRT_STATE_H

#include "pbrt_context.h"

void state_init(GraphicsState *state);

/* Appends the matrix to the active transforms (ctm = ctm * matrix), or replaces them. Fails when a transform becomes
 * infinite. */
bool state_concat(PbrtImport *im, const Matrix *matrix);
bool state_replace(PbrtImport *im, const Matrix *matrix);

/* AttributeBegin and its like; `opened_by` names it in messages. */
bool state_push(PbrtImport *im, const char *opened_by);

/* Ends what the directive `opened_by` began; `closed_by` is the directive that ends it. */
bool state_pop(PbrtImport *im, const char *opened_by, const char *closed_by);

/* CoordinateSystem and CoordSysTransform. */
bool state_coordinate_system(PbrtImport *im, const char *name, const Matrix transforms[2]);
bool state_use_coordinate_system(PbrtImport *im, const char *name, SourcePlace name_place);

/* Attribute "target" and the parameters in im->params. */
bool state_attribute(PbrtImport *im, const char *target, SourcePlace target_place);

/* AreaLightSource "kind" and the parameters in im->params. */
bool state_area_light(PbrtImport *im, const char *kind);

#endif
