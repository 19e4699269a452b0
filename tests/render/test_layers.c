/* Layers of an image: variances, halves, albedo, normal, depth, and the despeckled image. */
#include "camera/film_sum.h"
#include "image/despeckle.h"
#include "render/layers.h"
#include "support/render_fixture.h"

#include "support/test_util.h"

#include <string.h>

/* ---- mean and variance of a sequence ----------------------------------------------------------------------------- */

/* Against the explicit formulas, for weights of very different size; the second pixel has no value in some images. */
START_TEST(test_series)
{
    const float values[4][2] = {{1.0f, 10.0f}, {2.0f, -1e6f}, {4.0f, 13.0f}, {-3.0f, 11.5f}};
    const uint32_t weights[4][2] = {{1, 2}, {10, 0}, {3, 1}, {100, 5}};
    PixelSeries series;
    Error error = {0};
    ck_assert(pixel_series_init(&series, 2, 1, false, &error));
    for (int g = 0; g < 4; ++g)
        pixel_series_add(&series, values[g], weights[g], 0.5);
    for (size_t pixel = 0; pixel < 2; ++pixel) {
        double sum = 0.0, mean = 0.0, spread = 0.0;
        int seen = 0;
        for (int g = 0; g < 4; ++g) {
            sum += 0.5 * weights[g][pixel];
            mean += 0.5 * weights[g][pixel] * (double)values[g][pixel];
            seen += weights[g][pixel] > 0;
        }
        mean /= sum;
        for (int g = 0; g < 4; ++g)
            spread += 0.5 * weights[g][pixel] * pow((double)values[g][pixel] - mean, 2.0);
        ck_assert_double_eq_tol((double)series.mean[pixel], mean, 1e-5 * fabs(mean));
        ck_assert_double_eq_tol(pixel_series_spread(&series, pixel), spread / (seen - 1), 1e-4 * spread);
        ck_assert_double_eq_tol(pixel_series_variance(&series, pixel), spread / (seen - 1) / sum, 1e-4 * spread / sum);
    }
    pixel_series_destroy(&series);
}
END_TEST

/* Weights that all pixels have more are like larger weights. */
START_TEST(test_series_counted)
{
    const float values[2][3] = {{1.0f, 2.0f, 3.0f}, {4.0f, 1.0f, 5.0f}};
    const uint32_t few[2][3] = {{0, 1, 2}, {3, 0, 1}}, many[2][3] = {{4, 5, 6}, {7, 4, 5}};
    PixelSeries counted, series;
    Error error;
    ck_assert(pixel_series_init(&counted, 3, 1, false, &error) && pixel_series_init(&series, 3, 1, false, &error));
    for (int i = 0; i < 2; ++i) {
        pixel_series_add_counted(&counted, values[i], few[i], 4);
        pixel_series_add(&series, values[i], many[i], 1.0);
    }
    for (size_t pixel = 0; pixel < 3; ++pixel) {
        TEST_TRUE(pixel_series_weight(&counted, pixel) == pixel_series_weight(&series, pixel));
        TEST_TRUE(pixel_series_spread(&counted, pixel) == pixel_series_spread(&series, pixel));
        TEST_TRUE(counted.mean[pixel] == series.mean[pixel]);
    }
    pixel_series_destroy(&counted);
    pixel_series_destroy(&series);
}
END_TEST

