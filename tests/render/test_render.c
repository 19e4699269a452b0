/* Whole images: analytic scenes, furnaces, determinism, references. */
#include "backend_cpu.h"
#include "film/pixel_order.h"
#include "layout/item.h"
#include "support/render_fixture.h"
#include "support/test_util.h"

#include <string.h>
#include <time.h>

#define CAMERA_INSIDE                                                                                                  \
    "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"                                             \
    "PixelFilter \"box\"\n"                                                                                            \
    "Camera \"perspective\" \"float fov\" 60\nWorldBegin\n"

/* ---- reconstruction ---------------------------------------------------------------------------------------------- */

/* Splats are spread unless the filter covers one pixel alone, is too wide, or counts of samples would overflow. */
START_TEST(test_reconstruction)
{
    static const struct {
        const char *filter;
        unsigned samples;
        uint expected;
    } CASES[] = {{"\"box\"", 1, RECONSTRUCTION_SAMPLE},
                 {"\"box\" \"float xradius\" 0.6", 1, RECONSTRUCTION_SPLAT},
                 {"\"triangle\" \"float yradius\" 8", 1, RECONSTRUCTION_SPLAT},
                 {"\"triangle\" \"float yradius\" 8.5", 1, RECONSTRUCTION_SAMPLE},
                 {"\"gaussian\"", 16711680, RECONSTRUCTION_SPLAT},
                 {"\"gaussian\"", 16711681, RECONSTRUCTION_SAMPLE}};
    char text[256];
    Scene scene;
    FrameParams frame;
    snprintf(text, sizeof text, "PixelFilter %s\nCamera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n",
             CASES[_i].filter);
    const RenderSetup setup = {.text = text};
    RenderOptions options = {.samples = CASES[_i].samples, .max_depth = 1, .reconstruction = RECONSTRUCTION_SPLAT};
    fixture_scene(&setup, &scene);
    render_frame(integrator_pt(), &scene, &options, &frame);
    ck_assert_uint_eq(frame.film.reconstruction, CASES[_i].expected);
    options.reconstruction = RECONSTRUCTION_SAMPLE;
    render_frame(integrator_pt(), &scene, &options, &frame);
    ck_assert_uint_eq(frame.film.reconstruction, RECONSTRUCTION_SAMPLE);
    scene_destroy(&scene);
}
END_TEST

/* Walks of the chains' pools and of bdpt end as early as their throughput says, those of ibpt later. */
START_TEST(test_roulette_of_integrators)
{
    static const struct {
        const char *name;
        float scale;
    } CASES[] = {{"pt", 1.0f}, {"ibpt", 2.0f}, {"bdpt", 1.0f}, {"mmlt", 1.0f}};
    const RenderSetup setup = {.text = "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"};
    const RenderOptions options = {.samples = 1, .max_depth = 1};
    Scene scene;
    FrameParams frame;
    Error error;
    fixture_scene(&setup, &scene);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        render_frame(integrator_find(CASES[i].name, &error), &scene, &options, &frame);
        ck_assert_float_eq(frame.path.roulette_scale, CASES[i].scale);
    }
    scene_destroy(&scene);
}
END_TEST

/* ---- the order of pixels ----------------------------------------------------------------------------------------- */

/* In bands, too, every pixel occurs once, whatever the last band's height. */
START_TEST(test_pixels_in_bands)
{
    static const uint SIZES[][2] = {{1, 1}, {1, 7}, {5, 1}, {6, 35}, {16, 16}, {77, 60}};
    const uint width = SIZES[_i][0], n = width * SIZES[_i][1];
    bool *seen = calloc(n, sizeof *seen);
    ck_assert_ptr_nonnull(seen);
    for (uint i = 0; i < n; ++i) {
        uint pixel = pixel_in_bands(i, width, n / width);
        ck_assert_uint_lt(pixel, n);
        ck_assert(!seen[pixel]);
        seen[pixel] = true;
    }
    free(seen);
}
END_TEST

