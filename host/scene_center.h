/* Scenes far from the origin are moved there. */
#ifndef TWINLIGHT_SCENE_CENTER_H
#define TWINLIGHT_SCENE_CENTER_H

#include "box.h"
#include "scene.h"

/* Moves the world and the camera by whole floats when the world's box is small beside its distance from the origin, axis
 * by axis. Returns whether anything has moved. For scene_finish, before bounds and lights are derived. */
bool scene_center(Scene *scene, const Box *world);

#endif
