/* The CPU backend's ray queries against brute force: the same bits, whatever the hierarchy. */
#include "curve_cluster.h"
#include "geometry/geometry_suites.h"
#include "rays_embree.h"
#include "support/geometry_fixture.h"
#include "triangle_cluster.h"

#include <string.h>

typedef struct Differences {
    uint hits, shadows, traced, missed;
} Differences;

static RaysEmbree *rays_open(const TestScene *test)
{
    Error error = {0};
    RaysEmbree *rays = rays_embree_create(&test->backend, 1, &error);
    ck_assert_msg(rays != NULL, "%s", error.message);
    return rays;
}

static bool brute_occluded(const TestScene *test, const Ray *ray)
{
    return brute_force(test, ray).primitive != NONE;
}

/* Random walks through the scene: every ray is traced both ways. */
static Differences walks_compare(const TestScene *test, const RaysEmbree *rays, uint walks, uint steps, Vec3 start,
                                 uint seed)
{
    TestRandom random = {.seed = seed};
    Differences count = {0};
    for (uint i = 0; i < walks; ++i) {
        Ray ray = {start, random_direction(&random), FLOAT_MAX};
        Vec3 last = start, last_ng = vec3_splat(0.0f);
        for (uint step = 0; step < steps; ++step) {
            Hit a = rays_embree_closest(rays, &ray), b = brute_force(test, &ray);
            ++count.traced;
            count.hits += !hit_same(&a, &b);
            if (b.primitive == NONE) {
                ++count.missed;
                break;
            }
            Surface surface = surface_from_hit(&test->view, &ray, b);
            Ray segment = ray_between(surface.p, surface.ng, last, last_ng);
            if (step == 0 && segment.t_max > 0.0f)
                count.shadows += rays_embree_occluded(rays, &segment) != brute_occluded(test, &segment);
            last = surface.p;
            last_ng = surface.ng;
            ray = ray_spawn(surface.p, surface.ng, random_direction(&random));
        }
    }
    return count;
}

static void mesh_compare(TestMesh mesh, float scale, Vec3 shift, uint walks, uint seed)
{
    TestScene test;
    mesh_map(&mesh, scale, shift);
    test_scene_init(&test);
    test_scene_mesh(&test, &mesh, 0);
    test_scene_finish(&test);
    RaysEmbree *rays = rays_open(&test);
    Differences count =
        walks_compare(&test, rays, walks, 3, vec3_mad(shift, 0.1f * scale, vec3(0.3f, 0.2f, 0.1f)), seed);
    rays_embree_destroy(rays);
    test_scene_destroy(&test);
    mesh_destroy(&mesh);
    ck_assert_msg(count.hits == 0 && count.shadows == 0, "mesh %u: %u of %u hits, %u shadows differ", seed, count.hits,
                  count.traced, count.shadows);
    ck_assert_uint_ge(count.traced, walks);
}

START_TEST(test_same_bits_star)
{
    mesh_compare(mesh_star(9, 12, 0.3f, 1), 1.0f, vec3_splat(0.0f), 40000, 101);
    mesh_compare(mesh_star(9, 12, 0.3f, 2), 1e-4f, vec3_splat(0.0f), 20000, 102);
}
END_TEST

START_TEST(test_same_bits_slivers)
{
    mesh_compare(mesh_slivers(150, 1.5f, 1e-3f, 3), 1.0f, vec3_splat(0.0f), 60000, 103);
    mesh_compare(mesh_slivers(150, 2.0f, 1e-5f, 4), 100.0f, vec3(3.0f, -50.0f, 1e3f), 60000, 104);
}
END_TEST

START_TEST(test_same_bits_coplanar)
{
    mesh_compare(mesh_coplanar(4, 5, 5), 1.0f, vec3_splat(0.0f), 25000, 105);
    mesh_compare(mesh_coplanar(5, 3, 6), 0.7f, vec3(-0.3f, 11.0f, 0.25f), 25000, 106);
}
END_TEST

