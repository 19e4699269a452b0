/* Adversarial rays: Embree and the device's traversal (as C) must find bitwise the same hits as a brute-force test of
 * every primitive. End points are vertices and points on edges and faces of primitives and of their boxes, off by a few
 * units in the last place; directions lie in the planes of triangles, along axes, or have tiny components. Half of the
 * rays are found by hill climbing: a ray is changed by units in the last place, and the change is kept if its hit is at
 * least as far outside the primitive's box as before. */
#include "backend/bvh.h"
#include "geometry/bvh_scenes.h"
#include "geometry/bvh_traverse.h"
#include "geometry/test_bvh.h"
#include "rays_embree.h"

#include <pthread.h>
#include <string.h>

#define SCENES 64u /* every scene has new geometry */
#define SCENE_RAYS (10000000u / SCENES + 1u)
#define THREADS 2u
#define CLIMB 16u /* steps of hill climbing from one ray */

/* What rays aim at: points in world space. */
typedef struct Targets {
    Vec3 corner[4];
    uint count; /* 3 for a triangle, 4 for a patch, 2 for a mere box */
} Targets;

typedef struct Adversary {
    TestScene test;
    RaysEmbree *rays;
    Bvh bvh;
    Targets *targets;
    uint target_count;
    TestRandom random;
    float scale; /* of the scene */
    uint asked, hits, wrong;
    double outside; /* largest distance of a hit from its box, in units of FLOAT_EPSILON (box + origin) */
    Ray worst;
} Adversary;

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

/* A coordinate that others are likely to have as well. */
static float coordinate(TestRandom *random)
{
    static const float COMMON[] = {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f, 2.4f, 0.1f, -3.2f};
    return random_unit(random) < 0.7f ? COMMON[random_below(random, 8)] : random_between(random, -1.0f, 1.0f);
}

static Vec3 corner_random(TestRandom *random)
{
    float x = coordinate(random), y = coordinate(random);
    return vec3(x, y, coordinate(random));
}

static void add_triangles(TestScene *test, TestRandom *random, uint count, float scale, Vec3 shift)
{
    TestMesh mesh = mesh_create(3 * (size_t)count, count);
    for (uint i = 0; i < count; ++i) {
        Vec3 a = corner_random(random), b = corner_random(random), c = corner_random(random);
        if (i % 3 == 1) /* a sliver */
            c = vec3_mad(vec3_lerp(a, b, random_unit(random)), 1e-5f, random_direction(random));
        if (i % 3 == 2 && i > 1) { /* shares an edge with the previous one */
            a = mesh.positions[3 * i - 3];
            b = mesh.positions[3 * i - 2];
        }
        uint first = mesh_vertex(&mesh, a);
        mesh_vertex(&mesh, b);
        mesh_vertex(&mesh, c);
        mesh_triangle(&mesh, first, first + 1, first + 2);
    }
    mesh_map(&mesh, scale, shift);
    test_scene_mesh(test, &mesh, 0);
    mesh_destroy(&mesh);
}

/* The walls of a room as patches, and some non-planar ones. */
static void add_patches(TestScene *test, TestRandom *random, float scale, Vec3 shift)
{
    static const uchar WALLS[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                                      {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 3, 5, 7}};
    Error error = {0};
    Vec3 corners[8 + 12];
    uint indices[4 * 9];
    Vec3 low = corner_random(random), high = vec3_add(low, vec3(1.0f, 2.0f, random_between(random, 0.5f, 3.0f)));
    for (uint i = 0; i < 8; ++i)
        corners[i] = vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (uint i = 8; i < 20; ++i)
        corners[i] = corner_random(random);
    for (uint i = 0; i < 20; ++i)
        corners[i] = vec3_mad(shift, scale, corners[i]);
    for (uint i = 0; i < 36; ++i)
        indices[i] = i < 24 ? WALLS[i / 4][i % 4] : i - 16;
    MeshData data = {.positions = &corners[0].x, .vertex_count = 20, .indices = indices, .triangle_count = 9};
    Shape shape = {.alpha = NONE, .first_light = NONE};
    ck_assert_msg(scene_add_patches(&test->scene, &data, shape, NULL, 0, &error), "%s", error.message);
}

