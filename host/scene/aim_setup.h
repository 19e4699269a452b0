/* Chooses the aims of light subpaths (shared/light/aim.h). */
#ifndef TWINLIGHT_SCENE_AIM_SETUP_H
#define TWINLIGHT_SCENE_AIM_SETUP_H

#include "layout/scene_view.h"
#include "scene/scene.h"

/* Largest number of aims: every density of a light's rays is a sum over all. */
#define AIMS_MAX 16

/* Sets scene->aims, and aim_count; none without smooth specular surfaces. view: of the arrays before they are
 * packed. */
bool aim_setup(Scene *scene, const SceneView *view, Error *error);

#endif
