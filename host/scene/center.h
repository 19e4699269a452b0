/* Moves scenes that are far from the origin to the origin: either the importer reads them a second time and subtracts
 * the offset before rounding to floats, or the floats themselves are moved. */
#ifndef TWINLIGHT_SCENE_CENTER_H
#define TWINLIGHT_SCENE_CENTER_H

#include "geometry/box.h"
#include "scene/scene.h"

/* Offset to subtract from the coordinates of a world that is small compared to its distance from the origin, per axis;
 * else 0. */
Vec3 scene_center_offset(const Box *world);

/* Adapts the camera to a world moved by -offset. */
void camera_move(CameraSettings *camera, Vec3 offset);

/* Moves world and camera, axis by axis, if the box of the world is small compared to its distance from the origin.
 * Returns whether anything moved. Called by scene_finish before bounds and lights are derived. */
bool scene_center(Scene *scene, const Box *world);

#endif