/* An object of triangles and quadrics: rotated, mirrored, and stretched up to 30 times. */
static void add_instances(TestScene *test, TestRandom *random, float scale, Vec3 shift)
{
    Error error = {0};
    uint object;
    ck_assert(scene_object_begin(&test->scene, &object, &error));
    add_triangles(test, random, 6, 1.0f, vec3_splat(0.0f));
    test_scene_quadrics(test, random, 3);
    ck_assert(scene_object_end(&test->scene, &error));
    for (uint i = 0; i < 3; ++i) {
        double m[16], inverse[16];
        float stretch = i == 2 ? 0.03f : 0.5f;
        matrix_random(random, stretch * scale, scale, true, vec3_mad(shift, scale, corner_random(random)), m);
        if (i == 0) /* along the axes */
            for (int k = 0; k < 12; ++k)
                m[k] = k % 4 == 3 ? m[k] : k % 5 == 0 ? (double)(scale * random_between(random, stretch, 1.0f)) : 0.0;
        test_matrix_inverse(m, inverse);
        ck_assert(scene_add_instance(&test->scene, object, m, inverse, &error));
    }
}

/* A triangle with a corner so far away that rays from there use the devices' traversal on the CPU
 * (backend/ray_reach.h). */
static void add_far_triangle(TestScene *test, TestRandom *random, float scale)
{
    TestMesh mesh = mesh_create(3, 1);
    mesh_vertex(&mesh, corner_random(random));
    mesh_vertex(&mesh, corner_random(random));
    mesh_vertex(&mesh, vec3_scale(random_direction(random), 1.9e6f));
    mesh_triangle(&mesh, 0, 1, 2);
    mesh_map(&mesh, scale, vec3_splat(0.0f));
    test_scene_mesh(test, &mesh, 0);
    mesh_destroy(&mesh);
}

static void target_add(Adversary *adversary, uint id, const Instance *instance)
{
    const SceneView *view = &adversary->test.view;
    Primitive primitive = view->primitives[id];
    uint kind = primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    Targets *target = &adversary->targets[adversary->target_count++];
    Box box = primitive_box(view, id);
    target->count = kind == PRIMITIVE_TRIANGLE ? 3 : kind == PRIMITIVE_BILINEAR ? 4 : 2;
    const uint corners[3] = {primitive.a, primitive.b, primitive.c};
    for (uint k = 0; k < target->count; ++k) {
        if (kind == PRIMITIVE_TRIANGLE)
            target->corner[k] = view->positions[corners[k]];
        else if (kind == PRIMITIVE_BILINEAR)
            target->corner[k] = view->positions[view->patches[primitive.a].v[k]];
        else
            target->corner[k] =
                vec3(k ? box.high[0] : box.low[0], k ? box.high[1] : box.low[1], k ? box.high[2] : box.low[2]);
        if (instance)
            target->corner[k] = affine_point(instance->world_from_object, target->corner[k]);
    }
}

static void targets_make(Adversary *adversary)
{
    const SceneView *view = &adversary->test.view;
    uint instances = (uint)adversary->test.backend.instance_count, total = view->objects[0].primitive_count;
    for (uint i = 0; i < instances; ++i)
        total += view->objects[view->instances[i].object].primitive_count;
    adversary->targets = calloc(total, sizeof *adversary->targets);
    adversary->target_count = 0;
    ck_assert(adversary->targets != NULL);
    for (uint i = 0; i <= instances; ++i) {
        const Instance *instance = i < instances ? &view->instances[i] : NULL;
        Object object = view->objects[instance ? instance->object : 0];
        for (uint k = 0; k < object.primitive_count; ++k)
            target_add(adversary, object.first_primitive + k, instance);
    }
}

static bool has_far_triangle(uint number)
{
    return number % 8 >= 6;
}

