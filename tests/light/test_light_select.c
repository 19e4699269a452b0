/* Light selection probabilities, and scenes without lights. */
#include "base/log.h"
#include "light/test_light.h"
#include "support/light_fixture.h"

/* The powers of three lights at infinity, divided anew: a quarter by power, the rest by power over the root of the
 * solid angle. */
static void divide_expected(double *powers, const double *solid_angles)
{
    double all = 0.0, concentrated = 0.0;
    for (int i = 0; i < 3; ++i) {
        all += powers[i];
        concentrated += powers[i] / sqrt(solid_angles[i]);
    }
    for (int i = 0; i < 3; ++i)
        powers[i] = 0.25 * powers[i] + 0.75 * all * (powers[i] / sqrt(solid_angles[i])) / concentrated;
}

/* Lights are chosen by power, those at infinity among themselves also by solid angle; with the far ones bright, those
 * together as often as all others. */
START_TEST(test_powers)
{
    const float bright = _i == 0 ? 1.0f : 0.1f;
    LightFixture f;
    fixture_init(&f);
    f.scene.frame.scene.world_radius = 2.0f;
    static const float square[12] = {0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 1, 0};
    static const float texels[3 * 8] = {1, 1, 1, 1, 1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 1, 1, 1, 1, 1, 1};
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    fixture_add_polygon(&f, square, 4, NULL, 0, 0);
    fixture_add_polygon(&f, square, 3, NULL, 0, LIGHT_TWO_SIDED);
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}});
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {0, 0, 0}});
    fixture_add_light(
        &f,
        (LightData){.kind = LIGHT_SPOT, .emission = {1, 1, 1}, .detail.cos_total = 0.5f, .detail.cos_falloff = 0.75f});
    fixture_add_light(&f, (LightData){.kind = LIGHT_DISTANT,
                                      .emission = {0.5f * bright, 0.5f * bright, 0.5f * bright},
                                      .detail.direction = {0, 0, 1}});
    fixture_add_light(&f,
                      (LightData){.kind = LIGHT_INFINITE, .emission = {0.1f * bright, 0.1f * bright, 0.1f * bright}});
    fixture_add_environment(&f, texels, 4, 2, LIGHT_EQUIRECTANGULAR, identity);
    ARRAY_AT(&f.scene.lights, Light, 7).emission = vec3_splat(0.05f * bright);
    fixture_finish(&f);
    /* pbrt-v4's power estimates. The hemispheres of the image average to 2. */
    double expected[8] = {2.0 * M_PI,
                          2.0 * M_PI,
                          4.0 * M_PI,
                          0.0,
                          2.0 * M_PI * (0.25 + 0.125),
                          0.5 * M_PI * 4.0,
                          0.1 * 4.0 * M_PI * M_PI * 4.0,
                          0.05 * 2.0 * 4.0 * M_PI * M_PI * 4.0};
    double total = 0.0, near = 0.0, observed[8] = {0.0}, counts[8];
    enum { SAMPLES = 200000, FIRST_FAR = 5 };
    for (int i = 0; i < 8; ++i) {
        expected[i] *= i >= FIRST_FAR ? (double)bright : 1.0;
        total += expected[i];
        near += i < FIRST_FAR ? expected[i] : 0.0;
    }
    ck_assert((near < total - near) == (_i == 0));
    /* Of the image, whose interpolated cells are 2 - 9/16 and 2 + 9/16. */
    static const double spread = 2.0 * 2.0 / (2.0 * 2.0 + 9.0 / 16.0 * 9.0 / 16.0);
    divide_expected(&expected[FIRST_FAR], (const double[3]){6.8e-5, 4.0 * M_PI, 4.0 * M_PI * spread});
    for (int i = FIRST_FAR; _i == 0 && i < 8; ++i)
        expected[i] *= near / (total - near);
    total = _i == 0 ? 2.0 * near : total;
    for (int i = 0; i < 8; ++i) {
        double pdf = (double)ARRAY_AT(&f.scene.lights, Light, i).select_pdf;
        ck_assert_msg(fabs(pdf - expected[i] / total) < 1e-6, "light %d: %g, not %g", i, pdf, expected[i] / total);
        counts[i] = expected[i] / total * SAMPLES;
    }
    for (uint i = 0; i < SAMPLES; ++i) {
        Random4 r = random_four(i, 0, 0, 0, 77, 0);
        observed[light_select(&f.view, r.x[0], r.x[1])] += 1.0;
    }
    ck_assert_double_eq(observed[3], 0.0);
    ck_assert_double_gt(test_chi_square(observed, counts, 8), 1e-3);
    fixture_destroy(&f);
}
END_TEST

/* A sky alone, and beside a light of a fifth of its power: a distant one, the image of a sun, and an equirectangular
 * image whose light comes from 45 degrees around one pole. */
