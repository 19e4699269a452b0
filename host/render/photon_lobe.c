#include "render/photon_lobe.h"

#include "light/delta.h"
#include "light/infinite.h"
#include "path/caustic_rest.h"

#include <math.h>
#include <stdlib.h>

/* Steps between neighbouring subpaths: small beside the shapes that light passes, large beside rounding. Relative to
 * the reach of the light (reach_set), and in radians; at least so many times the spacing of floats as large as the
 * scene. */
#define POINT_STEP 3e-4
#define POINT_STEP_ULPS 32.0
#define DIRECTION_STEP 3e-4

/* A neighbour that begins beside the surface of a lamp begins this many steps farther along its ray, so that it is
 * outside unless the ray grazes the surface. */
#define STEPS_AHEAD 4.0f

/* What lights of no extent count as: a sphere, relative to the least reach of one, and a cone's sine. */
#define POINT_RADIUS 5e-4
#define DISTANT_SINE 1e-3f

/* Added to squared lengths where neighbours fall (almost) on one line, relative to them: near a focus a photon predicts
 * nothing but its own direction. */
#define FLAT_PART 1e-6

/* Bounds of the radius of light from infinity, in radians. */
#define FAR_RADIUS_MIN 1e-5
#define FAR_RADIUS_MAX 1.0

bool photon_light_is_far(const PhotonLights *lights, uint light)
{
    return light_kind(&lights->view.lights[light]) >= LIGHT_DISTANT;
}

/* Sums the areas of a shape's lights, then turns each light's into a radius. A sphere shows a quarter of its area, a
 * cylinder one part in pi. */
static bool radii_set(PhotonLights *lights, size_t shape_count, Error *error)
{
    const SceneView *view = &lights->view;
    double *areas = calloc(shape_count + 1, sizeof *areas);
    if (!areas)
        return error_memory(error, shape_count * sizeof *areas, "lights");
    for (uint i = 0; i < view->frame->scene.light_count; ++i)
        if (light_kind(&view->lights[i]) == LIGHT_AREA)
            areas[view->primitives[view->lights[i].primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK] +=
                (double)view->lights[i].area;
    for (uint i = 0; i < view->frame->scene.light_count; ++i) {
        if (light_kind(&view->lights[i]) != LIGHT_AREA)
            continue;
        uint word = view->primitives[view->lights[i].primitive].shape_and_kind;
        uint kind = word >> PRIMITIVE_KIND_SHIFT;
        double part = kind == PRIMITIVE_SPHERE ? 0.25 : kind == PRIMITIVE_CYLINDER ? 1.0 / M_PI : 1.0;
        lights->radius[i] = sqrt(part * areas[word & PRIMITIVE_SHAPE_MASK] / M_PI);
    }
    free(areas);
    return true;
}

static Vec3 light_place(const SceneView *view, const Light *light)
{
    if (light_kind(light) != LIGHT_AREA)
        return light_detail(view, light)->position;
    Box box = primitive_box(view, light->primitive);
    return box_center(&box);
}

/* Sets the steps, and the radius of point lights, by each light's reach: how far its subpaths go to the last specular
 * surface; from infinity, the extent of those. */
static void reach_set(PhotonLights *lights)
{
    const SceneView *view = &lights->view;
    const SceneParams *scene = &view->frame->scene;
    double world = (double)scene->world_radius, least = POINT_STEP_ULPS * (double)FLOAT_EPSILON * world,
           nearest = world;
    Vec3 center = smooth_boxes_center(&lights->aims);
    for (uint i = 0; i < scene->light_count; ++i) {
        const Light *light = &view->lights[i];
        double reach = smooth_boxes_radius(&lights->aims);
        if (!photon_light_is_far(lights, i))
            reach += (double)vec3_length(vec3_sub(light_place(view, light), center));
        reach = fmin(reach, world);
        lights->step[i] = fmax(POINT_STEP * reach, least);
        if (light_has_position(light_kind(light)))
            nearest = fmin(nearest, reach);
    }
    lights->params.point_radius = (float)(POINT_RADIUS * nearest);
}

bool photon_lights_init(PhotonLights *lights, const Scene *scene, Error *error)
{
    const BackendScene packed = scene_backend_view(scene);
    uint count = packed.frame->scene.light_count;
    *lights = (PhotonLights){.view = scene_view(packed.frame, packed.geometry, packed.tables, packed.texels),
                             .params.distant_sine = DISTANT_SINE,
                             .direction_step = DIRECTION_STEP};
    lights->radius = calloc(count + 1, sizeof *lights->radius);
    lights->step = calloc(count + 1, sizeof *lights->step);
    if (!lights->radius || !lights->step)
        return error_memory(error, count * (sizeof *lights->radius + sizeof *lights->step), "lights");
    if (!smooth_boxes_init(&lights->aims, scene, &lights->view, error))
        return false;
    reach_set(lights);
    return radii_set(lights, scene->shapes.count, error);
}

void photon_lights_destroy(PhotonLights *lights)
{
    free(lights->radius);
    free(lights->step);
    smooth_boxes_destroy(&lights->aims);
    *lights = (PhotonLights){0};
}

PhotonPath photon_neighbour(const PhotonLights *lights, const PhotonPath *path, uint k)
{
    PhotonPath neighbour = *path;
    Frame frame = frame_from_normal(path->first);
    Vec3 axis = k % 2u == 0u ? frame.t : frame.b;
    bool other_point = k >= 2u;
    if (other_point != photon_light_is_far(lights, path->light))
        neighbour.origin = vec3_mad(path->origin, (float)lights->step[path->light],
                                    other_point ? vec3_mad(axis, STEPS_AHEAD, path->first) : axis);
    else
        neighbour.first = vec3_normalize(vec3_mad(path->first, (float)lights->direction_step, axis));
    return neighbour;
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

static double far_radius(const PhotonLights *lights, uint light, Vec3 d)
{
    double pdf = (double)environment_pdf_w(&lights->view, light, vec3_negate(d));
    return fmin(fmax(sqrt(1.0 / (M_PI * fmax(pdf, 1e-30))), FAR_RADIUS_MIN), FAR_RADIUS_MAX);
}

static double light_radius(const PhotonLights *lights, const PhotonPath *path)
{
    const PhotonParams *params = &lights->params;
    uint kind = light_kind(&lights->view.lights[path->light]);
    if (kind == LIGHT_AREA)
        return lights->radius[path->light];
    if (kind == LIGHT_DISTANT)
        return (double)params->distant_sine;
    return light_has_position(kind) ? (double)params->point_radius : far_radius(lights, path->light, path->first);
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
                             .axes = {frame.t, frame.b},
                             .light_radius = light_radius(lights, path)};
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
    double step = far ? lights->direction_step : lights->step[path->light];
    bool finite = true;
    for (int i = 0; i < 4; ++i) {
        record->by_light[i] = (slopes[1][i] - across[i]) / step;
        finite = finite && isfinite(record->by_light[i]) && isfinite(record->by_place[i]);
    }
    return finite;
}

void photon_predict(const PhotonRecord *record, Vec3 p, const double light_moved[2], double slopes[2])
{
    Vec3 moved = frame_to_local(frame_from_normal(record->direction), vec3_sub(p, record->point));
    for (int row = 0; row < 2; ++row)
        slopes[row] = record->by_place[2 * row] * (double)moved.x + record->by_place[2 * row + 1] * (double)moved.y +
                      record->by_light[2 * row] * light_moved[0] + record->by_light[2 * row + 1] * light_moved[1];
}
