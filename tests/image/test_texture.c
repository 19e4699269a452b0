/* Lookups and texture programs against a model in double precision. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "geometry/texture.h"
#include "scene/scene.h"
#include "scene/texture_image.h"

#include <math.h>

TCase *texture_color_tcase(void);
TCase *texture_files_tcase(void);
TCase *texture_image_tcase(void);
TCase *texture_procedural_tcase(void);

static SceneView view_make(const Scene *scene)
{
    SceneView view = {.features = FEATURE_TEXTURE};
    view.images = scene->images.data;
    view.lookup = scene->lookup.data;
    view.texels = scene->texels.data;
    view.texture_ops = scene->texture_ops.data;
    return view;
}

/* An image of random texels; floats range from -1 to 3. */
static Image picture_make(int width, int height, int channels, bool is_float, unsigned seed)
{
    size_t count = (size_t)(width * height * channels);
    Image image = {.width = width, .height = height, .channels = channels, .is_float = is_float};
    image.data = malloc(count * sizeof(float));
    for (size_t i = 0; i < count; ++i) {
        if (is_float)
            ((float *)image.data)[i] = (float)(test_random_unit(&seed) * 4.0 - 1.0);
        else
            ((unsigned char *)image.data)[i] = (unsigned char)test_random(&seed);
    }
    return image;
}

static uint picture_add(Scene *scene, const Image *image, uint wrap, uint filter)
{
    TextureImageOptions options = {.encoding = ENCODING_LINEAR, .wrap = wrap, .filter = filter};
    Error error = {0};
    uint index = NONE;
    ck_assert_msg(texture_image_add(scene, image, &options, &index, &error), "%s", error.message);
    return index;
}

/* The texel that (x, y), arbitrary integers, refers to under a wrap mode, in double. */
static double model_texel(const Image *image, uint wrap, long x, long y, int channel)
{
    long w = image->width, h = image->height;
    if (wrap == WRAP_REPEAT) {
        x = (x % w + w) % w;
        y = (y % h + h) % h;
    } else if (wrap == WRAP_CLAMP) {
        x = x < 0 ? 0 : x >= w ? w - 1 : x;
        y = y < 0 ? 0 : y >= h ? h - 1 : y;
    } else if (wrap == WRAP_OCTAHEDRAL) {
        /* Crossing an edge leads back to the same edge, mirrored about its middle. */
        if (x < 0 || x >= w) {
            x = x < 0 ? -1 - x : 2 * w - 1 - x;
            y = h - 1 - y;
        }
        if (y < 0 || y >= h) {
            y = y < 0 ? -1 - y : 2 * h - 1 - y;
            x = w - 1 - x;
        }
    } else if (x < 0 || y < 0 || x >= w || y >= h) {
        return 0.0;
    }
    if (channel >= image->channels)
        channel = 0;
    return (double)image_value(image, (size_t)((y * w + x) * image->channels + channel));
}

static double model_lookup(const Image *image, uint wrap, uint filter, double u, double v, int channel)
{
    double s = u * image->width, t = (1.0 - v) * image->height;
    if (filter == FILTER_POINT)
        return model_texel(image, wrap, (long)floor(s), (long)floor(t), channel);
    s -= 0.5;
    t -= 0.5;
    double x = floor(s), y = floor(t), dx = s - x, dy = t - y, sum = 0.0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            sum +=
                (i ? dx : 1.0 - dx) * (j ? dy : 1.0 - dy) * model_texel(image, wrap, (long)x + i, (long)y + j, channel);
    return sum;
}

/* Whether float32 may round to the other side of a texel border. */
static bool near_border(const Image *image, double u, double v)
{
    double s = u * image->width, t = v * image->height;
    return fabs(s - rint(s)) < 1e-4 || fabs(t - rint(t)) < 1e-4;
}

