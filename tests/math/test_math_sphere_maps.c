/* The two image parametrisations of the sphere: orientation, inverses, precision. */
#include "math/test_math.h"

#include "math/warp.h"

static void assert_near(double value, double expected, double tolerance, const char *what)
{
    test_require(fabs(value - expected) <= tolerance, "%s: %.9g, expected %.9g", what, value, expected);
}

/* Directions and their positions in the square: pbrt-v4's convention (+z in the middle, -z in the corners, the other
 * axes in the middle of the edges) and points computed by hand from Clarberg's formula: r = sqrt(1 - |z|), and phi from
 * 0 to pi/2 maps to v / r from 0 to 1. */
static const float OCTAHEDRAL[][5] = {
    {0, 0, 1, 0.5f, 0.5f},
    {1, 0, 0, 1, 0.5f},
    {-1, 0, 0, 0, 0.5f},
    {0, 1, 0, 0.5f, 1},
    {0, -1, 0, 0.5f, 0},
    {0, 0, -1, 1, 1},
    {0.70710678f, 0.70710678f, 0, 0.75f, 0.75f},
    {0.70710678f, -0.70710678f, 0, 0.75f, 0.25f},
    {0.96824584f, 0, 0.25f, 0.93301270f, 0.5f}, /* r = sqrt(3)/2, phi = 0 */
    {-0.86602540f, 0, -0.5f, 0, 0.64644661f}, /* r = sqrt(1/2): |u| = 1, |v| = 1 - r */
    {0.57735027f, 0.57735027f, 0.57735027f, 0.66252877f, 0.66252877f},
};

START_TEST(test_octahedral_points)
{
    for (size_t i = 0; i < sizeof OCTAHEDRAL / sizeof OCTAHEDRAL[0]; ++i) {
        const float *p = OCTAHEDRAL[i];
        Vec2 uv = sphere_to_octahedral(vec3(p[0], p[1], p[2]));
        assert_near((double)uv.x, (double)p[3], 2e-7, "u");
        assert_near((double)uv.y, (double)p[4], 2e-7, "v");
        Vec3 d = octahedral_to_sphere(vec2(p[3], p[4]));
        assert_near((double)d.x, (double)p[0], 5e-7, "x");
        assert_near((double)d.y, (double)p[1], 5e-7, "y");
        assert_near((double)d.z, (double)p[2], 5e-7, "z");
    }
}
END_TEST

/* The formula evaluated independently in double, quadrant by quadrant. */
static void octahedral_double(double u, double v, double *d)
{
    double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0, x = fabs(a), y = fabs(b);
    bool lower = x + y > 1.0;
    if (lower) {
        double swap = x;
        x = 1.0 - y;
        y = 1.0 - swap;
    }
    double r = x + y, phi = r > 0.0 ? y / r * 0.5 * M_PI : 0.0;
    d[2] = (lower ? -1.0 : 1.0) * (1.0 - r * r);
    d[0] = copysign(sqrt(1.0 - d[2] * d[2]) * cos(phi), a);
    d[1] = copysign(sqrt(1.0 - d[2] * d[2]) * sin(phi), b);
}

START_TEST(test_octahedral_both_ways)
{
    uint64_t state = 20;
    for (int i = 0; i < 500000; ++i) {
        Vec2 uv = vec2(test_uniform(&state), test_uniform(&state));
        if (i % 4 == 0) /* close to the middle, where 1 - |z| would cancel */
            uv = vec2(0.5f + 1e-5f * (uv.x - 0.5f), 0.5f + 1e-5f * (uv.y - 0.5f));
        Vec3 d = octahedral_to_sphere(uv);
        double exact[3];
        octahedral_double((double)uv.x, (double)uv.y, exact);
        assert_near((double)d.x, exact[0], 4e-7, "x");
        assert_near((double)d.y, exact[1], 4e-7, "y");
        assert_near((double)d.z, exact[2], 4e-7, "z");
        Vec2 back = sphere_to_octahedral(d);
        test_require(back.x >= 0.0f && back.x <= 1.0f && back.y >= 0.0f && back.y <= 1.0f,
                     "back.x >= 0.0f && back.x <= 1.0f && back.y >= 0.0f && back.y <= 1.0f");
        assert_near((double)back.x, (double)uv.x, 3e-7, "u again");
        assert_near((double)back.y, (double)uv.y, 3e-7, "v again");
    }
}
END_TEST

START_TEST(test_equirectangular_points)
{
    static const float POINTS[][5] = {
        {1, 0, 0, 0, 0.5f},      {0, 1, 0, 0.25f, 0.5f}, {-1, 0, 0, 0.5f, 0.5f},
        {0, -1, 0, 0.75f, 0.5f}, {0, 0, 1, 0, 0},        {0, 0, -1, 0, 1},
    };
    for (size_t i = 0; i < sizeof POINTS / sizeof POINTS[0]; ++i) {
        const float *p = POINTS[i];
        Vec2 uv = sphere_to_equirectangular(vec3(p[0], p[1], p[2]));
        assert_near((double)uv.x, (double)p[3], 1e-7, "u");
        assert_near((double)uv.y, (double)p[4], 1e-7, "v");
        Vec3 d = equirectangular_to_sphere(vec2(p[3], p[4]));
        assert_near((double)d.x, (double)p[0], 2e-7, "x");
        assert_near((double)d.y, (double)p[1], 2e-7, "y");
        assert_near((double)d.z, (double)p[2], 2e-7, "z");
    }
    Vec2 seam = sphere_to_equirectangular(vec3(1.0f, -1e-30f, 0.0f));
    test_require(seam.x >= 0.0f && seam.x < 1.0f,
                 "seam.x >= 0.0f && seam.x < 1.0f"); /* the texel before or after the seam, never outside */
}
END_TEST

START_TEST(test_equirectangular_both_ways)
{
    uint64_t state = 21;
    for (int i = 0; i < 500000; ++i) {
        Vec2 uv = vec2(test_uniform(&state), test_uniform(&state));
        if (i % 4 == 0)
            uv.y *= 1e-4f; /* near the pole: acos(z) would have an error of 1e-4 */
        Vec3 d = equirectangular_to_sphere(uv);
        double theta = M_PI * (double)uv.y, phi = 2.0 * M_PI * (double)uv.x;
        assert_near((double)d.x, sin(theta) * cos(phi), 5e-7, "x");
        assert_near((double)d.y, sin(theta) * sin(phi), 5e-7, "y");
        assert_near((double)d.z, cos(theta), 3e-7, "z");
        Vec2 back = sphere_to_equirectangular(d);
        test_require(back.x >= 0.0f && back.x < 1.0f && back.y >= 0.0f && back.y <= 1.0f,
                     "back.x >= 0.0f && back.x < 1.0f && back.y >= 0.0f && back.y <= 1.0f");
        assert_near((double)back.y, (double)uv.y, 2e-7, "v again");
        double turn = (double)(back.x - uv.x);
        assert_near(turn - round(turn), 0.0, 3e-7, "u again");
        assert_near((double)equirectangular_pdf(d) * 2.0 * M_PI * M_PI * sin(theta), 1.0, 1e-6 + 4e-7 / sin(theta),
                    "density");
    }
}
END_TEST

TCase *test_math_sphere_maps(void)
{
    TCase *tcase = tcase_create("sphere maps");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_test(tcase, test_octahedral_points);
    tcase_add_test(tcase, test_octahedral_both_ways);
    tcase_add_test(tcase, test_equirectangular_points);
    tcase_add_test(tcase, test_equirectangular_both_ways);
    return tcase;
}
