/* Scenes with lights for tests, and random points. */
#ifndef TWINLIGHT_TESTS_SUPPORT_LIGHT_FIXTURE_H
#define TWINLIGHT_TESTS_SUPPORT_LIGHT_FIXTURE_H

#include "support/test_files.h"
#include "support/test_matrix.h"
#include "support/test_util.h"

#include "light/light.h"
#include "math/rng.h"
#include "scene/light_setup.h"
#include "scene/scene.h"

typedef struct LightFixture {
    Scene scene;
    SceneView view;
} LightFixture;

static inline void fixture_init(LightFixture *f)
{
    scene_init(&f->scene);
    f->scene.frame.scene.world_radius = 1.0f;
}

static inline void fixture_destroy(LightFixture *f)
{
    scene_destroy(&f->scene);
}

/* To be called after everything is added: sets up the lights, and makes the view that kernels would have. */
static inline void fixture_finish(LightFixture *f)
{
    Error error = {0};
    Scene *s = &f->scene;
    ck_assert_msg(light_setup(s, &error), "%s", error.message);
    s->frame.scene.light_count = (uint)s->lights.count;
    s->frame.scene.infinite_light_count = (uint)s->infinite_lights.count;
    f->view = (SceneView){.frame = &s->frame,
                          .guide = &s->guide,
                          .features = ~FEATURE_ALPHA,
                          .positions = s->positions.data,
                          .normals = s->normals.data,
                          .uvs = s->uvs.data,
                          .primitives = s->primitives.data,
                          .shapes = s->shapes.data,
                          .patches = s->patches.data,
                          .quadrics = s->quadrics.data,
                          .texture_ops = s->texture_ops.data,
                          .images = s->images.data,
                          .lights = s->lights.data,
                          .light_details = s->light_details.data,
                          .light_alias = s->light_alias.data,
                          .light_tree = s->light_tree.data,
                          .light_nodes = s->light_nodes.data,
                          .light_leaves = s->light_leaves.data,
                          .infinite_lights = s->infinite_lights.data,
                          .portals = s->portals.data,
                          .aims = s->aims.data,
                          .distributions2d = s->distributions2d.data,
                          .lookup = s->lookup.data,
                          .texels = s->texels.data};
}

static inline Shape fixture_shape(uint flags)
{
    return (Shape){.alpha = NONE, .first_light = NONE, .flags = flags};
}

/* A polygon with 3 (triangle) or 4 vertices (bilinear patch: p00 p10 p01 p11) and radiance 1. */
static inline void fixture_add_polygon(LightFixture *f, const float *positions, int vertices, const float *normals,
                                       uint shape_flags, uint light_flags)
{
    static const uint indices[4] = {0, 1, 2, 3};
    const float emission[3] = {1.0f, 1.0f, 1.0f};
    Error error = {0};
    MeshData mesh = {.positions = positions,
                     .normals = normals,
                     .vertex_count = (size_t)vertices,
                     .indices = indices,
                     .triangle_count = 1};
    bool ok = vertices == 3
                  ? scene_add_mesh(&f->scene, &mesh, fixture_shape(shape_flags), emission, light_flags, &error)
                  : scene_add_patches(&f->scene, &mesh, fixture_shape(shape_flags), emission, light_flags, &error);
    ck_assert_msg(ok, "%s", error.message);
}

/* A sphere or disk with the given radiance. */
static inline void fixture_add_quadric(LightFixture *f, uint kind, Quadric quadric, const double matrix[16],
                                       float radiance, uint shape_flags, uint light_flags)
{
    const float emission[3] = {radiance, radiance, radiance};
    double inverse[16];
    Error error = {0};
    test_matrix_inverse(matrix, inverse);
    const QuadricData data = {kind, quadric, matrix, inverse};
    ck_assert_msg(scene_add_quadric(&f->scene, &data, fixture_shape(shape_flags), emission, light_flags, &error), "%s",
                  error.message);
}

