/* Parameters that are colours, textures or materials: what shapes, materials and lights ask for. */
#ifndef TWINLIGHT_PBRT_VALUES_H
#define TWINLIGHT_PBRT_VALUES_H

#include "pbrt_context.h"

/* What a colour stands for decides how a spectrum becomes RGB and which values are errors. */
enum { COLOR_ALBEDO, COLOR_UNBOUNDED, COLOR_ILLUMINANT };

/* A colour ("rgb", "spectrum", "blackbody") as linear sRGB. rgb keeps its values when the parameter is absent. An
 * illuminant given as spectrum or blackbody has luminance 1, as pbrt normalises it. Returns whether it is present. */
bool value_color(PbrtImport *im, ParamList *list, const char *name, int role, float rgb[3]);

/* A colour or a spectrum texture. Absent: *out keeps its value. Returns whether it is present. */
bool value_color_param(PbrtImport *im, ParamList *list, const char *name, int role, ColorParam *out);

/* A float or a float texture, likewise. */
bool value_float_param(PbrtImport *im, ParamList *list, const char *name, FloatParam *out);

/* The program of a float texture parameter, NONE when absent. */
uint value_texture_program(PbrtImport *im, ParamList *list, const char *name);

/* An index of refraction: a float, or a spectrum, of which the mean over RGB is taken. */
float value_eta(PbrtImport *im, ParamList *list, const char *name, float fallback);

/* The program of a constant. NONE when memory is out. */
uint value_constant_program(PbrtImport *im, float value);

/* An image of the scene; `purpose` for messages. `encoding` NULL: by the file's type. Fails with the path. */
bool value_image(PbrtImport *im, ParamList *list, const char *name, const char *path, const char *encoding, uint wrap,
                 uint filter, uint *index);

/* The material in force for a shape: an index or MATERIAL_INTERFACE. */
bool value_material(PbrtImport *im, uint *material);

/* Emission of the area light in force; *present false when there is none. */
bool value_area_emission(PbrtImport *im, AreaEmission *emission, bool *present);

/* The programs of named textures, built by import_texture. */
bool texture_program(PbrtImport *im, uint texture, uint *program);

#endif
