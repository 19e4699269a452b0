/* Chooses the light guides of chains (shared/light/light_guide.h). */
#ifndef TWINLIGHT_SCENE_LIGHT_GUIDE_SETUP_H
#define TWINLIGHT_SCENE_LIGHT_GUIDE_SETUP_H

#include "scene/scene.h"

/* Sets the light guides of scene->guide: the shapes and environment images that emit most light. Called by scene_finish
 * after light_setup and before the arrays are packed. */
void light_guide_setup(Scene *scene);

#endif
