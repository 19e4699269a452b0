/* From a camera as the scene file gives it to the one that the kernels use. */
#ifndef TWINLIGHT_CAMERA_SETUP_H
#define TWINLIGHT_CAMERA_SETUP_H

#include "scene.h"

/* Fills `out` for a film of width x height pixels, by pbrt-v4's rules: the field of view spans the film's shorter
 * side, the screen window is [-a, a] x [-1, 1] for a frame aspect a >= 1 and [-1, 1] x [-1/a, 1/a] below, and an
 * explicit screen window replaces it. Fails on a size, angle, aspect, window, lens or transform that shows nothing. */
bool camera_setup(const CameraSettings *settings, int width, int height, Camera *out, Error *error);

#endif
