#include "render/photon_lights.h"

#include "light/area.h"
#include "light/delta.h"
#include "light/infinite.h"

#include <math.h>
#include <stdlib.h>

/* Steps between neighbouring subpaths: small beside the shapes that light passes, large beside rounding. Relative to
 * the reach of the light (reach_set), and in radians; at least so many times the spacing of floats as large as the
 * scene. */
#define POINT_STEP 3e-4
#define POINT_STEP_ULPS 32.0
#define DIRECTION_STEP 3e-4

/* What lights of no extent count as: a sphere, relative to the least reach of one, and a cone's sine. */
#define POINT_RADIUS 5e-4
#define DISTANT_SINE 1e-3f

/* Points of a lamp along each side of the square that they are drawn from, unless a scene has more than LAMPS_MANY. */
#define LAMP_POINTS 4u
#define LAMPS_MANY 65536u

/* Least part of the ellipse of the same covariance that a compact light fills: a triangle .83, a rectangle .95, a ring
 * half as wide inside .6. */
#define COMPACT_FILL 0.7

/* Least variance of a flat shape across its plane, relative to those along it. */
#define FLAT_VARIANCE 1e-3

/* Bounds of the radius of light from infinity, in radians. */
#define FAR_RADIUS_MIN 1e-5
#define FAR_RADIUS_MAX 1.0

/* Directions of an image light along each side of the square that they are drawn from, to find its spots, the largest
 * of which have this radius in radians. */
#define SPOT_POINTS 32u
#define SPOT_RADIUS_MAX 0.05

/* Squared distance from a spot's middle up to which directions are its own, in units of its variance: the edge of a
 * disc is at 4. */
#define SPOT_REACH 6.0

/* Estimates of a spot's radius, each by the one before. */
#define SPOT_STEPS 3

bool photon_light_is_far(const PhotonLights *lights, uint light)
{
    return light_kind(&lights->view.lights[light]) >= LIGHT_DISTANT;
}

/* The middle of square k of side x side that the unit square is divided into. */
static Vec2 square_point(uint k, uint side)
{
    const uint row = k / side, column = k % side;
    return vec2(((float)column + 0.5f) / (float)side, ((float)row + 0.5f) / (float)side);
}

/* Sums of points, each with its weight, about an origin. */
typedef struct Moments {
    Vec3 origin;
    double weight, first[3], second[6];
} Moments;

static void moments_add(Moments *moments, Vec3 p, double weight)
{
    if (moments->weight == 0.0)
        moments->origin = p;
    Vec3 moved = vec3_sub(p, moments->origin);
    const double x[3] = {(double)moved.x, (double)moved.y, (double)moved.z};
    moments->weight += weight;
    for (int i = 0, k = 0; i < 3; ++i) {
        moments->first[i] += weight * x[i];
        for (int j = i; j < 3; ++j, ++k)
            moments->second[k] += weight * x[i] * x[j];
    }
}

/* The mean of the points, and their covariance: xx, xy, xz, yy, yz, zz. */
static Vec3 moments_end(const Moments *moments, double covariance[6])
{
    double mean[3];
    for (int i = 0; i < 3; ++i)
        mean[i] = moments->first[i] / moments->weight;
    for (int i = 0, k = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j, ++k)
            covariance[k] = moments->second[k] / moments->weight - mean[i] * mean[j];
    return vec3_add(moments->origin, vec3((float)mean[0], (float)mean[1], (float)mean[2]));
}

/* ---- lamps ------------------------------------------------------------------------------------------------------- */

