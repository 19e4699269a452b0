/* What the tree of lights stores of their bounds: nothing is lost by it, and how little it takes. */
#include "light/test_light.h"
#include "scene/light_bounds.h"
#include "support/light_fixture.h"

/* Lamps of all kinds within `size` of a place. */
static void cluster_add(LightFixture *f, unsigned *state, Vec3 place, double size)
{
    static const uint indices[3] = {0, 1, 2};
    const float emission[3] = {1.0f, 1.0f, 1.0f};
    for (int i = 0; i < 6; ++i) {
        Error error = {0};
        Vec3 corners[3], middle = vec3_add(place, fixture_random_point(state, size));
        for (int k = 0; k < 3; ++k)
            corners[k] = vec3_add(middle, fixture_random_point(state, 0.1 * size));
        const MeshData mesh = {.positions = &corners[0].x, .vertex_count = 3, .indices = indices, .triangle_count = 1};
        ck_assert(scene_add_mesh(&f->scene, &mesh, fixture_shape(0), emission, i == 0 ? LIGHT_TWO_SIDED : 0, &error));
    }
    for (int i = 0; i < 3; ++i)
        fixture_add_light(f, (LightData){.kind = i == 0 ? LIGHT_POINT : LIGHT_SPOT,
                                         .emission = {1, 1, 1},
                                         .detail = {.position = vec3_add(place, fixture_random_point(state, size)),
                                                    .direction = fixture_random_unit(state),
                                                    .cos_total = 0.8f,
                                                    .cos_falloff = 0.9f}});
}

static Box light_box(const SceneView *view, uint light)
{
    Box box = box_empty();
    if (light_kind(view->lights + light) == LIGHT_AREA)
        return primitive_box(view, view->lights[light].primitive);
    box_add(&box, light_detail(view, view->lights + light)->position);
    return box;
}

/* On the way down to a leaf spheres contain its light and, if it shines on `at`, no estimate is 0. */
static void walk_check(const SceneView *view, uint light, LightReceiver at, bool shines)
{
    Box box = light_box(view, light);
    uint leaf = light_leaf(view->lights + light);
    LightWalk walk = light_walk_begin(view);
    while (walk.count > 1) {
        uint flags = view->light_nodes[walk.node].left;
        LightFork fork = light_walk_fork(view, &walk, at);
        bool to_left = leaf - walk.first < fork.lower;
        light_walk_descend(&walk, &fork, to_left);
        ck_assert_msg(box_reach(&box, walk.sphere.center) <= (double)walk.sphere.radius, "light %u: %g > %g", light,
                      box_reach(&box, walk.sphere.center), (double)walk.sphere.radius);
        if (shines)
            ck_assert_msg(light_importance(to_left ? &fork.left : &fork.right, flags, at) > 0.0f,
                          "light %u shines on (%g, %g, %g), but is not estimated to", light, (double)at.p.x,
                          (double)at.p.y, (double)at.p.z);
    }
    ck_assert_uint_eq(view->light_leaves[walk.first], light);
}

/* Scale and offset from the origin in units of it. */
static const double HOSTILE[5][2] = {{1.0, 0.0}, {1e-6, 0.0}, {1e6, 0.0}, {1e-3, 3e4}, {1e3, 3e4}};

/* Three clusters of lamps at distances of 1, 1000 and a million, at any scale and far from the origin. */
START_TEST(test_hostile)
{
    enum { CLUSTERS = 3 };
    const double scale = HOSTILE[_i][0], far = HOSTILE[_i][1] * scale, distances[CLUSTERS] = {0.0, 1e3, 1e6};
    unsigned state = 5, lit = 0;
    Vec3 places[CLUSTERS];
    LightFixture f;
    fixture_init(&f);
    for (int i = 0; i < CLUSTERS; ++i) {
        places[i] = vec3((float)far, (float)(far + distances[i] * scale), (float)-far);
        cluster_add(&f, &state, places[i], scale);
    }
    fixture_finish(&f);
    for (uint i = 0; i < 100000u; ++i) {
        LightSample sample = {0};
        uint light = i % (uint)f.scene.lights.count;
        Vec3 p = vec3_add(places[i % 7u % CLUSTERS], fixture_random_point(&state, (i % 2u == 0u ? 1.5 : 8.0) * scale));
        Vec2 u = vec2((float)test_random_unit(&state), (float)test_random_unit(&state));
        bool shines = light_sample(&f.view, light, p, u, &sample) && rgb_luminance(sample.radiance) > 0.0f;
        walk_check(&f.view, light, light_receiver(&f.view, p, fixture_random_unit(&state)), shines);
        lit += shines ? 1 : 0;
    }
    ck_assert_uint_gt(lit, 20000);
    fixture_destroy(&f);
}
END_TEST

