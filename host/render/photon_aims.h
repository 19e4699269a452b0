/* The smooth specular surfaces of a scene, as aims of light subpaths: of a light in a wide world, hardly any that is drawn
 * from it meets one. */
#ifndef TWINLIGHT_RENDER_PHOTON_AIMS_H
#define TWINLIGHT_RENDER_PHOTON_AIMS_H

#include "geometry/box.h"
#include "scene/scene.h"

typedef struct PhotonAims {
    Box *boxes; /* of primitives, in world space */
    double *sums; /* of the surfaces of boxes up to each */
    size_t count; /* 0: the scene has none */
    Box all; /* around them */
} PhotonAims;

/* Call photon_aims_destroy even on failure. */
bool photon_aims_init(PhotonAims *aims, const Scene *scene, const SceneView *view, Error *error);
void photon_aims_destroy(PhotonAims *aims);

/* A point in one of the boxes, of which there must be one. u: uniform in [0, 1). */
Vec3 photon_aims_point(const PhotonAims *aims, const double u[4]);

/* Center of all boxes, and half their diagonal. */
Vec3 photon_aims_center(const PhotonAims *aims);
double photon_aims_radius(const PhotonAims *aims);

#endif