/* Random (u, v), also far outside if the wrap mode defines lookups there. */
static void lookups_check(const Image *image, uint wrap, uint filter)
{
    Scene scene;
    scene_init(&scene);
    uint index = picture_add(&scene, image, wrap, filter);
    SceneView view = view_make(&scene);
    unsigned state = wrap * 7 + filter + 1;
    double range = wrap == WRAP_OCTAHEDRAL ? 1.0 : 5.0;
    for (int i = 0; i < 4000; ++i) {
        float u = (float)(0.5 + (test_random_unit(&state) - 0.5) * range);
        float v = (float)(0.5 + (test_random_unit(&state) - 0.5) * range);
        if (filter == FILTER_POINT && near_border(image, (double)u, (double)v))
            continue;
        Vec3 c = image_lookup(&view, index, vec2(u, v));
        const float got[3] = {c.x, c.y, c.z};
        for (int k = 0; k < 3; ++k)
            TEST_NEAR(got[k], model_lookup(image, wrap, filter, (double)u, (double)v, k), 2e-4);
        /* As a float texture: grey, the mean of RGB, the alpha of RGBA. */
        double number = (double)vec3_mean(c);
        if (image->channels == 4)
            number = model_lookup(image, wrap, filter, (double)u, (double)v, 3);
        TEST_NEAR(image_lookup_float(&view, index, vec2(u, v)), number, 2e-4);
    }
    scene_destroy(&scene);
}

START_TEST(test_lookups)
{
    const int sizes[][2] = {{1, 1}, {2, 3}, {7, 5}, {16, 16}, {1, 9}};
    const int channels[] = {1, 3, 4};
    for (int s = 0; s < 5; ++s) {
        for (int i = 0; i < 6; ++i) {
            Image image = picture_make(sizes[s][0], sizes[s][1], channels[i % 3], i >= 3, 11);
            for (uint wrap = WRAP_REPEAT; wrap <= WRAP_OCTAHEDRAL; ++wrap) {
                lookups_check(&image, wrap, FILTER_BILINEAR);
                lookups_check(&image, wrap, FILTER_POINT);
            }
            image_destroy(&image);
        }
    }
}
END_TEST

/* No float value leads outside the image. */
START_TEST(test_lookups_of_any_float)
{
    Image image = picture_make(5, 3, 4, false, 5);
    Scene scene;
    scene_init(&scene);
    uint first = NONE;
    for (uint i = 0; i < 8; ++i) {
        uint index = picture_add(&scene, &image, i % 4, i / 4);
        first = i == 0 ? index : first;
    }
    SceneView view = view_make(&scene);
    const float odd[] = {NAN,     INFINITY, -INFINITY, FLOAT_MAX, -FLOAT_MAX, 1e10f,       -1e10f, 16777215.5f,
                         -1e-10f, 1e-45f,   -0.0f,     1.0f,      -1.0f,      0.99999994f, 2.0f,   1e38f};
    unsigned state = 1;
    for (int i = 0; i < 20000; ++i) {
        float u = i < 256 ? odd[i / 16] : bits_float((test_random(&state) << 9) ^ test_random(&state));
        float v = i < 256 ? odd[i % 16] : bits_float((test_random(&state) << 9) ^ test_random(&state));
        for (uint k = 0; k < 8; ++k) {
            Vec3 c = image_lookup(&view, first + k, vec2(u, v));
            float a = image_lookup_float(&view, first + k, vec2(u, v));
            TEST_TRUE(c.x >= 0.0f && c.x <= 1.0f && c.y >= 0.0f && c.y <= 1.0f && c.z >= 0.0f && c.z <= 1.0f);
            TEST_TRUE(a >= 0.0f && a <= 1.0f);
        }
    }
    scene_destroy(&scene);
    image_destroy(&image);
}
END_TEST

/* pbrt: a float texture of an RGB image is its mean, of RGBA its alpha, of grey its value. */
START_TEST(test_images_as_numbers)
{
    const unsigned char grey[] = {51}, rgb[] = {51, 102, 153}, rgba[] = {51, 102, 153, 204};
    const unsigned char *const data[] = {grey, rgb, rgba};
    const float expected[] = {0.2f, 0.4f, 0.8f};
    Scene scene;
    scene_init(&scene);
    for (int i = 0; i < 3; ++i) {
        Image image = {.width = 1, .height = 1, .channels = i == 0 ? 1 : i + 2, .data = (void *)(uintptr_t)data[i]};
        uint index = picture_add(&scene, &image, WRAP_REPEAT, FILTER_BILINEAR);
        SceneView view = view_make(&scene);
        ck_assert_float_eq_tol(image_lookup_float(&view, index, vec2(0.3f, 0.7f)), expected[i], 1e-6f);
        ck_assert_float_eq_tol(image_lookup(&view, index, vec2(0.3f, 0.7f)).x, 0.2f, 1e-6f);
    }
    scene_destroy(&scene);
}
END_TEST

