/* The graphics state: transforms, attributes, and what AttributeBegin and AttributeEnd save and restore. */
#ifndef TWINLIGHT_PBRT_STATE_H
#define TWINLIGHT_PBRT_STATE_H

#include "pbrt/context.h"

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

/* The current transform for a directive that has no motion blur: the start's. Motion is unsupported. */
bool import_ctm(PbrtImport *im, SourcePlace place, Matrix *ctm);

/* A transform to the world of the file becomes one to that of the scene, which lies elsewhere by im->offset. */
void import_matrix_move(const PbrtImport *im, Matrix *matrix);

/* The inverse of a transform. A singular one is an error, and one that does not fit a float. */
bool import_inverse(PbrtImport *im, SourcePlace place, const Matrix *matrix, Matrix *inverse);

/* The transform to the scene's world and its inverse. Of the camera, before WorldBegin, nothing is moved. */
bool import_ctm_inverse(PbrtImport *im, SourcePlace place, Matrix *ctm, Matrix *inverse);

#endif
