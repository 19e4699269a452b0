#include "scene/light_setup.h"

#include "base/log.h"
#include "geometry/texture.h"
#include "light/delta.h"
#include "scene/distribution_build.h"
#include "scene/far_lights.h"
#include "scene/light_tree.h"
#include "scene/portal_setup.h"

#include <math.h>
#include <stdlib.h>

static double luminance(Vec3 c)
{
    return (double)rgb_luminance(vec3(float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f)));
}

/* ---- images of lights -------------------------------------------------------------------------------------------- */

/* The image of an infinite, goniometric or projection light while its distribution is built. */
typedef struct Environment {
    SceneView view;
    TextureImage image;
    const Light *light;
    const LightDetail *detail;
    float *texels; /* luminance of texel times emission, width x height */
} Environment;

static float texel_luminance(const Environment *e, int x, int y)
{
    return (float)luminance(vec3_mul(e->light->emission, image_texel_wrapped(&e->view, &e->image, x, y, 0)));
}

/* The texel (x, y), at most one outside the image, wrapped like environment_image (light/infinite.h). Lights at a point
 * do not interpolate (light/intensity_image.h). */
static float texel_at(const Environment *e, int x, int y)
{
    int width = (int)e->image.width, height = (int)e->image.height;
    if ((e->light->flags & LIGHT_EQUIRECTANGULAR) != 0)
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
    if (x >= 0 && x < width && y >= 0 && y < height)
        return e->texels[(size_t)y * e->image.width + (size_t)x];
    return texel_luminance(e, x, y);
}

/* Mean over the cell of texel (x, y) of the bilinear interpolant between texel centres: weights 1/8, 6/8, 1/8 along
 * each axis. It gives a dark texel next to a bright one the density of the interpolated light in it. */
static float cell_mean(const Environment *e, int x, int y)
{
    if (e->image.filter == FILTER_POINT)
        return texel_at(e, x, y);
    float rows[3];
    for (int j = 0; j < 3; ++j)
        rows[j] = 0.125f * texel_at(e, x - 1, y + j - 1) + 0.75f * texel_at(e, x, y + j - 1) +
                  0.125f * texel_at(e, x + 1, y + j - 1);
    return 0.125f * rows[0] + 0.75f * rows[1] + 0.125f * rows[2];
}

/* Fraction of the sphere covered by each cell of row y, times the number of cells; of projection lights a factor is
 * missing. */
static double row_weight(const Environment *e, int y)
{
    if ((e->light->flags & LIGHT_EQUIRECTANGULAR) == 0)
        return 1.0;
    double height = (double)e->image.height, step = M_PI / height;
    return 0.5 * height * (cos(step * y) - cos(step * (y + 1)));
}

/* The missing factor, by the midpoint rule with PROJECTION_POINTS or more points per side of the image:
 * projection_place (light/intensity_image.h) makes it a square of area 4. */
#define PROJECTION_POINTS 64

static double projection_weight(const Environment *e, int x, int y)
{
    int nx = 1 + PROJECTION_POINTS / (int)e->image.width, ny = 1 + PROJECTION_POINTS / (int)e->image.height;
    double sum = 0.0;
    if (light_kind(e->light) != LIGHT_PROJECTION)
        return 1.0;
    for (int i = 0; i < nx * ny; ++i) {
        int column = i % nx, row = i / nx;
        double px = 2.0 * (x + (column + 0.5) / nx) / (double)e->image.width - 1.0;
        double py = 1.0 - 2.0 * (y + (row + 0.5) / ny) / (double)e->image.height;
        Vec3 w = affine_vector(e->detail->world_from_light, vec3((float)px, (float)py, 1.0f));
        double length = (double)vec3_length(w);
        sum += 1.0 / (M_PI * length * length * length);
    }
    return sum / (nx * ny);
}

static bool environment_load(Environment *e, Error *error)
{
    int width = (int)e->image.width, height = (int)e->image.height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float value = texel_luminance(e, x, y);
            if (!float_finite(value)) {
                error_set(error, "texel (%d, %d) of a light's image is not finite", x, y);
                return error_fix(error, "repair the image, or clamp its values below 1e30");
            }
            e->texels[(size_t)y * e->image.width + (size_t)x] = value;
        }
    return true;
}

