/* How lights are chosen and environments sampled. */
#ifndef TWINLIGHT_SCENE_LIGHT_SETUP_H
#define TWINLIGHT_SCENE_LIGHT_SETUP_H

#include "scene/scene.h"

/* Sets select_pdf of every light in proportion to its power (luminance; pbrt-v4's estimates), and builds
 * scene->light_alias, infinite_lights and the distributions of infinite images. A light without power gets
 * select_pdf 0 and a warning. Needs frame.world_radius, the radius of the scene's bounding sphere. Fails when no
 * light has power, and on a light that is not finite. */
bool light_setup(Scene *scene, Error *error);

/* The solid angle that, filled with a spot light's intensity on its axis, holds all that the light sends out. */
double light_spot_solid_angle(double cos_total, double cos_falloff);

#endif