static inline void fixture_add_sphere(LightFixture *f, float radius, double x, double y, double z, float radiance,
                                      uint light_flags)
{
    const double matrix[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
    Quadric quadric = {.radius = radius, .z_min = -radius, .z_max = radius, .phi_max = 6.28318531f};
    fixture_add_quadric(f, PRIMITIVE_SPHERE, quadric, matrix, radiance, 0, light_flags);
}

static inline void fixture_add_light(LightFixture *f, LightData light)
{
    Error error = {0};
    ck_assert(scene_add_light(&f->scene, &light, &error));
}

/* An infinite light with an image of 3 float channels; `rotation`: world_from_light, 3x3 row-major. */
static inline void fixture_add_environment(LightFixture *f, const float *texels, uint width, uint height, uint flags,
                                           const double rotation[9])
{
    Error error = {0};
    TextureImage *image = array_grow(&f->scene.images, 1, &error);
    bool equirectangular = (flags & LIGHT_EQUIRECTANGULAR) != 0;
    *image = (TextureImage){.width = width,
                            .height = height,
                            .channels = 3,
                            .format = TEXEL_F32,
                            .first_word = (uint)f->scene.texels.count,
                            .wrap = equirectangular ? WRAP_REPEAT : WRAP_OCTAHEDRAL,
                            .filter = FILTER_BILINEAR,
                            .lut = NONE};
    size_t words = 3 * (size_t)width * height;
    memcpy(array_grow(&f->scene.texels, words, &error), texels, words * sizeof *texels);
    LightData light = {.kind = LIGHT_INFINITE_IMAGE,
                       .flags = flags,
                       .detail.image = (uint)f->scene.images.count - 1,
                       .emission = {1.0f, 1.0f, 1.0f}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            light.detail.world_from_light.m[4 * i + j] = (float)rotation[3 * i + j];
            light.detail.light_from_world.m[4 * i + j] = (float)rotation[3 * j + i];
        }
    fixture_add_light(f, light);
}

/* Makes the light that fixture_add_environment added last one at a point with that image: goniometric, or a projection
 * whose half extents at distance 1 are `extent`. */
static inline void fixture_to_intensity(LightFixture *f, uint kind, Vec3 position, const double extent[2])
{
    Light *stored = &ARRAY_AT(&f->scene.lights, Light, f->scene.lights.count - 1);
    LightDetail *light = scene_light_detail(&f->scene, stored);
    TextureImage *image = &ARRAY_AT(&f->scene.images, TextureImage, light->image);
    const double shape[3] = {extent[0], extent[1], 1.0}, scale = cbrt(extent[0] * extent[1]);
    stored->flags = (stored->flags & ~LIGHT_KIND_MASK) | kind;
    light->position = position;
    image->wrap = WRAP_CLAMP;
    image->filter = FILTER_POINT;
    light->direction = vec3(light->world_from_light.m[2], light->world_from_light.m[6], light->world_from_light.m[10]);
    light->cos_total = (float)(1.0 / sqrt(1.0 + extent[0] * extent[0] + extent[1] * extent[1]));
    light->cos_falloff = light->cos_total;
    for (int i = 0; kind == LIGHT_PROJECTION && i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            light->world_from_light.m[4 * i + j] *= (float)(shape[j] / scale);
            light->light_from_world.m[4 * j + i] *= (float)(scale / shape[j]);
        }
}

/* Point `i` of the stream `stream`. */
static inline Vec2 fixture_random(uint stream, uint i)
{
    Random4 r = random_four(i, 0, 0, 0, stream, 1);
    return vec2(random_float(r.x[0]), random_float(r.x[1]));
}

/* Point i of n x n, one per cell of a grid. */
static inline Vec2 fixture_stratified(uint stream, uint i, uint n)
{
    Vec2 r = fixture_random(stream, i);
    return vec2(((float)(i % n) + r.x) / (float)n, ((float)(i / n) + r.y) / (float)n);
}

/* Irradiance at `ref` with normal n from one light, by n_samples x n_samples stratified samples of light_sample;
 * *error: one standard error, computed as if they were independent, which is an upper bound. */
static inline double fixture_irradiance(const LightFixture *f, uint light, Vec3 ref, Vec3 n, uint stream,
                                        uint n_samples, double *error)
{
    double sum = 0.0, squares = 0.0, count = (double)n_samples * n_samples;
    for (uint i = 0; i < n_samples * n_samples; ++i) {
        LightSample s;
        if (!light_sample(&f->view, light, ref, fixture_stratified(stream, i, n_samples), &s))
            continue;
        double value = (double)s.radiance.x * fmax(0.0, (double)vec3_dot(s.wi, n)) / (double)s.pdf_w;
        sum += value;
        squares += value * value;
    }
    *error = sqrt(fmax(0.0, squares / count - sum / count * (sum / count)) / count);
    return sum / count;
}

/* Within 3 standard errors plus 0.5 %. */
#define ASSERT_IRRADIANCE(f, light, ref, n, expected)                                                                  \
    do {                                                                                                               \
        double error_, e_ = (expected);                                                                                \
        double got_ = fixture_irradiance(f, light, ref, n, 7, 300, &error_);                                           \
        ck_assert_msg(fabs(got_ - e_) <= fmin(3.0 * error_ + 1e-5 * e_, 0.005 * e_),                                   \
                      "%s: irradiance %g, not %g +- %g", #expected, got_, e_, error_);                                 \
    } while (0)

/* ---- random numbers from a state: in a range, in a cube of that half width, and of unit length ------------------- */

static inline double fixture_uniform(unsigned *state, double low, double high)
{
    return low + (high - low) * test_random_unit(state);
}

static inline Vec3 fixture_random_point(unsigned *state, double extent)
{
    float x = (float)fixture_uniform(state, -extent, extent), y = (float)fixture_uniform(state, -extent, extent);
    return vec3(x, y, (float)fixture_uniform(state, -extent, extent));
}

static inline Vec3 fixture_random_unit(unsigned *state)
{
    Vec3 d;
    do
        d = fixture_random_point(state, 1.0);
    while (!(vec3_length_squared(d) < 1.0f) || !(vec3_length_squared(d) > 0.01f));
    return vec3_normalize(d);
}

#endif
