/* What a photon predicts: the differentials of light subpaths through specular surfaces, by finite differences between
 * neighbouring subpaths. (Igehy, "Tracing ray differentials", 1999, has them analytically.) */
#ifndef TWINLIGHT_RENDER_PHOTON_LOBE_H
#define TWINLIGHT_RENDER_PHOTON_LOBE_H

#include "render/photon_lights.h"
#include "render/photon_pass.h"

/* A photon with its derivatives. Slopes are those of directions in frame_from_normal(direction) (path/photon.h). */
typedef struct PhotonRecord {
    uint number; /* of its subpath */
    uint light; /* PHOTON_LIGHT */
    uint vertices, lobes; /* PhotonPath */
    Vec3 point, direction; /* where it has arrived, and from where */
    double by_place[4]; /* slopes per unit of displacement across the direction, 2 x 2 row by row */
    double by_light[4]; /* slopes per unit of displacement of the light's point along `axes` */
    Vec3 light_point; /* or, for a light at infinity, the direction in which it travels */
    Vec3 axes[2];
    double extent[3]; /* covariance of the light's points along `axes`: xx, xy, yy */
    double spread[3]; /* of the slopes: lower triangular; set by photon_grid_make */
} PhotonRecord;

typedef struct PhotonRecords {
    PhotonRecord *records;
    uint count;
    int threads; /* that compare them; at least this one */
} PhotonRecords;

/* How far along a subpath's first ray the place is that is closest to the middle of the specular surfaces. */
float photon_path_along(const PhotonLights *lights, const PhotonPath *path);

/* Neighbours of a subpath: two through the same point of the light (or, at infinity, in the same direction), and two
 * through other points (in other directions). */
#define PHOTON_NEIGHBOURS 4u
PhotonPath photon_neighbour(const PhotonLights *lights, const PhotonPath *path, uint k);

/* Fills *record from a subpath and its neighbours, which have all arrived; false if there are no derivatives. */
bool photon_differences(const PhotonLights *lights, const PhotonPath *path,
                        const PhotonPath neighbours[PHOTON_NEIGHBOURS], PhotonRecord *record);

/* Slopes of the direction w in the frame of a photon's direction; false if w points away from it. */
bool photon_slopes(Vec3 direction, Vec3 w, double slopes[2]);

/* The slopes that a photon predicts for the place p and a displacement of its light's point along its axes. */
void photon_predict(const PhotonRecord *record, Vec3 p, const double light_moved[2], double slopes[2]);

#endif
