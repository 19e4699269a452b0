/* Warps from the square: chi-square against the density, numerical Jacobian, continuity, unit length. */
#include "math/test_math.h"

#include "math/rng.h"
#include "math/warp.h"

#define SAMPLES 400000
#define ROWS 16
#define COLUMNS 32
#define CELLS (ROWS * COLUMNS)
#define P_MIN 1e-4 /* a dozen chi-square tests in this file: 1e-3 overall after Sidak */

typedef struct DirectionWarp {
    const char *name;
    Vec3 (*sample)(Vec2 u);
    float (*pdf)(Vec3 d); /* with respect to solid angle */
} DirectionWarp;

static float cosine_pdf(Vec3 d)
{
    return warp_cosine_hemisphere_pdf(d.z);
}

static float sphere_pdf(Vec3 d)
{
    (void)d;
    return INV_4PI;
}

static Vec3 cone_wide(Vec2 u)
{
    return warp_cone(u, 0.7f);
}

static float cone_wide_pdf(Vec3 d)
{
    return 1.0f - d.z <= 0.7f ? warp_cone_pdf(0.7f) : 0.0f;
}

static Vec3 cone_sphere(Vec2 u)
{
    return warp_cone(u, 2.0f);
}

static Vec3 equirectangular(Vec2 u)
{
    return equirectangular_to_sphere(u);
}

static const DirectionWarp DIRECTION_WARPS[] = {
    {"cosine hemisphere", warp_cosine_hemisphere, cosine_pdf},
    {"sphere", warp_sphere, sphere_pdf},
    {"cone 0.7", cone_wide, cone_wide_pdf},
    {"cone 2", cone_sphere, sphere_pdf},
    {"octahedral", octahedral_to_sphere, sphere_pdf},
    {"equirectangular", equirectangular, equirectangular_pdf},
};
#define DIRECTION_WARP_COUNT ((int)(sizeof DIRECTION_WARPS / sizeof DIRECTION_WARPS[0]))

static int sphere_cell(double z, double phi)
{
    int row = (int)((z + 1.0) * 0.5 * ROWS), column = (int)((phi / (2.0 * M_PI) + (phi < 0.0 ? 1.0 : 0.0)) * COLUMNS);
    row = row < ROWS ? row : ROWS - 1;
    return row * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1);
}

/* SAMPLES times the integral of the density over each cell of the (z, phi) grid, by the midpoint rule in theta and phi:
 * the equirectangular density times sin(theta) has no pole. */
static void sphere_expected(const DirectionWarp *warp, double *expected)
{
    enum { SUB_THETA = 120, SUB_PHI = 4 };
    double d_phi = 2.0 * M_PI / (COLUMNS * SUB_PHI);
    for (int i = 0; i < ROWS * SUB_THETA; ++i)
        for (int j = 0; j < COLUMNS * SUB_PHI; ++j) {
            double row = i / SUB_THETA, low = acos(2.0 * row / ROWS - 1.0), high = acos(2.0 * (row + 1.0) / ROWS - 1.0);
            double theta = low + (high - low) * (i % SUB_THETA + 0.5) / SUB_THETA, phi = (j + 0.5) * d_phi;
            Vec3 d = vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
            double solid_angle = sin(theta) * (low - high) / SUB_THETA * d_phi;
            expected[i / SUB_THETA * COLUMNS + j / SUB_PHI] += SAMPLES * solid_angle * (double)warp->pdf(d);
        }
}

START_TEST(test_direction_chi_square)
{
    const DirectionWarp *warp = &DIRECTION_WARPS[_i];
    static double observed[CELLS], expected[CELLS];
    sphere_expected(warp, expected);
    double total = 0.0;
    for (int i = 0; i < CELLS; ++i)
        total += expected[i];
    test_require(fabs(total / SAMPLES - 1.0) < 0.005, "%s: the density integrates to %g", warp->name, total / SAMPLES);
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, (uint)_i, 3u);
        Vec3 d = warp->sample(vec2(random_float(r.x[0]), random_float(r.x[1])));
        test_require(fabsf(vec3_length(d) - 1.0f) < 4e-7f, "%s: length %.9g", warp->name, (double)vec3_length(d));
        observed[sphere_cell((double)d.z, atan2((double)d.y, (double)d.x))] += 1.0;
    }
    double p = test_chi_square(observed, expected, CELLS);
    test_require(p > P_MIN, "%s: p = %g", warp->name, p);
}
END_TEST

/* Area of the image of a small square times the density, divided by the area of the square. */
static double warp_jacobian(const DirectionWarp *warp, Vec2 u, float h)
{
    Vec3 right = vec3_sub(warp->sample(vec2(u.x + h, u.y)), warp->sample(vec2(u.x - h, u.y)));
    Vec3 up = vec3_sub(warp->sample(vec2(u.x, u.y + h)), warp->sample(vec2(u.x, u.y - h)));
    double area = (double)vec3_length(vec3_cross(right, up)) / (4.0 * (double)(h * h));
    return area * (double)warp->pdf(warp->sample(u));
}

