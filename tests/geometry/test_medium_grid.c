/* Media of grids: integrals along rays and the distances at which they reach a target, against integrals in double
 * precision that know nothing of cells in bricks. */
#include "geometry/trilinear.h"
#include "math/test_math.h"

#include "geometry/medium_grid.h"
#include "math/elementary.h"
#include "scene/grid_build.h"

#include <string.h>

enum { SAMPLES_MAX = 24 * 24 * 24 };

/* A grid in a scene, and its samples as they were given. The box is the grid's extent in the world. */
typedef struct Case {
    uint size[3], words;
    float low;
    double origin[3], spacing[3]; /* where the box begins; what a sample takes */
    float values[6 * SAMPLES_MAX];
    Scene scene;
    SceneView view;
    float largest[6];
} Case;

static void case_sample(const void *context, const uint index[3], float *out)
{
    const Case *c = context;
    size_t at = ((size_t)index[2] * c->size[1] + index[1]) * c->size[0] + index[0];
    memcpy(out, c->values + at * c->words, c->words * sizeof *out);
}

static void case_build(Case *c)
{
    GridSource source = {.words = c->words, .low = c->low, .sample = case_sample, .context = c};
    uint number;
    Error error = {{0}, {0}};
    source.grid_from_world = matrix_identity();
    for (int i = 0; i < 3; ++i) {
        source.size[i] = c->size[i];
        source.grid_from_world.m[5 * i] = 1.0 / c->spacing[i];
        source.grid_from_world.m[4 * i + 3] = (double)c->low - c->origin[i] / c->spacing[i];
    }
    scene_init(&c->scene);
    ck_assert_msg(grid_add(&c->scene, &source, &number, c->largest, &error), "%s", error.message);
    ck_assert_uint_eq(number, 1);
    c->view = (SceneView){.grids = c->scene.grids.data, .texels = c->scene.texels.data};
}

/* Sample i of an axis, 0 beyond the ends. */
static double case_value(const void *context, const int index[3], uint word)
{
    const Case *c = context;
    uint at[3];
    for (int i = 0; i < 3; ++i) {
        if (index[i] < 0 || index[i] >= (int)c->size[i])
            return 0.0;
        at[i] = (uint)index[i];
    }
    float value[6];
    case_sample(c, at, value);
    return c->largest[word] > 0.0f ? (double)value[word] / (double)c->largest[word] : 0.0;
}

/* The factor at a point of the world in the box. */
static double case_factor(const Case *c, const double p[3], uint word)
{
    return trilinear_value(p, c->origin, c->spacing, c->low, case_value, c, word);
}

static int double_compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Integral of the factor along a ray up to `distance`: by Gauss's rule with three points between all planes that go
 * through samples. */
