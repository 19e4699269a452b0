/* Parameters that are colours, textures or materials: what shapes, materials and lights ask for. */
#ifndef TWINLIGHT_PBRT_VALUES_H
#define TWINLIGHT_PBRT_VALUES_H

#include "image/color.h"
#include "pbrt/context.h"

/* A colour ("rgb", "spectrum", "blackbody") as linear sRGB. rgb keeps its values when the parameter is absent. An
 * illuminant given as spectrum or blackbody has luminance 1, as pbrt normalises it. Returns whether it is present. */
bool value_color(PbrtImport *im, ParamList *list, const char *name, ColorRole role, float rgb[3]);

/* A colour or a spectrum texture. Absent: *out keeps its value. Returns whether it is present. */
bool value_color_param(PbrtImport *im, ParamList *list, const char *name, ColorRole role, ColorParam *out);

/* A float or a float texture, likewise. */
bool value_float_param(PbrtImport *im, ParamList *list, const char *name, FloatParam *out);

/* The texture that a parameter of type texture names, an index into im->textures. NONE when the list has failed. */
uint value_texture_index(PbrtImport *im, ParamList *list, const Param *param, bool spectrum);

/* An index of refraction: a float, or a spectrum, of which the mean over RGB is taken. */
float value_eta(PbrtImport *im, ParamList *list, const char *name, float fallback);

/* The program of a constant. NONE when memory is out. */
uint value_constant_program(PbrtImport *im, float value);

/* The index of an image file of the scene; `what` ("texture", "normal map") for the message, which says the path. */
bool value_image(PbrtImport *im, SourcePlace place, const char *path, const TextureImageOptions *options,
                 const char *what, uint *index);

/* The material in force for a shape: an index or MATERIAL_INTERFACE. */
bool value_material(PbrtImport *im, uint *material);

/* Emission of the area light in force; *present false when there is none. */
bool value_area_emission(PbrtImport *im, AreaEmission *emission, bool *present);

/* The programs of named textures, built by import_texture. */
bool texture_program(PbrtImport *im, uint texture, uint *program);

#endif
