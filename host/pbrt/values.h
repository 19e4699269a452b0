/* Parameters that are colours, textures or materials, as needed by shapes, materials and lights. */
#ifndef TWINLIGHT_PBRT_VALUES_H
#define TWINLIGHT_PBRT_VALUES_H

#include "image/color.h"
#include "pbrt/context.h"

/* A colour ("rgb", "spectrum", "blackbody") as linear sRGB; `rgb` is unchanged if the parameter is absent. An
 * illuminant given as spectrum or blackbody has luminance 1, normalised as in pbrt. Returns whether the parameter is
 * present. */
bool value_color(PbrtImport *im, ParamList *list, const char *name, ColorRole role, float rgb[3]);

/* A colour or a spectrum texture; *out is unchanged if absent. Returns whether the parameter is present. */
bool value_color_param(PbrtImport *im, ParamList *list, const char *name, ColorRole role, ColorParam *out);

/* A float or a float texture, likewise. */
bool value_float_param(PbrtImport *im, ParamList *list, const char *name, FloatParam *out);

/* Parameters that no texture varies. */
static inline ColorParam value_color_constant(float value)
{
    return (ColorParam){.value = vec3_splat(value), .program = NONE};
}

static inline FloatParam value_float_constant(float value)
{
    return (FloatParam){.value = value, .program = NONE};
}

/* The texture named by a parameter of type texture, as an index into im->textures. NONE if the list has failed. */
uint value_texture_index(PbrtImport *im, ParamList *list, const Param *param, bool spectrum);

/* The mean of a float texture's program over the unit square of (u, v), which is in the plane z = 0; `unread` if only
 * the scene's needs are wanted, for which images are not read. */
float value_texture_mean(const PbrtImport *im, uint program, float unread);

/* An index of refraction: a float, or a spectrum, which is averaged over RGB. */
float value_eta(PbrtImport *im, ParamList *list, const char *name, float fallback);

/* Index of a texture program for a constant. NONE when out of memory. */
uint value_constant_program(PbrtImport *im, float value);

/* Index of an image file of the scene. `what` ("texture", "normal map") is for messages, which name the path. NONE if
 * only the scene's needs are wanted. */
bool value_image(PbrtImport *im, SourcePlace place, const char *path, const TextureImageOptions *options,
                 const char *what, uint *index);

/* The current material of a shape: an index or MATERIAL_INTERFACE. */
bool value_material(PbrtImport *im, uint *material);

/* Reads the material that `list` describes into the scene, at an index that it has. place: of `kind`. */
bool value_material_read(PbrtImport *im, ParamList *list, const char *kind, SourcePlace place, uint index);

/* Emission of the current area light; *present is false if there is none. */
bool value_area_emission(PbrtImport *im, AreaEmission *emission, bool *present);

/* The program of a named texture, added to the scene on first use. */
bool texture_program(PbrtImport *im, uint texture, uint *program);

#endif
