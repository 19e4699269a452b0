/* Scale and position of the scene, coincident surfaces, suns over scenes of any size. */
#include "support/numerics.h"

#include "compare/metrics.h"

#include <string.h>

/* ---- scale and place --------------------------------------------------------------------------------------------- */

typedef struct Placement {
    double scale, shift; /* of the world; then translated along x and z */
    double rel_mse; /* relative to the image at scale 1 and (0,0,0) with the same seed */
    double block; /* the same for the worst of the means of 4 x 4 blocks */
} Placement;

/* With the same seed, paths differ only where rounding decides a hit or a lobe: not at all for a power of two. */
static const Placement PLACEMENTS[] = {{1.0, 0.0, 0.0, 0.0},    {1.0 / 1024.0, 0.0, 0.0, 0.0}, {1e-3, 0.0, 1e-6, 1e-3},
                                       {37.0, 0.0, 1e-6, 1e-3}, {1e4, 0.0, 1e-6, 1e-3},        {1.0, 100.0, 1e-6, 1e-3},
                                       {1.0, 1e4, 1e-6, 1e-3}};
#define PLACEMENT_COUNT ((int)(sizeof PLACEMENTS / sizeof PLACEMENTS[0]))

/* Glass, a mesh with normals, a lamp, a floor. */
static const BidirectionalScene CONTENT = {
    "",
    BD_LAMP BD_GREY BD_FLOOR "AttributeBegin Translate 1 0 0.5 Scale 0.8 0.8 0.8 $ICOSPHERE AttributeEnd\n"
                             "Material \"dielectric\" \"float eta\" 1.5\n"
                             "AttributeBegin Translate -1 0 0 Scale 0.8 0.8 0.8 " BD_BALL "AttributeEnd\n",
    0, 0, 0};

static const char *placed_text(const Placement *place)
{
    static char text[8192];
    double a = place->scale, x = place->shift;
    snprintf(text, sizeof text,
             "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
             "LookAt %.17g %.17g %.17g  %.17g %.17g %.17g  0 1 0\nCamera \"perspective\" \"float fov\" 38\nWorldBegin\n"
             "Translate %.17g 0 %.17g Scale %.17g %.17g %.17g\n%s",
             x, 1.2 * a, x - 6.0 * a, x, -0.2 * a, x, x, x, a, a, a, bidirectional_text(&CONTENT));
    return text;
}

static void render_placed(const Integrator *integrator, const Placement *place, RenderedImage *image)
{
    RenderSetup setup = {
        .text = placed_text(place), .samples = 64, .max_depth = 6, .seed = 11, .integrator = integrator};
    fixture_render(&setup, image);
    ck_assert_uint_eq(image->film.not_finite, 0);
    ck_assert_uint_eq(image->film.saturated, 0);
    ck_assert_uint_eq(film_full_pixels(&image->film), 0);
}

START_TEST(test_placements)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt()};
    RenderedImage first, image;
    render_placed(integrators[_i], &PLACEMENTS[0], &first);
    for (int i = 1; i < PLACEMENT_COUNT; ++i) {
        const Placement *place = &PLACEMENTS[i];
        Metrics metrics;
        Error error = {0};
        render_placed(integrators[_i], place, &image);
        ck_assert(metrics_compute(image.rgb, first.rgb, 32, 32, 4, &metrics, &error));
        printf("%s, scale %g, shift %g: relMSE %.3g, worst block %.3g\n", integrators[_i]->name, place->scale,
               place->shift, metrics.rel_mse, metrics.block_max);
        ck_assert_double_le(metrics.rel_mse, place->rel_mse);
        ck_assert_double_le(metrics.block_max, place->block);
        fixture_destroy(&image);
    }
    fixture_destroy(&first);
}
END_TEST

