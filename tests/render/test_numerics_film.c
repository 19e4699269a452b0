/* Borders with every filter, lights of any brightness, tangent frames without texture coordinates, shapes of zero area,
 * and NaN and infinity. */
#include "support/numerics.h"

#include "backend_cpu.h"

#include <stdlib.h>
#include <string.h>

/* ---- borders ----------------------------------------------------------------------------------------------------- */

/* Inside a sphere of emission 0.5 and albedo 0.5: every pixel is 0.5 + 0.25 + ... with one term per segment. */
#define CONSTANT_SCENE                                                                                                 \
    "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 10\nPixelFilter %s\n"                             \
    "LookAt 0.3 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n"                              \
    "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\nReverseOrientation\n"                                   \
    "AreaLightSource \"diffuse\" \"rgb L\" [ 0.5 0.5 0.5 ]\nShape \"sphere\" \"float radius\" 2\n"

/* Mean and standard error, over groups, of the border pixels or of the others. */
static void border_mean(const PictureGroups *picture, bool border, double *mean, double *error)
{
    double sum = 0.0, squares = 0.0;
    for (int g = 0; g < picture->groups; ++g) {
        double one = 0.0;
        int count = 0;
        for (int y = 0; y < picture->height; ++y)
            for (int x = 0; x < picture->width; ++x)
                if ((x == 0 || y == 0 || x == picture->width - 1 || y == picture->height - 1) == border) {
                    one += picture->values[(g * picture->height + y) * picture->width + x];
                    ++count;
                }
        sum += one / count;
        squares += one / count * (one / count);
    }
    *mean = sum / picture->groups;
    *error = sqrt(fmax(squares / picture->groups - *mean * *mean, 0.0) / (picture->groups - 1));
}

START_TEST(test_borders)
{
    static const unsigned SAMPLES[] = {64, 16, 96};
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt(), integrator_mmlt()};
    const int depth = 4;
    const double expected = 0.5 + 0.25 + 0.125 + 0.0625;
    char text[1024];
    snprintf(text, sizeof text, CONSTANT_SCENE, BIDIRECTIONAL_FILTERS[_i]);
    for (int i = 0; i < 3; ++i) {
        PictureGroups picture;
        double mean[2], error[2];
        GroupSetup setup = {
            .groups = 16,
            .render = {
                .text = text, .samples = SAMPLES[i], .max_depth = depth, .threads = 2, .integrator = integrators[i]}};
        groups_render(&setup, &picture);
        ck_assert(picture.sound);
        for (int border = 0; border < 2; ++border)
            border_mean(&picture, border == 1, &mean[border], &error[border]);
        printf("%s, %s: inner pixels %.5f +- %.5f, border %.5f +- %.5f, expected %.4f\n", BIDIRECTIONAL_FILTERS[_i],
               integrators[i]->name, mean[0], error[0], mean[1], error[1], expected);
        for (int border = 0; border < 2; ++border) {
            /* 36 values in all: p = 0.01 for any of them, by Student's distribution with 15 degrees of freedom. */
            ck_assert_double_le(fabs(mean[border] - expected), 5.1 * error[border] + 1e-7); /* rounding */
            ck_assert_double_le(error[border], 0.02 * expected);
        }
        groups_destroy(&picture);
    }
}
END_TEST

/* ---- brightness -------------------------------------------------------------------------------------------------- */

/* A point light in smooth glass, which path tracing cannot find: of any brightness, and with a dim environment. */
#define ENCLOSED_SCENE                                                                                                 \
    BD_BEGIN "%sLightSource \"point\" \"point3 from\" [ 0 -0.4 0 ] \"rgb I\" [ %g %g %g ]\n" BD_GREY BD_FLOOR          \
             "Material \"dielectric\" \"float eta\" 1.5\n" BD_BALL

#define DIM "LightSource \"infinite\" \"rgb L\" [ 1e-4 1e-4 1e-4 ]\n"

static void enclosed_render(const Integrator *integrator, unsigned samples, const char *more, double intensity,
                            PictureGroups *picture)
{
    char text[2048];
    snprintf(text, sizeof text, ENCLOSED_SCENE, more, intensity, intensity, intensity);
    GroupSetup setup = {
        .groups = 8,
        .render = {.text = text, .samples = samples, .max_depth = 4, .threads = 2, .integrator = integrator}};
    groups_render(&setup, picture);
}

