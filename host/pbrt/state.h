/* The graphics state: transforms, attributes, and what AttributeBegin and AttributeEnd save and restore. */
#ifndef TWINLIGHT_PBRT_STATE_H
#define TWINLIGHT_PBRT_STATE_H

#include "pbrt/context.h"

void state_init(GraphicsState *state);

/* Multiplies the active transforms by the matrix (ctm = ctm * matrix), or replaces them. Fails if a transform becomes
 * infinite. */
bool state_concat(PbrtImport *im, const Matrix *matrix);
bool state_replace(PbrtImport *im, const Matrix *matrix);

/* Opens a scope, for AttributeBegin and similar; `opened_by` names the directive in messages. */
bool state_push(PbrtImport *im, const char *opened_by);

/* Closes the scope opened by the directive `opened_by`; `closed_by` names the closing directive in messages. */
bool state_pop(PbrtImport *im, const char *opened_by, const char *closed_by);

/* CoordinateSystem and CoordSysTransform. */
bool state_coordinate_system(PbrtImport *im, const char *name, const Matrix transforms[2]);
bool state_use_coordinate_system(PbrtImport *im, const char *name, SourcePlace name_place);

/* Attribute "target" and the parameters in im->params. */
bool state_attribute(PbrtImport *im, const char *target, SourcePlace target_place);

/* AreaLightSource "kind" and the parameters in im->params. */
bool state_area_light(PbrtImport *im, const char *kind);

/* The current transform for use without motion blur: the one at the start. Motion is reported as unsupported. Fails if
 * it is projective. */
bool import_ctm(PbrtImport *im, SourcePlace place, Matrix *ctm);

/* Converts a transform to the file's world space into one to the scene's world space, which is offset by im->offset. */
void import_matrix_move(const PbrtImport *im, Matrix *matrix);

/* Inverts a transform. Fails if it is singular, or if it or its inverse does not fit floats. */
bool import_inverse(PbrtImport *im, SourcePlace place, const Matrix *matrix, Matrix *inverse);

/* The current transform to the scene's world space, and its inverse. Before WorldBegin, for the camera, im->offset is
 * not applied. directions: only directions are transformed; then a projective transform without translation is one
 * without its last row, as in pbrt. */
bool import_ctm_inverse(PbrtImport *im, SourcePlace place, bool directions, Matrix *ctm, Matrix *inverse);

#endif
