/* The directives of the pbrt-v4 format. */
#ifndef TWINLIGHT_PBRT_DIRECTIVES_H
#define TWINLIGHT_PBRT_DIRECTIVES_H

#include "pbrt/context.h"

/* Reads directives to the end of the scene. False if reading ended early. */
bool directives_read(PbrtImport *im);

#endif
