/* Image environments under transforms that rotate, mirror and stretch: the direction of every texel, and irradiance, by
 * brute force over all directions. */
#include "light/light.h"
#include "support/analytic.h"
#include "support/test_files.h"

enum { SIDE = 8 };

typedef struct Environment {
    const char *name;
    double world_from_light[9]; /* row-major */
} Environment;

static const Environment ENVIRONMENTS[] = {
    {"as it is", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"rotated", {0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6}},
    {"mirrored", {-0.36, 0.48, -0.8, 0.8, 0.6, 0.0, -0.48, 0.64, 0.6}},
    {"scaled by 5", {5, 0, 0, 0, 5, 0, 0, 0, 5}},
    {"stretched", {2, 0, 0, 0, 0.5, 0, 0, 0, 1}},
    {"sheared and mirrored", {-0.5, 0.7, 0, 0.2, 1.5, 0.4, 0.3, -0.6, 1.1}},
};
#define ENVIRONMENT_COUNT ((int)(sizeof ENVIRONMENTS / sizeof *ENVIRONMENTS))

static float texels[3 * SIDE * SIDE];

static void map_make(void)
{
    unsigned state = 5;
    test_folder_make();
    for (int i = 0; i < SIDE * SIDE; ++i) {
        double bright = test_random_unit(&state);
        texels[3 * i] = texels[3 * i + 1] = texels[3 * i + 2] = bright < 0.3 ? 0.0f : (float)(3.0 * bright * bright);
    }
    analytic_write_pfm(test_path("map.pfm"), SIDE, SIDE, texels);
}

/* The directive that places the map, its matrix column by column. */
static void light_text(const Environment *e, char *text, size_t size)
{
    const double *m = e->world_from_light;
    snprintf(text, size,
             "Transform [ %.17g %.17g %.17g 0  %.17g %.17g %.17g 0  %.17g %.17g %.17g 0  0 0 0 1 ]\n"
             "LightSource \"infinite\" \"string filename\" \"%s\"\nIdentity\n",
             m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8], test_path("map.pfm"));
}

/* ---- the map, in double ------------------------------------------------------------------------------------------ */

/* The direction in the light's space, by Cramer's rule. */
static void light_direction(const double m[9], const double d[3], double out[3])
{
    double det =
        m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
    double length = 0.0;
    for (int k = 0; k < 3; ++k) {
        double a[9];
        memcpy(a, m, sizeof a);
        for (int i = 0; i < 3; ++i)
            a[3 * i + k] = d[i];
        out[k] = (a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
                  a[2] * (a[3] * a[7] - a[4] * a[6])) /
                 det;
        length += out[k] * out[k];
    }
    for (int k = 0; k < 3; ++k)
        out[k] /= sqrt(length);
}

/* Clarberg 2008: |z| = 1 - r^2 on the diamond of radius r, whose arc length is the azimuth. */
static void square_of(const double d[3], double *u, double *v)
{
    double r = sqrt(1.0 - fabs(d[2])), phi = atan2(fabs(d[1]), fabs(d[0])) * 2.0 / M_PI;
    double y = r * phi, x = r - y;
    if (d[2] < 0.0) {
        double swap = x;
        x = 1.0 - y;
        y = 1.0 - swap;
    }
    *u = 0.5 + 0.5 * copysign(x, d[0]);
    *v = 0.5 + 0.5 * copysign(y, d[1]);
}

/* Beyond an edge, the octahedron's square continues at the same edge, mirrored about the edge's middle. */
static double texel(int x, int y)
{
    if (x < 0 || x >= SIDE) {
        x = x < 0 ? -x - 1 : 2 * SIDE - 1 - x;
        y = SIDE - 1 - y;
    }
    if (y < 0 || y >= SIDE) {
        x = SIDE - 1 - x;
        y = y < 0 ? -y - 1 : 2 * SIDE - 1 - y;
    }
    return (double)texels[3 * (y * SIDE + x)];
}

