/* How lights are chosen and environments sampled. */
#ifndef TWINLIGHT_LIGHT_SETUP_H
#define TWINLIGHT_LIGHT_SETUP_H

#include "scene.h"

/* Sets select_pdf of every light in proportion to its power (luminance; pbrt-v4's estimates), and builds
 * scene->light_alias, infinite_lights and the distributions of infinite images. A light without power gets
 * select_pdf 0 and a warning. Needs frame.world_radius, the radius of the scene's bounding sphere. Fails when no
 * light has power, and on a light that is not finite. */
bool light_setup(Scene *scene, Error *error);

#endif
