/* Emission of grids along rays, against integrals in double precision in small steps; the table of black bodies. */
#include "geometry/trilinear.h"
#include "math/test_math.h"

#include "geometry/grid_emission.h"
#include "image/color.h"
#include "scene/grid_build.h"

#include <string.h>

enum { EDGE_MAX = 16, SAMPLES_MAX = EDGE_MAX * EDGE_MAX * EDGE_MAX };

/* One grid: its samples, and where they lie in the world: at origin + spacing * (index + 1 - low). */
typedef struct Samples {
    uint size[3], words;
    float low;
    double origin[3], spacing[3];
    float values[6 * SAMPLES_MAX];
    float largest[6];
} Samples;

typedef struct Case {
    const char *name;
    Samples density, emission;
    bool kelvins;
    GridKelvin kelvin;
    Medium medium;
    Scene scene;
    SceneView view;
    double thickest; /* optical depth of the coefficient 1 across the grid, at density 1 */
} Case;

static void samples_read(const void *context, const uint index[3], float *out)
{
    const Samples *s = context;
    size_t at = ((size_t)index[2] * s->size[1] + index[1]) * s->size[0] + index[0];
    memcpy(out, s->values + at * s->words, s->words * sizeof *out);
}

static GridSource samples_source(const Samples *s)
{
    GridSource source = {.words = s->words, .low = s->low, .sample = samples_read, .context = s};
    source.grid_from_world = matrix_identity();
    for (int i = 0; i < 3; ++i) {
        source.size[i] = s->size[i];
        source.grid_from_world.m[5 * i] = 1.0 / s->spacing[i];
        source.grid_from_world.m[4 * i + 3] = (double)s->low - s->origin[i] / s->spacing[i];
    }
    return source;
}

static void case_build(Case *c)
{
    GridSource density = samples_source(&c->density), emission = samples_source(&c->emission);
    uint number;
    Error error = {{0}, {0}};
    scene_init(&c->scene);
    ck_assert(grid_add(&c->scene, &density, &number, c->density.largest, &error));
    ck_assert(
        grid_emission_add(&c->scene, number, &emission, c->kelvins ? &c->kelvin : NULL, c->emission.largest, &error));
    c->medium.grid = number;
    c->view = (SceneView){.grids = c->scene.grids.data, .texels = c->scene.texels.data, .lookup = c->scene.lookup.data};
}

/* Sample i of an axis, 0 beyond the ends, as a part of the largest. */
static double samples_at(const void *context, const int index[3], uint word)
{
    const Samples *s = context;
    uint at[3];
    float value[6];
    for (int i = 0; i < 3; ++i) {
        if (index[i] < 0 || index[i] >= (int)s->size[i])
            return 0.0;
        at[i] = (uint)index[i];
    }
    samples_read(s, at, value);
    return s->largest[word] > 0.0f ? (double)value[word] / (double)s->largest[word] : 0.0;
}

static double samples_value(const Samples *s, const double p[3], uint word)
{
    return trilinear_value(p, s->origin, s->spacing, s->low, samples_at, s, word);
}

/* Extinction's factor and emission at a point, of one colour. */
static double point_density(const Case *c, const double p[3], uint color)
{
    return samples_value(&c->density, p, c->density.words == 1 ? 0u : color);
}

static double point_emission(const Case *c, const double p[3], uint color)
{
    const Samples *e = &c->emission;
    double strength = (double)vec3_component(c->medium.emission, color), first = samples_value(e, p, 0);
    if (e->words == 6)
        return strength * samples_value(e, p, color) * samples_value(e, p, 3u + color);
    strength *= point_density(c, p, color);
    if (!c->kelvins)
        return strength * first;
    float kelvin = (float)(first * (double)e->largest[0] * (double)c->kelvin.scale + (double)c->kelvin.offset);
    uint table = ARRAY_AT(&c->scene.grids, MediumGrid, 1).table;
    strength *= (double)vec3_component(blackbody_radiance(&c->view, table, kelvin), color);
    return e->words == 2 ? strength * samples_value(e, p, 1) : strength;
}

static int double_compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Places along the ray at which an interpolant has a kink, and limits of the box of densities. */
static size_t kinks_add(const Samples *s, const double o[3], const double d[3], double *at, size_t count)
{
    for (int i = 0; i < 3; ++i)
        for (int k = 0; d[i] != 0.0 && k <= (int)s->size[i] + 1; ++k)
            at[count++] = (s->origin[i] + s->spacing[i] * (k - (double)s->low) - o[i]) / d[i];
    return count;
}

