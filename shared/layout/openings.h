/* Openings: rectangles through which most of the light from infinity comes that reaches what the camera sees, such as
 * the windows of a room. Found before a rendering (host/render/openings.h); light/opening.h uses them. */
#ifndef TWINLIGHT_LAYOUT_OPENINGS_H
#define TWINLIGHT_LAYOUT_OPENINGS_H

#include "math/vec.h"

#define OPENINGS_MAX 8u

/* Lights that can have openings. */
#define OPENING_LIGHTS_MAX 4u

/* A rectangle perpendicular to an axis of OpeningParams.frame. */
typedef struct Opening {
    uint light; /* whose subpaths it is for */
    uint axis; /* 0, 1, 2; the rectangle's u axis is the next in cyclic order, its v axis the one after */
    float at; /* coordinate along that axis */
    float u_low, v_low, u_high, v_high;
    float side; /* the light comes from where the coordinate along that axis is larger: 1, smaller: -1, or both: 0 */
    float share; /* part of the light's subpaths that start through it, of those that no aim takes */
} Opening;

typedef struct OpeningParams {
    uint count; /* 0: there are none */
    Frame frame; /* whose axes t, b and n are 0, 1 and 2 */
    Opening each[OPENINGS_MAX];
    /* Light subpaths of these lights, which may have no opening, are divided among them anew. */
    uint light_count;
    uint lights[OPENING_LIGHTS_MAX];
    float light_shares[OPENING_LIGHTS_MAX]; /* adding up to 1 */
    float light_pdfs[OPENING_LIGHTS_MAX]; /* probability with which a light subpath starts from each */
} OpeningParams;

#endif
