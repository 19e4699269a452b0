/* The hierarchy against brute force, its layout, and inputs that it rejects. */
#include "backend/bvh.h"
#include "geometry/bvh_scenes.h"
#include "geometry/bvh_traverse.h"
#include "geometry/test_bvh.h"

#include <string.h>

static Bvh bvh_of(const TestScene *test)
{
    Error error = {0};
    Bvh bvh;
    ck_assert_msg(bvh_build(&test->backend, &bvh, &error), "%s", error.message);
    ck_assert_uint_le(bvh.stack, BVH_STACK);
    ck_assert_uint_eq((uintptr_t)bvh.words % 128, 0);
    return bvh;
}

/* ---- answers ----------------------------------------------------------------------------------------------------- */

/* A ray as random as possible: any length of direction, sometimes axis-aligned, from inside or outside, bounded or
 * not. */
static Ray any_ray(TestRandom *random, const TestScene *test)
{
    static const float LENGTHS[] = {1.0f, 1.0f, 1e-12f, 1e-30f, 1e6f, 1e-37f};
    float radius = test->backend.frame->scene.world_radius;
    Vec3 center = test->backend.frame->scene.world_center, d = random_direction(random);
    Vec3 o = vec3_mad(center, 1.2f * radius * random_unit(random), random_direction(random));
    uint choice = random_below(random, 8);
    if (choice < 3)
        d = vec3(choice == 0 ? 0.0f : d.x, choice == 1 ? -0.0f : d.y, choice == 2 ? 1e-20f : d.z);
    if (choice == 3)
        d = vec3(0.0f, random_unit(random) < 0.5f ? 1.0f : -1.0f, 0.0f);
    float length = LENGTHS[random_below(random, 6)] * float_max(radius, 1e-3f);
    float t_max = random_below(random, 3) == 0 ? radius * random_unit(random) / length : FLOAT_MAX;
    return (Ray){o, vec3_scale(d, length), t_max > 0.0f && t_max < FLOAT_MAX ? t_max : FLOAT_MAX};
}

START_TEST(test_same_hits_as_brute_force)
{
    const BvhCase *entry = &BVH_CASES[_i];
    TestRandom random = {.seed = 300 + (uint)_i};
    TestScene test;
    uint differ = 0, shadows = 0, met = 0, rays = 12000;
    if (!entry->small)
        return;
    entry->make(&test);
    Bvh bvh = bvh_of(&test);
    for (uint i = 0; i < rays; ++i) {
        Ray ray = any_ray(&random, &test);
        Hit a = bvh_closest(&test.view, bvh.words, ray), b = brute_force(&test, &ray);
        differ += !hit_same(&a, &b);
        shadows += bvh_occluded(&test.view, bvh.words, ray) != (b.primitive != NONE);
        met += b.primitive != NONE;
    }
    bvh_destroy(&bvh);
    test_scene_destroy(&test);
    ck_assert_msg(differ == 0 && shadows == 0, "%s: %u hits and %u visibilities differ", entry->name, differ, shadows);
    ck_assert_msg(met > rays / 50, "%s: %u hits", entry->name, met);
}
END_TEST

/* A single primitive, so that the root is a leaf, and none at all. */
START_TEST(test_small_scenes)
{
    TestRandom random = {.seed = 320};
    for (uint triangles = 0; triangles < 8; ++triangles) {
        TestScene test;
        TestMesh mesh = mesh_slivers(8, 1.0f, 0.5f, 321);
        mesh.triangle_count = triangles;
        test_scene_init(&test);
        if (triangles > 0)
            test_scene_mesh(&test, &mesh, 0);
        test_scene_finish(&test);
        Bvh bvh = bvh_of(&test);
        ck_assert_uint_eq(bvh.item_count, triangles);
        for (uint i = 0; i < 2000; ++i) {
            Ray ray = {vec3_splat(0.0f), random_direction(&random), FLOAT_MAX};
            Hit a = bvh_closest(&test.view, bvh.words, ray), b = brute_force(&test, &ray);
            TEST_TRUE(hit_same(&a, &b));
            TEST_TRUE(bvh_occluded(&test.view, bvh.words, ray) == (b.primitive != NONE));
        }
        bvh_destroy(&bvh);
        test_scene_destroy(&test);
        mesh_destroy(&mesh);
    }
}
END_TEST

START_TEST(test_untraceable_rays)
{
    static const float BAD[] = {NAN, INFINITY, -INFINITY, 3e38f, 2e18f};
    TestScene test;
    BVH_CASES[0].make(&test);
    Bvh bvh = bvh_of(&test);
    for (uint i = 0; i < 5; ++i)
        for (uint k = 0; k < 6; ++k) {
            float v[6] = {0.1f, 0.2f, 0.1f, 0.0f, 0.6f, 0.8f};
            v[k] = BAD[i];
            Ray ray = {vec3(v[0], v[1], v[2]), vec3(v[3], v[4], v[5]), FLOAT_MAX};
            ck_assert(bvh_closest(&test.view, bvh.words, ray).primitive == NONE);
            ck_assert(!bvh_occluded(&test.view, bvh.words, ray));
        }
    Ray still = {vec3(0.1f, 0.2f, 0.1f), vec3_splat(0.0f), FLOAT_MAX};
    ck_assert(bvh_closest(&test.view, bvh.words, still).primitive == NONE);
    bvh_destroy(&bvh);
    test_scene_destroy(&test);
}
END_TEST

/* ---- shape ------------------------------------------------------------------------------------------------------- */

typedef struct Census {
    const Bvh *bvh;
    uint nodes, items, instances;
    uint seen[1000]; /* how often primitive i is in a leaf */
} Census;