/* Means of an image of a light over the sphere. */
typedef struct EnvironmentMeans {
    double light, square; /* of the luminance, and of its square */
} EnvironmentMeans;

/* Fills `weights` with each cell's share of the light. */
static void environment_weights(const Environment *e, float *weights, EnvironmentMeans *means)
{
    int width = (int)e->image.width, height = (int)e->image.height;
    EnvironmentMeans sums = {0.0, 0.0};
    for (int y = 0; y < height; ++y) {
        double weight = row_weight(e, y);
        for (int x = 0; x < width; ++x) {
            double mean = (double)cell_mean(e, x, y), value = weight * projection_weight(e, x, y) * mean;
            weights[(size_t)y * e->image.width + (size_t)x] = (float)value;
            sums.light += value;
            sums.square += value * mean;
        }
    }
    double cells = (double)width * (double)height;
    *means = (EnvironmentMeans){sums.light / cells, sums.square / cells};
}

/* Builds the distribution of a light's image, of its radiance or intensity. */
static bool environment_setup(Scene *scene, const Light *light, EnvironmentMeans *means, Error *error)
{
    LightDetail *detail = scene_light_detail(scene, light);
    Environment e = {.light = light, .detail = detail, .image = ARRAY_AT(&scene->images, TextureImage, detail->image)};
    e.view.lookup = scene->lookup.data;
    e.view.texels = scene->texels.data;
    size_t cells = (size_t)e.image.width * e.image.height;
    if (cells == 0) {
        error_set(error, "a light's image is empty");
        return error_fix(error, "give another image");
    }
    float *weights = malloc(2 * cells * sizeof *weights);
    if (!weights)
        return error_memory(error, 2 * cells * sizeof *weights, "the image of a light");
    e.texels = weights + cells;
    bool ok = environment_load(&e, error);
    if (ok) {
        environment_weights(&e, weights, means);
        detail->distribution = (uint)scene->distributions2d.count;
        Distribution2D *out = array_grow(&scene->distributions2d, 1, error);
        ok = out && distribution2d_build(weights, e.image.width, e.image.height, &scene->lookup, out, error);
    }
    free(weights);
    return ok;
}

/* ---- power ------------------------------------------------------------------------------------------------------- */

/* Integral of pbrt's falloff over the sphere: the mean of smoothstep over the cosine is 1/2. */
double light_spot_solid_angle(double cos_total, double cos_falloff)
{
    return 2.0 * M_PI * ((1.0 - cos_falloff) + 0.5 * (cos_falloff - cos_total));
}

/* Flux of delta lights whose emission has luminance 1; disk: area of the bounding sphere's disk. */
static double point_power(const LightDetail *light, double disk)
{
    (void)light;
    (void)disk;
    return 4.0 * M_PI;
}

static double spot_power(const LightDetail *light, double disk)
{
    (void)disk;
    return light_spot_solid_angle((double)light->cos_total, (double)light->cos_falloff);
}

/* Of the mean over all directions. */
static double goniometric_power(const LightDetail *light, double disk)
{
    return point_power(light, disk);
}

static double projection_power(const LightDetail *light, double disk)
{
    return point_power(light, disk);
}

static double distant_power(const LightDetail *light, double disk)
{
    (void)light;
    return disk;
}

/* Area of the disk of the bounding sphere. */
static double world_disk(const Scene *scene)
{
    double radius = scene->frame.scene.world_radius > 0.0f ? (double)scene->frame.scene.world_radius : 1.0;
    return M_PI * radius * radius;
}

/* *power: luminance of the flux that a light sends into the scene; for infinite and distant lights, through the disk of
 * the bounding sphere, or through their portal. *solid_angle: from which most of the light of those at infinity
 * (light_is_far) comes. */
