/* trianglemesh, plymesh, bilinearmesh and loopsubdiv. */
#ifndef TWINLIGHT_PBRT_MESH_H
#define TWINLIGHT_PBRT_MESH_H

#include "pbrt/shape_add.h"

/* Reads the parameters of the mesh from `list`, finishes the list and adds the mesh. */
bool mesh_read(PbrtImport *im, const char *kind, ParamList *list, const ShapeContext *context);

#endif
