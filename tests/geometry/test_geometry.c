/* Rays and triangles in isolation: watertightness, accuracy, offsets, symmetry. */
#include "geometry/geometry_suites.h"
#include "support/geometry_fixture.h"

#include <string.h>

/* References are deliberately computed in long double from floats. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"

/* The hardest points of a triangle mesh: exactly a corner, or on an edge up to rounding. */
static Vec3 mesh_hard_point(const TestMesh *mesh, TestRandom *random, bool corner)
{
    const uint *triangle = mesh->indices + 3 * (size_t)random_below(random, (uint)mesh->triangle_count);
    uint k = random_below(random, 3);
    Vec3 p = mesh->positions[triangle[k]], q = mesh->positions[triangle[(k + 1) % 3]];
    return corner ? p : vec3_lerp(p, q, random_unit(random));
}

static uint mesh_hits(const TestMesh *mesh, const RayQuery *query)
{
    uint hits = 0;
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        const uint *v = mesh->indices + 3 * i;
        Hit hit;
        hits += triangle_query(mesh->positions[v[0]], mesh->positions[v[1]], mesh->positions[v[2]], query, &hit);
    }
    return hits;
}

static void watertight_check(float scale, Vec3 shift, uint rays, uint seed)
{
    TestRandom random = {.seed = seed};
    TestMesh mesh = mesh_star(6, 7, 0.2f, seed);
    uint missed = 0;
    mesh_map(&mesh, scale, shift);
    for (uint i = 0; i < rays; ++i) {
        Vec3 o = vec3_mad(shift, scale, vec3_scale(random_direction(&random), 0.3f * random_unit(&random)));
        Vec3 target = mesh_hard_point(&mesh, &random, i % 2 == 0);
        Vec3 d = vec3_sub(target, o);
        if (i % 3 != 0)
            d = vec3_normalize(d);
        RayQuery query = ray_query((Ray){o, d, FLOAT_MAX});
        missed += mesh_hits(&mesh, &query) == 0;
    }
    mesh_destroy(&mesh);
    ck_assert_uint_eq(missed, 0);
}

START_TEST(test_watertight)
{
    watertight_check(1.0f, vec3_splat(0.0f), 600000, 1);
    watertight_check(1e-3f, vec3_splat(0.0f), 150000, 2);
    watertight_check(1e4f, vec3(1e4f, -3e3f, 2e4f), 150000, 3);
    watertight_check(1.0f, vec3(1e4f, 1e4f, -1e4f), 150000, 4);
}
END_TEST

typedef struct ExactHit {
    long double t, u, v, cosine;
    bool inside;
} ExactHit;

/* Moeller and Trumbore 1997 in long double. */
static ExactHit triangle_exact(Vec3 a, Vec3 b, Vec3 c, const Ray *ray)
{
    long double e[3] = {(long double)b.x - a.x, (long double)b.y - a.y, (long double)b.z - a.z};
    long double f[3] = {(long double)c.x - a.x, (long double)c.y - a.y, (long double)c.z - a.z};
    long double s[3] = {(long double)ray->o.x - a.x, (long double)ray->o.y - a.y, (long double)ray->o.z - a.z};
    long double d[3] = {ray->d.x, ray->d.y, ray->d.z};
#define CROSS(out, p, q)                                                                                               \
    long double out[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]}
#define DOT(p, q) (p[0] * q[0] + p[1] * q[1] + p[2] * q[2])
    CROSS(h, d, f);
    CROSS(g, s, e);
    CROSS(n, e, f);
    long double determinant = DOT(e, h);
    ExactHit hit = {.t = DOT(f, g) / determinant, .u = DOT(s, h) / determinant, .v = DOT(d, g) / determinant};
    hit.cosine = fabsl(DOT(n, d)) / sqrtl(DOT(n, n) * DOT(d, d));
    hit.inside = hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1 && hit.t > 0;
    return hit;
}

