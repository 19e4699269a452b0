/* The directives of pbrt-v4's format. */
#ifndef TWINLIGHT_PBRT_DIRECTIVES_H
#define TWINLIGHT_PBRT_DIRECTIVES_H

#include "pbrt/context.h"

/* Reads directives to the end of the scene. */
bool directives_read(PbrtImport *im);

#endif
