/* Sets up the selection of lights and the sampling of environments. */
#ifndef TWINLIGHT_SCENE_LIGHT_SETUP_H
#define TWINLIGHT_SCENE_LIGHT_SETUP_H

#include "scene/scene.h"

/* Sets select_pdf of every light in proportion to its power (luminance; pbrt-v4's estimates), except for infinite and
 * distant lights: several of them divide what they have together by their solid angles, too, and it is no more than
 * that of all others, if there are others (scene/far_lights.h). Builds scene->light_alias, infinite_lights and the
 * distributions of environment images. Lights without power get select_pdf 0 and a warning. Needs
 * frame.scene.world_radius, the radius of the bounding sphere. Fails if no light has power, or if a light's power is
 * not finite. */
bool light_setup(Scene *scene, Error *error);

/* Effective solid angle of a spot light: its flux over its intensity on the axis. */
double light_spot_solid_angle(double cos_total, double cos_falloff);

#endif