static double case_integral(const Case *c, const double o[3], const double d[3], double distance, uint word)
{
    static double at[8192];
    double begin = 0.0, end = distance, sum = 0.0;
    size_t count = 0;
    for (int i = 0; i < 3; ++i) {
        double low = c->origin[i], high = low + c->spacing[i] * c->size[i];
        if (d[i] == 0.0) {
            if (o[i] < low || o[i] > high)
                return 0.0;
            continue;
        }
        begin = fmax(begin, fmin((low - o[i]) / d[i], (high - o[i]) / d[i]));
        end = fmin(end, fmax((low - o[i]) / d[i], (high - o[i]) / d[i]));
        for (int k = 0; k <= (int)c->size[i] + 1; ++k)
            at[count++] = (low + c->spacing[i] * (k - (double)c->low) - o[i]) / d[i];
    }
    if (!(begin < end))
        return 0.0;
    at[count++] = begin;
    at[count++] = end;
    qsort(at, count, sizeof *at, double_compare);
    for (size_t i = 0; i + 1 < count; ++i) {
        static const double NODES[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, WEIGHTS[3] = {5.0, 8.0, 5.0};
        double a = fmax(at[i], begin), b = fmin(at[i + 1], end);
        for (int n = 0; n < 3 && b > a; ++n) {
            double s = a + (b - a) * NODES[n];
            const double p[3] = {o[0] + s * d[0], o[1] + s * d[1], o[2] + s * d[2]};
            sum += (b - a) * WEIGHTS[n] / 18.0 * case_factor(c, p, word);
        }
    }
    return sum;
}

/* ---- grids ------------------------------------------------------------------------------------------------------- */

enum {
    GRID_ONE,
    GRID_ROW,
    GRID_RAMP,
    GRID_CHECKER,
    GRID_SPARSE,
    GRID_SPREAD,
    GRID_RGB,
    GRID_INDEX,
    GRID_FAR,
    GRID_KINDS
};

static float kind_value(int kind, uint x, uint y, uint z, uint64_t *state)
{
    switch (kind) {
    case GRID_ONE:
        return 3.0f;
    case GRID_RAMP:
        return (float)(x + 2 * y + 3 * z);
    case GRID_CHECKER:
        return (float)((x + y + z) & 1u);
    /* A single ball in two of twenty-seven bricks. */
    case GRID_SPARSE:
        return x > 9 && x < 19 && y > 9 && y < 14 && z > 9 && z < 14 ? test_uniform(state) : 0.0f;
    case GRID_SPREAD:
        return (test_random(state) & 3u) == 0u ? powf(10.0f, 60.0f * test_uniform(state) - 30.0f) : 0.0f;
    default:
        return test_uniform(state) < 0.3f ? 0.0f : test_uniform(state);
    }
}

static Case *case_make(int kind)
{
    static const uint SIZES[GRID_KINDS][3] = {{1, 1, 1},  {1, 7, 3},  {4, 3, 5},   {9, 8, 7}, {20, 20, 20},
                                              {6, 6, 24}, {5, 17, 4}, {17, 9, 12}, {5, 6, 7}};
    Case *c = calloc(1, sizeof *c);
    uint64_t state = 77u + (uint64_t)kind;
    ck_assert_ptr_nonnull(c);
    c->words = kind == GRID_RGB ? 6 : 1;
    c->low = kind == GRID_INDEX ? 1.0f : 0.5f;
    for (int i = 0; i < 3; ++i) {
        c->size[i] = SIZES[kind][i];
        c->origin[i] = kind == GRID_FAR ? 64.0 : -1.0;
        c->spacing[i] = (kind == GRID_FAR ? 0.5 : 2.0) / c->size[i];
    }
    size_t at = 0;
    for (uint z = 0; z < c->size[2]; ++z)
        for (uint y = 0; y < c->size[1]; ++y)
            for (uint x = 0; x < c->size[0]; ++x)
                for (uint w = 0; w < c->words; ++w)
                    c->values[at++] = kind_value(kind, x, y, z, &state);
    case_build(c);
    return c;
}

static void case_free(Case *c)
{
    scene_destroy(&c->scene);
    free(c);
}

/* ---- rays -------------------------------------------------------------------------------------------------------- */

/* A ray near the box: from inside or outside, along axes, in faces of the box and through its edges, with components
 * that are tiny beside the others. */
static void ray_make(const Case *c, uint64_t *state, Vec3 *o, Vec3 *d)
{
    float origin[3], direction[3];
    uint how = (uint)(test_random(state) % 8u), axis = (uint)(test_random(state) % 3u);
    for (uint i = 0; i < 3; ++i) {
        float extent = (float)(c->spacing[i] * c->size[i]);
        origin[i] = (float)c->origin[i] + extent * (how < 4 ? test_uniform(state) : 3.0f * test_uniform(state) - 1.0f);
        float to = (float)c->origin[i] + extent * test_uniform(state);
        direction[i] = to - origin[i];
        if (how == 1 || how == 5)
            direction[i] = i == axis ? (test_uniform(state) < 0.5f ? 1.0f : -1.0f) : 0.0f;
        if (how == 6 && i != axis)
            direction[i] *= 1e-20f;
        if (how == 2 && i != axis) /* in a plane through samples or in a face */
            origin[i] = (float)(c->origin[i] + c->spacing[i] * (double)(test_random(state) % (c->size[i] + 1u)));
        if (how == 7) /* from one corner to another */
            origin[i] = (float)c->origin[i] + (test_uniform(state) < 0.5f ? 0.0f : extent);
    }
    *o = vec3(origin[0], origin[1], origin[2]);
    *d = vec3_normalize(vec3(direction[0], direction[1], direction[2]));
}

static void ray_doubles(Vec3 o, Vec3 d, double out_o[3], double out_d[3])
{
    const double from[3] = {(double)o.x, (double)o.y, (double)o.z}, to[3] = {(double)d.x, (double)d.y, (double)d.z};
    memcpy(out_o, from, sizeof from);
    memcpy(out_d, to, sizeof to);
}

/* Largest error as a part of the box's diagonal, which is the largest integral: for a distant grid, the rounding of
 * coordinates. */
static double tolerance_of(const Case *c, double tolerance)
{
    return fmax(tolerance, (double)FLOAT_EPSILON * fabs(c->origin[0]) / c->spacing[0]);
}

START_TEST(test_columns)
{
    Case *c = case_make(_i);
    uint64_t state = 5;
    double worst = 0.0, diagonal = sqrt(3.0) * c->spacing[0] * c->size[0];
    for (int n = 0; n < 20000; ++n) {
        Vec3 o, d;
        double from[3], along[3], limit;
        ray_make(c, &state, &o, &d);
        ray_doubles(o, d, from, along);
        float distance = n % 3 == 0 ? (float)diagonal * test_uniform(&state) : FLOAT_INFINITY;
        limit = n % 3 == 0 ? (double)distance : 1e6;
        GridColumn column = grid_column(&c->view, 0u, o, d, distance, 0u, FLOAT_INFINITY);
        TEST_TRUE(!column.reached);
        for (uint w = 0; w < (c->words == 1 ? 1u : 3u); ++w) {
            double expected = case_integral(c, from, along, limit, w);
            double error = fabs((double)vec3_component(column.sums, w) - expected) / diagonal;
            worst = fmax(worst, error);
        }
    }
    printf("grid %d: integrals of 20000 rays are off by at most %.2g of the diagonal\n", _i, worst);
    ck_assert_double_le(worst, tolerance_of(c, 2e-6));
    case_free(c);
}
END_TEST

/* The distance to a target: the integral up to it is the target. */
START_TEST(test_distances)
{
    Case *c = case_make(_i);
    uint64_t state = 9;
    double worst = 0.0, diagonal = sqrt(3.0) * c->spacing[0] * c->size[0];
    uint colors = c->words == 1 ? 1u : 3u, reached = 0;
    for (int n = 0; n < 20000; ++n) {
        Vec3 o, d;
        double from[3], along[3];
        ray_make(c, &state, &o, &d);
        ray_doubles(o, d, from, along);
        uint channel = (uint)n % colors;
        GridColumn all = grid_column(&c->view, 0u, o, d, FLOAT_INFINITY, 0u, FLOAT_INFINITY);
        float u = test_uniform(&state), target = vec3_component(all.sums, channel) * (n % 2 == 0 ? u : u * u * u * u);
        GridColumn column = grid_column(&c->view, 0u, o, d, FLOAT_INFINITY, channel, target);
        reached += column.reached ? 1u : 0u;
        if (!column.reached)
            continue;
        TEST_NEAR(vec3_component(column.sums, channel), target, 2e-6 * diagonal);
        for (uint w = 0; w < colors; ++w) {
            double expected = case_integral(c, from, along, (double)column.distance, w);
            worst = fmax(worst, fabs((double)vec3_component(column.sums, w) - expected) / diagonal);
        }
    }
    printf("grid %d: %u distances, integrals off by at most %.2g of the diagonal\n", _i, reached, worst);
    ck_assert_uint_gt(reached, 2000);
    ck_assert_double_le(worst, tolerance_of(c, 2e-6));
    case_free(c);
}
END_TEST

/* Distances drawn along one ray: Kolmogorov and Smirnov's test against their exact distribution, with an optical depth
 * of 3 across the box. */
START_TEST(test_distribution)
{
    enum { COUNT = 20000 };
    static double at[COUNT];
    Case *c = case_make(_i);
    uint64_t state = 21;
    Vec3 o = vec3((float)c->origin[0] - 0.1f, (float)(c->origin[1] + 0.57 * c->spacing[1] * c->size[1]),
                  (float)(c->origin[2] + 0.61 * c->spacing[2] * c->size[2]));
    Vec3 d = vec3_normalize(vec3(1.0f, 0.02f, -0.02f));
    double from[3], along[3], worst = 0.0;
    ray_doubles(o, d, from, along);
    double coefficient = 3.0 / case_integral(c, from, along, 1e6, 0u);
    int count = 0;
    for (int n = 0; n < COUNT; ++n) {
        float target = -float_log(test_uniform(&state)) / (float)coefficient;
        GridColumn column = grid_column(&c->view, 0u, o, d, FLOAT_INFINITY, 0u, target);
        if (column.reached)
            at[count++] = (double)column.distance;
    }
    TEST_NEAR((double)count / COUNT, 1.0 - exp(-3.0), 4.0 * sqrt(0.05 * 0.95 / COUNT));
    qsort(at, (size_t)count, sizeof *at, double_compare);
    for (int n = 0; n < count; ++n) {
        double below = (1.0 - exp(-coefficient * case_integral(c, from, along, at[n], 0u))) / (1.0 - exp(-3.0));
        worst = fmax(worst, fabs(below - (n + 0.5) / count));
    }
    ck_assert_msg(worst * sqrt((double)count) < 1.95, "grid %d: distances: Kolmogorov-Smirnov %g", _i,
                  worst * sqrt((double)count)); /* one in a thousand */
    case_free(c);
}
END_TEST

/* ---- points ------------------------------------------------------------------------------------------------------ */

/* Factors are from 0 to 1, and each of the three coordinates is off by up to one and a half roundings of
 * tolerance_of. */
START_TEST(test_points)
{
    Case *c = case_make(_i);
    uint64_t state = 33;
    double tolerance = fmax(1e-5, 4.5 * tolerance_of(c, 0.0));
    for (int n = 0; n < 20000; ++n) {
        double p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = (double)(float)(c->origin[i] + c->spacing[i] * c->size[i] * (double)test_uniform(&state));
        Vec3 point = vec3((float)p[0], (float)p[1], (float)p[2]);
        Vec3 extinction = grid_factors(&c->view, 0u, point, false),
             scattering = grid_factors(&c->view, 0u, point, true);
        for (uint w = 0; w < 3; ++w) {
            TEST_NEAR(vec3_component(extinction, w), case_factor(c, p, c->words == 1 ? 0 : w), tolerance);
            TEST_NEAR(vec3_component(scattering, w), case_factor(c, p, c->words == 1 ? 0 : 3 + w), tolerance);
        }
    }
    case_free(c);
}
END_TEST

/* Bricks without any value take no samples; those beside each other with the same value share theirs. */
START_TEST(test_memory)
{
    Case *c = case_make(GRID_SPARSE);
    ck_assert_uint_eq(c->scene.texels.count, 27 + 2 * GRID_BRICK_SAMPLES);
    case_free(c);
    c = calloc(1, sizeof *c);
    ck_assert_ptr_nonnull(c);
    c->words = 1;
    for (int i = 0; i < 3; ++i) {
        c->size[i] = 24;
        c->spacing[i] = 1.0;
    }
    for (size_t i = 0; i < SAMPLES_MAX; ++i)
        c->values[i] = 1e30f;
    case_build(c);
    ck_assert_uint_eq(c->scene.texels.count, 64 + 57 * GRID_BRICK_SAMPLES); /* 8 of 64 bricks are not at the border */
    ck_assert_float_eq(c->largest[0], 1e30f);
    case_free(c);
    /* Two constant bricks of different values. */
    c = calloc(1, sizeof *c);
    ck_assert_ptr_nonnull(c);
    c->words = 1;
    for (int i = 0; i < 3; ++i) {
        c->size[i] = i == 0 ? 32 : 16;
        c->spacing[i] = 1.0;
    }
    for (size_t i = 0; i < 32 * 16 * 16; ++i)
        c->values[i] = i % 32 < 16 ? 1.0f : 2.0f;
    case_build(c);
    ck_assert_float_eq(grid_factors(&c->view, 0u, vec3(11.0f, 11.0f, 11.0f), false).x, 0.5f);
    ck_assert_float_eq(grid_factors(&c->view, 0u, vec3(27.0f, 11.0f, 11.0f), false).x, 1.0f);
    case_free(c);
}
END_TEST

/* Changes the map's translation so that it takes p to q. */
static void map_shift(Affine *map, Vec3 p, Vec3 q)
{
    Vec3 image = affine_vector(*map, p);
    map->m[3] = q.x - image.x;
    map->m[7] = q.y - image.y;
    map->m[11] = q.z - image.z;
}

/* A scene without a file that is far from the origin is moved there, and its grids with it. */
START_TEST(test_moved)
{
    static const float square[9] = {8999, -1, 0, 9001, -1, 0, 8999, 1, 0};
    static const uint indices[3] = {0, 1, 2};
    const MeshData mesh = {.positions = square, .vertex_count = 3, .indices = indices, .triangle_count = 1};
    const Material material = {.kind = MATERIAL_DIFFUSE, .normal_map = NONE, .displacement.program = NONE};
    const LightData light = {.kind = LIGHT_POINT, .emission = {1, 1, 1}, .detail.position = {9000, 0, 1}};
    Case *c = case_make(GRID_ROW);
    uint index;
    Error error = {{0}, {0}};
    Vec3 corner = vec3(8999.0f, -1.0f, -1.0f);
    map_shift(&ARRAY_AT(&c->scene.grids, MediumGrid, 0).grid_from_world, corner, vec3(0.5f, 0.5f, 0.5f));
    ck_assert(scene_add_material(&c->scene, &material, &index, &error));
    ck_assert(scene_add_mesh(&c->scene, &mesh, (Shape){.alpha = NONE}, NULL, 0, &error));
    ck_assert(scene_add_light(&c->scene, &light, &error));
    c->scene.movable = true;
    ck_assert_msg(scene_finish(&c->scene, &error), "%s", error.message);
    Affine map = ARRAY_AT(&c->scene.grids, MediumGrid, 0).grid_from_world;
    TEST_NEAR(affine_point(map, vec3(-1.0f, -1.0f, -1.0f)).x, 0.5, 1e-3);
    TEST_NEAR(affine_point(map, vec3(-1.0f, -1.0f, -1.0f)).y, 0.5, 1e-3);
    case_free(c);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("medium grid");
    TCase *tcase = tcase_create("grids");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_loop_test(tcase, test_columns, 0, GRID_KINDS);
    tcase_add_loop_test(tcase, test_distances, 0, GRID_KINDS);
    tcase_add_loop_test(tcase, test_distribution, 0, GRID_KINDS);
    tcase_add_loop_test(tcase, test_points, 0, GRID_KINDS);
    tcase_add_test(tcase, test_memory);
    tcase_add_test(tcase, test_moved);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