/* The image is as bright as the light, whatever part of it path tracing finds. */
START_TEST(test_brightness)
{
    static const struct {
        const char *more;
        double intensity;
    } LIGHTS[] = {{"", 1e-9}, {"", 1.0}, {"", 1e6}, {"", 1e7}, {DIM, 1e4}};
    const Integrator *const integrators[] = {integrator_ibpt(), integrator_bdpt(), integrator_mmlt()};
    const Integrator *integrator = integrators[_i];
    double mean[2], error[2];
    PictureGroups expected, got;
    enclosed_render(integrator_bdpt(), 128, "", 1.0, &expected);
    groups_block(&expected, 0, 0, 16, 16, &mean[0], &error[0]);
    groups_destroy(&expected);
    for (size_t k = 0; k < sizeof LIGHTS / sizeof LIGHTS[0]; ++k) {
        double intensity = LIGHTS[k].intensity;
        enclosed_render(integrator, integrator == integrator_mmlt() ? 1024 : 64, LIGHTS[k].more, intensity, &got);
        groups_block(&got, 0, 0, 16, 16, &mean[1], &error[1]);
        double ratio = mean[1] / intensity / mean[0];
        double deviation = hypot(error[0] / mean[0], error[1] / (intensity * mean[0]));
        printf("%s, intensity %g%s: mean %.5g, over that of 1 %.4f +- %.4f\n", integrator->name, intensity,
               LIGHTS[k].more[0] ? " beside 1e-4" : "", mean[1], ratio, deviation);
        ck_assert(got.sound);
        ck_assert_double_le(deviation, 0.02);
        /* 15 values: p = 0.01 for any of them, by Student's distribution with 7 degrees of freedom. */
        ck_assert_double_le(fabs(ratio - 1.0), 5.8 * deviation);
        groups_destroy(&got);
    }
}
END_TEST

/* If the pilot is black, the quantum is derived from the lights' power; a crop window uses the whole image's. */
START_TEST(test_quantum_of_pilot)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_ibpt(), integrator_bdpt(), integrator_mmlt()};
    const int crop[4] = {0, 0, 4, 4};
    int exponents[4][3];
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
            double intensity = k == 1 ? 0x1p40 : 1.0;
            char text[2048];
            Error error = {0};
            Film film;
            RenderResult result;
            Scene scene;
            snprintf(text, sizeof text, ENCLOSED_SCENE, "", intensity, intensity, intensity);
            const RenderSetup setup = {.text = text, .threads = 1 + k};
            const RenderOptions options = {.samples = 1, .max_depth = 4};
            fixture_scene(&setup, &scene);
            if (k == 2)
                ck_assert(scene_film_set(&scene, 16, 16, crop, &error));
            Backend *backend = fixture_open(&setup, &scene, &error);
            ck_assert_msg(backend != NULL, "%s", error.message);
            ck_assert(film_init(&film, 16, 16, scene.settings.crop, &error));
            const RenderTask task = {.integrator = integrators[i],
                                     .scene = &scene,
                                     .backend = {backend_cpu(), backend},
                                     .options = &options};
            ck_assert_msg(render_film(&task, &film, &result, &error), "%s", error.message);
            exponents[i][k] = film.quantum_exponent;
            ck_assert_int_eq(exponents[i][k], exponents[i][0] + (k == 1 ? 40 : 0));
            backend_cpu()->close(backend);
            film_destroy(&film);
            scene_destroy(&scene);
        }
    printf("units of path tracing, which sees nothing, and of the others: 2^%d 2^%d 2^%d 2^%d\n", exponents[0][0],
           exponents[1][0], exponents[2][0], exponents[3][0]);
    ck_assert_int_le(abs(exponents[0][0] - exponents[2][0]), 10);
}
END_TEST

/* A quantum so small that sums of chains, pools and path tracing are full: none wraps, full pixels are counted, and the
 * result is the same for any number of threads. */
START_TEST(test_full_chains)
{
    const Film fine = {.quantum_exponent = -80};
    RenderedImage one, three;
    RenderSetup setup = {.text = BD_ROOM BD_BALL,
                         .samples = 32,
                         .max_depth = 5,
                         .threads = 1,
                         .integrator = integrator_mmlt(),
                         .quantum_of = &fine};
    fixture_render(&setup, &one);
    setup.threads = 3;
    fixture_render(&setup, &three);
    ck_assert_uint_gt(one.film.saturated, 0);
    ck_assert_uint_eq(one.film.saturated, three.film.saturated);
    ck_assert_uint_gt(film_full_pixels(&one.film), 128);
    for (int i = 0; i < 3 * 16 * 16; ++i)
        ck_assert(one.rgb[i] >= 0.0f && one.rgb[i] == three.rgb[i]);
    fixture_destroy(&one);
    fixture_destroy(&three);
}
END_TEST

/* ---- tangent frames ---------------------------------------------------------------------------------------------- */