static bool light_power(Scene *scene, uint index, double *power, double *solid_angle, Error *error)
{
    const Light *light = &ARRAY_AT(&scene->lights, Light, index);
    uint kind = light_kind(light);
    double disk = world_disk(scene), mean = luminance(light->emission);
    EnvironmentMeans means = {mean, mean * mean};
    bool image = kind == LIGHT_INFINITE_IMAGE || light_has_intensity_image(kind);
    if (image && !environment_setup(scene, light, &means, error))
        return false;
    mean = means.light;
    *solid_angle = kind == LIGHT_DISTANT ? 0.0 : 4.0 * M_PI * (means.square > 0.0 ? mean * mean / means.square : 1.0);
    switch (kind) {
    case LIGHT_AREA:
        *power = mean * (double)light->area * M_PI * ((light->flags & LIGHT_TWO_SIDED) != 0 ? 2.0 : 1.0);
        break;
#define POWER(NAME, name, text, feature, position)                                                                     \
    case LIGHT_##NAME:                                                                                                 \
        *power = mean * name##_power(scene_light_detail(scene, light), disk);                                          \
        break;
        LIGHT_LIST_DELTA(POWER)
#undef POWER
    case LIGHT_PORTAL:
        if (!portal_setup(scene, index, power, error))
            return false;
        break;
    default:
        *power = mean * 4.0 * M_PI * disk;
    }
    if (*power >= 0.0 && isfinite(*power) && vec3_finite(light->emission))
        return true;
    error_set(error, "a light's power is not finite");
    return error_fix(error, "check its radiance, intensity, scale and size");
}

/* The irradiance, over the power per area, of a surface that faces a light at infinity, if that is a cone of this solid
 * angle. */
static double facing_part(double solid_angle)
{
    return solid_angle < 2.0 * M_PI ? 1.0 - solid_angle / (4.0 * M_PI) : M_PI / solid_angle;
}

/* Fills `at_vertices` with what light_tree_build takes for the powers of lights. */
static void powers_at_vertices(const Scene *scene, const double *powers, const double *solid_angles,
                               double *at_vertices)
{
    double disk = world_disk(scene);
    for (size_t i = 0; i < scene->lights.count; ++i) {
        uint kind = light_kind(&ARRAY_AT(&scene->lights, Light, i));
        at_vertices[i] = light_is_far(kind) ? powers[i] * facing_part(solid_angles[i]) / disk : powers[i];
    }
}

static bool no_light(size_t count, Error *error)
{
    if (count == 0)
        error_set(error, "the scene has no light");
    else
        error_set(error, "the scene has no light: the power of all %zu is zero", count);
    return error_fix(error, "add a LightSource, or an AreaLightSource before a shape, with a positive radiance");
}

/* Fills `powers` with those by which light subpaths choose lights, solid_angles as light_power does, and at_vertices;
 * builds the tree, sets select_pdf of every light, and lists the infinite lights. */
static bool lights_weigh(Scene *scene, double *powers, double *solid_angles, double *at_vertices, Error *error)
{
    size_t count = scene->lights.count, dark = 0;
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        if (!light_power(scene, (uint)i, &powers[i], &solid_angles[i], error))
            return false;
        sum += powers[i];
        dark += powers[i] > 0.0 ? 0 : 1;
    }
    if (!(sum > 0.0))
        return no_light(count, error);
    scene->light_power = sum;
    powers_at_vertices(scene, powers, solid_angles, at_vertices);
    if (!light_tree_build(scene, at_vertices, error))
        return false;
    far_lights_divide(scene, powers, solid_angles);
    far_lights_bound(scene, powers);
    sum = 0.0;
    for (size_t i = 0; i < count; ++i)
        sum += powers[i];
    if (dark > 0)
        log_message(LOG_WARNING, "%zu of %zu lights have no power and are ignored", dark, count);
    for (size_t i = 0; i < count; ++i) {
        Light *light = &ARRAY_AT(&scene->lights, Light, i);
        light->select_pdf = (float)(powers[i] / sum);
        if (light_kind(light) < LIGHT_INFINITE || !(powers[i] > 0.0))
            continue;
        uint *index = array_grow(&scene->infinite_lights, 1, error);
        if (!index)
            return false;
        *index = (uint)i;
    }
    return true;
}

bool light_setup(Scene *scene, Error *error)
{
    size_t count = scene->lights.count;
    scene->infinite_lights.count = scene->light_alias.count = 0;
    if (count == 0)
        return no_light(0, error);
    double *powers = calloc(3 * count, sizeof *powers);
    if (!powers)
        return error_memory(error, 3 * count * sizeof *powers, "lights");
    bool ok = lights_weigh(scene, powers, powers + count, powers + 2 * count, error);
    AliasBucket *buckets = ok ? array_grow(&scene->light_alias, count, error) : NULL;
    ok = buckets && alias_build(powers, count, buckets, error);
    free(powers);
    return ok;
}