static double radiance_of(const Environment *e, const double d[3])
{
    double w[3], u, v;
    light_direction(e->world_from_light, d, w);
    square_of(w, &u, &v);
    double x = u * SIDE - 0.5, y = v * SIDE - 0.5, fx = x - floor(x), fy = y - floor(y);
    int i = (int)floor(x), j = (int)floor(y);
    return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

static double irradiance_of(const Environment *e)
{
    enum { COUNT = 400 };
    double sum = 0.0;
    for (int j = 0; j < COUNT; ++j)
        for (int i = 0; i < 4 * COUNT; ++i) {
            double z = sqrt((j + 0.5) / COUNT), r = sqrt(1.0 - z * z), phi = 2.0 * M_PI * (i + 0.5) / (4 * COUNT);
            double d[3] = {r * cos(phi), r * sin(phi), z};
            sum += radiance_of(e, d);
        }
    return sum * M_PI / (4.0 * COUNT * COUNT);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

/* The map as seen in many directions. */
START_TEST(test_view)
{
    const Environment *e = &ENVIRONMENTS[_i];
    char light[512];
    double worst = 0.0;
    unsigned state = 3;
    light_text(e, light, sizeof light);
    for (int i = 0; i < 40; ++i) {
        double z = 2.0 * test_random_unit(&state) - 1.0, phi = 2.0 * M_PI * test_random_unit(&state);
        double d[3] = {sqrt(1.0 - z * z) * cos(phi), sqrt(1.0 - z * z) * sin(phi), z};
        double got =
            analytic_mean(1, 1,
                          "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n"
                          "LookAt 0 0 0  %.9g %.9g %.9g  0.3 0.4 0.5\n"
                          "Camera \"perspective\" \"float fov\" 0.0002\nWorldBegin\n%s",
                          d[0], d[1], d[2], light);
        worst = fmax(worst, fabs(got - radiance_of(e, d)));
    }
    fprintf(stderr, "map %-36s differs by up to %.2g over 40 directions\n", e->name, worst);
    ck_assert_double_le(worst, 1e-4);
}
END_TEST

START_TEST(test_irradiance)
{
    const Environment *e = &ENVIRONMENTS[_i];
    char light[512], name[64];
    light_text(e, light, sizeof light);
    snprintf(name, sizeof name, "plane under the map %s", e->name);
    double got = analytic_mean(4096, 2, ANALYTIC_LOOK_AT_ORIGIN "%s" ANALYTIC_DIFFUSE_PLANE, light);
    analytic_check(name, got, irradiance_of(e) * 0.5 / M_PI, ANALYTIC_TOLERANCE);
}
END_TEST

/* Light sampling alone: the mean of radiance times cosine over density. */
START_TEST(test_light_samples_alone)
{
    const Environment *e = &ENVIRONMENTS[_i];
    enum { ROWS = 600 };
    char light[600], name[64];
    Scene scene;
    unsigned state = 17;
    strcpy(light, "WorldBegin\n");
    light_text(e, light + strlen(light), sizeof light - strlen(light));
    const RenderSetup setup = {.text = light};
    fixture_scene(&setup, &scene);
    BackendScene packed = scene_backend_view(&scene);
    SceneView view = scene_view(packed.frame, packed.geometry, packed.tables, packed.texels);
    double sum = 0.0;
    for (int i = 0; i < ROWS * ROWS; ++i) {
        LightSample s = {0};
        float a = (float)((i % ROWS + test_random_unit(&state)) / ROWS);
        float b = (float)((i / ROWS + test_random_unit(&state)) / ROWS);
        if (light_sample(&view, 0, vec3(0, 0, 0), vec2(a, b), &s) && s.wi.z > 0.0f)
            sum += (double)s.radiance.x * (double)s.wi.z / (double)s.pdf_w / (ROWS * ROWS);
    }
    snprintf(name, sizeof name, "light samples alone, map %s", e->name);
    analytic_check(name, sum, irradiance_of(e), ANALYTIC_TOLERANCE);
    scene_destroy(&scene);
}
END_TEST

/* As in pbrt: a constant map gives an upward-facing plane twice the requested illuminance. */
START_TEST(test_illuminance)
{
    enum { FINE = 128 };
    static float constant[3 * FINE * FINE];
    for (int i = 0; i < 3 * FINE * FINE; ++i)
        constant[i] = 0.3f;
    analytic_write_pfm(test_path("constant.pfm"), FINE, FINE, constant);
    double got = analytic_mean(4096, 2,
                               ANALYTIC_LOOK_AT_ORIGIN "LightSource \"infinite\" \"string filename\" \"%s\" "
                                                       "\"float illuminance\" 5\n" ANALYTIC_DIFFUSE_PLANE,
                               test_path("constant.pfm"));
    analytic_check("illuminance of a constant map, as pbrt's", got, 10.0 * 0.5 / M_PI, 0.01);
}
END_TEST

TCase *analytic_environment_case(void)
{
    TCase *tcase = tcase_create("environment");
    tcase_set_timeout(tcase, 120);
    tcase_add_checked_fixture(tcase, map_make, test_folder_remove);
    tcase_add_loop_test(tcase, test_view, 0, ENVIRONMENT_COUNT);
    tcase_add_loop_test(tcase, test_irradiance, 0, ENVIRONMENT_COUNT);
    tcase_add_loop_test(tcase, test_light_samples_alone, 0, ENVIRONMENT_COUNT);
    tcase_add_test(tcase, test_illuminance);
    return tcase;
}
