/* Warnings about a scene before it is rendered. */
#ifndef TWINLIGHT_SCENE_WARNINGS_H
#define TWINLIGHT_SCENE_WARNINGS_H

#include "scene/scene.h"

/* Logs a note if a finished scene has lights without extent together with smooth glass or mirrors, and the rendering
 * has no photons: light from such a light that passes one and is seen through another is found by nothing else
 * (path/caustic.h). The same, photons or not, of area lights of alpha 0, and of scattering in media between the two.
 * Warns if a few primitives make the scene so large that rendering is slower and light from infinity is sampled poorly
 * (backend/ray_reach.h). */
void scene_advise(const Scene *scene, bool photons);

#endif