/* Two series say together what one of all their images does. */
START_TEST(test_series_together)
{
    const float values[5] = {1.0f, 7.0f, -3.0f, 4.0f, 2.5f};
    const double weights[5] = {1.0, 0.5, 20.0, 3.0, 7.0};
    PixelSeries all, parts[2];
    Error error = {0};
    ck_assert(pixel_series_init(&all, 1, 1, true, &error));
    for (int i = 0; i < 2; ++i)
        ck_assert(pixel_series_init(&parts[i], 1, 1, true, &error));
    for (int g = 0; g < 5; ++g) {
        pixel_series_add(&all, &values[g], NULL, weights[g]);
        pixel_series_add(&parts[g < _i ? 0 : 1], &values[g], NULL, weights[g]);
    }
    PixelStatistics one = pixel_series_statistics(&all, NULL, 0),
                    both = pixel_series_statistics(&parts[0], &parts[1], 0);
    ck_assert_uint_eq(both.pictures, 5);
    ck_assert_double_eq_tol(both.weight, one.weight, 1e-5);
    ck_assert_double_eq_tol(both.mean, one.mean, 1e-5);
    ck_assert_double_eq_tol(both.spread, one.spread, 1e-4 * one.spread);
    pixel_series_destroy(&all);
    for (int i = 0; i < 2; ++i)
        pixel_series_destroy(&parts[i]);
}
END_TEST

/* ---- specks ------------------------------------------------------------------------------------------------------ */

START_TEST(test_despeckle)
{
    enum { WIDTH = 5, HEIGHT = 4 };
    float rgb[3 * WIDTH * HEIGHT], out[3 * WIDTH * HEIGHT];
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = 1.0f + 0.01f * (float)i;
    const size_t corner = 0, inner = 1 * WIDTH + 3, bright = 3 * WIDTH + 1;
    rgb[3 * corner] = 50.0f;
    rgb[3 * inner + 1] = 4.5f; /* luminance 3.5: just over three times as bright */
    rgb[3 * bright + 2] = 9.0f; /* luminance 1.7 */
    despeckle(rgb, WIDTH, HEIGHT, 0, HEIGHT, 3.0f, out);
    for (size_t i = 0; i < WIDTH * HEIGHT; ++i) {
        bool speck = i == corner || i == inner;
        ck_assert_int_eq(memcmp(rgb + 3 * i, out + 3 * i, 3 * sizeof *rgb) != 0, speck);
        ck_assert(!speck || (out[3 * i] >= 1.0f && out[3 * i] < 1.2f && out[3 * i] == out[3 * i + 1]));
    }
}
END_TEST

/* ---- albedo, normal, depth --------------------------------------------------------------------------------------- */

/* A wall of albedo 0.2, 0.5, 0.7 that turns its back to +z, at distance 5 along the axis, up to a height. */
#define WALL_TO(height)                                                                                                \
    "LookAt 0 0 0  0 0 1  0 1 0\n"                                                                                     \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"                                               \
    "PixelFilter \"box\"\n"                                                                                            \
    "Camera \"perspective\" \"float fov\" 40\n"                                                                        \
    "WorldBegin\n"                                                                                                     \
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"                                                                   \
    "Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.5 0.7 ]\n"                                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 5  9 -9 5  -9 " height " 5  9 " height " 5 ]\n"

/* Up to the middle of the image. */
static const char WALL[] = WALL_TO("0");

/* Up to the middle of the fifth row of pixels. */
static const char LOW_WALL[] = WALL_TO("-0.227481");

START_TEST(test_variables)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt(), integrator_mmlt()};
    RenderLayers layers = {.wanted = LAYERS_AOV};
    RenderedImage image;
    float albedo[3 * 64], normal[3 * 64], depth[3 * 64];
    fixture_render(&(RenderSetup){.text = WALL, .samples = 64, .integrator = integrators[_i], .layers = &layers},
                   &image);
    aov_image_resolve(&layers.aovs[AOV_ALBEDO], 0, 64, albedo);
    aov_image_resolve(&layers.aovs[AOV_NORMAL], 0, 64, normal);
    aov_image_resolve(&layers.aovs[AOV_DEPTH], 0, 64, depth);
    const float wall[3] = {0.2f, 0.5f, 0.7f}, toward[3] = {0.0f, 0.0f, -1.0f};
    for (size_t i = 0; i < 64; ++i) {
        bool met = i >= 32; /* the lower half */
        double x = ((double)(i % 8) + 0.5 - 4.0) / 4.0 * tan(0.349066),
               y = ((double)(i / 8) + 0.5 - 4.0) / 4.0 * tan(0.349066);
        for (size_t c = 0; c < 3; ++c) {
            TEST_NEAR(albedo[3 * i + c], met ? wall[c] : 0.0f, 1e-6);
            TEST_NEAR(normal[3 * i + c], met ? toward[c] : 0.0f, 1e-6);
        }
        /* Within a pixel the distance varies by less than 0.04. */
        TEST_NEAR(depth[3 * i], met ? 5.0 * sqrt(1.0 + x * x + y * y) : 0.0, 0.04);
    }
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