/* Points near a crease or a pole of a map, which are left out. */
static bool near_crease(Vec2 u)
{
    float a = float_abs(2.0f * u.x - 1.0f), b = float_abs(2.0f * u.y - 1.0f);
    return float_abs(a - b) < 0.05f || a < 0.05f || b < 0.05f || a > 0.9f || b > 0.9f ||
           float_abs(a + b - 1.0f) < 0.05f;
}

START_TEST(test_direction_jacobian)
{
    const DirectionWarp *warp = &DIRECTION_WARPS[_i];
    uint64_t state = 9;
    for (int i = 0; i < 20000; ++i) {
        Vec2 u = vec2(test_uniform(&state), test_uniform(&state));
        double jacobian = near_crease(u) ? 1.0 : warp_jacobian(warp, u, 0x1p-8f);
        test_require(fabs(jacobian - 1.0) < 0.01, "%s at (%g, %g): %g", warp->name, (double)u.x, (double)u.y, jacobian);
    }
}
END_TEST

/* Cones down to a solid angle of 1e-14: (1 - cos) / (1 - cos_max), recomputed from x and y, and phi are uniform. */
START_TEST(test_cone_tiny)
{
    static const float CONES[] = {1e-30f, 1e-14f, 1e-7f, 1e-3f, 1.0f};
    static double observed[CELLS], expected[CELLS];
    float omc = CONES[_i];
    for (int i = 0; i < CELLS; ++i)
        expected[i] = (double)SAMPLES / CELLS;
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, (uint)_i, 4u);
        Vec3 d = warp_cone(vec2(random_float(r.x[0]), random_float(r.x[1])), omc);
        test_require(fabsf(vec3_length(d) - 1.0f) < 4e-7f, "fabsf(vec3_length(d) - 1.0f) < 4e-7f");
        double sine2 = (double)d.x * (double)d.x + (double)d.y * (double)d.y;
        double share = sine2 / (1.0 + sqrt(fmax(1.0 - sine2, 0.0))) / (double)omc;
        test_require(share < 1.000001, "share < 1.000001");
        observed[sphere_cell(2.0 * share - 1.0, atan2((double)d.y, (double)d.x))] += 1.0;
    }
    double p = test_chi_square(observed, expected, CELLS);
    test_require(p > P_MIN, "cone %g: p = %g", (double)omc, p);
    test_require(fabs((double)warp_cone_pdf(omc) * 2.0 * M_PI * (double)omc - 1.0) < 1e-6,
                 "fabs((double)warp_cone_pdf(omc) * 2.0 * M_PI * (double)omc - 1.0) < 1e-6");
}
END_TEST

START_TEST(test_disk)
{
    static double observed[CELLS], expected[CELLS];
    for (int i = 0; i < CELLS; ++i)
        expected[i] = (double)SAMPLES / CELLS;
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, 0u, 5u);
        Vec2 d = warp_disk_concentric(vec2(random_float(r.x[0]), random_float(r.x[1])));
        double r2 = (double)d.x * (double)d.x + (double)d.y * (double)d.y;
        test_require(r2 < 1.0 + 1e-7, "r2 < 1.0 + 1e-7");
        observed[sphere_cell(2.0 * r2 - 1.0, atan2((double)d.y, (double)d.x))] += 1.0;
    }
    test_require(test_chi_square(observed, expected, CELLS) > P_MIN,
                 "test_chi_square(observed, expected, CELLS) > P_MIN");
    Vec2 center = warp_disk_concentric(vec2(0.5f, 0.5f)), right = warp_disk_concentric(vec2(1.0f, 0.5f));
    test_require(center.x == 0.0f && center.y == 0.0f && right.x == 1.0f && right.y == 0.0f,
                 "center.x == 0.0f && center.y == 0.0f && right.x == 1.0f && right.y == 0.0f");
}
END_TEST

/* 32 x 32 cells of (b1, b2); those on the diagonal are half inside. */
START_TEST(test_triangle)
{
    enum { SIDE = 32 };
    static double observed[SIDE * SIDE], expected[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; ++i) {
        int sum = i / SIDE + i % SIDE;
        expected[i] = 2.0 * SAMPLES / (SIDE * SIDE) * (sum < SIDE - 1 ? 1.0 : sum == SIDE - 1 ? 0.5 : 0.0);
    }
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, 0u, 6u);
        Vec2 b = warp_triangle(vec2(random_float(r.x[0]), random_float(r.x[1])));
        test_require(b.x >= 0.0f && b.y >= 0.0f && b.x + b.y <= 1.0f,
                     "b.x >= 0.0f && b.y >= 0.0f && b.x + b.y <= 1.0f");
        observed[(int)(b.y * SIDE) * SIDE + (int)(b.x * SIDE)] += 1.0;
    }
    test_require(test_chi_square(observed, expected, SIDE * SIDE) > P_MIN,
                 "test_chi_square(observed, expected, SIDE * SIDE) > P_MIN");
}
END_TEST