/* 10^4 away, against the image at (0,0,0), both over many seeds. */
START_TEST(test_far)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt(), integrator_mmlt()};
    static const unsigned SAMPLES[] = {24, 12, 24};
    static const Placement NEAR = {.scale = 1.0}, FAR = {.scale = 1.0, .shift = 1e4};
    PictureGroups expected, got;
    char name[48];
    GroupSetup setup = {.groups = 16,
                        .render = {.text = placed_text(&NEAR), .samples = SAMPLES[_i], .max_depth = 6, .threads = 2}};
    setup.render.integrator = integrators[_i];
    groups_render(&setup, &expected);
    setup.render.text = placed_text(&FAR);
    setup.render.seed = 1000;
    groups_render(&setup, &got);
    snprintf(name, sizeof name, "%s, 10^4 away", integrators[_i]->name);
    groups_compare(name, &got, &expected, 4, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* A scene with every kind of object that has a position. Its coordinates are exactly representable, all multiples of
 * 1/64, none of the camera's is 0, and the origin is in the middle of its bounding box. */
static const char *moved_text(const double offset[3])
{
    static const double EYE[3] = {0.25, 0.5, -5.0};
    static char text[4096];
    const double *o = offset;
    snprintf(
        text, sizeof text,
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\nPixelFilter \"box\"\n"
        "LookAt %.17g %.17g %.17g  %.17g %.17g %.17g  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
        "Translate %.17g %.17g %.17g\n"
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 3 3 3 ]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ -1 1.75 -1  1 1.75 -1  -1 1.75 1  1 1.75 1 ] AttributeEnd\n"
        "AttributeBegin Translate 1 0.5 -1 AreaLightSource \"diffuse\" \"rgb L\" [ 2 1 1 ]\n"
        "Shape \"disk\" \"float radius\" 0.25 AttributeEnd\n"
        "LightSource \"point\" \"rgb I\" [ 4 4 4 ] \"point3 from\" [ 1.5 1.5 -3 ]\n"
        "LightSource \"spot\" \"rgb I\" [ 4 4 2 ] \"point3 from\" [ -1.5 1.5 -3 ] \"point3 to\" [ 0 0 0 ]\n"
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [ .2 .5 .2 ]\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 1 3 2 ]\n"
        "\"point3 P\" [ -2 -1.75 -2  2 -1.75 -2  -2 -1.75 2  2 -1.75 2 ]\n"
        "Material \"dielectric\"\n"
        "AttributeBegin Translate -1 0 0 Shape \"sphere\" \"float radius\" 0.75 AttributeEnd\n"
        "Material \"conductor\" \"float roughness\" 0.25\n"
        "ObjectBegin \"ball\" Translate %.17g %.17g %.17g Shape \"sphere\" \"float radius\" 0.5 \"float zmax\" 0.25 "
        "ObjectEnd\nAttributeBegin Translate 1 -1 1 ObjectInstance \"ball\" AttributeEnd\n",
        o[0] + EYE[0], o[1] + EYE[1], o[2] + EYE[2], o[0] - 0.25, o[1] - 0.25, o[2] + 0.25, o[0], o[1], o[2], -o[0],
        -o[1], -o[2]);
    return text;
}

/* A distant scene is moved to the origin (scene/center.h) without loss: the same sums. */
START_TEST(test_moved)
{
    static const double OFFSETS[4][3] = {{0, 0, 0}, {4096, -8192, 16384}, {-1000, 0, 0}, {0, 0, 1e5}};
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt()};
    RenderedImage first, image;
    for (int i = 0; i < 4; ++i) {
        RenderSetup setup = {
            .text = moved_text(OFFSETS[i]), .samples = 16, .max_depth = 6, .integrator = integrators[_i]};
        fixture_render(&setup, &image);
        if (i == 0) {
            first = image;
            continue;
        }
        ck_assert_mem_eq(first.film.sums, image.film.sums, 3 * film_pixels(&image.film) * sizeof *image.film.sums);
        fixture_destroy(&image);
    }
    fixture_destroy(&first);
}
END_TEST

/* A lamp 0.005 under a ceiling, less than the resolution of floats at a distance of 10^5: points are moved before they
 * are rounded. The file has the coordinates of a room at the origin, and a transform. */
