/* Cylinders against long double: t, the kept part, texture coordinates and tangents, rays that leave them. */
#include "geometry/geometry_suites.h"
#include "support/geometry_fixture.h"

/* References are deliberately computed in long double from floats. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"

static Quadric cylinder_plain(float radius, float z_min, float z_max)
{
    return (Quadric){.radius = radius, .z_min = z_min, .z_max = z_max, .phi_max = 2.0f * PI};
}

static void scene_with_cylinder(TestScene *test, Quadric quadric, const double m[16])
{
    test_scene_init(test);
    test_scene_quadric(test, PRIMITIVE_CYLINDER, quadric, m);
    test_scene_finish(test);
    ck_assert_uint_eq(test->backend.primitive_count, 1);
    ck_assert_uint_eq(test->view.quadrics[0].whole, 0);
}

/* What a ray in object space meets: t of the first hit (-1: none), the squared sine of the angle between the normal
 * plane and the ray there, and whether a float may decide otherwise. */
typedef struct Exact {
    long double t, depth;
    bool unsure;
} Exact;

static Exact cylinder_exact(const Ray *ray, Vec3 shift, const Quadric *q)
{
    long double ox = (long double)ray->o.x - shift.x, oy = (long double)ray->o.y - shift.y;
    long double oz = (long double)ray->o.z - shift.z, dx = ray->d.x, dy = ray->d.y, dz = ray->d.z, r = q->radius;
    long double a = dx * dx + dy * dy, b = ox * dx + oy * dy, c = ox * ox + oy * oy - r * r;
    long double discriminant = b * b - a * c, unit = 1.2e-7L * (vec3_max_abs(ray->o) + vec3_max_abs(shift) + r);
    Exact exact = {.t = -1, .depth = discriminant / (a * r * r)};
    exact.unsure = fabsl(exact.depth) * r < 100 * unit || fabsl(sqrtl(ox * ox + oy * oy) - r) < 100 * unit;
    if (discriminant < 0)
        return exact;
    for (int i = 0; i < 2; ++i) {
        long double t = (-b + (i == 0 ? -1 : 1) * sqrtl(discriminant)) / a, z = oz + t * dz;
        long double slack = 100 * unit * (1 + fabsl(dz) / sqrtl(a * fmaxl(exact.depth, 1e-12L)));
        exact.unsure |= fabsl(z - q->z_min) < slack || fabsl(z - q->z_max) < slack;
        if (t > 0 && z >= q->z_min && z <= q->z_max) {
            exact.t = t;
            return exact;
        }
    }
    return exact;
}

/* Rays from inside, nearby and 300 radii away, many of them grazing. */
START_TEST(test_cylinder_accuracy)
{
    TestRandom random = {.seed = 700};
    uint disagreed = 0, compared = 0, grazing = 0;
    long double worst = 0;
    for (uint k = 0; k < 200; ++k) {
        float radius = expf(random_between(&random, -5.0f, 5.0f)), half = radius * random_between(&random, 0.2f, 8.0f);
        Vec3 shift = vec3_scale(random_direction(&random), radius * random_between(&random, 0.0f, 10.0f));
        double m[16] = {1, 0, 0, (double)shift.x, 0, 1, 0, (double)shift.y, 0, 0, 1, (double)shift.z, 0, 0, 0, 1};
        TestScene test;
        Quadric quadric = cylinder_plain(radius, -half, 0.5f * half);
        scene_with_cylinder(&test, quadric, m);
        for (uint i = 0; i < 1000; ++i) {
            float far = i % 3 == 0 ? 0.9f : i % 3 == 1 ? 3.0f : 300.0f;
            Vec3 o = vec3_add(shift, vec3_scale(random_direction(&random), far * radius * random_unit(&random)));
            float phi = random_between(&random, 0.0f, 2.0f * PI),
                  off = i % 2 == 0 ? 1.2f * random_unit(&random) : 0.999f;
            Vec3 target = vec3_add(shift, vec3(off * radius * cosf(phi), off * radius * sinf(phi),
                                               random_between(&random, -1.1f, 0.6f) * half));
            Ray ray = {o, vec3_sub(target, o), FLOAT_MAX};
            Hit hit = brute_force(&test, &ray);
            Exact exact = cylinder_exact(&ray, shift, &quadric);
            disagreed += !exact.unsure && (hit.primitive != NONE) != (exact.t > 0);
            if (exact.unsure || hit.primitive == NONE || exact.t <= 0)
                continue;
            ++compared;
            grazing += exact.depth < 0.01L;
            long double unit = 1.2e-7L * (vec3_max_abs(o) + vec3_max_abs(shift) + radius);
            long double across = sqrtl((long double)ray.d.x * ray.d.x + (long double)ray.d.y * ray.d.y);
            worst = fmaxl(worst, fabsl(hit.t - exact.t) * across * sqrtl(exact.depth) / unit);
        }
        test_scene_destroy(&test);
    }
    printf("# cylinder: %u hits, %u grazing, t off by at most %.3Lg units\n", compared, grazing, worst);
    ck_assert_uint_eq(disagreed, 0);
    ck_assert_uint_gt(compared, 50000);
    ck_assert_uint_gt(grazing, 2000);
    ck_assert_msg(worst < 16, "t is off by %Lg units", worst);
}
END_TEST