/* Beside its geometry a triangle that emits takes at most 64 bytes; LightTree is for all. */
START_TEST(test_bytes)
{
    enum { COUNT = 10000 };
    unsigned state = 3;
    LightFixture f;
    fixture_init(&f);
    for (int i = 0; i < COUNT; ++i) {
        Vec3 p = fixture_random_point(&state, 20.0);
        const float corners[9] = {p.x, p.y, p.z, p.x + 0.1f, p.y, p.z, p.x, p.y + 0.1f, p.z};
        fixture_add_polygon(&f, corners, 3, NULL, 0, 0);
    }
    fixture_finish(&f);
    const Scene *s = &f.scene;
    ck_assert_uint_eq(s->lights.count, COUNT);
    size_t bytes = s->lights.count * sizeof(Light) + s->light_details.count * sizeof(LightDetail) +
                   s->light_alias.count * sizeof(AliasBucket) + s->light_tree.count * sizeof(LightTree) +
                   s->light_nodes.count * sizeof(LightNode) + s->light_leaves.count * sizeof(uint);
    ck_assert_uint_le(bytes, (size_t)COUNT * 64 + sizeof(LightTree));
    fixture_destroy(&f);
}
END_TEST

/* Point lights that differ in their intensity alone: shares are in proportion to it, as closely as nodes store them. */
START_TEST(test_ratio)
{
    static const float ratios[5] = {1.0f, 9.0f, 1e-3f, 1e6f, 1e12f};
    static const double most = 0x1p28;
    LightFixture f;
    fixture_init(&f);
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}, .detail.position = {-1, 0, 0}});
    fixture_add_light(
        &f, (LightData){.kind = LIGHT_POINT, .emission = vec3_splat(ratios[_i]), .detail.position = {1, 0, 0}});
    fixture_finish(&f);
    double ratio = fmin((double)ratios[_i], most);
    double pdf = (double)light_choice_pdf(&f.view, 1, vec3(0, 0, 2), vec3(0, 0, 1));
    double other = (double)light_choice_pdf(&f.view, 0, vec3(0, 0, 2), vec3(0, 0, 1));
    ck_assert_double_lt(fabs(pdf / (ratio / (1.0 + ratio)) - 1.0), 0.005);
    ck_assert_double_lt(fabs(other * (1.0 + ratio) - 1.0), ratio < 1e7 ? 0.005 : 0.1 * ratio);
    fixture_destroy(&f);
}
END_TEST

/* Of spots alone, none is chosen where it does not shine, to within the steps in which nodes store cones; the second
 * one here shines on nearly everything. */
START_TEST(test_beams)
{
    const LightData spot = {.kind = LIGHT_SPOT,
                            .emission = {1, 1, 1},
                            .detail = {.direction = {0, 0.6f, 0.8f}, .cos_total = 0.9f, .cos_falloff = 0.95f}};
    LightData wide = spot;
    unsigned state = 41, lit = 0, dark = 0;
    LightFixture f;
    wide.detail.position = vec3(-5.0f, 0.0f, 0.0f);
    wide.detail.cos_total = -0.999f;
    fixture_init(&f);
    fixture_add_light(&f, spot);
    fixture_add_light(&f, wide);
    fixture_finish(&f);
    for (int i = 0; i < 10000; ++i) {
        Vec3 w = fixture_random_unit(&state);
        float cosine = vec3_dot(w, spot.detail.direction);
        float pdf = light_choice_pdf(&f.view, 0, vec3_scale(w, 3.0f), vec3(0, 0, 1));
        if (cosine > 0.9f && ++lit > 0)
            ck_assert((pdf > 0.0f));
        else if (cosine < 0.87f && ++dark > 0)
            ck_assert((pdf == 0.0f));
    }
    ck_assert_uint_gt(lit, 300);
    ck_assert_uint_gt(dark, 8000);
    fixture_destroy(&f);
}
END_TEST

TCase *light_bounds_case(void)
{
    TCase *tcase = tcase_create("bounds");
    tcase_add_loop_test(tcase, test_hostile, 0, 5);
    tcase_add_test(tcase, test_bytes);
    tcase_add_loop_test(tcase, test_ratio, 0, 5);
    tcase_add_test(tcase, test_beams);
    return tcase;
}
