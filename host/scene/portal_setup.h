/* Tables of infinite lights with a portal (shared/light/portal.h): the light of the environment over the rectified
 * directions of the portal. */
#ifndef TWINLIGHT_SCENE_PORTAL_SETUP_H
#define TWINLIGHT_SCENE_PORTAL_SETUP_H

#include "scene/scene.h"

/* Most cells of a table per side. */
#define PORTAL_SIDE_MAX 2048u

/* Makes the portal of a rectangle given by its corners in order, in world space, as pbrt orients it: light comes from
 * the side to which (corner 3 - corner 0) x (corner 1 - corner 0) points. Fails if they are not a rectangle. */
bool portal_make(const double corners[4][3], Portal *portal, Error *error);

/* Corner 0 ... 3. */
Vec3 portal_corner(const Portal *portal, int index);

/* Sets the tables of scene->lights[light], a LIGHT_PORTAL: its portal's sums, and the distribution of light subpaths.
 * *flux: luminance of the light that passes the portal. Fails if the environment is not finite. */
bool portal_setup(Scene *scene, uint light, double *flux, Error *error);

#endif
