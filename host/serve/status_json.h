/* What the page asks for every moment: /TOKEN/status.json. */
#ifndef TWINLIGHT_SERVE_STATUS_JSON_H
#define TWINLIGHT_SERVE_STATUS_JSON_H

#include "serve/error_curve.h"
#include "serve/snapshot.h"

#include <stdio.h>

/* The layer that is the difference of the halves. */
#define LAYER_DIFFERENCE "difference"

/* Constant facts of a rendering; borrowed. */
typedef struct RenderFacts {
    const char *image, *scene, *integrator; /* file names; the integrator's name */
} RenderFacts;

/* The caller holds the snapshot's lock. */
void status_json_write(FILE *stream, const Snapshot *snapshot, const RenderFacts *facts, const ErrorCurve *curve);

#endif
