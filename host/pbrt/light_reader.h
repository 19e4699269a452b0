/* What the readers of lights share. */
#ifndef TWINLIGHT_PBRT_LIGHT_READER_H
#define TWINLIGHT_PBRT_LIGHT_READER_H

#include "base/matrix.h"
#include "pbrt/context.h"
#include "pbrt/params.h"

/* A light while it is read. */
typedef struct LightReader {
    PbrtImport *im;
    ParamList *list;
    Matrix ctm, inverse; /* the current transform */
    LightData light;
} LightReader;

/* "scale"; an error if it is negative. */
float light_scale_read(ParamList *list);

/* rgb x scale; an error if it overflows a float. */
Vec3 light_emission_make(ParamList *list, const float rgb[3], double scale);

/* Sets the light's position to the point `from` of the current space. */
void light_position_set(LightReader *r, const float from[3]);

/* Lights with images (light_images.c). */
void goniometric_read(LightReader *r);
void projection_read(LightReader *r);
void infinite_read(LightReader *r);

#endif