/* At effort 1 a quarter, but not where few rays meet what is hard: 4.4 * 10^6 in all. */
static uint scene_rays(uint number)
{
    return test_effort() > 1 || has_far_triangle(number) ? SCENE_RAYS : SCENE_RAYS / 4u;
}

static void scene_make(Adversary *adversary, uint number)
{
    static const float SCALES[] = {1.0f, 1.0f, 1e-3f, 100.0f, 1e6f}, SHIFTS[] = {0.0f, 0.0f, 0.0f, 10.0f, 1e3f};
    Error error = {0};
    TestRandom *random = &adversary->random;
    float scale = SCALES[number % 5];
    Vec3 shift = vec3_scale(random_direction(random), scale * SHIFTS[number / 5 % 5]);
    adversary->scale = scale;
    test_scene_init(&adversary->test);
    if (number % 4 != 1)
        add_triangles(&adversary->test, random, 9, scale, shift);
    if (number % 4 != 0)
        add_patches(&adversary->test, random, scale, shift);
    if (number % 4 == 2 && scale == 1.0f)
        test_scene_quadrics(&adversary->test, random, 5);
    if (number % 4 == 3)
        add_instances(&adversary->test, random, scale, shift);
    if (has_far_triangle(number))
        add_far_triangle(&adversary->test, random, scale);
    test_scene_finish(&adversary->test);
    adversary->rays = rays_embree_create(&adversary->test.backend, 1, &error);
    ck_assert_msg(adversary->rays != NULL, "%s", error.message);
    ck_assert_msg(bvh_build(&adversary->test.backend, &adversary->bvh, &error), "%s", error.message);
    targets_make(adversary);
}

static void scene_free(Adversary *adversary)
{
    free(adversary->targets);
    bvh_destroy(&adversary->bvh);
    rays_embree_destroy(adversary->rays);
    test_scene_destroy(&adversary->test);
}

/* ---- rays -------------------------------------------------------------------------------------------------------- */

/* x, moved by up to `most` representable floats. */
static float ulps_moved(TestRandom *random, float x, uint most)
{
    uint steps = random_below(random, most + 1);
    float to = random_below(random, 2) ? FLOAT_MAX : -FLOAT_MAX;
    for (uint i = 0; i < steps; ++i)
        x = nextafterf(x, to);
    return x;
}

static Vec3 ulps_moved3(TestRandom *random, Vec3 p, uint most)
{
    float x = ulps_moved(random, p.x, most), y = ulps_moved(random, p.y, most);
    return vec3(x, y, ulps_moved(random, p.z, most));
}

/* A corner, a point on an edge or diagonal, one within the face, or one of the bounding box. */
static Vec3 target_point(TestRandom *random, const Targets *target)
{
    Vec3 a = target->corner[random_below(random, target->count)],
         b = target->corner[random_below(random, target->count)];
    float u = random_unit(random);
    switch (random_below(random, 4)) {
    case 0:
        return a;
    case 1:
        return vec3_lerp(a, b, u);
    case 2:
        return vec3(a.x, b.y, random_below(random, 2) ? a.z : b.z);
    default: {
        Vec3 c = target->corner[random_below(random, target->count)];
        return vec3_lerp(vec3_lerp(a, b, u), c, random_unit(random));
    }
    }
}

/* d with one or two components set to zero or nearly zero. */
static Vec3 axis_turned(TestRandom *random, Vec3 d)
{
    static const float SMALL[] = {0.0f, -0.0f, 1e-8f, -1e-7f, 1e-20f, -1e-19f, 1e-40f};
    float c[3] = {d.x, d.y, d.z};
    for (uint k = 1 + random_below(random, 2); k > 0; --k)
        c[random_below(random, 3)] = SMALL[random_below(random, 7)];
    return c[0] == 0.0f && c[1] == 0.0f && c[2] == 0.0f ? d : vec3(c[0], c[1], c[2]);
}