/* Counts what is reachable from a child's word; returns the number of stack entries needed below it. */
static uint census_take(Census *census, uint word)
{
    if (word & BVH_LEAF) {
        uint item = word & BVH_LEAF_FIRST_MASK, count = (word >> BVH_LEAF_COUNT_SHIFT & BVH_LEAF_COUNT_MASK) + 1;
        for (uint i = 0; i < count; ++i, ++census->items) {
            const uint *words = census->bvh->words + (size_t)(item + i) * 4 * BVH_ITEM_QUADS;
            bool instance = words[13] == BVH_INSTANCE;
            census->instances += instance;
            if (!instance)
                ++census->seen[words[12]];
        }
        return 0;
    }
    const uint *node = census->bvh->words + (size_t)word * 4 * BVH_NODE_QUADS;
    uint children = 0, deepest = 0;
    ++census->nodes;
    for (uint lane = 0; lane < 4; ++lane)
        if (bits_float(node[lane]) <= bits_float(node[4 + lane])) {
            uint below = census_take(census, node[24 + lane]);
            ++children;
            deepest = below > deepest ? below : deepest;
        }
    return deepest + children - 1;
}

/* Every primitive of the world is in exactly one leaf, and sizes are as stated. */
START_TEST(test_layout)
{
    for (uint i = 0; i < BVH_CASE_COUNT; ++i) {
        TestScene test;
        Census census = {0};
        if (!BVH_CASES[i].small)
            continue;
        BVH_CASES[i].make(&test);
        Bvh bvh = bvh_of(&test);
        census.bvh = &bvh;
        uint stack = census_take(&census, bvh.words[BVH_ROOT]);
        Object world = test.view.objects[0];
        for (uint k = 0; k < world.primitive_count; ++k)
            ck_assert_uint_eq(census.seen[world.first_primitive + k], 1);
        if (test.backend.instance_count == 0) {
            ck_assert_uint_eq(census.nodes, bvh.node_count);
            ck_assert_uint_eq(census.items, bvh.item_count);
            ck_assert_uint_eq(stack + 1, bvh.stack);
        } else {
            ck_assert_uint_eq(census.instances, 12); /* those of the empty object are omitted */
            ck_assert_uint_gt(bvh.stack, stack + 2);
        }
        bvh_destroy(&bvh);
        test_scene_destroy(&test);
    }
}
END_TEST

/* ---- limits ------------------------------------------------------------------------------------------------------ */

/* Triangles that halve in size toward a corner: a SAH tree is as deep as their number. */
static void make_shrinking(TestScene *test, uint count)
{
    TestMesh mesh = mesh_create(3 * (size_t)count, count);
    float size = 1e12f;
    for (uint i = 0; i < count; ++i, size *= 0.5f) {
        uint a = mesh_vertex(&mesh, vec3(size, 0.0f, 0.0f)), b = mesh_vertex(&mesh, vec3(0.0f, size, 0.0f));
        mesh_triangle(&mesh, a, b, mesh_vertex(&mesh, vec3(0.0f, 0.0f, size)));
    }
    test_scene_init(test);
    test_scene_mesh(test, &mesh, 0);
    test_scene_finish(test);
    mesh_destroy(&mesh);
}

/* If the SAH tree needs too much stack, a tree that fits is built, down to the smallest depth that can hold all
 * primitives. */
START_TEST(test_depth_is_bounded)
{
    Error error = {0};
    TestScene test;
    Bvh free_depth, bounded;
    make_shrinking(&test, 90);
    ck_assert_msg(bvh_build_bounded(&test.backend, 1000, &free_depth, &error), "%s", error.message);
    ck_assert_msg(bvh_build_bounded(&test.backend, 31, &bounded, &error), "%s", error.message);
    ck_assert_uint_gt(free_depth.stack, 31);
    ck_assert_uint_le(bounded.stack, 31);
    ck_assert_uint_eq(bounded.item_count, free_depth.item_count);
    ck_assert_uint_lt(bounded.max_depth, free_depth.max_depth);
    TestRandom random = {.seed = 330};
    uint differ = 0;
    for (uint i = 0; i < 3000; ++i) {
        Ray ray = {vec3_splat(0.0f), vec3_abs(random_direction(&random)), FLOAT_MAX};
        Hit a = bvh_closest(&test.view, bounded.words, ray), b = brute_force(&test, &ray);
        differ += !hit_same(&a, &b);
    }
    ck_assert_uint_eq(differ, 0);
    bvh_destroy(&free_depth);
    bvh_destroy(&bounded);
    test_scene_destroy(&test);
}
END_TEST

START_TEST(test_too_deep)
{
    for (uint i = 0; i < BVH_CASE_COUNT; ++i) {
        Error error = {0};
        TestScene test;
        Bvh bvh;
        BVH_CASES[i].make(&test);
        ck_assert_msg(!bvh_build_bounded(&test.backend, 5, &bvh, &error), "%s fits a stack of 5", BVH_CASES[i].name);
        ck_assert_msg(strstr(error.message, "too deep for a stack of 5 entries"), "%s", error.message);
        ck_assert_msg(strstr(error.fix, "--backend=cpu"), "%s", error.fix);
        ck_assert(bvh.words == NULL && bvh.word_count == 0);
        bvh_destroy(&bvh);
        test_scene_destroy(&test);
    }
}
END_TEST

TCase *bvh_build_tcase(void)
{
    TCase *tcase = tcase_create("building");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_loop_test(tcase, test_same_hits_as_brute_force, 0, (int)BVH_CASE_COUNT);
    tcase_add_test(tcase, test_small_scenes);
    tcase_add_test(tcase, test_untraceable_rays);
    tcase_add_test(tcase, test_layout);
    tcase_add_test(tcase, test_depth_is_bounded);
    tcase_add_test(tcase, test_too_deep);
    return tcase;
}