static const char *ceiling_text(double shift)
{
    static char text[2048];
    double x = shift, y = -2.0 * shift;
    snprintf(
        text, sizeof text,
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
        "LookAt %.17g %.17g %.17g  %.17g %.17g %.17g  0 1 0\nCamera \"perspective\" \"float fov\" "
        "50\nWorldBegin\n" BD_GREY
        "ObjectBegin \"ball\" Shape \"sphere\" \"float radius\" 0.3 ObjectEnd\nTranslate %.17g %.17g %.17g\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]\n"
        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 1 3 2 ]\n"
        "\"point3 P\" [ -2 2.7 -2  2 2.7 -2  -2 2.7 2  2 2.7 2 ]\n"
        "AttributeBegin Translate 0.8 0.303 0.4 ObjectInstance \"ball\" AttributeEnd\n"
        "AttributeBegin Translate -0.9 0.005 0.3 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.4 AttributeEnd\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ] \"bool twosided\" true\n"
        "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 1 3 2 ]\n"
        "\"point3 P\" [ -0.4 2.695 -0.4  0.4 2.695 -0.4  -0.4 2.695 0.4  0.4 2.695 0.4 ]\n",
        x, 1.25 + y, -4.0 + x, x, 1.25 + y, x, x, y, x);
    return text;
}

START_TEST(test_rounded_once)
{
    const Integrator *const integrators[] = {integrator_pt(), integrator_bdpt()};
    static const double SHIFTS[] = {0.0, 1e4, 1e5, 1e6};
    RenderedImage first, image;
    for (int i = 0; i < 4; ++i) {
        Metrics metrics;
        Error error = {0};
        RenderSetup setup = {
            .text = ceiling_text(SHIFTS[i]), .samples = 64, .max_depth = 5, .integrator = integrators[_i]};
        fixture_render(&setup, &image);
        if (i == 0) {
            first = image;
            continue;
        }
        ck_assert(metrics_compute(image.rgb, first.rgb, 16, 16, 4, &metrics, &error));
        printf("%s, under a ceiling %g away: relMSE %.3g, worst block %.3g\n", integrators[_i]->name, SHIFTS[i],
               metrics.rel_mse, metrics.block_max);
        ck_assert_double_le(metrics.rel_mse, 1e-6);
        ck_assert_double_le(metrics.block_max, 1e-3);
        fixture_destroy(&image);
    }
    fixture_destroy(&first);
}
END_TEST

/* ---- two surfaces in one place ----------------------------------------------------------------------------------- */

/* The first of two coincident surfaces is hit everywhere, for any number of threads: the same sums, and nothing of the
 * other's colour. test_opencl does the same on a device. */
START_TEST(test_coincident)
{
    static const int THREADS[] = {1, 2, 3, 8};
    RenderedImage first, image;
    for (int i = 0; i < 4; ++i) {
        RenderSetup setup = {.text = COINCIDENT_SCENE, .samples = 16, .max_depth = 4, .threads = THREADS[i]};
        fixture_render(&setup, &image);
        for (size_t pixel = 0; pixel < film_pixels(&image.film); ++pixel) {
            ck_assert_int_gt(image.film.sums[3 * pixel], 0);
            ck_assert_int_eq(image.film.sums[3 * pixel + 2], 0);
        }
        if (i == 0) {
            first = image;
            continue;
        }
        ck_assert_mem_eq(first.film.sums, image.film.sums, 3 * film_pixels(&image.film) * sizeof *image.film.sums);
        fixture_destroy(&image);
    }
    fixture_destroy(&first);
}
END_TEST

/* ---- suns -------------------------------------------------------------------------------------------------------- */

/* A glass ball in the sun over a floor: only paths from the light make the caustic under it. `radius`: of the floor,
 * which determines the scene's bounding sphere; `scale`: of everything. */