static Ray ray_make(Adversary *adversary)
{
    TestRandom *random = &adversary->random;
    const Targets *from = &adversary->targets[random_below(random, adversary->target_count)];
    const Targets *to =
        random_below(random, 4) ? &adversary->targets[random_below(random, adversary->target_count)] : from;
    float reach = adversary->test.backend.frame->scene.ray_reach;
    Ray ray;
    ray.o = ulps_moved3(random, target_point(random, from), random_below(random, 3) ? 40 : 1);
    if (random_below(random, 6) == 0) { /* in the plane of `from`, outside of it */
        Vec3 side = vec3_sub(target_point(random, from), ray.o);
        ray.o = vec3_mad(ray.o, random_between(random, -2.0f, 2.0f), side);
    }
    ray.o = vec3(float_clamp(ray.o.x, -reach, reach), float_clamp(ray.o.y, -reach, reach),
                 float_clamp(ray.o.z, -reach, reach));
    Vec3 end = ulps_moved3(random, target_point(random, to), random_below(random, 3) ? 40 : 1);
    ray.d = vec3_sub(end, ray.o);
    if (vec3_is_zero(ray.d))
        ray.d = random_direction(random);
    ray.t_max = 1.0f;
    if (random_below(random, 4)) {
        ray.t_max = FLOAT_MAX;
        ray.d = random_below(random, 2) ? vec3_normalize(ray.d) : ray.d;
    }
    if (random_below(random, 3) == 0)
        ray.d = axis_turned(random, ray.d);
    return ray;
}

static Ray ray_changed(Adversary *adversary, Ray ray)
{
    TestRandom *random = &adversary->random;
    float reach = adversary->test.backend.frame->scene.ray_reach;
    if (random_below(random, 2))
        ray.o = ulps_moved3(random, ray.o, 8);
    else
        ray.d = ulps_moved3(random, ray.d, 8);
    ray.o = vec3(float_clamp(ray.o.x, -reach, reach), float_clamp(ray.o.y, -reach, reach),
                 float_clamp(ray.o.z, -reach, reach));
    return ray;
}

/* How far the hit is outside its primitive's box, in units of FLOAT_EPSILON (box + origin), in the primitive's space;
 * negative for a miss. */
static double hit_outside(const Adversary *adversary, const Ray *ray, const Hit *hit)
{
    const SceneView *view = &adversary->test.view;
    if (hit->primitive == NONE)
        return -1.0;
    RayQuery query = ray_query(*ray);
    if (hit->instance != NONE)
        query = ray_query_transform(view->instances[hit->instance].object_from_world, &query);
    Box box = primitive_box(view, hit->primitive);
    const float o[3] = {query.o.x, query.o.y, query.o.z}, d[3] = {query.d.x, query.d.y, query.d.z};
    double outside = 0.0;
    for (int i = 0; i < 3; ++i) {
        double p = (double)o[i] + (double)hit->t * (double)d[i];
        outside = fmax(outside, fmax((double)box.low[i] - p, p - (double)box.high[i]));
    }
    return outside / ((double)FLOAT_EPSILON * ((double)box_largest(&box) + (double)vec3_max_abs(query.o)) + 1e-300);
}

/* Traces the ray by all three, which must find nothing if it is not traceable; its hit_outside goes to *outside. */
static void ray_ask(Adversary *adversary, const Ray *ray, double *outside)
{
    const SceneView *view = &adversary->test.view;
    Hit brute = ray_traceable(ray->o, ray->d) ? brute_force(&adversary->test, ray) : hit_none(ray->t_max),
        embree = rays_embree_closest(adversary->rays, ray), device = bvh_closest(view, adversary->bvh.words, *ray);
    bool occluded = brute.primitive != NONE;
    bool same = hit_same(&brute, &embree) && hit_same(&brute, &device) &&
                rays_embree_occluded(adversary->rays, ray) == occluded &&
                bvh_occluded(view, adversary->bvh.words, *ray) == occluded;
    ++adversary->asked;
    adversary->hits += occluded;
    if (!same && adversary->wrong++ == 0)
        adversary->worst = *ray;
    *outside = hit_outside(adversary, ray, &brute);
    if (*outside > adversary->outside)
        adversary->outside = *outside;
}

