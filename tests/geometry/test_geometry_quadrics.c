/* Spheres, disks and bilinear patches against long double, and the surfaces at their hits. */
#include "geometry/geometry_suites.h"
#include "support/geometry_fixture.h"

#include <string.h>

/* References are deliberately computed in long double from floats. */
#pragma GCC diagnostic ignored "-Wdouble-promotion"

typedef struct Exact3 {
    long double x, y, z;
} Exact3;

static Exact3 exact(Vec3 v)
{
    return (Exact3){v.x, v.y, v.z};
}

static Exact3 exact_mad(Exact3 a, long double s, Exact3 b)
{
    return (Exact3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static long double exact_dot(Exact3 a, Exact3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static long double exact_length(Exact3 a)
{
    return sqrtl(exact_dot(a, a));
}

static const double IDENTITY[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static Quadric sphere_plain(float radius)
{
    return (Quadric){.radius = radius, .z_min = -radius, .z_max = radius, .phi_max = 2.0f * PI};
}

static void scene_with_quadric(TestScene *test, uint kind, Quadric quadric, const double m[16])
{
    test_scene_init(test);
    test_scene_quadric(test, kind, quadric, m);
    test_scene_finish(test);
    ck_assert_uint_eq(test->backend.primitive_count, 1);
}

/* ---- spheres ----------------------------------------------------------------------------------------------------- */

/* Both roots in long double; the smaller positive one, or -1. */
static long double sphere_exact(const Ray *ray, Vec3 center, float radius, long double *depth)
{
    Exact3 d = exact(ray->d), f = exact_mad(exact(ray->o), -1.0L, exact(center));
    long double a = exact_dot(d, d), b = exact_dot(f, d), c = exact_dot(f, f) - (long double)radius * radius;
    long double discriminant = b * b - a * c;
    *depth = discriminant / (a * radius * radius); /* squared cosine at the sphere */
    if (discriminant < 0)
        return -1;
    long double root = sqrtl(discriminant), t0 = (-b - root) / a, t1 = (-b + root) / a;
    return t0 > 0 ? t0 : t1 > 0 ? t1 : -1;
}

START_TEST(test_sphere_accuracy)
{
    TestRandom random = {.seed = 300};
    uint disagreed = 0, compared = 0;
    long double worst = 0;
    for (uint k = 0; k < 200; ++k) {
        float radius = expf(random_between(&random, -5.0f, 5.0f));
        Vec3 center = vec3_scale(random_direction(&random), radius * random_between(&random, 0.0f, 10.0f));
        double m[16];
        TestScene test;
        memcpy(m, IDENTITY, sizeof m);
        m[3] = (double)center.x;
        m[7] = (double)center.y;
        m[11] = (double)center.z;
        scene_with_quadric(&test, PRIMITIVE_SPHERE, sphere_plain(radius), m);
        ck_assert_uint_eq(test.view.quadrics[0].whole, 1);
        for (uint i = 0; i < 1000; ++i) {
            float far = i % 3 == 0 ? 0.9f : i % 3 == 1 ? 3.0f : 300.0f;
            Vec3 o = vec3_add(center, vec3_scale(random_direction(&random), far * radius * random_unit(&random)));
            Vec3 target = vec3_add(center, vec3_scale(random_direction(&random), 1.2f * radius));
            Ray ray = {o, vec3_sub(target, o), FLOAT_MAX};
            Hit hit = brute_force(&test, &ray);
            long double depth, t = sphere_exact(&ray, center, radius, &depth);
            long double reach = (vec3_max_abs(o) + vec3_max_abs(center) + radius) * 1.2e-7L;
            bool sure = fabsl(depth) * radius > 100 * reach;
            float from = vec3_length(vec3_sub(o, center));
            sure = sure && fabsf(from - radius) > 100 * (float)reach;
            disagreed += sure && (hit.primitive != NONE) != (t > 0);
            if (!sure || hit.primitive == NONE || t <= 0)
                continue;
            ++compared;
            long double away = fabsl(hit.t - t) * exact_length(exact(ray.d)) * sqrtl(depth) / reach;
            worst = fmaxl(worst, away);
        }
        test_scene_destroy(&test);
    }
    ck_assert_uint_eq(disagreed, 0);
    ck_assert_uint_gt(compared, 50000);
    ck_assert_msg(worst < 16, "t is off by %Lg units", worst);
}
END_TEST

/* Clipped spheres under arbitrary transforms: a hit lies on the kept part, and a ray through a kept point hits it or an
 * earlier point. */
START_TEST(test_partial_sphere)
{
    TestRandom random = {.seed = 310};
    for (uint k = 0; k < 150; ++k) {
        double m[16];
        TestScene test;
        Quadric quadric = sphere_plain(1.5f);
        quadric.z_min = random_between(&random, -1.5f, 0.0f);
        quadric.z_max = k % 3 == 0 ? 1.5f : random_between(&random, 0.2f, 1.5f);
        quadric.phi_max = k % 4 == 0 ? 2.0f * PI : random_between(&random, 1.0f, 6.0f);
        matrix_random(&random, 0.3f, 2.0f, true, vec3_scale(random_direction(&random), 3.0f), m);
        scene_with_quadric(&test, PRIMITIVE_SPHERE, quadric, m);
        Affine world_from_object = test.view.quadrics[0].world_from_object;
        for (uint i = 0; i < 500; ++i) {
            float z = random_between(&random, quadric.z_min, quadric.z_max);
            float phi = quadric.phi_max * random_unit(&random), r = sqrtf(1.5f * 1.5f - z * z);
            Vec3 target = affine_point(world_from_object, vec3(r * cosf(phi), r * sinf(phi), z));
            Vec3 o = vec3_scale(random_direction(&random), 20.0f);
            Ray ray = {o, vec3_sub(target, o), FLOAT_MAX};
            Hit hit = brute_force(&test, &ray);
            Vec3 normal = affine_normal(test.view.quadrics[0].object_from_world, vec3(r * cosf(phi), r * sinf(phi), z));
            bool grazing = fabsf(vec3_dot(vec3_normalize(normal), vec3_normalize(ray.d))) < 0.02f;
            bool border = grazing || z < quadric.z_min + 1e-3f || z > quadric.z_max - 1e-3f || phi < 1e-3f ||
                          phi > quadric.phi_max - 1e-3f || r < 1e-2f;
            ck_assert(border || (hit.primitive == 0 && hit.t < 1.0f + 1e-3f));
            if (hit.primitive == NONE)
                continue;
            Surface surface = surface_from_hit(&test.view, &ray, hit);
            Vec3 p = affine_point(test.view.quadrics[0].object_from_world, surface.p);
            ck_assert(fabsf(vec3_length(p) - 1.5f) < 1e-5f);
            ck_assert(p.z > quadric.z_min - 1e-5f && p.z < quadric.z_max + 1e-5f);
            ck_assert(surface.uv.x >= 0.0f && surface.uv.x <= 1.0f && surface.uv.y >= 0.0f && surface.uv.y <= 1.0f);
        }
        test_scene_destroy(&test);
    }
}
END_TEST

/* (u, v), dp/du and dp/dv against the parametrisation, differentiated in double. */
static void parametrisation(uint kind, const Quadric *q, double u, double v, double p[3])
{
    double phi = u * (double)q->phi_max, radius = (double)q->radius;
    if (kind == PRIMITIVE_DISK) {
        double r = radius + v * ((double)q->inner_radius - radius);
        p[0] = r * cos(phi);
        p[1] = r * sin(phi);
        p[2] = (double)q->z_min;
        return;
    }
    double first = acos(fmax(-1.0, (double)q->z_min / radius)), last = acos(fmin(1.0, (double)q->z_max / radius));
    double theta = first + v * (last - first);
    p[0] = radius * sin(theta) * cos(phi);
    p[1] = radius * sin(theta) * sin(phi);
    p[2] = radius * cos(theta);
}

static void derivative_check(uint kind, const Quadric *q, Affine map, const Surface *surface)
{
    double h = 1e-6, a[3], b[3], at[3];
    double uv[2] = {(double)surface->uv.x, (double)surface->uv.y};
    Vec3 found[2] = {surface->dpdu, surface->dpdv};
    parametrisation(kind, q, uv[0], uv[1], at);
    Vec3 p = affine_point(map, vec3((float)at[0], (float)at[1], (float)at[2]));
    ck_assert(vec3_length(vec3_sub(p, surface->p)) < 1e-4f);
    for (int k = 0; k < 2; ++k) {
        parametrisation(kind, q, uv[0] + (k == 0 ? h : 0), uv[1] + (k == 1 ? h : 0), a);
        parametrisation(kind, q, uv[0] - (k == 0 ? h : 0), uv[1] - (k == 1 ? h : 0), b);
        Vec3 d = affine_vector(map, vec3((float)((a[0] - b[0]) / (2 * h)), (float)((a[1] - b[1]) / (2 * h)),
                                         (float)((a[2] - b[2]) / (2 * h))));
        ck_assert_msg(vec3_length(vec3_sub(d, found[k])) < 1e-3f * (1.0f + vec3_length(d)), "derivative %d", k);
    }
    float sign = vec3_dot(vec3_cross(surface->dpdu, surface->dpdv), surface->ng);
    float determinant = vec3_dot(vec3_cross(vec3(map.m[0], map.m[4], map.m[8]), vec3(map.m[1], map.m[5], map.m[9])),
                                 vec3(map.m[2], map.m[6], map.m[10]));
    ck_assert(sign * determinant > 0.0f);
    ck_assert(fabsf(vec3_dot(surface->ng, vec3_normalize(surface->dpdu))) < 1e-4f);
    ck_assert(fabsf(vec3_dot(surface->ng, vec3_normalize(surface->dpdv))) < 1e-4f);
}

START_TEST(test_quadric_parameters)
{
    TestRandom random = {.seed = 320};
    uint checked = 0;
    for (uint k = 0; k < 60; ++k) {
        uint kind = k % 2 == 0 ? PRIMITIVE_SPHERE : PRIMITIVE_DISK;
        double m[16];
        TestScene test;
        Quadric quadric = sphere_plain(1.2f);
        quadric.phi_max = k % 3 == 0 ? 5.0f : 2.0f * PI;
        if (kind == PRIMITIVE_DISK) {
            quadric.z_min = 0.4f;
            quadric.inner_radius = 0.3f;
        } else if (k % 5 != 0) {
            quadric.z_min = -0.7f;
            quadric.z_max = 1.0f;
        }
        matrix_random(&random, 0.5f, 2.0f, true, random_direction(&random), m);
        scene_with_quadric(&test, kind, quadric, m);
        for (uint i = 0; i < 400; ++i) {
            Vec3 o = vec3_scale(random_direction(&random), 10.0f);
            Ray ray = {o, vec3_sub(random_direction(&random), o), FLOAT_MAX};
            Hit hit = brute_force(&test, &ray);
            if (hit.primitive == NONE)
                continue;
            Surface surface = surface_from_hit(&test.view, &ray, hit);
            if (surface.uv.y < 0.01f || surface.uv.y > 0.99f || surface.uv.x < 0.01f || surface.uv.x > 0.99f)
                continue;
            ++checked;
            derivative_check(kind, &quadric, test.view.quadrics[0].world_from_object, &surface);
        }
        test_scene_destroy(&test);
    }
    ck_assert_uint_gt(checked, 2000);
}
END_TEST

/* A ray that leaves a sphere outward never hits it again; inward, it hits the opposite side. */
static void sphere_self_check(float scale, Vec3 shift, bool stretched, uint seed)
{
    TestRandom random = {.seed = seed};
    uint again = 0, lost = 0;
    double m[16];
    TestScene test;
    matrix_random(&random, stretched ? 0.5f * scale : scale, scale, false, shift, m);
    scene_with_quadric(&test, PRIMITIVE_SPHERE, sphere_plain(1.0f), m);
    ck_assert_uint_eq(test.view.quadrics[0].whole, stretched ? 0 : 1);
    for (uint i = 0; i < 30000; ++i) {
        Vec3 o = vec3_mad(shift, 3.0f * scale, random_direction(&random));
        Ray ray = {o, vec3_sub(vec3_mad(shift, 0.4f * scale, random_direction(&random)), o), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        ck_assert(hit.primitive == 0);
        Surface surface = surface_from_hit(&test.view, &ray, hit);
        Vec3 d = random_direction(&random);
        Ray next = ray_spawn(surface.p, surface.ng, d);
        float cosine = vec3_dot(surface.ng, d);
        Hit second = brute_force(&test, &next);
        again += cosine > 0.0f && second.primitive != NONE;
        lost += cosine < -0.05f && second.primitive == NONE;
        if (second.primitive != NONE && cosine < -0.05f) {
            float chord = stretched ? 0.1f * scale : 1.8f * scale * -cosine;
            lost += second.t < 0.5f * -cosine * chord;
        }
        Ray segment = ray_between(surface.p, surface.ng, vec3_mad(surface.p, scale, d), vec3_splat(0.0f));
        again += cosine > 0.05f && brute_force(&test, &segment).primitive != NONE;
    }
    test_scene_destroy(&test);
    ck_assert_msg(again == 0 && lost == 0, "scale %g shift %g: %u met again, %u lost", (double)scale, (double)shift.x,
                  again, lost);
}

START_TEST(test_sphere_self_intersection)
{
    static const float scales[] = {1e-3f, 1.0f, 1e4f};
    for (uint i = 0; i < 3; ++i) {
        sphere_self_check(scales[i], vec3_splat(0.0f), false, 330 + i);
        sphere_self_check(scales[i], vec3_splat(0.0f), true, 340 + i);
        /* The surface passes through the coordinate origin. */
        sphere_self_check(scales[i], vec3(scales[i], 0.0f, 0.0f), false, 350 + i);
        sphere_self_check(scales[i], vec3(scales[i], 0.0f, 0.0f), true, 360 + i);
    }
    sphere_self_check(100.0f, vec3(1e4f, 1e4f, -1e4f), false, 370);
    sphere_self_check(100.0f, vec3(1e4f, 1e4f, -1e4f), true, 371);
}
END_TEST

/* ---- disks ------------------------------------------------------------------------------------------------------- */

START_TEST(test_disk)
{
    TestRandom random = {.seed = 400};
    TestScene test;
    Quadric quadric = {.radius = 2.0f, .inner_radius = 0.5f, .z_min = 0.25f, .phi_max = 4.0f};
    uint disagreed = 0;
    scene_with_quadric(&test, PRIMITIVE_DISK, quadric, IDENTITY);
    for (uint i = 0; i < 100000; ++i) {
        Vec3 o = vec3_scale(random_direction(&random), 3.0f);
        Ray ray = {o, random_direction(&random), FLOAT_MAX};
        Hit hit = brute_force(&test, &ray);
        long double t = (0.25L - o.z) / ray.d.z, x = o.x + t * ray.d.x, y = o.y + t * ray.d.y;
        long double r = sqrtl(x * x + y * y), phi = atan2l(y, x);
        phi += phi < 0 ? 2 * 3.14159265358979323846L : 0;
        bool inside = t > 0 && r <= 2 && r >= 0.5L && phi <= 4;
        bool border = fabsl(r - 2) < 1e-4L || fabsl(r - 0.5L) < 1e-4L || fabsl(phi - 4) < 1e-4L || phi < 1e-4L ||
                      phi > 6.283L || fabsl(t) < 1e-4L || fabsf(ray.d.z) < 1e-3f;
        disagreed += !border && inside != (hit.primitive != NONE);
        if (border || hit.primitive == NONE)
            continue;
        ck_assert(fabsl(hit.t - t) < 2e-6L * (1 + fabsl(t)) / fabsf(ray.d.z));
        Surface surface = surface_from_hit(&test.view, &ray, hit);
        ck_assert(fabsl(surface.uv.x - phi / 4) < 1e-5L / fabsf(ray.d.z) &&
                  fabsl(surface.uv.y - (2 - r) / 1.5L) < 1e-5L / fabsf(ray.d.z));
        ck_assert(surface.p.z == 0.25f && surface.ng.z == 1.0f);
        Ray next = ray_spawn(surface.p, surface.ng, random_direction(&random));
        ck_assert(brute_force(&test, &next).primitive == NONE);
    }
    ck_assert_uint_eq(disagreed, 0);
    test_scene_destroy(&test);
}
END_TEST

/* ---- patches ----------------------------------------------------------------------------------------------------- */

static PatchCorners patch_random(TestRandom *random, bool flat)
{
    PatchCorners q = {random_direction(random), random_direction(random), random_direction(random), {0, 0, 0}};
    q.p11 = flat ? vec3_sub(vec3_add(q.p10, q.p01), q.p00) : random_direction(random);
    return q;
}

/* A hit is a point of both ray and patch; the ray through a point of the patch hits it or an earlier point. */
START_TEST(test_patch)
{
    TestRandom random = {.seed = 500};
    uint lost = 0, checked = 0;
    long double worst = 0;
    for (uint i = 0; i < 300000; ++i) {
        PatchCorners q = patch_random(&random, i % 2 == 0);
        float u = random_unit(&random), v = random_unit(&random);
        Vec3 target = patch_point(&q, u, v), o = vec3_scale(random_direction(&random), 4.0f * random_unit(&random));
        Ray ray = {o, vec3_normalize(vec3_sub(target, o)), FLOAT_MAX};
        RayQuery query = ray_query(ray);
        float distance = vec3_length(vec3_sub(target, o)), t = 0.0f, hit_u = 0.0f, hit_v = 0.0f;
        Vec3 normal = vec3_cross(patch_dpdu(&q, v), patch_dpdv(&q, u));
        float cosine = vec3_length(normal) > 0.05f ? fabsf(vec3_dot(vec3_normalize(normal), ray.d)) : 0.0f;
        if (cosine < 0.1f || distance < 0.01f)
            continue;
        ++checked;
        if (!patch_query(&q, &query, &t, &hit_u, &hit_v) || t > distance * (1.0f + 1e-3f)) {
            ++lost;
            continue;
        }
        Exact3 on_ray = exact_mad(exact(o), t, exact(ray.d));
        Exact3 on_patch = exact(patch_point(&q, hit_u, hit_v));
        Vec3 at = vec3_cross(patch_dpdu(&q, hit_v), patch_dpdv(&q, hit_u));
        if (fabsf(vec3_dot(at, ray.d)) > 0.05f)
            worst = fmaxl(worst, exact_length(exact_mad(on_ray, -1.0L, on_patch)));
    }
    ck_assert_uint_gt(checked, 150000);
    ck_assert_msg(worst < 2e-4L, "ray and patch are %Lg apart", worst);
    ck_assert_msg(lost == 0, "%u of %u lost", lost, checked);
}
END_TEST

START_TEST(test_patch_self_intersection)
{
    TestRandom random = {.seed = 510};
    uint again = 0;
    for (uint i = 0; i < 200000; ++i) {
        PatchCorners q = patch_random(&random, true);
        float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1e-3f : 1e4f;
        q.p00 = vec3_scale(q.p00, scale);
        q.p10 = vec3_scale(q.p10, scale);
        q.p01 = vec3_scale(q.p01, scale);
        q.p11 = vec3_scale(q.p11, scale);
        float u = random_unit(&random), v = random_unit(&random), t, hit_u, hit_v;
        Vec3 normal = vec3_cross(patch_dpdu(&q, v), patch_dpdv(&q, u));
        if (!(vec3_length(normal) > 0.01f * scale * scale))
            continue;
        Ray next = ray_spawn(patch_point(&q, u, v), vec3_normalize(normal), random_direction(&random));
        RayQuery query = ray_query(next);
        again += patch_query(&q, &query, &t, &hit_u, &hit_v);
    }
    ck_assert_uint_eq(again, 0);
}
END_TEST

/* ---- surfaces of triangles --------------------------------------------------------------------------------------- */

/* A triangle with normals and texture coordinates, and the ray through its centre. */
static Surface triangle_surface(uint flags, const float *normals, const float *uvs)
{
    static const float positions[9] = {0, 0, 0, 2, 0, 0, 0, 1, 0};
    static const uint indices[3] = {0, 1, 2};
    Error error = {0};
    TestScene test;
    MeshData mesh = {positions, normals, uvs, 3, indices, 1};
    Shape shape = {.alpha = NONE, .first_light = NONE, .flags = flags};
    test_scene_init(&test);
    ck_assert(scene_add_mesh(&test.scene, &mesh, shape, NULL, 0, &error));
    test_scene_finish(&test);
    Ray ray = {{0.5f, 0.25f, -1.0f}, {0.0f, 0.0f, 1.0f}, FLOAT_MAX};
    Hit hit = brute_force(&test, &ray);
    ck_assert(hit.primitive == 0);
    Surface surface = surface_from_hit(&test.view, &ray, hit);
    test_scene_destroy(&test);
    return surface;
}

START_TEST(test_triangle_surface)
{
    static const float down[9] = {0, 0, -1, 0, 0, -1, 0, 0, -1}, none[9] = {0};
    static const float tilted[9] = {0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f};
    static const float uvs[6] = {0.5f, 0.5f, 0.5f, 2.5f, 1.5f, 0.5f}, same[6] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    Surface s = triangle_surface(0, NULL, NULL);
    ck_assert(s.p.x == 0.5f && s.p.y == 0.25f && s.p.z == 0.0f);
    ck_assert(s.ng.z == 1.0f && s.ns.z == 1.0f);
    /* Default texture coordinates (0,0), (1,0), (1,1): u = beta + gamma, v = gamma. */
    ck_assert(s.uv.x == 0.5f && s.uv.y == 0.25f);
    ck_assert(s.dpdu.x == 2.0f && s.dpdu.y == 0.0f && s.dpdv.x == -2.0f && s.dpdv.y == 1.0f);
    s = triangle_surface(SHAPE_FLIP_NORMAL, NULL, uvs);
    ck_assert(s.ng.z == -1.0f && s.ns.z == -1.0f);
    ck_assert(s.uv.x == 0.75f && s.uv.y == 1.0f);
    /* v increases by 2 along x (length 2), u by 1 along y (length 1). */
    ck_assert(s.dpdu.x == 0.0f && s.dpdu.y == 1.0f && s.dpdv.x == 1.0f && s.dpdv.y == 0.0f);
    s = triangle_surface(0, down, NULL);
    ck_assert(s.ng.z == -1.0f && s.ns.z == -1.0f);
    s = triangle_surface(SHAPE_FLIP_NORMAL, tilted, uvs);
    ck_assert(s.ng.z == 1.0f && fabsf(s.ns.x - 0.6f) < 1e-6f && fabsf(s.ns.z - 0.8f) < 1e-6f);
    ck_assert(fabsf(vec3_dot(s.dpdu, s.ns)) < 1e-6f && fabsf(vec3_dot(s.dpdv, s.ns)) < 1e-6f && s.dpdu.y > 0.9f);
    s = triangle_surface(SHAPE_FLIP_NORMAL, none, same);
    ck_assert(s.ng.z == -1.0f && s.ns.z == -1.0f);
    ck_assert(fabsf(vec3_length(s.dpdu) - 1.0f) < 1e-6f && fabsf(vec3_dot(s.dpdu, s.ng)) < 1e-6f);
}
END_TEST

/* The hash for stochastic alpha: equal for equal rays, evenly distributed, and different for different primitives.
 * Lookups are covered by the texture tests. */
START_TEST(test_ray_hash)
{
    TestRandom random = {.seed = 600};
    double cells[16] = {0}, expected[16];
    uint equal = 0;
    for (uint i = 0; i < 100000; ++i) {
        RayQuery query = ray_query((Ray){random_direction(&random), random_direction(&random), 1.0f});
        float h = ray_hash(&query, 5), other = ray_hash(&query, 6);
        ck_assert(h >= 0.0f && h < 1.0f && h == ray_hash(&query, 5));
        equal += h == other;
        cells[(int)(16.0f * h)] += 1.0;
    }
    for (int k = 0; k < 16; ++k)
        expected[k] = 100000.0 / 16.0;
    ck_assert_uint_lt(equal, 5);
    ck_assert(test_chi_square(cells, expected, 16) > 1e-4);
}
END_TEST

TCase *geometry_quadrics_tcase(void)
{
    TCase *tcase = tcase_create("quadrics, patches, surfaces");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_sphere_accuracy);
    tcase_add_test(tcase, test_partial_sphere);
    tcase_add_test(tcase, test_quadric_parameters);
    tcase_add_test(tcase, test_sphere_self_intersection);
    tcase_add_test(tcase, test_disk);
    tcase_add_test(tcase, test_patch);
    tcase_add_test(tcase, test_patch_self_intersection);
    tcase_add_test(tcase, test_triangle_surface);
    tcase_add_test(tcase, test_ray_hash);
    return tcase;
}
