/* The material of hair. */
#ifndef TWINLIGHT_PBRT_HAIR_H
#define TWINLIGHT_PBRT_HAIR_H

#include "pbrt/context.h"

/* Reads its colour (of sigma_a, reflectance and the pigments, the first that is given), beta_m, beta_n, alpha and eta
 * into m. On errors the list has failed. */
void hair_material_read(PbrtImport *im, ParamList *list, Material *m);

#endif