START_TEST(test_same_bits_far)
{
    mesh_compare(mesh_star(7, 9, 0.2f, 7), 1.0f, vec3(1e4f, -1e4f, 1e4f), 40000, 107);
    mesh_compare(mesh_star(7, 9, 0.2f, 8), 1.0f, vec3(1e6f, 0.0f, 3e5f), 20000, 108);
}
END_TEST

START_TEST(test_same_bits_huge)
{
    mesh_compare(mesh_star(7, 9, 0.2f, 9), 1e7f, vec3(1e7f, 0.0f, 3e5f), 20000, 109);
    mesh_compare(mesh_star(7, 9, 0.2f, 10), 1e12f, vec3_splat(0.0f), 20000, 110);
}
END_TEST

/* Rays from a distant camera, whose rounding is larger than the scene's; they hit and miss the silhouette. */
START_TEST(test_same_bits_far_camera)
{
    static const float distances[] = {10.0f, 300.0f, 1e4f};
    for (uint k = 0; k < 3; ++k) {
        TestRandom random = {.seed = 115 + k};
        TestScene test;
        TestMesh mesh = mesh_star(9, 11, 0.3f, 11 + k);
        uint differ = 0, met = 0;
        test_scene_init(&test);
        test.scene.camera_settings.world_from_camera[3] = (double)distances[k];
        test_scene_mesh(&test, &mesh, 0);
        test_scene_finish(&test);
        ck_assert(test.scene.frame.scene.ray_reach >= distances[k] &&
                  test.scene.frame.scene.ray_reach < 1.001f * distances[k]);
        RaysEmbree *rays = rays_open(&test);
        for (uint i = 0; i < 60000; ++i) {
            Vec3 target = vec3_scale(random_direction(&random), 1.0f + 0.2f * random_unit(&random));
            Vec3 o = vec3_scale(random_direction(&random), 0.99f * distances[k]);
            if (i % 3 == 0)
                target = mesh.positions[random_below(&random, (uint)mesh.vertex_count)];
            Ray ray = {o, vec3_normalize(vec3_sub(target, o)), FLOAT_MAX};
            Hit a = rays_embree_closest(rays, &ray), b = brute_force(&test, &ray);
            differ += !hit_same(&a, &b);
            met += b.primitive != NONE;
        }
        rays_embree_destroy(rays);
        test_scene_destroy(&test);
        mesh_destroy(&mesh);
        ck_assert_msg(differ == 0, "camera at %g: %u differ", (double)distances[k], differ);
        ck_assert_uint_gt(met, 20000);
        ck_assert_uint_lt(met, 59000);
    }
}
END_TEST

/* Two equal quads: the smaller number wins, in either order. */
START_TEST(test_tie_by_id)
{
    for (uint order = 0; order < 2; ++order) {
        TestScene test;
        TestRandom random = {.seed = 120};
        TestMesh mesh = mesh_create(8, 4);
        for (uint copy = 0; copy < 2; ++copy) {
            uint a = mesh_vertex(&mesh, vec3(-1.3f, -1.1f, 0.3f)), b = mesh_vertex(&mesh, vec3(1.0f, -1.0f, 0.1f));
            uint c = mesh_vertex(&mesh, vec3(1.7f, 1.1f, -0.2f)), d = mesh_vertex(&mesh, vec3(-1.0f, 1.0f, 0.0f));
            mesh_triangle(&mesh, copy == order ? a : c, copy == order ? b : d, copy == order ? c : a);
            mesh_triangle(&mesh, copy == order ? c : a, copy == order ? d : b, copy == order ? a : c);
        }
        test_scene_init(&test);
        test_scene_mesh(&test, &mesh, 0);
        test_scene_finish(&test);
        RaysEmbree *rays = rays_open(&test);
        for (uint i = 0; i < 20000; ++i) {
            Vec3 o = vec3(random_between(&random, -1.0f, 1.0f), random_between(&random, -1.0f, 1.0f), 2.0f);
            Vec3 target = vec3(random_between(&random, -0.9f, 0.9f), random_between(&random, -0.9f, 0.9f), 0.0f);
            Ray ray = {o, vec3_sub(target, o), FLOAT_MAX};
            Hit hit = rays_embree_closest(rays, &ray), brute = brute_force(&test, &ray);
            ck_assert(hit_same(&hit, &brute));
            float t[4], u, v;
            bool met[4];
            for (uint k = 0; k < 4; ++k) {
                const uint *index = mesh.indices + 3 * k;
                t[k] = FLOAT_MAX;
                met[k] = triangle_intersect(mesh.positions[index[0]], mesh.positions[index[1]],
                                            mesh.positions[index[2]], &ray, &t[k], &u, &v);
            }
            for (uint k = 0; k < 4; ++k)
                ck_assert(!met[k] || t[k] > hit.t || (t[k] == hit.t && k >= hit.primitive));
        }
        rays_embree_destroy(rays);
        test_scene_destroy(&test);
        mesh_destroy(&mesh);
    }
}
END_TEST