static void climb(Adversary *adversary)
{
    double best, outside;
    Ray ray = ray_make(adversary);
    ray_ask(adversary, &ray, &best);
    for (uint i = 1; i < CLIMB; ++i) {
        Ray other = i % 2 ? ray_changed(adversary, ray) : ray_make(adversary);
        ray_ask(adversary, &other, &outside);
        if (outside >= best) {
            best = outside;
            ray = other;
        }
    }
}

typedef struct AdversaryThread {
    pthread_t thread;
    uint first; /* scene */
    unsigned long long asked, hits, wrong;
    double outside;
    char failure[256];
} AdversaryThread;

static void *adversary_thread(void *argument)
{
    AdversaryThread *share = argument;
    for (uint number = share->first; number < share->first + SCENES / THREADS; ++number) {
        Adversary adversary = {.random = {.seed = 7000 + number}};
        scene_make(&adversary, number);
        while (adversary.asked < scene_rays(number))
            climb(&adversary);
        scene_free(&adversary);
        share->asked += adversary.asked;
        share->hits += adversary.hits;
        share->wrong += adversary.wrong;
        share->outside = fmax(share->outside, adversary.outside);
        const Ray *r = &adversary.worst;
        if (adversary.wrong > 0 && share->failure[0] == '\0')
            snprintf(share->failure, sizeof share->failure, "scene %u: o (%a, %a, %a) d (%a, %a, %a) t_max %g", number,
                     r->o.x, r->o.y, r->o.z, r->d.x, r->d.y, r->d.z, r->t_max);
    }
    return NULL;
}

/* 10^7 rays per unit of effort from 2 to 7; the long test traces 10^9, over a hundred times as many scenes, in
 * LONG_PARTS, since Check's time limits end at 2^31 microseconds. */
#define LONG_PARTS 20u

START_TEST(test_adversary)
{
    uint rounds = test_effort() >= 8 ? 100u / LONG_PARTS : test_effort(), first = (uint)_i * rounds;
    AdversaryThread total = {0};
    for (uint round = first; round < first + rounds; ++round) {
        AdversaryThread shares[THREADS];
        memset(shares, 0, sizeof shares);
        for (uint i = 0; i < THREADS; ++i) {
            shares[i].first = round * SCENES + i * (SCENES / THREADS);
            ck_assert_int_eq(pthread_create(&shares[i].thread, NULL, adversary_thread, &shares[i]), 0);
        }
        for (uint i = 0; i < THREADS; ++i) {
            pthread_join(shares[i].thread, NULL);
            total.asked += shares[i].asked;
            total.hits += shares[i].hits;
            total.outside = fmax(total.outside, shares[i].outside);
            total.wrong += shares[i].wrong;
            if (shares[i].wrong > 0)
                memcpy(total.failure, shares[i].failure, sizeof total.failure);
        }
    }
    printf("# adversary: %llu rays, %llu hits, %.2f units outside at most, %llu differ\n", total.asked, total.hits,
           total.outside, total.wrong);
    ck_assert_msg(total.wrong == 0, "%llu of %llu rays differ, one of them in %s", total.wrong, total.asked,
                  total.failure);
    ck_assert(total.asked >= (test_effort() > 1 ? 10000000ull : 4000000ull) * rounds && total.hits > total.asked / 4);
    ck_assert_msg(total.outside <= (double)HIT_ULPS + 1.5, "a hit counts %g units outside its box", total.outside);
}
END_TEST

TCase *bvh_adversary_tcase(void)
{
    TCase *tcase = tcase_create("adversary");
    tcase_set_timeout(tcase, test_effort() >= 8 ? 900.0 : 240.0);
    tcase_add_loop_test(tcase, test_adversary, 0, test_effort() >= 8 ? (int)LONG_PARTS : 1);
    return tcase;
}