static Vec3 disk_as_vec3(Vec2 u)
{
    Vec2 d = warp_disk_concentric(u);
    return vec3(d.x, d.y, 0.0f);
}

/* Round trip, for points that include the square's border, diagonals and centre. */
START_TEST(test_disk_inverse)
{
    uint64_t state = 12;
    for (int i = 0; i < 200000; ++i) {
        Vec2 u = vec2(test_uniform(&state), test_uniform(&state));
        if (i % 4 == 1)
            u.y = i % 8 == 1 ? u.x : 1.0f - u.x;
        if (i % 4 == 2)
            u.x = i % 8 == 2 ? 0.0f : 1.0f;
        if (i % 4 == 3)
            u.y = 0.5f;
        Vec2 back = warp_disk_inverse(warp_disk_concentric(u));
        test_require(fabsf(back.x - u.x) < 1e-6f && fabsf(back.y - u.y) < 1e-6f, "(%g, %g) becomes (%g, %g)",
                     (double)u.x, (double)u.y, (double)back.x, (double)back.y);
    }
    Vec2 middle = warp_disk_inverse(vec2(0.0f, 0.0f)), beyond = warp_disk_inverse(vec2(-1.1f, 0.0f));
    ck_assert(middle.x == 0.5f && middle.y == 0.5f);
    ck_assert(beyond.x == 0.0f && beyond.y == 0.5f);
}
END_TEST

static Vec3 triangle_as_vec3(Vec2 u)
{
    Vec2 b = warp_triangle(u);
    return vec3(b.x, b.y, 0.0f);
}

/* Distance on the image over distance in the square, for small random steps: bounded also across creases, where a map
 * with a seam would jump. */
START_TEST(test_continuous)
{
    static Vec3 (*const MAPS[])(Vec2) = {disk_as_vec3, triangle_as_vec3, cone_wide, octahedral_to_sphere};
    uint64_t state = 10;
    for (int i = 0; i < 200000; ++i) {
        Vec2 u = vec2(0.002f + 0.996f * test_uniform(&state), 0.002f + 0.996f * test_uniform(&state));
        if (i % 2)
            u.y = i % 4 == 1 ? u.x : 0.5f; /* a crease */
        Vec2 step = vec2(0.001f * (2.0f * test_uniform(&state) - 1.0f), 0.001f * (2.0f * test_uniform(&state) - 1.0f));
        float length = sqrtf(step.x * step.x + step.y * step.y);
        for (size_t m = 0; m < sizeof MAPS / sizeof MAPS[0]; ++m) {
            Vec3 moved = vec3_sub(MAPS[m](vec2(u.x + step.x, u.y + step.y)), MAPS[m](u));
            test_require(vec3_length(moved) <= 8.0f * length + 1e-6f, "map %zu at (%g, %g): %g for %g", m, (double)u.x,
                         (double)u.y, (double)vec3_length(moved), (double)length);
        }
    }
}
END_TEST

/* The corners and edges of the square that random_float can reach. */
START_TEST(test_extremes)
{
    static const float EDGES[] = {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f, 1.0f};
    for (int i = 0; i < 25; ++i) {
        Vec2 u = vec2(EDGES[i / 5], EDGES[i % 5]);
        for (int w = 0; w < DIRECTION_WARP_COUNT; ++w) {
            Vec3 d = DIRECTION_WARPS[w].sample(u);
            test_require(vec3_finite(d) && fabsf(vec3_length(d) - 1.0f) < 4e-7f,
                         "vec3_finite(d) && fabsf(vec3_length(d) - 1.0f) < 4e-7f");
        }
        if (i / 5 % 4 != 0 && i % 5 % 4 != 0)
            test_require(warp_cosine_hemisphere(u).z > 0.0f, "warp_cosine_hemisphere(u).z > 0.0f");
    }
}
END_TEST

TCase *test_math_warp(void)
{
    TCase *tcase = tcase_create("warp");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_loop_test(tcase, test_direction_chi_square, 0, DIRECTION_WARP_COUNT);
    tcase_add_loop_test(tcase, test_direction_jacobian, 0, DIRECTION_WARP_COUNT);
    tcase_add_loop_test(tcase, test_cone_tiny, 0, 5);
    tcase_add_test(tcase, test_disk);
    tcase_add_test(tcase, test_triangle);
    tcase_add_test(tcase, test_disk_inverse);
    tcase_add_test(tcase, test_continuous);
    tcase_add_test(tcase, test_extremes);
    return tcase;
}
