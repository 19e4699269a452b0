/* The aims of chains (shared/light/aim.h). */
#ifndef TWINLIGHT_SCENE_AIM_SETUP_H
#define TWINLIGHT_SCENE_AIM_SETUP_H

#include "scene/scene.h"

/* Sets the aims of scene->frame: the shapes and images of the environment that send most light. For scene_finish, once
 * light_setup is done and before the arrays are packed. */
void aim_setup(Scene *scene);

#endif
