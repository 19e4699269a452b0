/* The lights of a scene, as photons need them: how large they are, and where their middle is. */
#ifndef TWINLIGHT_RENDER_PHOTON_LIGHTS_H
#define TWINLIGHT_RENDER_PHOTON_LIGHTS_H

#include "layout/scene_view.h"
#include "scene/scene.h"
#include "scene/smooth_boxes.h"

/* The points of the lamps of a shape. */
typedef struct LampExtent {
    double radius; /* of a disc that shows as much of them as they show on average */
    bool compact; /* they fill the ellipse of their covariance */
    Vec3 center;
    double covariance[6]; /* xx, xy, xz, yy, yz, zz, of the points that are seen from one side */
} LampExtent;

/* A bright spot in an image light, such as the sun. */
typedef struct LightSpot {
    uint light;
    Vec3 direction; /* in which light travels from its middle, unit */
    double variance; /* of its directions along any axis, radians^2 */
} LightSpot;

#define LIGHT_SPOTS 8u

/* The lights, and the specular surfaces that they light. */
typedef struct PhotonLights {
    SceneView view;
    SmoothBoxes aims;
    Vec3 center; /* of a sphere around them */
    double radius;
    PhotonParams params; /* the radii of lights of no extent */
    LampExtent *lamps; /* one per shape */
    LightSpot spots[LIGHT_SPOTS];
    uint spot_count;
    /* Between neighbouring subpaths, one per light: places where they meet the specular surfaces, and points of the
     * light or, from infinity, directions. */
    double *place_step, *light_step;
} PhotonLights;

/* Call photon_lights_destroy even on failure. */
bool photon_lights_init(PhotonLights *lights, const Scene *scene, Error *error);
void photon_lights_destroy(PhotonLights *lights);

/* At infinity: light arrives in directions that do not change with the place. */
bool photon_light_is_far(const PhotonLights *lights, uint light);

/* How a light looks along a ray: its middle, or the ray's own point if that is not known, and the covariance of its
 * points across the ray along two axes: xx, xy, yy. Points of a light at infinity are directions in which light
 * travels. */
typedef struct LightLook {
    Vec3 center;
    double covariance[3];
} LightLook;

/* own: the point of the light that the ray comes from; at infinity, the ray's direction. axes: unit, across it. */
LightLook photon_light_look(const PhotonLights *lights, uint light, Vec3 own, const Vec3 axes[2]);

#endif