static TextureOp op_constant(float r, float g, float b)
{
    return (TextureOp){.code = TEXTURE_CONSTANT, .value = {r, g, b}};
}

static const float AFFINE[12] = {0.5f, 0.2f, -0.1f, 0.3f, -0.4f, 1.1f, 0.3f, -0.2f, 0.1f, -0.2f, 0.9f, 0.7f};

static TextureOp op_mapped(uint code, uint mapping)
{
    TextureOp op = {.code = code, .mapping = mapping, .scale = 1.0f, .uv_map = {1.0f, 1.0f, 0.0f, 0.0f}};
    memcpy(op.texture_from_world.m, AFFINE, sizeof AFFINE);
    return op;
}

static Vec3 program_run(const TextureOp *ops, size_t count, Scene *scene, const TexturePoint *point, float *number)
{
    SceneView view = view_make(scene);
    view.texture_ops = ops;
    TEST_TRUE(texture_program_depth(ops, count) - 1u < TEXTURE_STACK);
    *number = texture_eval_float(&view, 0, point);
    return texture_eval(&view, 0, point);
}

static void vec3_check(Vec3 v, double x, double y, double z)
{
    ck_assert_double_eq_tol((double)v.x, x, 1e-5);
    ck_assert_double_eq_tol((double)v.y, y, 1e-5);
    ck_assert_double_eq_tol((double)v.z, z, 1e-5);
}

START_TEST(test_programs)
{
    Scene scene;
    scene_init(&scene);
    const TexturePoint point = {.p = {0.1f, 0.2f, 0.3f}, .uv = {0.4f, 0.6f}};
    float number;
    const TextureOp constant[] = {op_constant(1, 2, 3), {.code = TEXTURE_END}};
    vec3_check(program_run(constant, 2, &scene, &point, &number), 1, 2, 3);
    ck_assert_float_eq(number, 1.0f);
    const TextureOp scale[] = {op_constant(1, 2, 3), op_constant(2, 0.5f, 3), {.code = TEXTURE_SCALE}, {0}};
    vec3_check(program_run(scale, 4, &scene, &point, &number), 2, 1, 9);
    const TextureOp mix[] = {
        op_constant(0.25f, 0.25f, 0.25f), op_constant(1, 2, 3), op_constant(5, 2, -1), {.code = TEXTURE_MIX}, {0}};
    vec3_check(program_run(mix, 5, &scene, &point, &number), 2, 2, 2);
    /* mix(0.5, scale(a, b), mix(1, c, d)), nested on both sides */
    const TextureOp nested[] = {op_constant(0.5f, 0.5f, 0.5f), op_constant(1, 2, 3),
                                op_constant(4, 4, 4),          {.code = TEXTURE_SCALE},
                                op_constant(1, 1, 1),          op_constant(9, 9, 9),
                                op_constant(0, 2, 4),          {.code = TEXTURE_MIX},
                                {.code = TEXTURE_MIX},         {0}};
    vec3_check(program_run(nested, 10, &scene, &point, &number), 2, 5, 8);
    ck_assert_uint_eq(texture_program_depth(nested, 10), 5);
    scene_destroy(&scene);
}
END_TEST

