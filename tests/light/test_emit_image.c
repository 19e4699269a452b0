/* Images of a plane by light tracing alone (a single ray from a light to the plane, connected to the lens) against path
 * tracing, pixel by pixel, for every filter and every kind of light and camera. */
#include "camera/camera.h"
#include "camera/film_splat.h"
#include "light/emit.h"
#include "light/test_emit.h"
#include "math/rng.h"
#include "support/render_fixture.h"
#include "support/test_util.h"

#include <string.h>

typedef struct ImageCase {
    const char *film; /* further parameters of the film */
    const char *filter;
    const char *camera;
    const char *light;
} ImageCase;

#define PINHOLE "Camera \"perspective\" \"float fov\" 40\n"
#define QUAD "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2.5 1  -2 -2 1  -1.5 -2.5 1  -1.5 -2 1 ]\n"

static const ImageCase CASES[] = {
    {"", "\"box\"", PINHOLE, "AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ]\n" QUAD},
    {"\"integer pixelbounds\" [ 2 9 1 6 ]", "\"box\" \"float xradius\" 1.2 \"float yradius\" 0.8", PINHOLE,
     "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ]\nTranslate -1.8 -2 1.2\nShape \"sphere\" \"float radius\" 0.2\n"},
    {"", "\"triangle\"", "Camera \"perspective\" \"float fov\" 50 \"float lensradius\" 0.3 \"float focaldistance\" 2\n",
     "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ]\nTranslate -2 -2.2 1\nReverseOrientation\n"
     "Shape \"disk\" \"float radius\" 0.4\n"},
    {"\"integer pixelbounds\" [ 0 7 3 8 ]", "\"gaussian\"",
     "Camera \"orthographic\" \"float screenwindow\" [ -1 1 -1.5 0.5 ]\n",
     "LightSource \"point\" \"rgb I\" [ 2 2 2 ] \"point3 from\" [ 0.3 0.3 1 ]\n"},
    {"", "\"mitchell\"",
     "Camera \"perspective\" \"float fov\" 40 \"float screenwindow\" [ -1 0.7 -1 1.3 ] \"float lensradius\" 0.1 "
     "\"float focaldistance\" 4\n",
     "LightSource \"spot\" \"rgb I\" [ 2 2 2 ] \"point3 from\" [ 0.3 0.3 2 ] \"point3 to\" [ 0 0 0 ] "
     "\"float coneangle\" 75 \"float conedeltaangle\" 25\n"},
    {"\"integer pixelbounds\" [ 3 12 0 5 ]", "\"sinc\"", PINHOLE,
     "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"point3 from\" [ 1 0.5 1 ] \"point3 to\" [ 0 0 0 ]\n"},
    {"", "\"sinc\" \"float xradius\" 2 \"float yradius\" 3",
     "Camera \"orthographic\" \"float lensradius\" 0.3 \"float focaldistance\" 2\n",
     "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"},
};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

/* The camera is rotated and scaled by 2; it sees only the plane, which spans 12 by 12 around the origin; lights with a
 * surface are out of its view. */
static void scene_text(const ImageCase *c, char *text, size_t size)
{
    snprintf(text, size,
             "Scale 0.5 0.5 0.5\nLookAt -1 -1.5 3  0 0 0  0 1 0\nFilm \"rgb\" \"integer xresolution\" 12 "
             "\"integer yresolution\" 8 %s\nPixelFilter %s\n%sWorldBegin\n"
             "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.6 0.6 ]\n"
             "Shape \"bilinearmesh\" \"point3 P\" [ -6 -6 0  6 -6 0  -6 6 0  6 6 0 ]\n%s",
             c->film, c->filter, c->camera, c->light);
}

enum { BATCHES = 24, PATHS = 200, LIGHT_PATHS = 4 * PATHS, PIXELS = 12 * 8 };

/* Sums and sums of squares over batches, one value per pixel. */
typedef struct Batches {
    double sum[PIXELS], squares[PIXELS];
} Batches;

static void batches_add(Batches *b, const double *image)
{
    for (int i = 0; i < PIXELS; ++i) {
        b->sum[i] += image[i] / BATCHES;
        b->squares[i] += image[i] * image[i] / BATCHES;
    }
}

/* Variance of the mean. */
static double batches_variance(const Batches *b, int i)
{
    return fmax(0.0, b->squares[i] - b->sum[i] * b->sum[i]) / (BATCHES - 1);
}

/* Path tracing with two segments; the crop window's pixels come first. */
static void trace_from_camera(const char *text, int pixels, Batches *batches)
{
    for (uint64_t seed = 0; seed < BATCHES; ++seed) {
        double image[PIXELS] = {0.0};
        RenderedImage rendered;
        RenderSetup setup = {.text = text, .samples = PATHS, .max_depth = 2, .seed = seed + 1};
        fixture_render(&setup, &rendered);
        for (int i = 0; i < pixels; ++i)
            image[i] = (double)rendered.rgb[3 * i];
        batches_add(batches, image);
        fixture_destroy(&rendered);
    }
}

