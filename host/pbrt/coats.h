/* The medium inside the coats of coateddiffuse and coatedconductor. */
#ifndef TWINLIGHT_PBRT_COATS_H
#define TWINLIGHT_PBRT_COATS_H

#include "pbrt/context.h"

typedef struct CoatMedium {
    float thickness;
    float g;
    Vec3 albedo; /* 0: it only absorbs */
    SourcePlace place; /* of the albedo */
} CoatMedium;

/* Reads thickness, albedo, g and the parameters of pbrt's random walk. A texture as thickness counts as its mean, with
 * a warning. scatters: whether an albedo is supported. On errors the list has failed. */
void coat_medium_read(PbrtImport *im, ParamList *list, bool scatters, CoatMedium *medium);

/* Replaces a coat over a conductor by a mix if its medium scatters, with a warning (scene/coat_medium.h). `coat` is
 * complete but for its thickness, which this sets. On errors the list has failed. */
void coat_medium_apply(PbrtImport *im, ParamList *list, const CoatMedium *medium, Material *coat);

#endif