/* Invalid programs are rejected before a kernel sees them. */
START_TEST(test_program_check)
{
    const TextureOp one = op_constant(1, 1, 1), end = {0}, scale = {.code = TEXTURE_SCALE}, odd = {.code = 77};
    const TextureOp missing[] = {one, scale, end}, two[] = {one, one, end}, open[] = {one}, none[] = {end};
    const TextureOp unknown[] = {one, odd, end};
    TextureOp deep[20];
    ck_assert_uint_eq(texture_program_depth(missing, 3), 0);
    ck_assert_uint_eq(texture_program_depth(two, 3), 0);
    ck_assert_uint_eq(texture_program_depth(open, 1), 0);
    ck_assert_uint_eq(texture_program_depth(none, 1), 0);
    ck_assert_uint_eq(texture_program_depth(unknown, 3), 0);
    for (int i = 0; i < 9; ++i) {
        deep[i] = one;
        deep[9 + i] = scale;
    }
    deep[17] = end;
    ck_assert_uint_eq(texture_program_depth(deep, 18), 9);
}
END_TEST

/* Which of two textures a checkerboard shows (0 or 1), in double. */
static int model_checker(const double *s, int n)
{
    long sum = 0;
    for (int i = 0; i < n; ++i)
        sum += (long)floor(s[i]);
    return (int)(((sum % 2) + 2) % 2);
}

static void model_map(uint mapping, Vec3 point, double st[3])
{
    const double world[3] = {(double)point.x, (double)point.y, (double)point.z};
    double p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = (double)AFFINE[4 * i] * world[0] + (double)AFFINE[4 * i + 1] * world[1] +
               (double)AFFINE[4 * i + 2] * world[2] + (double)AFFINE[4 * i + 3];
    double phi = atan2(p[1], p[0]), r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (mapping == MAPPING_PLANAR) {
        st[0] = 0.5 + p[0] + 2.0 * p[1];
        st[1] = -0.25 + p[1] - p[2];
    } else if (mapping == MAPPING_SPHERICAL) {
        st[0] = acos(p[2] / r) / M_PI;
        st[1] = (phi < 0.0 ? phi + 2.0 * M_PI : phi) / (2.0 * M_PI);
    } else if (mapping == MAPPING_CYLINDRICAL) {
        st[0] = (M_PI + phi) / (2.0 * M_PI);
        st[1] = p[2];
    } else {
        memcpy(st, p, sizeof p);
    }
}

START_TEST(test_mappings)
{
    unsigned state = 9;
    for (uint mapping = MAPPING_PLANAR; mapping <= MAPPING_CYLINDRICAL; ++mapping) {
        TextureOp op = op_mapped(TEXTURE_IMAGE, mapping);
        const float planar[8] = {1.0f, 2.0f, 0.0f, 0.5f, 0.0f, 1.0f, -1.0f, -0.25f};
        memcpy(op.uv_map, planar, sizeof planar);
        for (int i = 0; i < 10000; ++i) {
            TexturePoint point = {.uv = {0.0f, 0.0f}};
            double st[3];
            point.p = vec3((float)(test_random_unit(&state) * 8.0 - 4.0), (float)(test_random_unit(&state) * 8.0 - 4.0),
                           (float)(test_random_unit(&state) * 8.0 - 4.0));
            model_map(mapping, point.p, st);
            Vec2 got = texture_map(&op, &point);
            TEST_NEAR(got.x, st[0], 3e-5);
            TEST_NEAR(got.y, st[1], 3e-5);
        }
    }
    /* At the origin, where the direction is undefined, the result is some point of the map. */
    Vec2 origin = texture_map_spherical(vec3(0.0f, 0.0f, 0.0f));
    ck_assert(origin.x >= 0.0f && origin.x <= 1.0f && origin.y >= 0.0f && origin.y <= 1.0f);
    const TextureOp uv = {.code = TEXTURE_IMAGE, .uv_map = {2.0f, -3.0f, 0.5f, 0.25f}};
    const TexturePoint point = {.uv = {0.25f, 0.5f}};
    ck_assert_float_eq(texture_map(&uv, &point).x, 1.0f);
    ck_assert_float_eq(texture_map(&uv, &point).y, -1.25f);
}
END_TEST

