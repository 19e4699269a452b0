/* Builds the tree by which a light is chosen for a point (shared/light/light_tree.h). */
#ifndef TWINLIGHT_SCENE_LIGHT_TREE_H
#define TWINLIGHT_SCENE_LIGHT_TREE_H

#include "scene/scene.h"

/* Sets scene->light_nodes, Light.leaf, and FEATURE_LIGHT_TREE if it can tell lights that have power apart. powers: of
 * every light, as light_bounds takes them. To be called before the scene is packed. */
bool light_tree_build(Scene *scene, const double *powers, Error *error);

#endif