static void caustic_text(char *text, size_t size, double scale, double radius)
{
    double r = radius * scale;
    snprintf(
        text, size,
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
        "LookAt %.17g %.17g %.17g  %.17g %.17g 0  0 1 0\nCamera \"perspective\" \"float fov\" 20 "
        "\"float screenwindow\" [ -0.625 0.25 -0.4375 0.4375 ]\nWorldBegin\n"
        "LightSource \"distant\" \"rgb L\" [ 3 3 3 ] \"point3 from\" [ 1 1 0 ] \"point3 to\" [ 0 0 0 ]\n"
        "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ %.17g %.17g %.17g  %.17g %.17g %.17g  %.17g %.17g %.17g  %.17g %.17g "
        "%.17g ]\n"
        "Material \"dielectric\" \"float eta\" 1.5\nScale %.17g %.17g %.17g\nShape \"sphere\" \"float radius\" 1\n",
        -2.2 * scale, 4.0 * scale, -5.0 * scale, -1.4 * scale, -1.1 * scale, -r, -1.1 * scale, -r, r, -1.1 * scale, -r,
        -r, -1.1 * scale, r, r, -1.1 * scale, r, scale, scale, scale);
}

/* The whole scene scaled up to a radius of 10^5: with the same seed, nearly the same image. */
START_TEST(test_sun_scaled)
{
    static const double SCALES[] = {1.0, 10.0, 100.0, 1e3, 1e4, 2.5e4};
    char text[2048];
    RenderedImage first, image;
    for (int i = 0; i < 6; ++i) {
        Metrics metrics;
        Error error = {0};
        caustic_text(text, sizeof text, SCALES[i], 4.0);
        fixture_render(
            &(RenderSetup){.text = text, .samples = 100, .max_depth = 5, .seed = 3, .integrator = integrator_bdpt()},
            &image);
        if (i == 0) {
            first = image;
            double spot = 0.0;
            for (int k = 0; k < 256; ++k)
                spot = fmax(spot, fixture_block_mean(image.rgb, 16, k % 16, k / 16, k % 16 + 1, k / 16 + 1));
            printf("sun: the spot has %.3g of the floor's mean\n", spot / fixture_mean(&image));
            ck_assert_double_gt(spot, 1.5 * fixture_mean(&image));
            continue;
        }
        ck_assert(metrics_compute(image.rgb, first.rgb, 16, 16, 4, &metrics, &error));
        printf("sun, scene radius %.3g: relMSE %.3g, worst block %.3g\n", 5.7 * SCALES[i], metrics.rel_mse,
               metrics.block_max);
        ck_assert_double_le(metrics.rel_mse, 1e-3);
        ck_assert_double_le(metrics.block_max, 2e-3);
        fixture_destroy(&image);
    }
    fixture_destroy(&first);
}
END_TEST

/* The floor alone is enlarged: a part of the light subpaths is aimed at the ball, so nothing changes, the noise no more
 * than the mean. */
START_TEST(test_sun_wide)
{
    static const double RADII[] = {4.0, 20.0, 400.0};
    char text[2048], name[48];
    PictureGroups expected, got;
    for (int i = 0; i < 3; ++i) {
        GroupSetup setup = {.groups = 16,
                            .render = {.text = text,
                                       .samples = 125,
                                       .max_depth = 5,
                                       .threads = 2,
                                       .seed = 100u * (unsigned)i,
                                       .integrator = integrator_bdpt()}};
        caustic_text(text, sizeof text, 1.0, RADII[i]);
        groups_render(&setup, i == 0 ? &expected : &got);
        if (i == 0)
            continue;
        snprintf(name, sizeof name, "sun, floor of %g", RADII[i]);
        groups_compare(name, &got, &expected, 4, false);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

TCase *numerics_scale_case(void)
{
    TCase *tcase = tcase_create("scale");
    tcase_set_timeout(tcase, 300);
    tcase_add_loop_test(tcase, test_placements, 0, 2);
    tcase_add_loop_test(tcase, test_moved, 0, 2);
    tcase_add_loop_test(tcase, test_rounded_once, 0, 2);
    tcase_add_loop_test(tcase, test_far, 0, 3);
    tcase_add_test(tcase, test_coincident);
    tcase_add_test(tcase, test_sun_scaled);
    tcase_add_test(tcase, test_sun_wide);
    return tcase;
}