/* Every pixel occurs once, and in large images neighbours are far apart in the order: a range of a tenth of the order
 * prefers no region. */
START_TEST(test_pixel_order)
{
    static const uint SIZES[][2] = {{1, 1},   {1, 7},     {5, 1},       {2, 2},       {6, 35},       {16, 16},
                                    {77, 60}, {400, 400}, {1920, 1080}, {8192, 8192}, {32768, 32767}};
    const uint width = SIZES[_i][0], height = SIZES[_i][1], n = width * height,
               stride = pixel_order_stride(width, height);
    uint a = stride, b = n;
    while (b != 0) {
        uint rest = a % b;
        a = b;
        b = rest;
    }
    ck_assert_uint_eq(a, 1);
    ck_assert(n == 1 || stride < n);
    if (n < 4000 || n > 1 << 21)
        return;
    uint *number = malloc(n * sizeof *number);
    ck_assert_ptr_nonnull(number);
    for (uint k = 0; k < n; ++k)
        number[(uint64_t)k * stride % n] = k;
    const int near[][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
    for (size_t i = 0; i < sizeof near / sizeof near[0]; ++i) {
        uint from = height / 2 * width + width / 2;
        uint to = from + (uint)(near[i][1] * (int)width + near[i][0]);
        uint apart = (number[to] + n - number[from]) % n;
        printf("%u x %u: pixel %d %d away is %.3f of the order later\n", width, height, near[i][0], near[i][1],
               (double)apart / n);
        ck_assert_uint_gt(apart, n / 10);
        ck_assert_uint_lt(apart, n - n / 10);
    }
    free(number);
}
END_TEST

/* Pools whose visits differ between cells: each visit of a pixel within a round is a different sample, also across the
 * start of the next round, and the number of visits matches the density ratio. For images with more and with fewer
 * pixels than cells, and for crop windows. */
START_TEST(test_visits)
{
    static const uint CROPS[][4] = {{0, 0, 1, 1}, {0, 0, 5, 90}, {3, 2, 36, 40}, {10, 0, 74, 64}, {1, 7, 200, 101}};
    static FrameParams frame;
    static Guide guide;
    frame = (FrameParams){.film.width = 210, .film.height = 120, .pass.sample_index = 7};
    frame.film.crop_x0 = CROPS[_i][0];
    frame.film.crop_y0 = CROPS[_i][1];
    frame.film.crop_x1 = CROPS[_i][2];
    frame.film.crop_y1 = CROPS[_i][3];
    const uint width = frame.film.crop_x1 - frame.film.crop_x0, height = frame.film.crop_y1 - frame.film.crop_y0,
               pixels = width * height;
    for (uint i = 0, all = 0; i <= IMPORTANCE_CELLS; ++i) {
        guide.visits[i] = all;
        if (i < IMPORTANCE_CELLS) {
            uint x = i % IMPORTANCE_SIDE, y = i / IMPORTANCE_SIDE;
            all += (cell_begin(x + 1, width) - cell_begin(x, width)) *
                   (cell_begin(y + 1, height) - cell_begin(y, height)) * (1 + i * 7 % VISITS_MOST);
        }
    }
    const uint all = frame.pool.visits = guide.visits[IMPORTANCE_CELLS], room = 2 * VISITS_MOST;
    frame.pass.pixel_stride = pixel_order_stride_of(all);
    frame.pass.pixel_first = all / 3;
    bool *seen = calloc((size_t)frame.film.width * frame.film.height * room, sizeof *seen);
    uint *counts = calloc((size_t)frame.film.width * frame.film.height, sizeof *counts);
    ck_assert(seen && counts);
    for (uint k = 0; k < all; ++k) {
        ItemPlace place = pool_item_place(&frame, &guide, k);
        uint x = place.pixel % frame.film.width, y = place.pixel / frame.film.width;
        ck_assert(x >= frame.film.crop_x0 && x < frame.film.crop_x1 && y >= frame.film.crop_y0 &&
                  y < frame.film.crop_y1);
        ck_assert(place.sample >= 7 && place.sample < 7 + room);
        bool *one = &seen[(size_t)place.pixel * room + place.sample - 7];
        ck_assert(!*one);
        *one = true;
        ++counts[place.pixel];
    }
    for (uint i = 0; i < frame.film.width * frame.film.height; ++i)
        if (counts[i] > 0)
            ck_assert_float_eq_tol(pool_density_ratio(&frame, &guide, i) * (float)counts[i], (float)all / (float)pixels,
                                   1e-5f * (float)all / (float)pixels);
    free(seen);
    free(counts);
}
END_TEST

/* ---- analytic scenes, to 0.5 % --------------------------------------------------------------------------------- */

/* Inside a sphere of emission L and albedo a, light bounces forever: the radiance is L / (1 - a) everywhere. */
START_TEST(test_emitting_sphere_inside)
{
    RenderedImage image;
    RenderSetup setup = {.text = CAMERA_INSIDE "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
                                               "ReverseOrientation\n"
                                               "AreaLightSource \"diffuse\" \"rgb L\" [ 0.5 0.5 0.5 ]\n"
                                               "Shape \"sphere\" \"float radius\" 2\n",
                         .samples = 512,
                         .max_depth = 40};
    fixture_render(&setup, &image);
    ck_assert_double_eq_tol(fixture_mean(&image), 1.0, 0.005);
    fixture_destroy(&image);
}
END_TEST

/* The same, truncated after d segments: L (1 + a + ... + a^(d-1)), which pins down what a segment is. */
START_TEST(test_emitting_sphere_depths)
{
    double expected = 0.0;
    for (int depth = 1; depth <= 4; ++depth) {
        RenderedImage image;
        RenderSetup setup = {.text = CAMERA_INSIDE "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
                                                   "ReverseOrientation\n"
                                                   "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n"
                                                   "Shape \"sphere\" \"float radius\" 2\n",
                             .samples = 256,
                             .max_depth = depth};
        expected += pow(0.5, depth - 1);
        fixture_render(&setup, &image);
        ck_assert_double_eq_tol(fixture_mean(&image), expected, 0.005 * expected);
        fixture_destroy(&image);
    }
}
END_TEST

/* A Lambertian sphere of albedo 0.5 and emission 0.5, seen from outside. In black space the radiance is 0.5 (it does
 * not see itself); in a constant environment of radiance 1 it is 0.5 + 0.5 = 1. */
START_TEST(test_lambert_sphere)
{
    RenderedImage image;
    RenderSetup setup = {.text = "LookAt 0 0 5  0 0 0  0 1 0\n"
                                 "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
                                 "PixelFilter \"box\"\n"
                                 "Camera \"perspective\" \"float fov\" 8\nWorldBegin\n"
                                 "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [ 0.5 0.5 0.5 ]\n"
                                 "Shape \"sphere\" \"float radius\" 1\n",
                         .samples = 512,
                         .max_depth = 10};
    fixture_render(&setup, &image);
    ck_assert_double_eq_tol(fixture_mean(&image), 1.0, 0.005);
    fixture_destroy(&image);
}
END_TEST

/* A point light of intensity I at height h over a Lambertian plane: the radiance straight below is a / pi * I / h^2. */
START_TEST(test_point_light_plane)
{
    RenderedImage image;
    RenderSetup setup = {.text = "LookAt 0 0 5  0 0 0  0 1 0\n"
                                 "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
                                 "PixelFilter \"box\"\n"
                                 "Camera \"perspective\" \"float fov\" 0.1\nWorldBegin\n"
                                 "LightSource \"point\" \"rgb I\" [ 20 20 20 ] \"point3 from\" [ 0 0 2 ]\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]\n"
                                 "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]\n",
                         .samples = 16,
                         .max_depth = 2};
    fixture_render(&setup, &image);
    ck_assert_double_eq_tol(fixture_mean(&image), 0.6 / M_PI * 20.0 / 4.0, 0.005);
    fixture_destroy(&image);
}
END_TEST

/* ---- furnaces ---------------------------------------------------------------------------------------------------- */

typedef struct FurnaceCase {
    const char *material;
    double low, high; /* bounds of the mean; 1 is all of the energy */
} FurnaceCase;

/* A sphere of a non-absorbing material in an environment of radiance 1. Single-scattering microfacet models lose what
 * would bounce between facets; none may gain. The figures of the rough conductors are from an independent Monte Carlo
 * estimate of E[G2 / G1] over the same view (0.9267 and 0.5273); those of the rough dielectrics are this program's own
 * and guard against change. */
static const FurnaceCase FURNACES[] = {
    {"Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]", 0.995, 1.005},
    {"Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0", 0.995, 1.005},
    {"Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0.2 \"bool remaproughness\" false",
     0.922, 0.932},
    {"Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0.8 \"bool remaproughness\" false",
     0.522, 0.533},
    {"Material \"dielectric\" \"float eta\" 1.5", 0.995, 1.005},
    {"Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.2 \"bool remaproughness\" false", 0.85, 0.87},
    {"Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.7 \"bool remaproughness\" false", 0.48, 0.50},
    {"Material \"thindielectric\" \"float eta\" 1.5", 0.995, 1.005},
    {"Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ] \"float thickness\" 0", 0.99, 1.005},
    {"Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ]", 0.85, 0.98}, /* the coat absorbs */
    {"Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ] \"float thickness\" 0 \"float roughness\" 0.3 "
     "\"bool remaproughness\" false",
     0.9, 1.005},
    {"Material \"diffusetransmission\" \"rgb reflectance\" [ 0.4 0.4 0.4 ] \"rgb transmittance\" [ 0.6 0.6 0.6 ]", 0.99,
     1.005},
    {"MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
     "MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0\n"
     "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3",
     0.995, 1.005},
};

START_TEST(test_furnace)
{
    char text[1024];
    RenderedImage image;
    snprintf(text, sizeof text,
             "LookAt 0 0 5  0 0 0  0 1 0\n"
             "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
             "PixelFilter \"box\"\n"
             "Camera \"perspective\" \"float fov\" 20\nWorldBegin\n"
             "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n%s\nShape \"sphere\" \"float radius\" 1\n",
             FURNACES[_i].material);
    RenderSetup setup = {.text = text, .samples = 256, .max_depth = 60};
    fixture_render(&setup, &image);
    double mean = fixture_mean(&image);
    ck_assert_msg(mean >= FURNACES[_i].low && mean <= FURNACES[_i].high, "%s: mean %g outside [%g, %g]",
                  FURNACES[_i].material, mean, FURNACES[_i].low, FURNACES[_i].high);
    fixture_destroy(&image);
}
END_TEST

/* ---- determinism ------------------------------------------------------------------------------------------------- */

static const char *const PUBLIC_SCENES[] = {"cornell-box/gray.pbrt", "veach-mis/gray.pbrt", "veach-bidir/gray.pbrt",
                                            "coffee/gray.pbrt"};
#define PUBLIC_SCENE_COUNT ((int)(sizeof PUBLIC_SCENES / sizeof PUBLIC_SCENES[0]))

static void films_equal(const Film *a, const Film *b)
{
    size_t pixels = (size_t)(a->crop[2] - a->crop[0]) * (size_t)(a->crop[3] - a->crop[1]);
    ck_assert_int_eq(a->quantum_exponent, b->quantum_exponent);
    for (size_t i = 0; i < 3 * pixels; ++i)
        ck_assert_msg(a->sums[i] == b->sums[i], "sum %zu differs: %lld and %lld", i, (long long)a->sums[i],
                      (long long)b->sums[i]);
    for (size_t i = 0; i < pixels; ++i)
        ck_assert_uint_eq(film_count(a, i), film_count(b, i));
}

START_TEST(test_same_bits_for_any_threads)
{
    static const int THREADS[] = {2, 3, 8};
    char path[1200];
    if (!test_public_scene(PUBLIC_SCENES[_i], path, sizeof path))
        return;
    RenderSetup setup = {.path = path, .width = 40, .height = 24, .samples = 4, .threads = 1, .seed = 7};
    RenderedImage one, other;
    fixture_render(&setup, &one);
    ck_assert(fixture_mean(&one) > 0.0);
    for (int i = 0; i < 3; ++i) {
        setup.threads = THREADS[i];
        fixture_render(&setup, &other);
        films_equal(&one.film, &other.film);
        ck_assert_int_eq(memcmp(one.rgb, other.rgb, sizeof(float) * 3 * 40 * 24), 0);
        fixture_destroy(&other);
    }
    fixture_destroy(&one);
}
END_TEST

START_TEST(test_same_bits_in_two_parts)
{
    char path[1200];
    Error error = {0};
    if (!test_public_scene(PUBLIC_SCENES[_i], path, sizeof path))
        return;
    RenderSetup setup = {.path = path, .width = 40, .height = 24, .samples = 7, .seed = 9};
    RenderedImage whole, first, second;
    fixture_render(&setup, &whole);
    setup.samples = 3;
    fixture_render(&setup, &first);
    setup.first_sample = 3;
    setup.samples = 4;
    setup.threads = 3;
    fixture_render(&setup, &second);
    ck_assert_msg(film_merge(&first.film, &second.film, &error), "%s", error.message);
    films_equal(&whole.film, &first.film);
    fixture_destroy(&whole);
    fixture_destroy(&first);
    fixture_destroy(&second);
}
END_TEST

/* Pixels of a crop window have the same bits as in the whole image, although most of its light is elsewhere. */
START_TEST(test_crop_has_the_bits_of_the_whole)
{
    static const int CROP[4] = {1, 2, 6, 9};
    char text[512];
    RenderedImage images[2];
    for (int i = 0; i < 2; ++i) {
        snprintf(text, sizeof text,
                 "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12 %s\n"
                 "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" \"float scale\" 1e-3\n"
                 "Translate 3 0 3\nAreaLightSource \"diffuse\" \"float scale\" 1e4\n"
                 "Shape \"sphere\" \"float radius\" 1\n",
                 i ? "\"integer pixelbounds\" [ 1 6 2 9 ]" : "");
        RenderSetup setup = {.text = text, .samples = 8};
        fixture_render(&setup, &images[i]);
    }
    const Film *whole = &images[0].film, *crop = &images[1].film;
    ck_assert_mem_eq(crop->crop, CROP, sizeof CROP);
    ck_assert_int_eq(whole->quantum_exponent, crop->quantum_exponent);
    for (int y = 2; y < 9; ++y)
        for (int k = 0; k < 15; ++k)
            ck_assert(crop->sums[15 * (y - 2) + k] == whole->sums[3 * (16 * y + 1) + k]);
    fixture_destroy(&images[0]);
    fixture_destroy(&images[1]);
}
END_TEST

/* ---- the length of passes ---------------------------------------------------------------------------------------- */

static double exchange_seconds; /* that a pass is said to have taken */
static uint items_most; /* of a pass */

/* A million items a second, without a picture. */
static bool steady_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                       const atomic_int *stop, uint64_t *items_done, Error *error)
{
    (void)backend, (void)list, (void)sink, (void)stop, (void)error;
    uint items = frame->pass.item_count;
    const struct timespec pause = {items / 1000000u, items % 1000000u * 1000L};
    nanosleep(&pause, NULL);
    items_most = items > items_most ? items : items_most;
    if (items_done)
        *items_done = items;
    return true;
}