/* World geometry, and instances (some mirrored or stretched) of an object with every kind of primitive. */
static void instances_scene(TestScene *test, TestRandom *random, uint instances)
{
    Error error = {0};
    TestMesh world = mesh_star(6, 7, 0.2f, 30), inner = mesh_star(5, 6, 0.3f, 31);
    uint object;
    mesh_map(&world, 4.0f, vec3_splat(0.0f));
    test_scene_init(test);
    test_scene_mesh(test, &world, 0);
    ck_assert(scene_object_begin(&test->scene, &object, &error));
    test_scene_mesh(test, &inner, 0);
    test_scene_quadrics(test, random, 6);
    ck_assert(scene_object_end(&test->scene, &error));
    test_scene_quadrics(test, random, 4);
    test_scene_instances(test, random, object, instances, 1.0f);
    test_scene_finish(test);
    mesh_destroy(&world);
    mesh_destroy(&inner);
}

START_TEST(test_same_bits_instances)
{
    TestRandom random = {.seed = 130};
    TestScene test;
    instances_scene(&test, &random, 4);
    RaysEmbree *rays = rays_open(&test);
    Differences count = walks_compare(&test, rays, 25000, 4, vec3(0.1f, 0.0f, -0.2f), 131);
    rays_embree_destroy(rays);
    test_scene_destroy(&test);
    ck_assert_msg(count.hits == 0 && count.shadows == 0, "%u of %u hits, %u shadows differ", count.hits, count.traced,
                  count.shadows);
    ck_assert_uint_gt(count.traced, 60000);
}
END_TEST

static void mesh_transform(TestMesh *mesh, const double m[16])
{
    for (size_t i = 0; i < mesh->vertex_count; ++i) {
        Vec3 p = mesh->positions[i];
        double out[3];
        for (int k = 0; k < 3; ++k)
            out[k] = m[4 * k] * (double)p.x + m[4 * k + 1] * (double)p.y + m[4 * k + 2] * (double)p.z + m[4 * k + 3];
        mesh->positions[i] = vec3((float)out[0], (float)out[1], (float)out[2]);
    }
}