START_TEST(test_sun_and_sky)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    enum { SIDE = 256, BLOCK = 4 };
    float *texels = calloc((size_t)3 * SIDE * SIDE, sizeof *texels);
    const double sky_power = 4.0 * M_PI * M_PI, cap = 2.0 * M_PI * (1.0 - sqrt(0.5)),
                 texel = 4.0 * M_PI / (SIDE * SIDE);
    /* Interpolation makes a block of 4 texels as wide as 4.49, by the means of the light and of its square. */
    const double wide = 4.0 * 4.0 / (2.0 * (0.875 * 0.875 + 0.125 * 0.125 + 1.0));
    const double angles[4] = {4.0 * M_PI, 6.8e-5, texel * wide * wide, cap}, tolerance = _i == 3 ? 3e-3 : 1e-5;
    LightFixture f;
    fixture_init(&f);
    f.scene.frame.scene.world_radius = 1.0f;
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {1, 1, 1}});
    if (_i == 1)
        fixture_add_light(&f, (LightData){.kind = LIGHT_DISTANT,
                                          .emission = vec3_splat(0.8f * (float)M_PI),
                                          .detail.direction = {0, 0, 1}});
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            bool block = abs(2 * x + 1 - SIDE) < BLOCK && abs(2 * y + 1 - SIDE) < BLOCK;
            double value = _i == 2 ? block * 0.2 * SIDE * SIDE / (BLOCK * BLOCK) : (y < SIDE / 4) * 0.8 * M_PI / cap;
            for (int c = 0; c < 3; ++c)
                texels[3 * (y * SIDE + x) + c] = (float)value;
        }
    if (_i >= 2)
        fixture_add_environment(&f, texels, SIDE, SIDE, _i == 3 ? LIGHT_EQUIRECTANGULAR : 0, identity);
    fixture_finish(&f);
    ck_assert_double_lt(fabs(f.scene.light_power / sky_power - (_i == 0 ? 1.0 : 1.2)), tolerance);
    double sky = (double)ARRAY_AT(&f.scene.lights, Light, 0).select_pdf, expected = 1.0;
    if (_i != 0) {
        double other = 0.2 / sqrt(angles[_i]), own = 1.0 / sqrt(4.0 * M_PI);
        expected = 0.25 / 1.2 + 0.75 * own / (other + own);
    }
    ck_assert_msg(fabs(sky - expected) < tolerance, "sky: %g, not %g", sky, expected);
    /* What arrives from a cone counts at a vertex, as if that faced it; of the sky, a quarter of its 4 pi. */
    const double facing[4] = {0.0, 1.0, 1.0 - angles[2] / (4.0 * M_PI), 1.0 - cap / (4.0 * M_PI)};
    double choice = (double)light_choice_pdf(&f.view, 0, vec3(0, 0, 0), vec3(0, 0, 1));
    expected = 0.25 / (0.25 + 0.2 * facing[_i]);
    ck_assert_msg(fabs(choice - expected) < 1e-3, "sky at a vertex: %g, not %g", choice, expected);
    fixture_destroy(&f);
    free(texels);
}
END_TEST

static void drop_line(const char *line, void *context)
{
    (void)line;
    (void)context;
}

START_TEST(test_no_light)
{
    LightFixture f;
    Error error = {0};
    fixture_init(&f);
    log_sink_set(drop_line, NULL);
    ck_assert(!light_setup(&f.scene, &error));
    ck_assert_str_eq(error.message, "error: the scene has no light");
    ck_assert(error.fix[0] != '\0');
    static const float black[3 * 2] = {0};
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    fixture_add_environment(&f, black, 2, 1, LIGHT_EQUIRECTANGULAR, identity);
    ck_assert(!light_setup(&f.scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the scene has no light"));
    /* Next to another light, the black one does not count as a light. */
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}});
    fixture_finish(&f);
    LightSample s;
    ck_assert_uint_eq(f.scene.infinite_lights.count, 0);
    ck_assert_uint_eq(light_select(&f.view, 0, 0), 1);
    ck_assert_uint_eq(light_select(&f.view, ~0u, ~0u), 1);
    ck_assert(!light_sample(&f.view, 0, vec3(0, 0, 0), vec2(0.5f, 0.5f), &s));
    ck_assert((light_pdf_w(&f.view, 0, vec3(0, 0, 0), vec3(0, 0, 1), NULL) == 0.0f));
    log_sink_set(NULL, NULL);
    fixture_destroy(&f);
}
END_TEST

START_TEST(test_not_finite)
{
    LightFixture f;
    Error error = {0};
    static const float bad[3 * 2] = {1, 1, 1, 1, INFINITY, 1};
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    fixture_init(&f);
    fixture_add_environment(&f, bad, 2, 1, LIGHT_EQUIRECTANGULAR, identity);
    ck_assert(!light_setup(&f.scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "texel (1, 0)"));
    f.scene.lights.count = 0;
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, NAN, 1}});
    ck_assert(!light_setup(&f.scene, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "power is not finite"));
    fixture_destroy(&f);
}
END_TEST

TCase *light_select_case(void)
{
    TCase *tcase = tcase_create("choice of lights");
    tcase_add_loop_test(tcase, test_powers, 0, 2);
    tcase_add_loop_test(tcase, test_sun_and_sky, 0, 4);
    tcase_add_test(tcase, test_no_light);
    tcase_add_test(tcase, test_not_finite);
    return tcase;
}