static void exchanging_statistics(Backend *backend, BackendStatistics *statistics)
{
    backend_cpu()->statistics(backend, statistics);
    statistics->exchange.latest_seconds = exchange_seconds;
}

/* Passes take a quarter of a second, or 20 times as long as an exchange. */
START_TEST(test_passes_are_long_where_exchanges_are)
{
    BackendInterface steady = *backend_cpu();
    steady.run = steady_run;
    steady.statistics = exchanging_statistics;
    const RenderSetup setup = {.text = "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n",
                               .width = 100,
                               .height = 100,
                               .samples = 120,
                               .threads = 1,
                               .backend = &steady};
    static const double EXCHANGES[] = {0.0, 0.005, 0.05, 100.0};
    static const uint LEAST[] = {50000, 50000, 450000, 450000}, MOST[] = {420000, 420000, 1200000, 1200000};
    for (int i = 0; i < 4; ++i) {
        RenderedImage image;
        exchange_seconds = EXCHANGES[i];
        items_most = 0;
        fixture_render(&setup, &image);
        ck_assert_msg(items_most >= LEAST[i] && items_most <= MOST[i], "%u items with an exchange of %g s", items_most,
                      EXCHANGES[i]);
        fixture_destroy(&image);
    }
}
END_TEST

START_TEST(test_seeds_differ)
{
    static const char TEXT[] = CAMERA_INSIDE "Material \"diffuse\"\n"
                                             "LightSource \"point\" \"point3 from\" [ 0.2 0.9 0.1 ]\n"
                                             "Shape \"sphere\" \"float radius\" 2\n";
    RenderedImage a, b;
    RenderSetup setup = {.text = TEXT, .samples = 4, .seed = 1};
    fixture_render(&setup, &a);
    setup.seed = 1ull << 40;
    fixture_render(&setup, &b);
    ck_assert_int_ne(memcmp(a.rgb, b.rgb, sizeof(float) * 3 * 16 * 16), 0);
    fixture_destroy(&a);
    fixture_destroy(&b);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("render");
    TCase *analytic = tcase_create("analytic");
    tcase_set_timeout(analytic, 120);
    tcase_add_test(analytic, test_emitting_sphere_inside);
    tcase_add_test(analytic, test_emitting_sphere_depths);
    tcase_add_test(analytic, test_lambert_sphere);
    tcase_add_test(analytic, test_point_light_plane);
    suite_add_tcase(suite, analytic);
    TCase *furnace = tcase_create("furnace");
    tcase_set_timeout(furnace, 120);
    tcase_add_loop_test(furnace, test_furnace, 0, (int)(sizeof FURNACES / sizeof FURNACES[0]));
    suite_add_tcase(suite, furnace);
    TCase *determinism = tcase_create("determinism");
    tcase_set_timeout(determinism, 120);
    tcase_add_loop_test(determinism, test_same_bits_for_any_threads, 0, PUBLIC_SCENE_COUNT);
    tcase_add_loop_test(determinism, test_same_bits_in_two_parts, 0, PUBLIC_SCENE_COUNT);
    tcase_add_test(determinism, test_crop_has_the_bits_of_the_whole);
    tcase_add_test(determinism, test_seeds_differ);
    tcase_add_test(determinism, test_roulette_of_integrators);
    tcase_add_test(determinism, test_passes_are_long_where_exchanges_are);
    tcase_add_loop_test(determinism, test_pixels_in_bands, 0, 6);
    tcase_add_loop_test(determinism, test_reconstruction, 0, 6);
    tcase_add_loop_test(determinism, test_pixel_order, 0, 11);
    tcase_add_loop_test(determinism, test_visits, 0, 5);
    suite_add_tcase(suite, determinism);
    return test_run(suite);
}
