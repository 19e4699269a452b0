/* Scenes far from the origin are moved there: by the importer, which reads them a second time and takes the offset off
 * before it rounds to floats, or, where that is not to be had, as floats. */
#ifndef TWINLIGHT_SCENE_CENTER_H
#define TWINLIGHT_SCENE_CENTER_H

#include "geometry/box.h"
#include "scene/scene.h"

/* What to take off the coordinates of a world that is small beside its distance from the origin, axis by axis; else
 * 0. */
Vec3 scene_center_offset(const Box *world);

/* The same camera where the world has been moved by -offset. */
void camera_move(CameraSettings *camera, Vec3 offset);

/* Moves the world and the camera by whole floats when the world's box is small beside its distance from the origin,
 * axis by axis. Returns whether anything has moved. For scene_finish, before bounds and lights are derived. */
bool scene_center(Scene *scene, const Box *world);

#endif