/* Backward errors of a few units in the last place of the coordinates become forward errors divided by the cosine. */
START_TEST(test_triangle_accuracy)
{
    TestRandom random = {.seed = 11};
    double worst_t = 0.0, worst_uv = 0.0;
    uint compared = 0, disagreed = 0;
    for (uint i = 0; i < 400000; ++i) {
        Vec3 p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = vec3_scale(random_direction(&random), random_unit(&random));
        Vec3 o = vec3_scale(random_direction(&random), 2.0f * random_unit(&random));
        Vec3 target = vec3_lerp(vec3_lerp(p[0], p[1], random_unit(&random)), p[2], random_unit(&random));
        Ray ray = {o, vec3_normalize(vec3_sub(target, o)), FLOAT_MAX};
        ExactHit exact = triangle_exact(p[0], p[1], p[2], &ray);
        float t, u, v;
        bool hit = triangle_intersect(p[0], p[1], p[2], &ray, &t, &u, &v);
        long double border = fminl(fminl(exact.u, exact.v), 1 - exact.u - exact.v);
        long double area = vec3_length(triangle_normal(p[0], p[1], p[2]));
        if (hit != exact.inside && (border > 1e-3L) && exact.t > 1e-3L && exact.cosine > 1e-3L && area > 1e-3L)
            ++disagreed;
        if (!hit || exact.cosine < 0.05L || area < 0.05L)
            continue;
        ++compared;
        worst_t = fmax(worst_t, (double)(fabsl(t - exact.t) * exact.cosine));
        worst_uv = fmax(worst_uv, (double)(fmaxl(fabsl(u - exact.u), fabsl(v - exact.v)) * exact.cosine * area));
    }
    ck_assert_uint_eq(disagreed, 0);
    ck_assert_uint_gt(compared, 200000);
    ck_assert_msg(worst_t < 16 * 1.2e-7, "t is off by %g", worst_t);
    ck_assert_msg(worst_uv < 16 * 1.2e-7, "(u, v) is off by %g", worst_uv);
}
END_TEST

START_TEST(test_triangle_refuses)
{
    Ray ray = {{0.25f, 0.25f, -1.0f}, {0.0f, 0.0f, 1.0f}, FLOAT_MAX};
    Vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0}, nan = {NAN, 0, 0}, inf = {INFINITY, 0, 0};
    float t, u, v;
    ck_assert(triangle_intersect(a, b, c, &ray, &t, &u, &v));
    ck_assert(t == 1.0f && u == 0.25f && v == 0.25f);
    ck_assert(triangle_intersect(a, c, b, &ray, &t, &u, &v));
    ck_assert(!triangle_intersect(a, b, b, &ray, &t, &u, &v));
    ck_assert(!triangle_intersect(a, b, vec3(2, 0, 0), &ray, &t, &u, &v));
    ck_assert(!triangle_intersect(a, b, nan, &ray, &t, &u, &v));
    ck_assert(!triangle_intersect(inf, b, c, &ray, &t, &u, &v));
    ray.t_max = 1.0f;
    ck_assert(!triangle_intersect(a, b, c, &ray, &t, &u, &v));
    ray.t_max = 1.001f;
    ck_assert(triangle_intersect(a, b, c, &ray, &t, &u, &v));
    ray.o.z = 0.0f;
    ck_assert(!triangle_intersect(a, b, c, &ray, &t, &u, &v));
    ray.o.x = NAN;
    ck_assert(!triangle_intersect(a, b, c, &ray, &t, &u, &v));
}
END_TEST

/* A closed mesh does not leak: a ray from inside hits something, and does so on the inside. Leaving a hit toward the
 * inside must not hit the same triangle again. */
