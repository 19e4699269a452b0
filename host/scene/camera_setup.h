/* Converts a camera as given in the scene file to the one used by the kernels. */
#ifndef TWINLIGHT_SCENE_CAMERA_SETUP_H
#define TWINLIGHT_SCENE_CAMERA_SETUP_H

#include "scene/scene.h"

/* Fills `out` for a film of width x height pixels, following pbrt-v4: the field of view spans the film's shorter side,
 * the screen window is [-a, a] x [-1, 1] for a frame aspect a >= 1 and [-1, 1] x [-1/a, 1/a] below, and an explicit
 * screen window replaces it. Fails for an invalid size, angle, aspect, window, lens or transform. */
bool camera_setup(const CameraSettings *settings, int width, int height, Camera *out, Error *error);

/* Matrices from the world of the scene file, in which the scene's origin is at `origin`, to camera space and to the
 * image: x and y from (0, 0) in its upper left corner to (1, 1), after division by w; zero for spherical cameras, which
 * no matrix describes. Row-major, for column vectors. `camera` must come from the same settings. */
void camera_matrices(const CameraSettings *settings, const Camera *camera, Vec3 origin, float world_to_camera[16],
                     float world_to_ndc[16]);

#endif
