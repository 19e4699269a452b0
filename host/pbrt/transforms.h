/* Directives that change the current transform. The directive's name has been read, its arguments have not. */
#ifndef TWINLIGHT_PBRT_TRANSFORMS_H
#define TWINLIGHT_PBRT_TRANSFORMS_H

#include "pbrt/context.h"

bool directive_identity(PbrtImport *im);
bool directive_translate(PbrtImport *im);
bool directive_scale(PbrtImport *im);
bool directive_rotate(PbrtImport *im);
bool directive_look_at(PbrtImport *im);
bool directive_transform(PbrtImport *im);
bool directive_concat_transform(PbrtImport *im);
bool directive_coordinate_system(PbrtImport *im);
bool directive_coord_sys_transform(PbrtImport *im);
bool directive_active_transform(PbrtImport *im);
bool directive_transform_times(PbrtImport *im);

#endif