/* The integral from a to b, in steps by Gauss's rule with three points, and what it adds to *depth. */
static double span_integral(const Case *c, const double o[3], const double d[3], double a, double b, uint color,
                            double *depth)
{
    static const double NODES[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, WEIGHTS[3] = {5.0, 8.0, 5.0};
    double coefficient = (double)vec3_component(c->medium.extinction, color), sum = 0.0;
    int steps = 24 + (int)fmin(coefficient * (b - a) * 4.0, 4000.0);
    for (int n = 0; n < steps && *depth < 30.0; ++n) {
        double h = (b - a) / steps, begin = a + n * h, step = 0.0;
        for (int k = 0; k < 3; ++k) {
            double s = begin + h * NODES[k], before = 0.0;
            const double p[3] = {o[0] + s * d[0], o[1] + s * d[1], o[2] + s * d[2]};
            for (int m = 0; m < 3; ++m) {
                double r = begin + h * NODES[k] * NODES[m];
                const double q[3] = {o[0] + r * d[0], o[1] + r * d[1], o[2] + r * d[2]};
                before += h * NODES[k] * WEIGHTS[m] / 18.0 * point_density(c, q, color);
            }
            sum += h * WEIGHTS[k] / 18.0 * point_emission(c, p, color) * exp(-*depth - coefficient * before);
            step += h * WEIGHTS[k] / 18.0 * point_density(c, p, color);
        }
        *depth += coefficient * step;
    }
    return sum;
}

static double case_integral(const Case *c, const double o[3], const double d[3], double distance, uint color)
{
    static double at[1024];
    const Samples *s = &c->density;
    double begin = 0.0, end = distance, sum = 0.0, depth = 0.0;
    size_t count = kinks_add(s, o, d, at, 0);
    count = kinks_add(&c->emission, o, d, at, count);
    for (int i = 0; i < 3; ++i) {
        double low = s->origin[i], high = low + s->spacing[i] * s->size[i];
        if (d[i] == 0.0 && (o[i] < low || o[i] > high))
            return 0.0;
        if (d[i] == 0.0)
            continue;
        begin = fmax(begin, fmin((low - o[i]) / d[i], (high - o[i]) / d[i]));
        end = fmin(end, fmax((low - o[i]) / d[i], (high - o[i]) / d[i]));
    }
    at[count++] = begin;
    at[count++] = end;
    qsort(at, count, sizeof *at, double_compare);
    for (size_t i = 0; i + 1 < count; ++i) {
        double a = fmax(at[i], begin), b = fmin(at[i + 1], end);
        if (b > a)
            sum += span_integral(c, o, d, a, b, color, &depth);
    }
    return sum;
}

/* ---- cases ------------------------------------------------------------------------------------------------------- */

enum {
    CASE_FACTORS,
    CASE_OPAQUE,
    CASE_FLAME,
    CASE_STEEP,
    CASE_BOTH,
    CASE_COLORS,
    CASE_ACROSS,
    CASE_HOT,
    CASE_CELSIUS,
    CASE_KINDS
};
static const char *const NAMES[CASE_KINDS] = {"factors", "opaque",   "flame", "steep",  "temperature and factor",
                                              "colours", "two sets", "hot",   "celsius"};

static void samples_make(Samples *s, const uint size[3], uint words, double origin, double extent)
{
    s->words = words;
    s->low = 0.5f;
    for (int i = 0; i < 3; ++i) {
        s->size[i] = size[i];
        s->origin[i] = origin;
        s->spacing[i] = extent / size[i];
    }
}

/* The emission's value of one sample. r: distance from the middle, 1 at the faces. */
static float emission_value(int kind, uint word, double r, uint64_t *state)
{
    float u = test_uniform(state);
    switch (kind) {
    case CASE_FLAME:
        return (float)(1700.0 * exp(-1.5 * r * r));
    case CASE_STEEP:
        return u < 0.5f ? 0.0f : 2400.0f * u;
    case CASE_ACROSS:
        return 600.0f + 1200.0f * u;
    case CASE_BOTH:
        return word == 0 ? 1400.0f + 300.0f * u : u;
    case CASE_HOT:
        return u < 0.3f ? 0.0f : 20000.0f * u;
    case CASE_CELSIUS:
        return 700.0f + 400.0f * u;
    default:
        return u < 0.3f ? 0.0f : u;
    }
}

static void samples_fill(Samples *s, int kind, bool density, uint64_t *state)
{
    size_t at = 0;
    for (uint z = 0; z < s->size[2]; ++z)
        for (uint y = 0; y < s->size[1]; ++y)
            for (uint x = 0; x < s->size[0]; ++x)
                for (uint w = 0; w < s->words; ++w) {
                    double a = 2.0 * (x + 0.5) / s->size[0] - 1.0, b = 2.0 * (y + 0.5) / s->size[1] - 1.0,
                           c = 2.0 * (z + 0.5) / s->size[2] - 1.0;
                    float u = test_uniform(state);
                    s->values[at++] = density ? (u < 0.25f ? 0.0f : 2.0f * u)
                                              : emission_value(kind, w, sqrt(a * a + b * b + c * c), state);
                }
}

static Case *case_make(int kind)
{
    static const uint SIZE[3] = {9, 7, 12}, OTHER[3] = {5, 13, 8};
    static const Vec3 COEFFICIENTS[CASE_KINDS] = {{0.3f, 2.0f, 9.0f},  {3.0f, 90.0f, 9000.0f}, {0.5f, 1.0f, 2.0f},
                                                  {1.0f, 3.0f, 20.0f}, {1.0f, 2.0f, 4.0f},     {2.0f, 1.0f, 30.0f},
                                                  {1.0f, 4.0f, 8.0f},  {1.0f, 3.0f, 10.0f},    {1.0f, 3.0f, 10.0f}};
    Case *c = calloc(1, sizeof *c);
    uint64_t state = 41u + (uint64_t)kind;
    ck_assert_ptr_nonnull(c);
    c->kelvins = kind != CASE_FACTORS && kind != CASE_OPAQUE && kind != CASE_COLORS;
    c->kelvin = (GridKelvin){kind == CASE_BOTH ? 1.2f : 1.0f, kind == CASE_CELSIUS ? 273.15f : 0.0f};
    c->medium.extinction = COEFFICIENTS[kind];
    c->medium.emission = vec3(1.0f, 2.0f, 3.0f);
    samples_make(&c->density, SIZE, kind == CASE_COLORS ? 6u : 1u, -1.0, 2.0);
    bool across = kind == CASE_ACROSS;
    samples_make(&c->emission, across ? OTHER : SIZE, kind == CASE_COLORS ? 6u : (kind == CASE_BOTH ? 2u : 1u),
                 across ? -0.9 : -1.0, across ? 1.7 : 2.0);
    samples_fill(&c->density, kind, true, &state);
    samples_fill(&c->emission, kind, false, &state);
    case_build(c);
    return c;
}

/* A ray from outside or inside, or along an axis. */
static void ray_make(uint64_t *state, int n, Vec3 *o, Vec3 *d)
{
    float origin[3], direction[3];
    for (int i = 0; i < 3; ++i) {
        origin[i] = (n % 2 == 0 ? 1.0f : 3.0f) * (2.0f * test_uniform(state) - 1.0f);
        direction[i] = 1.8f * (test_uniform(state) - 0.5f) - origin[i];
        if (n % 5 == 4)
            direction[i] = i == n % 3 ? -origin[i] : 0.0f;
    }
    *o = vec3(origin[0], origin[1], origin[2]);
    *d = vec3_normalize(vec3(direction[0], direction[1], direction[2]));
}

/* Every ray's error is below 1e-3 of its light: of that of a colour or, where that is less, of a fifth of its brightest
 * colour's, or of a thousandth of the brightest ray's. */
START_TEST(test_integrals)
{
    enum { RAYS = 120 };
    static double expected[RAYS][3], got[RAYS][3];
    Case *c = case_make(_i);
    uint64_t state = 7;
    double worst = 0.0, brightest[3] = {0.0};
    for (int n = 0; n < RAYS; ++n) {
        Vec3 o, d;
        ray_make(&state, n, &o, &d);
        const double from[3] = {(double)o.x, (double)o.y, (double)o.z}, to[3] = {(double)d.x, (double)d.y, (double)d.z};
        float distance = n % 3 == 0 ? 2.0f * test_uniform(&state) : FLOAT_INFINITY;
        Vec3 light = grid_emission(&c->view, &c->medium, o, d, distance);
        for (uint k = 0; k < 3; ++k) {
            expected[n][k] = case_integral(c, from, to, n % 3 == 0 ? (double)distance : 1e6, k);
            got[n][k] = (double)vec3_component(light, k);
            brightest[k] = fmax(brightest[k], expected[n][k]);
        }
    }
    for (int n = 0; n < RAYS; ++n)
        for (int k = 0; k < 3; ++k) {
            double most = fmax(expected[n][0], fmax(expected[n][1], expected[n][2]));
            double scale = fmax(fmax(expected[n][k], 0.2 * most), 1e-3 * brightest[k]);
            worst = scale > 0.0 ? fmax(worst, fabs(got[n][k] - expected[n][k]) / scale) : worst;
            TEST_TRUE(expected[n][k] > 0.0 || got[n][k] < 1e-6);
        }
    printf("%s: light of %d rays is off by at most %.2g\n", NAMES[_i], RAYS, worst);
    ck_assert_double_le(worst, 1e-3);
    scene_destroy(&c->scene);
    free(c);
}
END_TEST

/* A part of a ray and the rest of it, behind the part's extinction, make the whole. */
START_TEST(test_parts)
{
    Case *c = case_make(CASE_BOTH);
    Vec3 o = vec3(-2.0f, 0.13f, -0.21f), d = vec3_normalize(vec3(1.0f, 0.11f, 0.07f));
    Vec3 all = grid_emission(&c->view, &c->medium, o, d, FLOAT_INFINITY);
    Vec3 near = grid_emission(&c->view, &c->medium, o, d, 1.9f);
    Vec3 far = grid_emission(&c->view, &c->medium, vec3_mad(o, 1.9f, d), d, FLOAT_INFINITY);
    Vec3 column = grid_column(&c->view, 0u, o, d, 1.9f, 0u, FLOAT_INFINITY).sums;
    for (uint k = 0; k < 3; ++k) {
        float depth = vec3_component(column, k) * vec3_component(c->medium.extinction, k);
        float sum = vec3_component(near, k) + float_exp(-depth) * vec3_component(far, k);
        ck_assert_float_gt(vec3_component(near, k), 0.0f);
        TEST_NEAR(sum / vec3_component(all, k), 1.0, 1e-4);
    }
    scene_destroy(&c->scene);
    free(c);
}
END_TEST

/* The table against what it is made of; all grids of a scene share it. */
START_TEST(test_table)
{
    Case *c = case_make(CASE_FLAME);
    uint64_t state = 3;
    uint table = ARRAY_AT(&c->scene.grids, MediumGrid, 1).table, number;
    float largest[6];
    Error error = {{0}, {0}};
    double worst = 0.0;
    for (int n = 0; n < 3000; ++n) {
        float kelvin = 700.0f * powf(40.0f, test_uniform(&state)), rgb[3];
        color_blackbody_relative(kelvin, rgb);
        Vec3 got = blackbody_radiance(&c->view, table, kelvin);
        for (uint k = 0; k < 3; ++k) {
            double limit = fmax((double)rgb[k], 0.1 * (double)rgb[0]); /* blue begins at 1900 K */
            worst = fmax(worst, fabs((double)vec3_component(got, k) - (double)rgb[k]) / limit);
        }
    }
    printf("black bodies are off by at most %.2g\n", worst);
    ck_assert_double_le(worst, 1e-3);
    ck_assert_float_eq(blackbody_radiance(&c->view, table, -5.0f).x, 0.0f);
    ck_assert_float_lt(blackbody_radiance(&c->view, table, 1e30f).x, 1e-2f);
    GridSource source = samples_source(&c->emission);
    ck_assert(grid_emission_add(&c->scene, 1u, &source, &c->kelvin, largest, &error));
    number = (uint)c->scene.grids.count - 1;
    ck_assert_uint_eq(ARRAY_AT(&c->scene.grids, MediumGrid, number).table, table);
    ck_assert_uint_eq(c->scene.lookup.count, BLACKBODY_WORDS);
    scene_destroy(&c->scene);
    free(c);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("grid emission");
    TCase *tcase = tcase_create("grids");
    tcase_set_timeout(tcase, 240.0);
    tcase_add_loop_test(tcase, test_integrals, 0, CASE_KINDS);
    tcase_add_test(tcase, test_parts);
    tcase_add_test(tcase, test_table);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