/* An instance of a mesh equals the transformed mesh up to rounding, its normal included. */
static void instance_compare(bool mirror, uint seed)
{
    Error error = {0};
    TestRandom random = {.seed = seed};
    TestScene instanced, baked;
    TestMesh mesh = mesh_star(6, 8, 0.2f, seed);
    double m[16], inverse[16];
    uint object, far = 0;
    matrix_random(&random, 0.5f, 1.5f, false, vec3(3.0f, -2.0f, 5.0f), m);
    for (int i = 0; mirror && i < 3; ++i)
        m[4 * i] = -m[4 * i];
    test_matrix_inverse(m, inverse);
    test_scene_init(&instanced);
    ck_assert(scene_object_begin(&instanced.scene, &object, &error));
    test_scene_mesh(&instanced, &mesh, 0);
    ck_assert(scene_object_end(&instanced.scene, &error));
    ck_assert(scene_add_instance(&instanced.scene, object, m, inverse, &error));
    test_scene_finish(&instanced);
    mesh_transform(&mesh, m);
    test_scene_init(&baked);
    test_scene_mesh(&baked, &mesh, mirror ? SHAPE_FLIP_NORMAL : 0);
    test_scene_finish(&baked);
    for (uint i = 0; i < 20000; ++i) {
        Vec3 o = vec3_add(vec3(3.0f, -2.0f, 5.0f), vec3_scale(random_direction(&random), 4.0f));
        Ray ray = {o, vec3_sub(vec3_add(vec3(3.0f, -2.0f, 5.0f), random_direction(&random)), o), FLOAT_MAX};
        Hit a = brute_force(&instanced, &ray), b = brute_force(&baked, &ray);
        if (a.primitive == NONE || b.primitive == NONE || a.primitive != b.primitive) {
            ++far;
            continue;
        }
        Surface sa = surface_from_hit(&instanced.view, &ray, a), sb = surface_from_hit(&baked.view, &ray, b);
        float cosine = float_abs(vec3_dot(vec3_normalize(ray.d), sb.ng));
        ck_assert(vec3_dot(sa.ng, sb.ng) > 0.99999f);
        ck_assert(cosine < 0.01f || float_abs(a.t - b.t) < 1e-5f);
        ck_assert(cosine < 0.01f || vec3_length(vec3_sub(sa.p, sb.p)) < 1e-4f);
        ck_assert(vec3_length(vec3_cross(vec3_normalize(sa.dpdu), vec3_normalize(sb.dpdu))) < 1e-3f);
    }
    test_scene_destroy(&instanced);
    test_scene_destroy(&baked);
    mesh_destroy(&mesh);
    ck_assert_uint_lt(far, 20000 * 6 / 10);
}

START_TEST(test_instance_equals_baked)
{
    instance_compare(false, 140);
    instance_compare(true, 141);
}
END_TEST

/* A surface seen through an instance's transform does not hit itself either. */
START_TEST(test_instance_self_intersection)
{
    Error error = {0};
    TestRandom random = {.seed = 150};
    uint self = 0, lost = 0;
    for (uint k = 0; k < 12; ++k) {
        TestScene test;
        TestMesh mesh = mesh_star(7, 8, 0.1f, k);
        double m[16], inverse[16];
        uint object;
        Vec3 shift = vec3_scale(random_direction(&random), k % 3 == 0 ? 0.0f : k % 3 == 1 ? 10.0f : 1e4f);
        matrix_random(&random, 0.1f, 10.0f, true, shift, m);
        test_matrix_inverse(m, inverse);
        test_scene_init(&test);
        ck_assert(scene_object_begin(&test.scene, &object, &error));
        test_scene_mesh(&test, &mesh, 0);
        ck_assert(scene_object_end(&test.scene, &error));
        ck_assert(scene_add_instance(&test.scene, object, m, inverse, &error));
        test_scene_finish(&test);
        for (uint i = 0; i < 10000; ++i) {
            Ray ray = {shift, random_direction(&random), FLOAT_MAX};
            Hit hit = brute_force(&test, &ray);
            if (hit.primitive == NONE) {
                ++lost;
                continue;
            }
            Surface surface = surface_from_hit(&test.view, &ray, hit);
            Ray next = ray_spawn(surface.p, surface.ng, random_direction(&random));
            self += brute_force(&test, &next).primitive == hit.primitive;
        }
        test_scene_destroy(&test);
        mesh_destroy(&mesh);
    }
    ck_assert_uint_eq(lost, 0);
    ck_assert_uint_eq(self, 0);
}
END_TEST

START_TEST(test_nothing_to_hit)
{
    TestScene test;
    Ray ray = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, FLOAT_MAX};
    test_scene_init(&test);
    test_scene_finish(&test);
    RaysEmbree *rays = rays_open(&test);
    ck_assert(rays_embree_closest(rays, &ray).primitive == NONE);
    ck_assert(!rays_embree_occluded(rays, &ray));
    rays_embree_destroy(rays);
    test_scene_destroy(&test);
}
END_TEST