/* Intersects a ray with the plane; returns false if it misses. */
static bool plane_meet(const LightEmission *e, Vec3 *p)
{
    float t = -e->p.z / e->w.z;
    if (!(e->w.z < 0.0f) || !(t > 0.0f))
        return false;
    *p = vec3_mad(e->p, t, e->w);
    p->z = 0.0f;
    return float_abs(p->x) <= 6.0f && float_abs(p->y) <= 6.0f;
}

/* Adds one light path to its pixel of the crop window. */
static void path_from_light(const SceneView *scene, uint index, uint stream, double *image)
{
    const FrameParams *frame = scene->frame;
    Random4 a = random_four(index, stream, 0, 0, 5, 6), b = random_four(index, stream, 1, 0, 5, 6);
    Random4 c = random_four(index, stream, 2, 0, 5, 6);
    LightEmission e;
    CameraConnection connection;
    Vec3 p;
    float weight;
    uint light = light_select(scene, a.x[0], a.x[1]);
    if (!light_emit(scene, light, vec2(random_float(a.x[2]), random_float(a.x[3])),
                    vec2(random_float(b.x[0]), random_float(b.x[1])), &e) ||
        !plane_meet(&e, &p) || !camera_connect(frame, p, vec2(random_float(b.x[2]), random_float(b.x[3])), &connection))
        return;
    double beta = (double)e.radiance.x * (double)e.cosine /
                  ((double)scene->lights[light].select_pdf * (double)e.pdf_p * (double)e.pdf_w);
    double f_cos = 0.6 / M_PI * (double)connection.wi.z;
    uint pixel = film_splat_pixel(scene, connection.film, vec2(random_float(c.x[0]), random_float(c.x[1])), &weight);
    if (pixel == NONE)
        return;
    uint x = pixel % frame->film.width - frame->film.crop_x0, y = pixel / frame->film.width - frame->film.crop_y0;
    image[y * (frame->film.crop_x1 - frame->film.crop_x0) + x] +=
        beta * f_cos * (double)connection.pdf * (double)weight / LIGHT_PATHS;
}

static void trace_from_light(const char *text, int *pixels, Batches *batches)
{
    const RenderSetup setup = {.text = text};
    Scene scene;
    fixture_scene(&setup, &scene);
    SceneView view = scene_view(&scene.frame, scene.geometry_words.data, scene.tables_words.data, scene.texels.data);
    *pixels = (int)((scene.frame.film.crop_x1 - scene.frame.film.crop_x0) *
                    (scene.frame.film.crop_y1 - scene.frame.film.crop_y0));
    for (uint k = 0; k < BATCHES; ++k) {
        double image[PIXELS] = {0.0};
        for (uint i = 0; i < (uint)*pixels * LIGHT_PATHS; ++i)
            path_from_light(&view, i, k, image);
        batches_add(batches, image);
    }
    scene_destroy(&scene);
}

/* z of every pixel below 5 (46 degrees of freedom, 600 pixels in all), and the mean of z^2 about 1. */
START_TEST(test_plane)
{
    char text[2048];
    Batches camera = {{0.0}, {0.0}}, light = {{0.0}, {0.0}};
    int pixels;
    scene_text(&CASES[_i], text, sizeof text);
    trace_from_light(text, &pixels, &light);
    trace_from_camera(text, pixels, &camera);
    double z2 = 0.0, mean = 0.0, error2 = 0.0;
    for (int i = 0; i < pixels; ++i) {
        double variance = batches_variance(&camera, i) + batches_variance(&light, i);
        double difference = light.sum[i] - camera.sum[i];
        ck_assert_msg(camera.sum[i] > 0.0 && variance > 0.0, "case %d, pixel %d: %g", _i, i, camera.sum[i]);
        ck_assert_msg(difference * difference < 25.0 * variance, "case %d, pixel %d: %g by light, %g by camera, +- %g",
                      _i, i, light.sum[i], camera.sum[i], sqrt(variance));
        z2 += difference * difference / variance / pixels;
        mean += camera.sum[i] / pixels;
        error2 += variance / pixels;
    }
    ck_assert_msg(z2 > 0.6 && z2 < 1.5, "case %d: mean of z^2 is %g", _i, z2);
    ck_assert_msg(sqrt(error2) < 0.1 * mean, "case %d: noise %g of %g", _i, sqrt(error2), mean);
}
END_TEST

TCase *emit_image_case(void)
{
    TCase *tcase = tcase_create("pictures");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_plane, 0, CASE_COUNT);
    return tcase;
}