/* Parts of cylinders under arbitrary transforms: a hit lies on the kept part, a ray through a kept point hits it or an
 * earlier point, and (u, v), the tangents and the normal are those of the parametrisation. */
static void part_check(const TestScene *test, const Quadric *q, TestRandom *random, uint *checked)
{
    const Quadric *stored = &test->view.quadrics[0];
    float u = random_unit(random), v = random_unit(random), phi = u * q->phi_max;
    Vec3 p = vec3(q->radius * cosf(phi), q->radius * sinf(phi), q->z_min + v * (q->z_max - q->z_min));
    Vec3 target = affine_point(stored->world_from_object, p), o = vec3_scale(random_direction(random), 20.0f);
    Ray ray = {o, vec3_sub(target, o), FLOAT_MAX};
    Hit hit = brute_force(test, &ray);
    Vec3 normal = vec3_normalize(affine_normal(stored->object_from_world, vec3(p.x, p.y, 0.0f)));
    bool grazing = fabsf(vec3_dot(normal, vec3_normalize(ray.d))) < 0.02f;
    bool border = fminf(fminf(u, 1.0f - u), fminf(v, 1.0f - v)) < 1e-3f;
    ck_assert(border || grazing || (hit.primitive == 0 && hit.t < 1.0f + 1e-3f));
    if (hit.primitive == NONE)
        return;
    Surface surface = surface_from_hit(&test->view, &ray, hit);
    Vec3 at = affine_point(stored->object_from_world, surface.p);
    ck_assert(fabsf(hypotf(at.x, at.y) - q->radius) < 1e-5f);
    ck_assert(at.z > q->z_min - 1e-5f && at.z < q->z_max + 1e-5f);
    ck_assert(surface.uv.x >= 0.0f && surface.uv.x <= 1.0f && surface.uv.y >= 0.0f && surface.uv.y <= 1.0f);
    if (border || grazing || hit.t < 1.0f - 1e-5f)
        return;
    ++*checked;
    ck_assert(fabsf(surface.uv.x - u) < 1e-3f && fabsf(surface.uv.y - v) < 1e-3f);
    ck_assert(vec3_dot(surface.ng, normal) > 0.9999f);
    Vec3 dpdu = affine_vector(stored->world_from_object, vec3(-q->phi_max * at.y, q->phi_max * at.x, 0.0f));
    Vec3 dpdv = affine_vector(stored->world_from_object, vec3(0.0f, 0.0f, q->z_max - q->z_min));
    ck_assert(vec3_length(vec3_sub(surface.dpdu, dpdu)) < 1e-4f * (1.0f + vec3_length(dpdu)));
    ck_assert(vec3_length(vec3_sub(surface.dpdv, dpdv)) < 1e-4f * (1.0f + vec3_length(dpdv)));
}

START_TEST(test_cylinder_part)
{
    TestRandom random = {.seed = 710};
    uint checked = 0;
    for (uint k = 0; k < 150; ++k) {
        double m[16];
        TestScene test;
        Quadric quadric =
            cylinder_plain(1.5f, random_between(&random, -1.5f, 0.0f), random_between(&random, 0.2f, 1.5f));
        quadric.phi_max = k % 4 == 0 ? 2.0f * PI : random_between(&random, 1.0f, 6.0f);
        matrix_random(&random, 0.3f, 2.0f, true, vec3_scale(random_direction(&random), 3.0f), m);
        scene_with_cylinder(&test, quadric, m);
        for (uint i = 0; i < 500; ++i)
            part_check(&test, &quadric, &random, &checked);
        test_scene_destroy(&test);
    }
    ck_assert_uint_gt(checked, 20000);
}
END_TEST

