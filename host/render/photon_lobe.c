#include "render/photon_lobe.h"

#include "path/caustic_rest.h"

#include <math.h>

/* A neighbour that begins beside the surface of a lamp begins this many steps farther along its ray, so that it is
 * outside unless the ray grazes the surface. */
#define STEPS_AHEAD 4.0f

/* How many radii of the sphere of specular surfaces neighbours at infinity begin before its middle. */
#define FAR_START 2.0

/* Added to squared lengths where neighbours fall (almost) on one line, relative to them: near a focus a photon predicts
 * nothing but its own direction. */
#define FLAT_PART 1e-6

float photon_path_along(const PhotonLights *lights, const PhotonPath *path)
{
    return vec3_dot(vec3_sub(lights->center, path->origin), path->first);
}

/* A place of a path's first ray among the specular surfaces: closest to their middle, or beyond it if they surround the
 * light. */
static Vec3 path_place(const PhotonLights *lights, const PhotonPath *path)
{
    float along = photon_path_along(lights, path);
    return vec3_mad(path->origin, float_max(along, (float)lights->radius), path->first);
}

/* From infinity. The neighbour begins just outside the sphere of specular surfaces, since nothing stands in between:
 * from where its path begins, outside the world, another direction would miss small surfaces. */
static PhotonPath far_neighbour(const PhotonLights *lights, const PhotonPath *path, bool other_point, Vec3 axis)
{
    PhotonPath neighbour = *path;
    Vec3 place = path_place(lights, path);
    if (other_point)
        neighbour.first = vec3_normalize(vec3_mad(path->first, (float)lights->light_step[path->light], axis));
    else
        place = vec3_mad(place, (float)lights->place_step[path->light], axis);
    neighbour.origin = vec3_mad(place, (float)(-FAR_START * lights->radius), neighbour.first);
    return neighbour;
}

/* From a lamp. */
static PhotonPath near_neighbour(const PhotonLights *lights, const PhotonPath *path, bool other_point, Vec3 axis)
{
    PhotonPath neighbour = *path;
    Vec3 place = path_place(lights, path);
    if (other_point)
        neighbour.origin =
            vec3_mad(path->origin, (float)lights->light_step[path->light], vec3_mad(axis, STEPS_AHEAD, path->first));
    else
        place = vec3_mad(place, (float)lights->place_step[path->light], axis);
    neighbour.first = vec3_normalize(vec3_sub(place, neighbour.origin));
    return neighbour;
}

PhotonPath photon_neighbour(const PhotonLights *lights, const PhotonPath *path, uint k)
{
    Frame frame = frame_from_normal(path->first);
    Vec3 axis = k % 2u == 0u ? frame.t : frame.b;
    return (photon_light_is_far(lights, path->light) ? far_neighbour : near_neighbour)(lights, path, k >= 2u, axis);
}

bool photon_slopes(Vec3 direction, Vec3 w, double slopes[2])
{
    Vec3 local = frame_to_local(frame_from_normal(direction), w);
    slopes[0] = (double)local.x / (double)local.z;
    slopes[1] = (double)local.y / (double)local.z;
    return local.z > 0.0f;
}

/* Where a neighbour's last ray crosses the plane through the photon across its direction. */
static bool place_across(Vec3 point, Vec3 direction, const PhotonPath *neighbour, double place[2])
{
    Frame frame = frame_from_normal(direction);
    Vec3 moved = frame_to_local(frame, vec3_sub(neighbour->point, point)), ray = frame_to_local(frame, neighbour->last);
    double along = -(double)moved.z / (double)ray.z;
    place[0] = (double)moved.x + along * (double)ray.x;
    place[1] = (double)moved.y + along * (double)ray.y;
    return ray.z != 0.0f;
}

/* out = a b, 2 x 2 row by row. */
static void multiply(const double a[4], const double b[4], double out[4])
{
    const double product[4] = {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
                               a[2] * b[1] + a[3] * b[3]};
    for (int i = 0; i < 4; ++i)
        out[i] = product[i];
}

/* out = slopes places^-1, or, near a place where neighbours fall together, what is closest to it without large
 * derivatives: slopes places^T (places places^T + FLAT_PART |places|^2)^-1. */
