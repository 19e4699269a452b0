/* What a scene needs of the kernels: the features of its materials, geometry, lights and camera. See scene.h for
 * scene_material_is_rough and its like. */
#ifndef TWINLIGHT_SCENE_FEATURES_H
#define TWINLIGHT_SCENE_FEATURES_H

#include "scene/scene.h"

/* The alpha that the kernels use for a constant roughness. */
float material_alpha(const Material *m, const FloatParam *roughness);

/* Whether the surface itself is rough or, of a coated one, the coat. */
bool interface_is_rough(const Material *m);

/* FEATURE_* bits of all that is in the scene, without those that light_setup adds. */
ulong scene_features(const Scene *scene);

#endif
