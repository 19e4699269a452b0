/* How light subpaths are divided among lights at infinity, and between these and others. */
#ifndef TWINLIGHT_SCENE_FAR_LIGHTS_H
#define TWINLIGHT_SCENE_FAR_LIGHTS_H

#include "scene/scene.h"

/* In both functions powers[light] is the luminance of the flux that it sends into the scene. */

/* Divides the power of all lights at infinity (light_is_far) among them anew: FAR_BY_POWER of it by power, and the rest
 * by power over the root of the solid angle from which most of a light comes, in solid_angles. Their sum stays, and so
 * do the powers of other lights.
 *
 * Of a light with irradiance E from a solid angle W, directions that camera subpaths draw by a BSDF leave a variance in
 * proportion to E^2 / W. If n light subpaths leave 1 / n of it, the sum over lights is least for n in proportion to E /
 * sqrt(W) (Neyman 1934). So most light subpaths are the sun's even beside a sky that sends more light into the scene:
 * that of the sky is found without them. docs/CAUSTICS.md */
void far_lights_divide(const Scene *scene, double *powers, const double *solid_angles);

/* Scales the powers of lights at infinity, which grow with the square of the scene's radius, so that together they have
 * no more than all others, if there are others. Most of what they send into a wide scene arrives where no lamp does,
 * and of its lamps' light hardly any sample would be left. */
void far_lights_bound(const Scene *scene, double *powers);

#endif