#define WAVES 12

/* A rough mirror over a floor, shaped as waves: triangles with normals and, if requested, texture coordinates that are
 * rotated from one triangle to the next. */
static char *waves_text(bool coordinates)
{
    static char text[65536];
    size_t used =
        (size_t)snprintf(text, sizeof text, "%s",
                         BD_ROOM "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ] \"float roughness\" 0.3 "
                                 "\"bool remaproughness\" false\nShape \"trianglemesh\" \"point3 P\" [");
    for (int part = 0; part < (coordinates ? 3 : 2); ++part) {
        if (part > 0)
            used += (size_t)snprintf(text + used, sizeof text - used, " ]\n%s [",
                                     part == 1 ? "\"normal N\"" : "\"point2 uv\"");
        for (int k = 0; k < WAVES * WAVES; ++k) {
            double x = 3.0 * (k % WAVES) / (WAVES - 1) - 1.5, z = 3.0 * (double)(k / WAVES) / (WAVES - 1) - 1.5;
            if (part == 0)
                used += (size_t)snprintf(text + used, sizeof text - used, " %g %g %g", x, 0.1 * sin(3.0 * x + z), z);
            else if (part == 1)
                used += (size_t)snprintf(text + used, sizeof text - used, " %g 1 %g", -0.3 * cos(3.0 * x + z),
                                         -0.1 * cos(3.0 * x + z));
            else
                used += (size_t)snprintf(text + used, sizeof text - used, " %d %d", k * 7 % 5, k * 3 % 11);
        }
    }
    used += (size_t)snprintf(text + used, sizeof text - used, " ]\n\"integer indices\" [");
    for (int k = 0; k < WAVES * (WAVES - 1); ++k)
        if (k % WAVES + 1 < WAVES)
            used += (size_t)snprintf(text + used, sizeof text - used, " %d %d %d %d %d %d", k, k + WAVES, k + 1, k + 1,
                                     k + WAVES, k + WAVES + 1);
    used += (size_t)snprintf(text + used, sizeof text - used, " ]\n");
    ck_assert_uint_lt(used, sizeof text - 1);
    return text;
}

/* Frames depend on the normal alone, so erratic texture coordinates change no bit of the chains' result; and chains on
 * a surface without any agree with bidirectional path tracing. */
START_TEST(test_frames)
{
    RenderedImage without, with;
    RenderSetup render = {.text = waves_text(false), .samples = 32, .max_depth = 6, .integrator = integrator_mmlt()};
    fixture_render(&render, &without);
    render.text = waves_text(true);
    fixture_render(&render, &with);
    ck_assert_mem_eq(without.film.sums, with.film.sums, 3 * film_pixels(&with.film) * sizeof *with.film.sums);
    fixture_destroy(&without);
    fixture_destroy(&with);

    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16, .render = {.text = waves_text(false), .max_depth = 6, .threads = 2}};
    setup.render.samples = 128;
    setup.render.integrator = integrator_mmlt();
    groups_render(&setup, &got);
    setup.render.samples = 32;
    setup.render.seed = 1000;
    setup.render.integrator = integrator_bdpt();
    groups_render(&setup, &expected);
    groups_compare("waves without coordinates", &got, &expected, 8, false);
    ck_assert_double_eq_tol(groups_mean(&got) / groups_mean(&expected), 1.0, 0.01);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* ---- zero area --------------------------------------------------------------------------------------------------- */

#define NOTHING                                                                                                        \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ]\n"                                                 \
    "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ]\n"                                                    \
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  0 0 0  0 0 0  0 0 0 ] AttributeEnd\n"                                \
    "Shape \"sphere\" \"float radius\" 1e-30\n"

/* Triangles, patches and lamps of zero area change no bit; normals of zero length, and vertex normals that cancel, are
 * replaced by the geometric normal. */
START_TEST(test_no_area)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt(), integrator_mmlt()};
    static const char NORMALS[] = "Shape \"trianglemesh\" \"point3 P\" [ -1 0 1  1 0 1  0 1 1 ] "
                                  "\"normal N\" [ 0 1 0  0 -1 0  0 0 0 ] \"point2 uv\" [ 0 0 0 0 0 0 ]\n";
    RenderedImage without, with;
    char text[2048];
    RenderSetup setup = {.text = text, .samples = 16, .max_depth = 4, .integrator = integrators[_i]};
    snprintf(text, sizeof text, "%s%s", BD_ROOM BD_BALL, NORMALS);
    fixture_render(&setup, &without);
    snprintf(text, sizeof text, "%s%s%s", BD_ROOM NOTHING BD_BALL, NOTHING, NORMALS);
    fixture_render(&setup, &with);
    ck_assert_uint_eq(with.film.not_finite, 0);
    for (int i = 0; i < with.result.diagnostic_count; ++i)
        ck_assert_uint_eq(with.result.diagnostics[i], 0);
    ck_assert_double_gt(fixture_mean(&with), 0.0);
    ck_assert_mem_eq(without.film.sums, with.film.sums, 3 * film_pixels(&with.film) * sizeof *with.film.sums);
    fixture_destroy(&without);
    fixture_destroy(&with);
}
END_TEST