START_TEST(test_checkerboards)
{
    Scene scene;
    scene_init(&scene);
    unsigned state = 5;
    for (int i = 0; i < 20000; ++i) {
        TexturePoint point;
        double st[3];
        float number;
        bool solid = i % 2 != 0;
        TextureOp ops[] = {op_constant(1, 2, 3),
                           op_constant(4, 5, 6),
                           op_mapped(TEXTURE_CHECKERBOARD, solid ? MAPPING_3D : MAPPING_UV),
                           {0}};
        point.uv = vec2((float)(test_random_unit(&state) * 20.0 - 10.0), (float)(test_random_unit(&state) * 9.0 - 4.0));
        point.p = vec3(point.uv.x, point.uv.y, (float)(test_random_unit(&state) * 9.0 - 4.0));
        if (solid)
            model_map(MAPPING_3D, point.p, st);
        else
            st[0] = (double)point.uv.x, st[1] = (double)point.uv.y, st[2] = 0.5;
        bool near = false;
        for (int k = 0; k < 3; ++k)
            near = near || fabs(st[k] - rint(st[k])) < 1e-4;
        if (near)
            continue;
        Vec3 got = program_run(ops, 4, &scene, &point, &number);
        TEST_NEAR(got.x, model_checker(st, solid ? 3 : 2) ? 4.0 : 1.0, 0.0);
        TEST_NEAR(number, got.x, 0.0);
    }
    const float odd[] = {NAN, INFINITY, FLOAT_MAX, -FLOAT_MAX, 1e20f};
    for (int i = 0; i < 5; ++i)
        ck_assert_uint_eq(texture_cell_odd(odd[i]), 0);
    ck_assert_uint_eq(texture_cell_odd(-0.5f), 1);
    ck_assert_uint_eq(texture_cell_odd(16777215.0f), 1);
    scene_destroy(&scene);
}
END_TEST

/* Scaled first, then inverted, then clamped to at least 0; a number within a colour by TEXTURE_IMAGE_FLOAT. */
START_TEST(test_image_ops)
{
    float rgba[] = {0.25f, 0.5f, -1.0f, 0.125f};
    Image image = {.width = 1, .height = 1, .channels = 4, .is_float = true, .data = rgba};
    Scene scene;
    scene_init(&scene);
    picture_add(&scene, &image, WRAP_CLAMP, FILTER_POINT);
    const TexturePoint point = {.uv = {0.5f, 0.5f}};
    float number;
    TextureOp ops[] = {op_mapped(TEXTURE_IMAGE, MAPPING_UV), {0}};
    ops[0].scale = 4.0f;
    vec3_check(program_run(ops, 2, &scene, &point, &number), 1.0, 2.0, 0.0);
    ck_assert_float_eq(number, 0.5f);
    ops[0].invert = 1;
    vec3_check(program_run(ops, 2, &scene, &point, &number), 0.0, 0.0, 5.0);
    ck_assert_float_eq(number, 0.5f);
    ops[0].code = TEXTURE_IMAGE_FLOAT;
    vec3_check(program_run(ops, 2, &scene, &point, &number), 0.5, 0.5, 0.5);
    SceneView view = view_make(&scene);
    view.texture_ops = ops;
    const ColorParam fixed = {{1, 2, 3}, NONE}, textured = {{1, 2, 3}, 0};
    const FloatParam number_fixed = {7, NONE}, number_textured = {7, 0};
    vec3_check(color_param_eval(&view, fixed, &point), 1, 2, 3);
    vec3_check(color_param_eval(&view, textured, &point), 0.5, 0.5, 0.5);
    ck_assert_float_eq(float_param_eval(&view, number_fixed, &point), 7.0f);
    ck_assert_float_eq(float_param_eval(&view, number_textured, &point), 0.5f);
    scene_destroy(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("texture");
    TCase *tcase = tcase_create("texture");
    tcase_add_test(tcase, test_lookups);
    tcase_add_test(tcase, test_lookups_of_any_float);
    tcase_add_test(tcase, test_images_as_numbers);
    tcase_add_test(tcase, test_programs);
    tcase_add_test(tcase, test_program_check);
    tcase_add_test(tcase, test_mappings);
    tcase_add_test(tcase, test_checkerboards);
    tcase_add_test(tcase, test_image_ops);
    tcase_set_timeout(tcase, 30);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, texture_color_tcase());
    suite_add_tcase(suite, texture_files_tcase());
    suite_add_tcase(suite, texture_image_tcase());
    suite_add_tcase(suite, texture_procedural_tcase());
    return test_run(suite);
}