static uint lamp_shape(const SceneView *view, uint light)
{
    return view->primitives[view->lights[light].primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK;
}

static void lamp_add(const SceneView *view, uint light, uint side, Moments *moments)
{
    const Primitive primitive = view->primitives[view->lights[light].primitive];
    for (uint k = 0; k < side * side; ++k) {
        AreaPoint point = area_light_point(view, light, &primitive, square_point(k, side));
        moments_add(moments, point.p, (double)view->lights[light].area / (side * side));
    }
}

/* Of a convex shape a quarter of its area is seen on average (Cauchy), and of a sphere three quarters of the covariance
 * of its points. A flat shape is seen whole. */
static void lamp_end(const Moments *moments, LampExtent *lamp)
{
    double *c = lamp->covariance;
    lamp->center = moments_end(moments, c);
    double minors = c[0] * c[3] - c[1] * c[1] + c[0] * c[5] - c[2] * c[2] + c[3] * c[5] - c[4] * c[4],
           determinant = c[0] * (c[3] * c[5] - c[4] * c[4]) - c[1] * (c[1] * c[5] - c[4] * c[2]) +
                         c[2] * (c[1] * c[4] - c[3] * c[2]);
    bool flat = !(determinant > FLAT_VARIANCE * pow(fmax(minors, 0.0), 1.5));
    double seen = (flat ? 1.0 : 0.25) * moments->weight, pairs = flat ? 1.0 : 3.0, part = flat ? 1.0 : 0.75;
    for (int k = 0; k < 6; ++k)
        c[k] *= part;
    lamp->radius = sqrt(seen / M_PI);
    /* of a single point, which is all that is known of one lamp among very many, nothing */
    lamp->compact = minors > 0.0 && seen >= COMPACT_FILL * 4.0 * M_PI * part * sqrt(minors / pairs);
}

static bool lamps_set(PhotonLights *lights, size_t shape_count, Error *error)
{
    const SceneView *view = &lights->view;
    const uint count = view->frame->scene.light_count, side = count > LAMPS_MANY ? 1u : LAMP_POINTS;
    Moments *moments = calloc(shape_count + 1, sizeof *moments);
    lights->lamps = calloc(shape_count + 1, sizeof *lights->lamps);
    if (!moments || !lights->lamps) {
        free(moments);
        return error_memory(error, shape_count * (sizeof *moments + sizeof *lights->lamps), "lights");
    }
    for (uint i = 0; i < count; ++i)
        if (light_kind(&view->lights[i]) == LIGHT_AREA)
            lamp_add(view, i, side, &moments[lamp_shape(view, i)]);
    for (size_t shape = 0; shape < shape_count; ++shape)
        if (moments[shape].weight > 0.0)
            lamp_end(&moments[shape], &lights->lamps[shape]);
    free(moments);
    return true;
}

/* ---- lights at infinity ------------------------------------------------------------------------------------------ */

/* The radius of a disc of even light of which directions have the density pdf per solid angle. */
static double far_radius(double pdf)
{
    return fmin(fmax(sqrt(1.0 / (M_PI * fmax(pdf, 1e-30))), FAR_RADIUS_MIN), FAR_RADIUS_MAX);
}

/* The spot that the direction d, in which light travels, belongs to; NULL: none. */
static const LightSpot *spot_of(const PhotonLights *lights, uint light, Vec3 d)
{
    for (uint i = 0; i < lights->spot_count; ++i) {
        const LightSpot *spot = &lights->spots[i];
        double away = (double)vec3_length(vec3_sub(d, spot->direction));
        if (spot->light == light && away * away < SPOT_REACH * spot->variance)
            return spot;
    }
    return NULL;
}

/* Sums the directions that are less than two radii from one of them. A disc around which there is nothing else, of
 * which the part p of all was drawn with density q, has the solid angle p / q. */
static Moments spot_around(const LightSample *samples, uint count, uint from, double *radius)
{
    Moments moments = {0};
    *radius = FAR_RADIUS_MAX;
    for (int step = 0; step < SPOT_STEPS; ++step) {
        const double most = 2.0 * *radius;
        moments = (Moments){0};
        for (uint i = 0; i < count; ++i)
            if ((double)vec3_length(vec3_sub(samples[i].wi, samples[from].wi)) < most)
                moments_add(&moments, samples[i].wi, 1.0);
        *radius = far_radius((double)samples[from].pdf_w * count / moments.weight);
    }
    return moments;
}

/* Adds the spot that a direction is in, of many that were drawn in proportion to the light, if it fills its disc and is
 * new: the corners of a square are not within SPOT_REACH. */
static void spot_add(PhotonLights *lights, uint light, const LightSample *samples, uint count, uint from)
{
    double radius, covariance[6];
    const Moments moments = spot_around(samples, count, from, &radius);
    const Vec3 middle = vec3_normalize(moments_end(&moments, covariance));
    const double variance = 0.5 * (covariance[0] + covariance[3] + covariance[5]);
    if (radius < SPOT_RADIUS_MAX && variance > 0.0 && radius * radius >= COMPACT_FILL * 4.0 * variance &&
        lights->spot_count < LIGHT_SPOTS && !spot_of(lights, light, vec3_negate(middle)))
        lights->spots[lights->spot_count++] = (LightSpot){light, vec3_negate(middle), variance};
}

static bool spots_find(PhotonLights *lights, Error *error)
{
    const SceneView *view = &lights->view;
    LightSample *samples = malloc(SPOT_POINTS * SPOT_POINTS * sizeof *samples);
    if (!samples)
        return error_memory(error, SPOT_POINTS * SPOT_POINTS * sizeof *samples, "bright spots");
    for (uint light = 0; light < view->frame->scene.light_count; ++light) {
        uint count = 0;
        if (light_kind(&view->lights[light]) != LIGHT_INFINITE_IMAGE)
            continue;
        for (uint k = 0; k < SPOT_POINTS * SPOT_POINTS; ++k) {
            const Vec2 u = square_point(k, SPOT_POINTS);
            count += infinite_light_sample(view, light, vec3_splat(0.0f), u, &samples[count]);
        }
        for (uint i = 0; i < count; ++i)
            if (!spot_of(lights, light, vec3_negate(samples[i].wi)))
                spot_add(lights, light, samples, count, i);
    }
    free(samples);
    return true;
}

/* ---- all lights -------------------------------------------------------------------------------------------------- */

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
    double world = (double)scene->world_radius, least = POINT_STEP_ULPS * (double)FLOAT_EPSILON, nearest = world;
    const double at_surfaces = (double)vec3_length(lights->center) + 2.0 * lights->radius;
    for (uint i = 0; i < scene->light_count; ++i) {
        const Light *light = &view->lights[i];
        const bool far = photon_light_is_far(lights, i);
        double reach = lights->radius;
        if (!far)
            reach += (double)vec3_length(vec3_sub(light_place(view, light), lights->center));
        reach = fmin(reach, world);
        const double smallest = least * (far ? at_surfaces : world);
        lights->place_step[i] = fmax(POINT_STEP * lights->radius, smallest);
        lights->light_step[i] = far ? DIRECTION_STEP : fmax(POINT_STEP * reach, smallest);
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
                             .params.distant_sine = DISTANT_SINE};
    lights->place_step = calloc(count + 1, sizeof *lights->place_step);
    lights->light_step = calloc(count + 1, sizeof *lights->light_step);
    if (!lights->place_step || !lights->light_step)
        return error_memory(error, count * (sizeof *lights->place_step + sizeof *lights->light_step), "lights");
    if (!smooth_boxes_init(&lights->aims, scene, &lights->view, error))
        return false;
    lights->center = smooth_boxes_center(&lights->aims);
    lights->radius = smooth_boxes_radius(&lights->aims);
    reach_set(lights);
    return lamps_set(lights, scene->shapes.count, error) && spots_find(lights, error);
}