/* Where a wall ends, alpha is the part of the pixel that it covers; an environment is everywhere. The distance is the
 * mean of the rays that meet the wall. */
START_TEST(test_alpha)
{
    RenderLayers layers = {.wanted = LAYER_BIT(LAYER_ALBEDO) | LAYER_BIT(LAYER_DEPTH) | LAYER_BIT(LAYER_ALPHA)};
    RenderedImage image;
    float alpha[3 * 64], depth[3 * 64];
    char text[sizeof LOW_WALL + 64];
    const char *light = strstr(LOW_WALL, "LightSource \"infinite\""), *rest = strchr(light, '\n');
    snprintf(text, sizeof text, "%.*s%s%s", (int)(light - LOW_WALL), LOW_WALL,
             _i == 0 ? "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ]" : "LightSource \"infinite\"", rest);
    fixture_render(&(RenderSetup){.text = text, .samples = 8, .layers = &layers}, &image);
    aov_image_resolve(&layers.aovs[AOV_ALPHA], 0, 64, alpha);
    aov_image_resolve(&layers.aovs[AOV_DEPTH], 0, 64, depth);
    for (size_t i = 0; i < 64; ++i) {
        TEST_NEAR(alpha[3 * i], _i == 1 || i >= 40 ? 1.0f : i < 32 ? 0.0f : 0.5f, 0.0);
        TEST_TRUE(i < 32 || depth[3 * i] > 4.99f); /* the wall is at 5 */
    }
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

/* Samples are stratified: exactly half of them meet a wall that covers half of a pixel. */
START_TEST(test_variables_edge)
{
    RenderLayers layers = {.wanted = LAYERS_AOV};
    RenderedImage image;
    float albedo[3 * 64];
    fixture_render(&(RenderSetup){.text = LOW_WALL, .samples = 64, .integrator = integrator_mmlt(), .layers = &layers},
                   &image);
    aov_image_resolve(&layers.aovs[AOV_ALBEDO], 0, 64, albedo);
    for (size_t i = 0; i < 64; ++i)
        TEST_NEAR(albedo[3 * i + 1], i < 32 ? 0.0f : i < 40 ? 0.25f : 0.5f, 1e-6);
    ck_assert_uint_eq(layers.aov_samples, 8);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

/* So is path tracing, across generations: direct light at the edge of the wall is closer to the truth than that of
 * independent samples, whose standard deviation is half the difference of both sides over the root of their number. */
START_TEST(test_direct_edge)
{
    RenderedImage image;
    double square = 0.0;
    fixture_render(&(RenderSetup){.text = LOW_WALL, .samples = 200, .integrator = integrator_mmlt()}, &image);
    double samples = (double)film_count(&image.film, 32);
    for (size_t i = 32; i < 40; ++i)
        square += pow((double)image.rgb[3 * i + 1] - 0.75, 2.0) / 8.0;
    double independent = 0.25 * 0.25 / samples;
    printf("edge: %.0f samples, variance %.3g of independent ones\n", samples, square / independent);
    ck_assert_double_gt(samples, 50.0);
    ck_assert_double_lt(square, 0.2 * independent);
    fixture_destroy(&image);
}
END_TEST

/* The first picture that is saved is that of a sample per pixel of path tracing, before chains have run, and all of
 * path tracing's samples, these too, are in the last. */
START_TEST(test_first)
{
    RenderLayers layers = {.wanted = LAYERS_AOV};
    RenderedImage image;
    float saved[3 * 64];
    const char *scene = WALL_TO("9");
    fixture_render(
        &(RenderSetup){.text = scene, .samples = 6, .integrator = integrator_mmlt(), .layers = &layers, .saved = saved},
        &image);
    ck_assert_uint_ge(layers.aov_samples, 2);
    ck_assert_uint_lt(layers.aov_samples, 8);
    double first = 0.0, all = 0.0;
    for (size_t i = 0; i < 3 * 64; ++i) {
        ck_assert_uint_eq(film_count(&image.film, i / 3), layers.aov_samples);
        first += (double)saved[i];
        all += (double)image.rgb[i];
    }
    printf("first picture: %.3f times the light of the last\n", first / all);
    TEST_NEAR(first / all, 1.0, 0.1);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

/* ---- halves and variance ----------------------------------------------------------------------------------------- */

/* The two halves have the image's film size, and all sums are sums of theirs. */
START_TEST(test_halves)
{
    char path[512];
    RenderLayers layers = {.wanted = LAYERS_ALL};
    RenderedImage image;
    snprintf(path, sizeof path, "%s/scenes/cornell.pbrt", test_source_folder());
    fixture_render(&(RenderSetup){.path = path,
                                  .width = 24,
                                  .height = 18,
                                  .samples = 200,
                                  .integrator = integrator_mmlt(),
                                  .layers = &layers},
                   &image);
    const Film *film = &image.film, *a = &layers.halves[0], *b = &layers.halves[1];
    for (size_t i = 0; i < 3 * film_pixels(film); ++i) {
        TEST_TRUE(film->sums[i] == a->sums[i] + b->sums[i]);
        TEST_TRUE(film->light_sums[i] == a->light_sums[i] + b->light_sums[i]);
        TEST_TRUE(film_count(film, i / 3) == film_count(a, i / 3) + film_count(b, i / 3));
        TEST_TRUE(film_count(a, i / 3) > 0 && film_count(b, i / 3) > 0);
    }
    ck_assert_uint_eq(film->light_samples, a->light_samples + b->light_samples);
    double part = (double)a->light_samples / (double)film->light_samples;
    printf("halves: the first has %.3f of the work\n", part);
    ck_assert(part > 0.3 && part < 0.7);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

/* Halves are compared only if their errors are independent: their path tracing is then of two stratified sequences, and
 * of one if none are wanted, which is less noise. So layers of halves and of variance change the image of direct light;
 * others do not. */
START_TEST(test_sequences)
{
    const Layer wanted[] = {LAYER_HALVES, LAYER_VARIANCE, LAYER_DIRECT, LAYER_ALBEDO};
    char path[512];
    RenderLayers layers = {.wanted = LAYER_BIT(wanted[_i])};
    RenderedImage image, plain;
    RenderSetup setup = {
        .path = path, .width = 24, .height = 18, .samples = 40, .max_depth = 2, .integrator = integrator_mmlt()};
    snprintf(path, sizeof path, "%s/scenes/cornell.pbrt", test_source_folder());
    fixture_render(&setup, &plain);
    setup.layers = &layers;
    fixture_render(&setup, &image);
    bool equal = memcmp(image.film.sums, plain.film.sums, 3 * film_pixels(&image.film) * sizeof(int64_t)) == 0;
    ck_assert_int_eq(equal, _i >= 2);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
    fixture_destroy(&plain);
}
END_TEST

/* Layers by depth add up to the indirect layer, up to the rounding of individual sums; also for chains alone. The image
 * equals the one without such layers, up to rounding of paths that contribute at several depths; so long as no trial of
 * bidirectional path tracing, of which there are no layers by depth, takes a part of the work. */
START_TEST(test_by_depth)
{
    char path[512];
    double largest = 0.0, other = 0.0;
    RenderLayers layers = {.wanted = LAYER_BIT(LAYER_BY_DEPTH)};
    RenderedImage image, plain;
    RenderSetup setup = {.path = path,
                         .width = 24,
                         .height = 18,
                         .samples = 199,
                         .max_depth = 6,
                         .integrator = integrator_mmlt(),
                         .chains = {.chains_only = _i == 1}};
    snprintf(path, sizeof path, "%s/scenes/glossy.pbrt", test_source_folder());
    fixture_render(&setup, &plain);
    setup.layers = &layers;
    fixture_render(&setup, &image);
    const Film *film = &image.film;
    ck_assert_uint_eq(film->depth_last, 6);
    for (size_t i = 0; i < 3 * film_pixels(film); ++i) {
        double sum = 0.0, light = (double)film->light_sums[i];
        for (uint segments = 3; segments <= 6; ++segments)
            sum += (double)film_depth_sums(film, segments, FILM_KIND_LIGHT)[i];
        largest = fmax(largest, fabs(sum - light) / (fabs(light) + (double)film->light_samples));
        other = fmax(other, fabs((double)(image.rgb[i] - plain.rgb[i])) / (fabs((double)plain.rgb[i]) + 1e-2));
    }
    printf("by depth: off by %.2g, the picture by %.2g\n", largest, other);
    ck_assert_double_lt(largest, 1e-4);
    ck_assert_double_lt(other, 1e-5);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
    fixture_destroy(&plain);
}
END_TEST

/* The variance layer equals the variance of pixels over seeds, averaged over the image. */
START_TEST(test_variance)
{
    enum { RUNS = 12, WIDTH = 16, HEIGHT = 12, VALUES = 3 * WIDTH * HEIGHT };
    double sum[VALUES] = {0}, square[VALUES] = {0}, stated = 0.0, found = 0.0;
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/cornell.pbrt", test_source_folder());
    for (uint64_t seed = 0; seed < RUNS; ++seed) {
        RenderLayers layers = {.wanted = LAYER_BIT(LAYER_VARIANCE)};
        RenderedImage image;
        float variance[VALUES];
        fixture_render(&(RenderSetup){.path = path,
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .samples = 2000,
                                      .seed = seed,
                                      .integrator = integrator_mmlt(),
                                      .layers = &layers},
                       &image);
        render_layers_variance(&layers, 1.0f, 0, layers.own[0].pixels, variance);
        for (size_t i = 0; i < VALUES; ++i) {
            sum[i] += (double)image.rgb[i];
            square[i] += (double)image.rgb[i] * (double)image.rgb[i];
            stated += (double)variance[i] / RUNS / VALUES;
        }
        render_layers_destroy(&layers);
        fixture_destroy(&image);
    }
    for (size_t i = 0; i < VALUES; ++i)
        found += (square[i] - sum[i] * sum[i] / RUNS) / (RUNS - 1) / VALUES;
    printf("variance: %.4g stated, %.4g found over %d seeds\n", stated, found, RUNS);
    /* From twelve seeds and some hundred values it is known to about a tenth. */
    ck_assert_double_gt(stated, 0.6 * found);
    ck_assert_double_lt(stated, 1.6 * found);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("layers");
    TCase *tcase = tcase_create("layers");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_series_counted);
    tcase_add_test(tcase, test_series);
    tcase_add_loop_test(tcase, test_series_together, 0, 6); /* 0: the first is empty, 5: the second */
    tcase_add_test(tcase, test_despeckle);
    tcase_add_loop_test(tcase, test_variables, 0, 3);
    tcase_add_loop_test(tcase, test_alpha, 0, 2);
    tcase_add_test(tcase, test_variables_edge);
    tcase_add_test(tcase, test_direct_edge);
    tcase_add_test(tcase, test_first);
    tcase_add_test(tcase, test_halves);
    tcase_add_loop_test(tcase, test_sequences, 0, 4);
    tcase_add_loop_test(tcase, test_by_depth, 0, 2);
    suite_add_tcase(suite, tcase);
    TCase *variance = tcase_create("variance");
    tcase_set_timeout(variance, 120.0);
    tcase_set_tags(variance, "pictures");
    tcase_add_test(variance, test_variance);
    suite_add_tcase(suite, variance);
    return test_run(suite);
}
