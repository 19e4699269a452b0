/* Curves against double precision: which rays hit, t, (u, v), tangents and normals; strands without gaps; rays that
 * leave curves; degenerate curves. */
#include "geometry/geometry_suites.h"
#include "support/geometry_fixture.h"

#include <math.h>

#define STEPS 2000

/* ---- the reference ----------------------------------------------------------------------------------------------- */

static void curve_at(const Curve *c, double u, double p[3], double d[3])
{
    const float *q = &c->p[0].x;
    double w = 1.0 - u;
    for (int i = 0; i < 3; ++i) {
        double a = (double)q[i], b = (double)q[3 + i], e = (double)q[6 + i], f = (double)q[9 + i];
        p[i] = w * w * w * a + 3.0 * w * w * u * b + 3.0 * w * u * u * e + u * u * u * f;
        d[i] = 3.0 * (w * w * (b - a) + 2.0 * w * u * (e - b) + u * u * (f - e));
    }
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Where the axis is at u, as seen along the ray: distance from it, distance along it, the part of the tangent across
 * it; half the width. */
typedef struct Near {
    double u, distance, along, across, half;
} Near;

static Near near_at(const Curve *c, const Ray *ray, double u)
{
    double p[3], tangent[3], o[3] = {(double)ray->o.x, (double)ray->o.y, (double)ray->o.z};
    double d[3] = {(double)ray->d.x, (double)ray->d.y, (double)ray->d.z}, length = sqrt(dot3(d, d));
    curve_at(c, u, p, tangent);
    for (int i = 0; i < 3; ++i) {
        p[i] -= o[i];
        d[i] /= length;
    }
    double along = dot3(p, d), size = sqrt(dot3(tangent, tangent)), t = dot3(tangent, d);
    return (Near){.u = u,
                  .distance = sqrt(fmax(dot3(p, p) - along * along, 0.0)),
                  .along = along,
                  .across = size > 0.0 ? sqrt(fmax(1.0 - t * t / (size * size), 0.0)) : 0.0,
                  .half = 0.5 * ((1.0 - u) * (double)c->width[0] + u * (double)c->width[1])};
}

/* Golden section between u - step and u + step. */
static Near near_refine(const Curve *c, const Ray *ray, double low, double high)
{
    for (int i = 0; i < 40; ++i) {
        double a = low + 0.381966 * (high - low), b = low + 0.618034 * (high - low);
        if (near_at(c, ray, a).distance < near_at(c, ray, b).distance)
            high = b;
        else
            low = a;
    }
    return near_at(c, ray, 0.5 * (low + high));
}

/* What the ray hits first; `unsure`: floats, or the flatness at which the subdivision stops, may decide otherwise. */
typedef struct Exact {
    bool hit, unsure;
    Near first;
} Exact;

static Exact curve_exact(const Curve *c, const Ray *ray)
{
    Exact exact = {.first.along = INFINITY};
    double before = INFINITY, here = near_at(c, ray, 0.0).distance;
    for (int i = 0; i <= STEPS; ++i) {
        double u = (double)i / STEPS, after = i < STEPS ? near_at(c, ray, u + 1.0 / STEPS).distance : INFINITY;
        if (here <= before && here <= after) {
            Near near = near_refine(c, ray, fmax(u - 1.0 / STEPS, 0.0), fmin(u + 1.0 / STEPS, 1.0));
            bool end = near.u < 0.01 || near.u > 0.99;
            bool inside = near.distance <= near.half;
            double start = hypot(near.distance, near.along);
            exact.unsure |= fabs(near.distance - near.half) < 0.1 * near.half + 1e-6;
            exact.unsure |= near.distance < 1.2 * near.half && (near.across < 0.4 || end || start < 2.0 * near.half);
            if (inside && near.along > 0.0 && near.along < exact.first.along) {
                exact.hit = true;
                exact.first = near;
            }
        }
        before = here;
        here = after;
    }
    return exact;
}

static Curve curve_random(TestRandom *random, float bend)
{
    Curve curve = {.width = {random_between(random, 0.02f, 0.1f), random_between(random, 0.0f, 0.1f)}};
    Vec3 d = random_direction(random);
    for (uint k = 0; k < 4; ++k)
        curve.p[k] = vec3_mad(vec3_scale(d, 0.5f * (float)k), bend * random_unit(random), random_direction(random));
    return curve;
}

static Vec3 curve_point(const Curve *c, float u)
{
    Bezier b = {{c->p[0], c->p[1], c->p[2], c->p[3]}};
    return bezier_blossom(&b, u, u, u);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

/* What surface_from_hit makes of a hit. */
static void record_check(const TestScene *test, const Curve *c, const Ray *ray, const Hit *hit, bool round)
{
    double p[3], d[3];
    Surface s = surface_from_hit(&test->view, ray, *hit);
    curve_at(c, (double)hit->u, p, d);
    ck_assert(vec3_length(vec3_sub(s.p, vec3((float)p[0], (float)p[1], (float)p[2]))) < 1e-5f);
    Vec3 derivative = vec3((float)d[0], (float)d[1], (float)d[2]), tangent = vec3_normalize(derivative);
    ck_assert(vec3_length(vec3_sub(s.dpdu, derivative)) < 1e-4f * (1.0f + vec3_length(derivative)));
    ck_assert(vec3_length(vec3_sub(s.ng, vec3_scale(tangent, FIBRE_NORMAL))) < 1e-3f);
    ck_assert(s.uv.x == hit->u && s.uv.y == hit->v);
    /* the offset of the ray from the axis, along dp/dv of a flat curve */
    Vec3 at = vec3_mad(ray->o, hit->t, ray->d), across = vec3_normalize(vec3_cross(ray->d, tangent));
    float width = (1.0f - hit->u) * c->width[0] + hit->u * c->width[1];
    float v = 0.5f + vec3_dot(vec3_sub(at, s.p), across) / width;
    ck_assert_msg(fabsf(v - hit->v) < 0.06f, "v is %g, not %g", (double)hit->v, (double)v);
    float angle = round ? PI * (hit->v - 0.5f) : 0.0f;
    Vec3 facing = vec3_cross(tangent, across);
    Vec3 normal = vec3_mad(vec3_scale(facing, cosf(angle)), sinf(angle), across);
    ck_assert(vec3_length(vec3_sub(s.ns, normal)) < 2e-3f);
    Vec3 dpdv = vec3_sub(vec3_scale(across, cosf(angle) * width), vec3_scale(facing, sinf(angle) * width));
    ck_assert(vec3_length(vec3_sub(s.dpdv, dpdv)) < 2e-3f);
    ck_assert(vec3_dot(facing, ray->d) > 0.0f);
}

/* Random curves and rays near them. */
START_TEST(test_curve_accuracy)
{
    TestRandom random = {.seed = 800};
    uint disagreed = 0, hits = 0, misses = 0;
    double worst = 0.0;
    for (uint k = 0; k < 120; ++k) {
        TestScene test;
        Curve curve = curve_random(&random, k % 3 == 0 ? 0.0f : 0.5f);
        bool round = k % 2 == 0;
        test_scene_init(&test);
        test_scene_curves(&test, &curve, 1, k % 5, round ? CURVE_ROUND : CURVE_FLAT);
        test_scene_finish(&test);
        for (uint i = 0; i < 100; ++i) {
            Vec3 target = vec3_mad(curve_point(&curve, random_unit(&random)), 0.08f * random_unit(&random),
                                   random_direction(&random));
            Vec3 o = vec3_mad(target, random_between(&random, 0.5f, 4.0f), random_direction(&random));
            Ray ray = {o, vec3_scale(vec3_sub(target, o), i % 2 == 0 ? 1.0f : 0.01f), FLOAT_MAX};
            Exact exact = curve_exact(&curve, &ray);
            Hit hit = brute_force(&test, &ray);
            if (exact.unsure)
                continue;
            disagreed += exact.hit != (hit.primitive != NONE);
            misses += !exact.hit;
            if (!exact.hit || hit.primitive == NONE)
                continue;
            ++hits;
            double t = (double)hit.t * (double)vec3_length(ray.d);
            worst = fmax(worst, fabs(t - exact.first.along) * exact.first.across / exact.first.half);
            record_check(&test, &curve, &ray, &hit, round);
        }
        test_scene_destroy(&test);
    }
    printf("# curves: %u hits, %u misses, %u disagreements, t off by at most %.3g radii\n", hits, misses, disagreed,
           worst);
    ck_assert_uint_gt(hits, 3000);
    ck_assert_uint_gt(misses, 1000);
    ck_assert_uint_eq(disagreed, 0);
    ck_assert_msg(worst < 0.5, "t is off by %g radii", worst);
}
END_TEST

/* Segments of a uniform cubic B-spline. */
static void strand_make(TestRandom *random, float scale, Vec3 shift, float width, Curve *segments, uint count)
{
    Vec3 point[16];
    for (uint i = 0; i < count + 3u; ++i)
        point[i] =
            vec3_mad(shift, scale, vec3(0.4f * (float)i, 0.15f * random_unit(random), 0.15f * random_unit(random)));
    for (uint i = 0; i < count; ++i) {
        const Vec3 *q = &point[i];
        Curve *c = &segments[i];
        Vec3 middle = vec3_sub(q[2], q[1]);
        c->p[0] = vec3_scale(vec3_add(vec3_add(q[0], vec3_scale(q[1], 4.0f)), q[2]), 1.0f / 6.0f);
        c->p[1] = vec3_mad(q[1], 1.0f / 3.0f, middle);
        c->p[2] = vec3_mad(q[1], 2.0f / 3.0f, middle);
        c->p[3] = vec3_scale(vec3_add(vec3_add(q[1], vec3_scale(q[2], 4.0f)), q[3]), 1.0f / 6.0f);
        c->width[0] = c->width[1] = width;
    }
}

/* Every ray through the axis of a strand hits it, also where pieces and segments meet. */
START_TEST(test_curve_watertight)
{
    TestRandom random = {.seed = 810};
    uint lost = 0, rays = 0;
    for (uint k = 0; k < 60; ++k) {
        Curve segments[8];
        TestScene test;
        float scale = k % 3 == 0 ? 1.0f : k % 3 == 1 ? 1e-3f : 1e3f;
        strand_make(&random, scale, vec3_splat(0.0f), 0.01f * scale, segments, 8);
        test_scene_init(&test);
        test_scene_curves(&test, segments, 8, k % 5, CURVE_FLAT);
        test_scene_finish(&test);
        for (uint i = 0; i < 1500; ++i) {
            uint joint = random_below(&random, 64);
            float u = i % 3 == 0 ? random_unit(&random) : (float)(joint % 8u) / 8.0f;
            Vec3 target = curve_point(&segments[1u + joint / 8u % 6u], u);
            Vec3 d = random_direction(&random);
            if (fabsf(d.x) > 0.9f)
                continue;
            Ray ray = {vec3_mad(target, -3.0f * scale, d), d, FLOAT_MAX};
            ++rays;
            lost += brute_force(&test, &ray).primitive == NONE;
        }
        test_scene_destroy(&test);
    }
    ck_assert_uint_gt(rays, 50000);
    ck_assert_msg(lost == 0, "%u of %u rays go through a strand", lost, rays);
}
END_TEST

/* A thick strand covers its length times its width: a segment of length 4 in one piece and in eight. */
START_TEST(test_curve_coverage)
{
    enum { SIDE = 500 };
    TestRandom random = {.seed = 811};
    const Curve arc = {.p = {{-1.0f, -1.0f, 0.0f}, {-1.0f, 1.0f, 0.0f}, {1.0f, 1.0f, 0.0f}, {1.0f, -1.0f, 0.0f}},
                       .width = {0.3f, 0.3f}};
    for (uint levels = 0; levels <= 3; levels += 3) {
        TestScene test;
        uint hits = 0;
        test_scene_init(&test);
        test_scene_curves(&test, &arc, 1, levels, CURVE_ROUND);
        test_scene_finish(&test);
        for (uint i = 0; i < SIDE * SIDE; ++i) {
            Vec3 o = vec3(-1.5f + 3.0f * ((float)(i % SIDE) + random_unit(&random)) / SIDE,
                          -1.5f + 3.0f * ((float)(i / SIDE) + random_unit(&random)) / SIDE, 4.0f);
            Ray ray = {o, vec3(0.0f, 0.0f, -1.0f), FLOAT_MAX};
            hits += brute_force(&test, &ray).primitive != NONE;
        }
        test_scene_destroy(&test);
        double area = 9.0 * hits / (SIDE * SIDE);
        printf("# coverage: %.5f of 1.2 with %u levels\n", area, levels);
        ck_assert_double_eq_tol(area, 4.0 * 0.3, 0.0012);
    }
}
END_TEST

/* Rays from a strand do not hit it, nor do segments that end on one; they do hit another strand. */
static void self_check(float scale, Vec3 shift, uint seed)
{
    TestRandom random = {.seed = seed};
    Curve first[6], second[6];
    TestScene test;
    uint again = 0, lost = 0, blocked = 0;
    float width = 0.02f * scale;
    strand_make(&random, scale, shift, width, first, 6);
    strand_make(&random, scale, vec3_add(shift, vec3(0.0f, scale, 0.0f)), width, second, 6);
    test_scene_init(&test);
    test_scene_curves(&test, first, 6, 3, CURVE_FLAT);
    test_scene_curves(&test, second, 6, 3, CURVE_ROUND);
    test_scene_finish(&test);
    for (uint i = 0; i < 20000; ++i) {
        Vec3 p = curve_point(&first[1u + random_below(&random, 4)], random_unit(&random));
        Vec3 q = curve_point(&second[1u + random_below(&random, 4)], random_unit(&random));
        Vec3 from = random_direction(&random), d = random_direction(&random);
        Ray ray = {vec3_mad(p, 0.4f * scale, from), vec3_negate(from), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        if (hit.primitive == NONE || hit.primitive >= 48u)
            continue;
        Surface surface = surface_from_hit(&test.view, &ray, hit);
        if (fabsf(vec3_dot(surface.ng, d)) > 1.7f)
            continue;
        Ray next = ray_spawn(surface.p, surface.ng, d);
        Hit other = brute_force(&test, &next);
        again += other.primitive < 48u;
        Ray between = ray_between(surface.p, surface.ng, q, vec3(FIBRE_NORMAL, 0.0f, 0.0f));
        blocked += brute_force(&test, &between).primitive != NONE;
        Ray through = ray_spawn(surface.p, surface.ng, vec3_sub(q, surface.p));
        lost += brute_force(&test, &through).primitive == NONE;
    }
    test_scene_destroy(&test);
    ck_assert_msg(again == 0 && lost == 0 && blocked == 0,
                  "scale %g shift %g: %u hit the strand again, %u segments blocked, %u go through the other",
                  (double)scale, (double)shift.x, again, blocked, lost);
}

START_TEST(test_curve_self_intersection)
{
    static const float SCALES[] = {1e-3f, 1.0f, 1e4f};
    for (uint i = 0; i < 3; ++i)
        self_check(SCALES[i], vec3_splat(0.0f), 820 + i);
    self_check(10.0f, vec3(1e3f, -1e3f, 1e3f), 830);
}
END_TEST

/* Curves that are points or have no width are dropped and counted; cusps, loops and double points are none. Rays along
 * the axis, and rays whose numbers are no numbers, do no harm. */
START_TEST(test_curve_degenerate)
{
    const Vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {1, 1, 0}, far = {1e12f, 0, 0};
    const Curve curves[] = {{{a, a, a, a}, {1, 1}},     {{a, b, c, a}, {0, 0}},       {{a, c, b, c}, {0.1f, 0.1f}},
                            {{a, a, b, b}, {0.1f, 0}},  {{a, b, b, a}, {0.1f, 0.1f}}, {{b, c, a, b}, {0, 0.1f}},
                            {{a, a, far, far}, {1, 1}}, {{a, b, c, b}, {1e-30f, 0}}};
    TestScene test;
    TestRandom random = {.seed = 840};
    uint hits = 0;
    test_scene_init(&test);
    test_scene_curves(&test, curves, 8, 2, CURVE_FLAT);
    test_scene_finish(&test);
    ck_assert_uint_eq(test.scene.counts.degenerate_triangles, 2);
    ck_assert_uint_eq(test.backend.primitive_count, 6u * 4u);
    for (uint i = 0; i < 20000; ++i) {
        Vec3 o = vec3_scale(random_direction(&random), 2.0f);
        Ray ray = {o, vec3_sub(vec3(0.5f * random_unit(&random), 0.5f * random_unit(&random), 0.0f), o), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        hits += hit.primitive != NONE;
        ck_assert(hit.primitive == NONE || (hit.t > 0.0f && hit.u >= 0.0f && hit.u <= 1.0f && hit.v >= 0.0f));
    }
    ck_assert_uint_gt(hits, 1000);
    const Ray rays[] = {{{-1, 0, 0}, {1, 0, 0}, FLOAT_MAX},
                        {{-1, 0, 0}, {1, 1e-30f, 0}, FLOAT_MAX},
                        {{0.5f, 0, 0}, {0, 0, 1}, FLOAT_MAX},
                        {{FLOAT_NAN, 0, 0}, {0, 0, 1}, FLOAT_MAX},
                        {{0.5f, 0, -1}, {0, FLOAT_NAN, 1}, FLOAT_MAX}};
    for (uint i = 0; i < 5; ++i) {
        Hit hit = brute_force(&test, &rays[i]);
        ck_assert(hit.primitive == NONE || (hit.t > 0.0f && float_finite(hit.t)));
        ck_assert(i < 3 || hit.primitive == NONE);
    }
    test_scene_destroy(&test);
}
END_TEST

/* A piece of a curve lies in its box, and pieces are smaller than the curve. */
START_TEST(test_curve_boxes)
{
    TestRandom random = {.seed = 850};
    for (uint k = 0; k < 200; ++k) {
        Curve curve = curve_random(&random, 0.5f);
        Box whole = curve_box(&curve, CURVE_PIECE(0u, 0u));
        for (uint piece = 0; piece < 8u; ++piece) {
            Box box = curve_box(&curve, CURVE_PIECE(3u, piece));
            float u = ((float)piece + random_unit(&random)) / 8.0f;
            Vec3 p = vec3_mad(curve_point(&curve, u), 0.499f * curve_width(&curve, u), random_direction(&random));
            ck_assert(p.x >= box.low[0] && p.y >= box.low[1] && p.z >= box.low[2]);
            ck_assert(p.x <= box.high[0] && p.y <= box.high[1] && p.z <= box.high[2]);
            ck_assert(box.high[0] - box.low[0] <= whole.high[0] - whole.low[0] + 1e-5f);
        }
    }
}
END_TEST

TCase *geometry_curve_tcase(void)
{
    TCase *tcase = tcase_create("curves");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_curve_accuracy);
    tcase_add_test(tcase, test_curve_watertight);
    tcase_add_test(tcase, test_curve_coverage);
    tcase_add_test(tcase, test_curve_self_intersection);
    tcase_add_test(tcase, test_curve_degenerate);
    tcase_add_test(tcase, test_curve_boxes);
    return tcase;
}
