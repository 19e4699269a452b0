/* Readers of the directives that take a name and parameters, and of those for objects. The parameters are in
 * im->params. */
#ifndef TWINLIGHT_PBRT_READERS_H
#define TWINLIGHT_PBRT_READERS_H

#include "pbrt/context.h"

bool import_shape(PbrtImport *im, const char *kind);
bool import_texture(PbrtImport *im, const char *name, SourcePlace name_place, const char *type, const char *kind);
bool import_material(PbrtImport *im, const char *kind);
bool import_named_material(PbrtImport *im, const char *name, SourcePlace name_place);
bool import_light(PbrtImport *im, const char *kind);
bool import_camera(PbrtImport *im, const char *kind);
bool import_film(PbrtImport *im, const char *kind);
bool import_filter(PbrtImport *im, const char *kind);
bool import_integrator(PbrtImport *im, const char *kind);
bool import_sampler(PbrtImport *im, const char *kind);
bool import_accelerator(PbrtImport *im, const char *kind);
bool import_option(PbrtImport *im, const char *name, const Token *value);

bool import_named_medium(PbrtImport *im, const char *name);

/* The number of a medium that MediumInterface names; "" is empty space. */
bool medium_number(PbrtImport *im, const char *name, SourcePlace place, uint *number);

/* To be called at the end of the scene: every medium that is mentioned must be defined. */
bool media_check(PbrtImport *im);

/* Objects and instances. */
bool import_object_begin(PbrtImport *im, const char *name, SourcePlace name_place);
bool import_object_end(PbrtImport *im);
bool import_object_instance(PbrtImport *im, const char *name, SourcePlace name_place);

/* Called at WorldBegin for what depends on several directives before it. */
bool import_settings_finish(PbrtImport *im);

#endif