static void self_intersection_check(float scale, Vec3 shift, uint walks, uint seed)
{
    TestRandom random = {.seed = seed};
    TestScene test;
    TestMesh mesh = mesh_star(8, 9, 0.1f, seed);
    uint lost = 0, self = 0, through = 0;
    mesh_map(&mesh, scale, shift);
    test_scene_init(&test);
    test_scene_mesh(&test, &mesh, 0);
    test_scene_finish(&test);
    for (uint i = 0; i < walks; ++i) {
        Ray ray = {shift, random_direction(&random), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        for (uint step = 0; step < 3 && hit.primitive != NONE; ++step) {
            Surface surface = surface_from_hit(&test.view, &ray, hit);
            Vec3 inward = ray_side(surface.ng, vec3_negate(ray.d));
            Ray next = ray_spawn(surface.p, surface.ng, ray_side(random_direction(&random), inward));
            Hit next_hit = brute_force(&test, &next);
            lost += next_hit.primitive == NONE;
            self += next_hit.primitive == hit.primitive;
            if (next_hit.primitive != NONE) {
                Surface end = surface_from_hit(&test.view, &next, next_hit);
                through += vec3_dot(end.ng, next.d) < 0.0f;
            }
            ray = next;
            hit = next_hit;
        }
        lost += hit.primitive == NONE;
    }
    test_scene_destroy(&test);
    mesh_destroy(&mesh);
    ck_assert_msg(lost == 0 && self == 0, "scale %g: %u lost, %u met themselves", (double)scale, lost, self);
    ck_assert_uint_eq(through, 0);
}

START_TEST(test_self_intersection)
{
    static const float scales[] = {1e-3f, 1e-2f, 1.0f, 37.0f, 1e4f};
    for (uint i = 0; i < 5; ++i) {
        self_intersection_check(scales[i], vec3_splat(0.0f), 12000, 20 + i);
        self_intersection_check(scales[i], vec3_scale(vec3(0.3f, -1.0f, 0.7f), 10.0f * scales[i]), 6000, 40 + i);
    }
    self_intersection_check(1.0f, vec3(1e4f, 0.0f, 0.0f), 12000, 60);
    self_intersection_check(1.0f, vec3(1e4f, -1e4f, 1e4f), 12000, 61);
}
END_TEST

/* A case that an offset by ulps of the point itself does not cover: a hit near (0,0,0) of a triangle whose corners are
 * far away. */
START_TEST(test_large_floor)
{
    TestRandom random = {.seed = 70};
    uint self = 0, blocked = 0;
    for (uint i = 0; i < 300000; ++i) {
        Frame frame = frame_from_normal(random_direction(&random));
        Vec3 a = vec3_add(vec3_scale(frame.t, 1e4f), vec3_scale(frame.b, random_between(&random, -9e3f, 9e3f)));
        Vec3 b = vec3_add(vec3_scale(frame.t, -8e3f), vec3_scale(frame.b, 7e3f));
        Vec3 c = vec3_add(vec3_scale(frame.t, -9e3f), vec3_scale(frame.b, -1.1e4f));
        float u = 0.3f + 0.1f * random_unit(&random), v = 0.35f + 0.1f * random_unit(&random);
        Vec3 p = vec3_add(a, vec3_mad(vec3_scale(vec3_sub(b, a), u), v, vec3_sub(c, a)));
        Vec3 ng = vec3_normalize(triangle_normal(a, b, c));
        Vec3 wi = random_direction(&random);
        Ray ray = ray_spawn(p, ng, wi);
        float t, bu, bv;
        self += triangle_intersect(a, b, c, &ray, &t, &bu, &bv);
        /* Points closer to the plane than p's own rounding (about 10^-3) are on no definite side. */
        float distance = random_between(&random, 1.0f, 100.0f);
        if (float_abs(vec3_dot(ng, wi)) * distance < 0.01f)
            continue;
        Ray segment = ray_between(p, ng, vec3_mad(p, distance, wi), vec3_splat(0.0f));
        blocked += triangle_intersect(a, b, c, &segment, &t, &bu, &bv);
    }
    ck_assert_uint_eq(self, 0);
    ck_assert_uint_eq(blocked, 0);
}
END_TEST

START_TEST(test_ray_between_symmetric)
{
    TestRandom random = {.seed = 80};
    for (uint i = 0; i < 200000; ++i) {
        float scale = expf(random_between(&random, -10.0f, 10.0f));
        Vec3 p = vec3_scale(random_direction(&random), scale), q = vec3_scale(random_direction(&random), scale);
        Vec3 np = random_direction(&random), nq = i % 5 == 0 ? vec3_splat(0.0f) : random_direction(&random);
        if (i % 7 == 0)
            q.x = p.x;
        if (i % 49 == 0)
            q.y = p.y;
        Ray there = ray_between(p, np, q, nq), back = ray_between(q, nq, p, np);
        ck_assert(memcmp(&there, &back, sizeof there) == 0);
        ck_assert(there.t_max == 1.0f);
    }
    Ray none = ray_between(vec3(1, 2, 3), vec3(0, 0, 1), vec3(1, 2, 3), vec3(0, 0, -1));
    ck_assert(none.t_max == 0.0f);
}
END_TEST

START_TEST(test_float_step)
{
    static const float values[] = {1.0f, -1.0f, 1e-42f, -1e-42f, 0.0f, 3.4e38f, 0.99999994f, -2.0f};
    for (uint i = 0; i < sizeof values / sizeof *values; ++i) {
        ck_assert(float_step(values[i], 0.5f) == nextafterf(values[i], INFINITY));
        ck_assert(float_step(values[i], -0.5f) == nextafterf(values[i], -INFINITY));
        ck_assert(float_step(values[i], 0.0f) == values[i]);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("geometry");
    TCase *tcase = tcase_create("rays and triangles");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_watertight);
    tcase_add_test(tcase, test_triangle_accuracy);
    tcase_add_test(tcase, test_triangle_refuses);
    tcase_add_test(tcase, test_self_intersection);
    tcase_add_test(tcase, test_large_floor);
    tcase_add_test(tcase, test_ray_between_symmetric);
    tcase_add_test(tcase, test_float_step);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, geometry_quadrics_tcase());
    suite_add_tcase(suite, geometry_cylinder_tcase());
    suite_add_tcase(suite, geometry_curve_tcase());
    suite_add_tcase(suite, geometry_rays_tcase());
    suite_add_tcase(suite, geometry_backend_tcase());
    return test_run(suite);
}