/* A ray that leaves a cylinder outward never hits it again; inward, it hits the opposite side if that is long
 * enough. */
static void self_check(float scale, Vec3 shift, bool stretched, uint seed)
{
    TestRandom random = {.seed = seed};
    uint again = 0, lost = 0;
    double m[16];
    TestScene test;
    matrix_random(&random, stretched ? 0.5f * scale : scale, scale, false, shift, m);
    scene_with_cylinder(&test, cylinder_plain(1.0f, -8.0f, 8.0f), m);
    const Quadric *stored = &test.view.quadrics[0];
    for (uint i = 0; i < 30000; ++i) {
        float turn = random_between(&random, 0.0f, 2.0f * PI);
        Vec3 outside = vec3(3.0f * cosf(turn), 3.0f * sinf(turn), random_between(&random, -2.0f, 2.0f));
        Vec3 o = affine_point(stored->world_from_object, outside);
        Vec3 inside = affine_point(stored->world_from_object, vec3_scale(random_direction(&random), 0.4f));
        Ray ray = {o, vec3_sub(inside, o), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        ck_assert(hit.primitive == 0);
        Surface surface = surface_from_hit(&test.view, &ray, hit);
        Vec3 d = random_direction(&random);
        Ray next = ray_spawn(surface.p, surface.ng, d);
        float cosine = vec3_dot(surface.ng, d);
        Vec3 local = vec3_normalize(affine_vector(stored->object_from_world, d));
        bool short_of_end = fabsf(local.z) < 0.8f && cosine < -0.2f;
        Hit second = brute_force(&test, &next);
        again += cosine > 0.0f && second.primitive != NONE;
        lost += short_of_end && second.primitive == NONE;
        Ray segment = ray_between(surface.p, surface.ng, vec3_mad(surface.p, scale, d), vec3_splat(0.0f));
        again += cosine > 0.05f && brute_force(&test, &segment).primitive != NONE;
    }
    test_scene_destroy(&test);
    ck_assert_msg(again == 0 && lost == 0, "scale %g shift %g: %u met again, %u lost", (double)scale, (double)shift.x,
                  again, lost);
}

START_TEST(test_cylinder_self_intersection)
{
    static const float SCALES[] = {1e-3f, 1.0f, 1e4f};
    for (uint i = 0; i < 3; ++i)
        for (uint stretched = 0; stretched < 2; ++stretched) {
            self_check(SCALES[i], vec3_splat(0.0f), stretched, 720 + i);
            self_check(SCALES[i], vec3(SCALES[i], 0.0f, 0.0f), stretched, 730 + i);
        }
    self_check(100.0f, vec3(1e4f, 1e4f, -1e4f), false, 740);
    self_check(100.0f, vec3(1e4f, 1e4f, -1e4f), true, 741);
}
END_TEST

/* Rays along the axis, and closer to it than floats can tell, hit nothing; both ends are open. */
START_TEST(test_cylinder_axis)
{
    static const double IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const float SIDEWAYS[] = {0.0f, 1e-38f, -1e-30f, 1e-20f};
    TestScene test;
    scene_with_cylinder(&test, cylinder_plain(1.0f, -1.0f, 2.0f), IDENTITY);
    for (uint i = 0; i < 4; ++i)
        for (uint inside = 0; inside < 2; ++inside) {
            Ray ray = {{inside ? 0.5f : 1.5f, 0.0f, -9.0f}, {SIDEWAYS[i], 0.0f, 1.0f}, FLOAT_MAX};
            ck_assert_uint_eq(brute_force(&test, &ray).primitive, NONE);
        }
    Ray into = {{0.5f, 0.0f, -2.0f}, {0.25f, 0.0f, 1.0f}, FLOAT_MAX}; /* through the open end to the inside */
    Hit hit = brute_force(&test, &into);
    ck_assert(hit.primitive == 0 && fabsf(hit.t - 2.0f) < 1e-6f);
    test_scene_destroy(&test);
}
END_TEST

TCase *geometry_cylinder_tcase(void)
{
    TCase *tcase = tcase_create("cylinders");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_cylinder_accuracy);
    tcase_add_test(tcase, test_cylinder_part);
    tcase_add_test(tcase, test_cylinder_self_intersection);
    tcase_add_test(tcase, test_cylinder_axis);
    return tcase;
}
