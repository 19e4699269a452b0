/* Noise against pbrt-v4's values and a model in double precision; the textures made of it, dots, mixes by direction and
 * bilinear interpolation against their formulas. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "geometry/texture.h"
#include "scene/texture_image.h"

#include <math.h>

TCase *texture_procedural_tcase(void);

/* A program's value; the mapping of 3-D textures is the identity. */
static Vec3 value_of(const TextureOp *ops, const TexturePoint *point)
{
    SceneView view = {.features = FEATURE_TEXTURE | FEATURE_PROCEDURAL, .texture_ops = ops};
    return texture_eval(&view, 0, point);
}

static TextureOp noise_op(uint code, uint octaves, float omega)
{
    return (TextureOp){.code = code,
                       .index = octaves,
                       .mapping = MAPPING_3D,
                       .uv_map = {omega},
                       .texture_from_world = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}};
}

static TexturePoint point_random(unsigned *state, double range)
{
    TexturePoint point = {.p = {0, 0, 0}};
    point.p.x = (float)((test_random_unit(state) - 0.5) * range);
    point.p.y = (float)((test_random_unit(state) - 0.5) * range);
    point.p.z = (float)((test_random_unit(state) - 0.5) * range);
    point.uv = vec2(point.p.y, point.p.z);
    return point;
}

/* ---- the model --------------------------------------------------------------------------------------------------- */