/* ---- NaN and infinity -------------------------------------------------------------------------------------------- */

/* Plants a value that a file cannot contain into the packed scene: the ball's index of refraction, or the radiance of
 * the second lamp. */
static void scene_spoil(Scene *scene, bool lamp, float value)
{
    uint *words = scene->tables_words.data;
    Material *materials = (Material *)(void *)(words + scene->frame.scene.layout.materials);
    Light *lights = (Light *)(void *)(words + scene->frame.scene.layout.lights);
    for (size_t i = 0; i < scene->materials.count; ++i)
        if (!lamp && materials[i].kind == MATERIAL_DIELECTRIC)
            materials[i].eta = value;
    if (lamp)
        lights[1].emission = vec3_splat(value);
}

#define SPOILT_SCENE                                                                                                   \
    BD_ROOM "Material \"dielectric\" \"float eta\" 1.5 \"float roughness\" 0.3\n"                                      \
            "AttributeBegin Scale 0.5 0.5 0.5 " BD_BALL "AttributeEnd\n"                                               \
            "AreaLightSource \"diffuse\" \"rgb L\" [ 3 3 3 ] Translate 1.5 0 0 Shape \"disk\" \"float radius\" 0.1\n"

/* A contribution that is not finite counts as zero and is counted; no pixel is bad, and the rest of the image is
 * unaffected. */
START_TEST(test_not_finite)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_ibpt(), integrator_bdpt(), integrator_mmlt()};
    /* A NaN index does no harm: all comparisons with it block the light. */
    static const struct {
        bool lamp;
        float value;
    } FAULTS[] = {{false, INFINITY}, {true, NAN}, {true, INFINITY}};
    const Integrator *integrator = integrators[_i / 3];
    bool lamp = FAULTS[_i % 3].lamp;
    float value = FAULTS[_i % 3].value;
    const RenderSetup setup = {.text = SPOILT_SCENE};
    Error error = {0};
    Scene scene;
    Film film;
    RenderResult result;
    float rgb[3 * 16 * 16];
    fixture_scene(&setup, &scene);
    scene_spoil(&scene, lamp, value);
    Backend *backend = fixture_open(&setup, &scene, &error);
    ck_assert_msg(backend != NULL, "%s", error.message);
    ck_assert(film_init(&film, 16, 16, scene.settings.crop, &error));
    RenderOptions options = {.samples = 16, .max_depth = 4};
    const RenderTask task = {
        .integrator = integrator, .scene = &scene, .backend = {backend_cpu(), backend}, .options = &options};
    ck_assert_msg(render_film(&task, &film, &result, &error), "%s", error.message);
    film_resolve(&film, 1.0f, rgb);
    double mean = 0.0;
    for (int i = 0; i < 3 * 16 * 16; ++i) {
        ck_assert(isfinite(rgb[i]) && rgb[i] >= 0.0f);
        mean += (double)rgb[i] / (3 * 16 * 16);
    }
    unsigned long long counted = film.not_finite;
    for (int i = 0; i < result.diagnostic_count; ++i)
        counted += result.diagnostics[i];
    printf("%s, %s of %g: %llu counted, the picture's mean %.3f\n", integrator->name, lamp ? "radiance" : "index",
           (double)value, counted, mean);
    ck_assert_uint_gt(counted, 0);
    ck_assert_double_gt(mean, 0.1);
    backend_cpu()->close(backend);
    film_destroy(&film);
    scene_destroy(&scene);
}
END_TEST

TCase *numerics_film_case(void)
{
    TCase *tcase = tcase_create("film");
    tcase_set_timeout(tcase, 300);
    tcase_add_loop_test(tcase, test_borders, 0, BIDIRECTIONAL_FILTER_COUNT);
    tcase_add_loop_test(tcase, test_brightness, 0, 3);
    tcase_add_test(tcase, test_quantum_of_pilot);
    tcase_add_test(tcase, test_full_chains);
    tcase_add_test(tcase, test_frames);
    tcase_add_loop_test(tcase, test_no_area, 0, 3);
    tcase_add_loop_test(tcase, test_not_finite, 0, 12);
    return tcase;
}
