/* Materials that are used before they are defined, or defined before the textures and materials that they name: pbrt
 * resolves names at the end of the scene. Such a material gets its index in the scene when it is first named, and its
 * contents when they are known. */
#ifndef TWINLIGHT_PBRT_LATE_H
#define TWINLIGHT_PBRT_LATE_H

#include "pbrt/context.h"

/* Index in the scene of the material of that name, which is not defined yet. place: of the name. */
bool late_material_use(PbrtImport *im, const char *name, SourcePlace place, uint *material);

/* The index given to uses of that name so far; NONE: there are none. They now count as defined. */
uint late_material_define(PbrtImport *im, const char *name);

/* Whether the list of a material of that kind names a texture or material that is not defined yet. */
bool late_material_waits(const PbrtImport *im, const ParamList *list, const char *kind);

/* Leaves reading the current directive, a material of that kind, to late_materials_finish. index: of the material,
 * which is blank until then. */
bool late_material_defer(PbrtImport *im, const ParamList *list, const char *kind, SourcePlace place, uint index);

/* Called at the end of the scene: reads what was deferred. Fails if names were never defined, or if mixes contain each
 * other. */
bool late_materials_finish(PbrtImport *im);

#endif