static bool divide(const double slopes[4], const double places[4], double out[4])
{
    const double transposed[4] = {places[0], places[2], places[1], places[3]};
    double square[4], product[4];
    multiply(places, transposed, square);
    double flat = FLAT_PART * (square[0] + square[3]);
    square[0] += flat;
    square[3] += flat;
    double determinant = square[0] * square[3] - square[1] * square[2];
    const double inverse[4] = {square[3] / determinant, -square[1] / determinant, -square[2] / determinant,
                               square[0] / determinant};
    multiply(slopes, transposed, product);
    multiply(product, inverse, out);
    return determinant > 0.0;
}

/* Turns the derivatives into those in the frame of another direction, which is close to the first one: to first order,
 * slopes and displacements turn as vectors across the direction do. */
static void record_turn(PhotonRecord *record, Vec3 direction)
{
    const Frame from = frame_from_normal(record->direction), to = frame_from_normal(direction);
    const double turn[4] = {(double)vec3_dot(from.t, to.t), (double)vec3_dot(from.t, to.b),
                            (double)vec3_dot(from.b, to.t), (double)vec3_dot(from.b, to.b)},
                 back[4] = {turn[0], turn[2], turn[1], turn[3]};
    multiply(record->by_place, turn, record->by_place);
    multiply(back, record->by_place, record->by_place);
    multiply(back, record->by_light, record->by_light);
    record->direction = direction;
}

/* Makes the photon one of the middle of its light, so that the lobes of photons around a place lie upon each other and
 * need be no wider than the light. */
static void record_center(PhotonRecord *record, const LightLook *look)
{
    double slopes[2];
    Vec3 moved = vec3_sub(look->center, record->light_point);
    const double light_moved[2] = {(double)vec3_dot(moved, record->axes[0]), (double)vec3_dot(moved, record->axes[1])};
    photon_predict(record, record->point, light_moved, slopes);
    const Vec3 framed = vec3((float)slopes[0], (float)slopes[1], 1.0f);
    record_turn(record, vec3_normalize(frame_to_world(frame_from_normal(record->direction), framed)));
    record->light_point = look->center;
    for (int i = 0; i < 3; ++i)
        record->extent[i] = look->covariance[i];
}

bool photon_differences(const PhotonLights *lights, const PhotonPath *path,
                        const PhotonPath neighbours[PHOTON_NEIGHBOURS], PhotonRecord *record)
{
    bool far = photon_light_is_far(lights, path->light);
    Frame frame = frame_from_normal(path->first);
    double places[2][4], slopes[2][4], across[4];
    *record = (PhotonRecord){.number = path->number,
                             .light = caustic_light(&lights->view, path->light),
                             .vertices = path->vertices,
                             .lobes = path->lobes,
                             .point = path->point,
                             .direction = vec3_normalize(vec3_negate(path->last)),
                             .light_point = far ? path->first : path->origin,
                             .axes = {frame.t, frame.b}};
    for (uint k = 0; k < PHOTON_NEIGHBOURS; ++k) {
        double place[2], slope[2];
        if (!place_across(record->point, record->direction, &neighbours[k], place) ||
            !photon_slopes(record->direction, vec3_negate(neighbours[k].last), slope))
            return false;
        for (uint row = 0; row < 2; ++row) {
            places[k / 2][2 * row + k % 2] = place[row];
            slopes[k / 2][2 * row + k % 2] = slope[row];
        }
    }
    if (!divide(slopes[0], places[0], record->by_place))
        return false;
    /* Neighbours through other points of the light have arrived at other places. */
    multiply(record->by_place, places[1], across);
    double step = lights->light_step[path->light];
    bool finite = true;
    for (int i = 0; i < 4; ++i) {
        record->by_light[i] = (slopes[1][i] - across[i]) / step;
        finite = finite && isfinite(record->by_light[i]) && isfinite(record->by_place[i]);
    }
    if (!finite)
        return false;
    const LightLook look = photon_light_look(lights, path->light, record->light_point, record->axes);
    record_center(record, &look);
    return true;
}

void photon_predict(const PhotonRecord *record, Vec3 p, const double light_moved[2], double slopes[2])
{
    Vec3 moved = frame_to_local(frame_from_normal(record->direction), vec3_sub(p, record->point));
    for (int row = 0; row < 2; ++row)
        slopes[row] = record->by_place[2 * row] * (double)moved.x + record->by_place[2 * row + 1] * (double)moved.y +
                      record->by_light[2 * row] * light_moved[0] + record->by_light[2 * row + 1] * light_moved[1];
}