static double model_corner(long x, long y, long z, double dx, double dy, double dz)
{
    static const int GRADIENTS[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                         {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                         {1, 1, 0},  {-1, 1, 0},  {0, 1, -1}, {0, -1, -1}};
    int h = NOISE_PERMUTATION[x & 255];
    h = NOISE_PERMUTATION[(h + y) & 255];
    h = NOISE_PERMUTATION[(h + z) & 255] & 15;
    return GRADIENTS[h][0] * dx + GRADIENTS[h][1] * dy + GRADIENTS[h][2] * dz;
}

static double model_noise(double px, double py, double pz)
{
    double p[3] = {px, py, pz}, offset[3], fade[3], sum = 0.0;
    long cell[3];
    for (int k = 0; k < 3; ++k) {
        cell[k] = (long)floor(p[k]);
        offset[k] = p[k] - (double)cell[k];
        fade[k] = 6.0 * pow(offset[k], 5.0) - 15.0 * pow(offset[k], 4.0) + 10.0 * pow(offset[k], 3.0);
    }
    for (int i = 0; i < 8; ++i) {
        int bit[3] = {i & 1, i >> 1 & 1, i >> 2};
        double weight = 1.0;
        for (int k = 0; k < 3; ++k)
            weight *= bit[k] ? fade[k] : 1.0 - fade[k];
        sum += weight * model_corner(cell[0] + bit[0], cell[1] + bit[1], cell[2] + bit[2], offset[0] - bit[0],
                                     offset[1] - bit[1], offset[2] - bit[2]);
    }
    return sum;
}

static double model_octaves(Vec3 p, double omega, int octaves, bool absolute)
{
    double sum = 0.0, frequency = 1.0, weight = 1.0;
    for (int i = 0; i < octaves; ++i) {
        double n = model_noise((double)p.x * frequency, (double)p.y * frequency, (double)p.z * frequency);
        sum += weight * (absolute ? fabs(n) : n);
        frequency *= 1.99;
        weight *= omega;
    }
    return absolute ? sum + 0.2 * weight : sum;
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

/* Values that pbrt-v4's Noise has, and four octaves of it with weights of 0.5. */
START_TEST(test_noise_is_pbrts)
{
    static const struct {
        Vec3 p;
        float noise, octaves;
    } VALUES[] = {{{0.5f, 0.5f, 0.5f}, -0.125f, -0.115600795f},
                  {{0.25f, 1.75f, -2.125f}, -0.399733335f, -0.671242893f},
                  {{-7.30000019f, 100.599998f, 255.899994f}, 0.247526392f, 0.340762556f},
                  {{256.5f, -0.25f, 3.75f}, -0.0393266678f, 0.0727181733f},
                  {{-1000.125f, 12345.625f, 0.100000001f}, -0.200714245f, -0.184759766f},
                  {{31.8999996f, -256.700012f, -511.200012f}, 0.0808381438f, 0.375777721f}};
    for (size_t i = 0; i < sizeof VALUES / sizeof *VALUES; ++i) {
        TEST_NEAR(noise(VALUES[i].p), VALUES[i].noise, 2e-6);
        TEST_NEAR(noise_fbm(VALUES[i].p, 0.5f, 4), VALUES[i].octaves, 1e-5);
    }
}
END_TEST

START_TEST(test_noise_is_the_model)
{
    unsigned state = 3;
    double least = 0.0, most = 0.0;
    for (int i = 0; i < 100000; ++i) {
        TexturePoint point = point_random(&state, i % 2 ? 20.0 : 1200.0);
        double expected = model_noise((double)point.p.x, (double)point.p.y, (double)point.p.z);
        TEST_NEAR(noise(point.p), expected, 3e-6);
        least = fmin(least, expected);
        most = fmax(most, expected);
        Vec3 corner = vec3(floorf(point.p.x), floorf(point.p.y), floorf(point.p.z));
        ck_assert(noise(corner) == 0.0f);
    }
    printf("# noise: %.3f ... %.3f\n", least, most);
    static const float ODD[] = {NAN, INFINITY, -INFINITY, FLOAT_MAX, -FLOAT_MAX, 1e20f, 16777217.0f};
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 3; ++k) {
            float p[3] = {0.3f, 0.7f, 0.1f};
            p[k] = ODD[i];
            ck_assert(fabsf(noise(vec3(p[0], p[1], p[2]))) <= 1.5f);
        }
}
END_TEST

START_TEST(test_sums_of_octaves)
{
    unsigned state = 4;
    for (int i = 0; i < 3000; ++i) {
        TexturePoint point = point_random(&state, 10.0);
        int octaves = 1 + i % 6;
        float omega = 0.25f * (float)(i % 4);
        const TextureOp fbm[] = {noise_op(TEXTURE_FBM, (uint)octaves, omega), {0}};
        const TextureOp wrinkled[] = {noise_op(TEXTURE_WRINKLED, (uint)octaves, omega), {0}};
        const TextureOp windy[] = {noise_op(TEXTURE_WINDY, 0, 0.0f), {0}};
        TEST_NEAR(value_of(fbm, &point).x, model_octaves(point.p, (double)omega, octaves, false), 1e-3);
        TEST_NEAR(value_of(wrinkled, &point).y, model_octaves(point.p, (double)omega, octaves, true), 1e-3);
        double strength = model_octaves(vec3_scale(point.p, 0.1f), 0.5, 3, false);
        TEST_NEAR(value_of(windy, &point).z, fabs(strength) * model_octaves(point.p, 0.5, 6, false), 1e-3);
    }
}
END_TEST

/* Against de Casteljau's algorithm. */
START_TEST(test_marble)
{
    static const double COLORS[9][3] = {{.58, .58, .6}, {.58, .58, .6}, {.58, .58, .6}, {.5, .5, .5},  {.6, .59, .58},
                                        {.58, .58, .6}, {.58, .58, .6}, {.2, .2, .33},  {.58, .58, .6}};
    unsigned state = 5;
    TextureOp ops[] = {noise_op(TEXTURE_MARBLE, 4, 0.5f), {0}};
    ops[0].scale = 2.0f;
    ops[0].uv_map[1] = 0.75f;
    for (int i = 0; i < 5000; ++i) {
        TexturePoint point = point_random(&state, 8.0);
        Vec3 p = vec3_scale(point.p, 2.0f);
        double t = 6.0 * (0.5 + 0.5 * sin((double)p.y + 0.75 * model_octaves(p, 0.5, 4, false)));
        int first = t < 5.0 ? (int)t : 5;
        Vec3 found = value_of(ops, &point);
        const float got[3] = {found.x, found.y, found.z};
        for (int k = 0; k < 3; ++k) {
            double c[4];
            for (int j = 0; j < 4; ++j)
                c[j] = COLORS[first + j][k];
            for (int level = 3; level > 0; --level)
                for (int j = 0; j < level; ++j)
                    c[j] = (1.0 - (t - first)) * c[j] + (t - first) * c[j + 1];
            TEST_NEAR(got[k], 1.5 * c[0], 2e-3);
        }
    }
}
END_TEST

START_TEST(test_dots)
{
    unsigned state = 6;
    int inside = 0, all = 0;
    const TextureOp ops[] = {{.code = TEXTURE_CONSTANT, .value = {1, 2, 3}},
                             {.code = TEXTURE_CONSTANT, .value = {4, 5, 6}},
                             {.code = TEXTURE_DOTS, .uv_map = {2.0f, 1.0f, 0.0f, 0.5f}},
                             {0}};
    for (int i = 0; i < 40000; ++i) {
        TexturePoint point = point_random(&state, 40.0);
        double st[2] = {2.0 * (double)point.uv.x, (double)point.uv.y + 0.5};
        double s = floor(st[0] + 0.5), t = floor(st[1] + 0.5);
        double x = s + 0.15 * model_noise(s + 1.5, (double)((float)t + 2.8f), 0.5);
        double y = t + 0.15 * model_noise(s + 4.5, (double)((float)t + 9.8f), 0.5);
        double away = hypot(st[0] - x, st[1] - y) - 0.35, drawn = model_noise(s + 0.5, t + 0.5, 0.5);
        if (fabs(away) < 1e-4 || fabs(drawn) < 1e-6 || fabs(st[0] + 0.5 - rint(st[0] + 0.5)) < 1e-4)
            continue;
        bool expected = away < 0.0 && drawn > 0.0;
        ck_assert_msg((value_of(ops, &point).x == 1.0f) == expected, "(%g, %g)", st[0], st[1]);
        inside += expected;
        ++all;
    }
    ck_assert_int_gt(inside, all / 10);
    ck_assert_int_lt(inside, all / 2);
}
END_TEST

/* The first texture where the normal lies along the direction, on either side. */
START_TEST(test_direction_mix)
{
    const TextureOp ops[] = {{.code = TEXTURE_CONSTANT, .value = {1, 0, 3}},
                             {.code = TEXTURE_CONSTANT, .value = {0, 1, 7}},
                             {.code = TEXTURE_DIRECTION_MIX, .value = {0.0f, 0.6f, 0.8f}},
                             {0}};
    static const struct {
        Vec3 n;
        float amount;
    } CASES[] = {{{0.0f, 0.6f, 0.8f}, 1.0f},
                 {{0.0f, -0.6f, -0.8f}, 1.0f},
                 {{1.0f, 0.0f, 0.0f}, 0.0f},
                 {{0.0f, 1.0f, 0.0f}, 0.6f},
                 {{0.0f, 0.0f, -1.0f}, 0.8f}};
    for (int i = 0; i < 5; ++i) {
        TexturePoint point = {.n = CASES[i].n};
        Vec3 c = value_of(ops, &point);
        TEST_NEAR(c.x, CASES[i].amount, 1e-6);
        TEST_NEAR(c.y, 1.0f - CASES[i].amount, 1e-6);
        TEST_NEAR(c.z, 7.0f - 4.0f * CASES[i].amount, 1e-5);
    }
}
END_TEST

/* The corners, a point inside, one outside; a value that was on the stack before stays there. */
START_TEST(test_bilerp)
{
    TextureOp ops[8] = {{.code = TEXTURE_CONSTANT, .value = {10, 10, 10}}};
    static const float CORNERS[4] = {1.0f, 2.0f, 4.0f, 9.0f}; /* v00 v10 v01 v11 */
    for (int i = 0; i < 4; ++i)
        ops[i + 1] = (TextureOp){.code = TEXTURE_CONSTANT, .value = {CORNERS[i], 0, 0}};
    ops[5] = (TextureOp){.code = TEXTURE_BILERP, .uv_map = {1.0f, 1.0f}};
    ops[6] = (TextureOp){.code = TEXTURE_SCALE};
    ck_assert_uint_eq(texture_program_depth(ops, 8), 5);
    static const float AT[6][3] = {{0, 0, 1}, {1, 0, 2}, {0, 1, 4}, {1, 1, 9}, {0.25f, 0.5f, 3.25f}, {2, 0, 3}};
    for (int i = 0; i < 6; ++i) {
        TexturePoint point = {.uv = {AT[i][0], AT[i][1]}};
        TEST_NEAR(value_of(ops, &point).x, 10.0f * AT[i][2], 1e-5);
    }
}
END_TEST

TCase *texture_procedural_tcase(void)
{
    TCase *tcase = tcase_create("procedural");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_noise_is_pbrts);
    tcase_add_test(tcase, test_noise_is_the_model);
    tcase_add_test(tcase, test_sums_of_octaves);
    tcase_add_test(tcase, test_marble);
    tcase_add_test(tcase, test_dots);
    tcase_add_test(tcase, test_direction_mix);
    tcase_add_test(tcase, test_bilerp);
    return tcase;
}