void photon_lights_destroy(PhotonLights *lights)
{
    free(lights->lamps);
    free(lights->place_step);
    free(lights->light_step);
    smooth_boxes_destroy(&lights->aims);
    *lights = (PhotonLights){0};
}

/* a^T covariance b. */
static double covariance_along(const double covariance[6], Vec3 a, Vec3 b)
{
    const double *c = covariance, x[3] = {(double)a.x, (double)a.y, (double)a.z},
                 y[3] = {(double)b.x, (double)b.y, (double)b.z};
    return x[0] * (c[0] * y[0] + c[1] * y[1] + c[2] * y[2]) + x[1] * (c[1] * y[0] + c[3] * y[1] + c[4] * y[2]) +
           x[2] * (c[2] * y[0] + c[4] * y[1] + c[5] * y[2]);
}

/* A disc of this radius around the ray's own point or direction. */
static LightLook disc_look(Vec3 own, double radius)
{
    const double variance = 0.25 * radius * radius;
    return (LightLook){.center = own, .covariance = {variance, 0.0, variance}};
}

static LightLook lamp_look(const LampExtent *lamp, Vec3 origin, const Vec3 axes[2])
{
    if (!lamp->compact)
        return disc_look(origin, lamp->radius);
    const double *covariance = lamp->covariance;
    return (LightLook){lamp->center,
                       {covariance_along(covariance, axes[0], axes[0]), covariance_along(covariance, axes[0], axes[1]),
                        covariance_along(covariance, axes[1], axes[1])}};
}

static LightLook far_look(const PhotonLights *lights, uint light, Vec3 d)
{
    const LightSpot *spot = spot_of(lights, light, d);
    if (spot)
        return (LightLook){spot->direction, {spot->variance, 0.0, spot->variance}};
    return disc_look(d, far_radius((double)environment_pdf_w(&lights->view, light, vec3_negate(d))));
}

LightLook photon_light_look(const PhotonLights *lights, uint light, Vec3 own, const Vec3 axes[2])
{
    const PhotonParams *params = &lights->params;
    uint kind = light_kind(&lights->view.lights[light]);
    if (kind == LIGHT_AREA)
        return lamp_look(&lights->lamps[lamp_shape(&lights->view, light)], own, axes);
    if (kind == LIGHT_DISTANT)
        return disc_look(own, (double)params->distant_sine);
    return light_has_position(kind) ? disc_look(own, (double)params->point_radius) : far_look(lights, light, own);
}
