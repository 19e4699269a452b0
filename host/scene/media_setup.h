/* What is derived from a scene's media. */
#ifndef TWINLIGHT_SCENE_MEDIA_SETUP_H
#define TWINLIGHT_SCENE_MEDIA_SETUP_H

#include "geometry/box.h"
#include "scene/scene.h"

/* Features of media that some shape, light or the camera uses. */
ulong media_features(const Scene *scene);

/* Joins the boxes of the grids of such media to *world: media may be lit outside of all shapes. */
void media_box_join(const Scene *scene, Box *world);

/* Sets scene->medium_around, puts lights at infinity into that medium, and takes the light of the colour channels that
 * it attenuates, of which nothing arrives from infinity. Before lights are weighed. Fails when out of memory. */
bool media_lights_setup(Scene *scene, Error *error);

/* How far vertices in media may lie outside of the scene's geometry: 40 mean free paths, beyond which one path in 10^17
 * goes. 0 if no scattering medium can reach outside. */
float media_reach(const Scene *scene);

#endif