/* Invalid rays hit nothing and do no harm. */
START_TEST(test_untraceable_rays)
{
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 3e38f, 2e18f};
    TestScene test;
    TestMesh mesh = mesh_star(5, 6, 0.2f, 3);
    test_scene_init(&test);
    test_scene_mesh(&test, &mesh, 0);
    test_scene_finish(&test);
    RaysEmbree *rays = rays_open(&test);
    for (uint i = 0; i < 5; ++i)
        for (uint k = 0; k < 6; ++k) {
            float v[6] = {0.1f, 0.2f, 0.1f, 0.0f, 0.6f, 0.8f};
            v[k] = BAD[i];
            Ray ray = {vec3(v[0], v[1], v[2]), vec3(v[3], v[4], v[5]), FLOAT_MAX};
            ck_assert(!ray_traceable(ray.o, ray.d));
            ck_assert(rays_embree_closest(rays, &ray).primitive == NONE);
            ck_assert(!rays_embree_occluded(rays, &ray));
        }
    Ray good = {vec3(0.1f, 0.2f, 0.1f), vec3(0.0f, 0.6f, 0.8f), FLOAT_MAX};
    ck_assert(ray_traceable(good.o, good.d) && rays_embree_closest(rays, &good).primitive != NONE);
    rays_embree_destroy(rays);
    test_scene_destroy(&test);
    mesh_destroy(&mesh);
}
END_TEST

static size_t bytes_of(TestScene *test)
{
    test_scene_finish(test);
    RaysEmbree *rays = rays_open(test);
    size_t bytes = rays_embree_bytes(rays);
    rays_embree_destroy(rays);
    test_scene_destroy(test);
    return bytes;
}

/* The size that is stated includes the clusters, which are larger than Embree's hierarchy over them. */
START_TEST(test_bytes_of_clusters)
{
    enum { CURVES = 4000 };
    TestScene test;
    TestMesh mesh = mesh_star(60, 80, 0.3f, 12);
    size_t clusters = mesh.triangle_count / CLUSTER_LANES * sizeof(TriangleCluster);
    test_scene_init(&test);
    test_scene_mesh(&test, &mesh, 0);
    size_t bytes = bytes_of(&test);
    ck_assert_msg(bytes > clusters, "%zu bytes, %zu of them in clusters of triangles", bytes, clusters);
    mesh_destroy(&mesh);

    TestRandom random = {.seed = 120};
    test_scene_init(&test);
    for (uint i = 0; i < CURVES; ++i) {
        Curve curve = {.width = {0.01f, 0.01f}};
        for (uint k = 0; k < 4; ++k)
            curve.p[k] = random_direction(&random);
        test_scene_curves(&test, &curve, 1, 3, CURVE_FLAT);
    }
    bytes = bytes_of(&test);
    ck_assert_msg(bytes > CURVES * sizeof(CurveCluster), "%zu bytes, %zu of them in clusters of curves", bytes,
                  CURVES * sizeof(CurveCluster));
}
END_TEST

TCase *geometry_rays_tcase(void)
{
    TCase *tcase = tcase_create("ray queries");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_same_bits_star);
    tcase_add_test(tcase, test_same_bits_slivers);
    tcase_add_test(tcase, test_same_bits_coplanar);
    tcase_add_test(tcase, test_same_bits_far);
    tcase_add_test(tcase, test_same_bits_huge);
    tcase_add_test(tcase, test_same_bits_far_camera);
    tcase_add_test(tcase, test_tie_by_id);
    tcase_add_test(tcase, test_same_bits_instances);
    tcase_add_test(tcase, test_instance_equals_baked);
    tcase_add_test(tcase, test_instance_self_intersection);
    tcase_add_test(tcase, test_nothing_to_hit);
    tcase_add_test(tcase, test_untraceable_rays);
    tcase_add_test(tcase, test_bytes_of_clusters);
    return tcase;
}
