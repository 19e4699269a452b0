/* Tables of a scene's coats. */
#ifndef TWINLIGHT_SCENE_COATS_SETUP_H
#define TWINLIGHT_SCENE_COATS_SETUP_H

#include "scene/scene.h"

/* Builds the tables of rough coats and of all coats over conductors; materials with equal coats share one. Fails if
 * memory is short or there are too many different coats. */
bool coats_setup(Scene *scene, Error *error);

#endif
