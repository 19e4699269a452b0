/* The choice of a light for a point: the tree's bounds, its probabilities, and what it is good for. */
#include "light/test_light.h"
#include "scene/light_tree.h"
#include "support/light_fixture.h"

static void polygon_add(LightFixture *f, unsigned *state, double extent, double size, int vertices, uint flags)
{
    float positions[12];
    Vec3 center = fixture_random_point(state, extent);
    for (int i = 0; i < vertices; ++i) {
        Vec3 corner = vec3_add(center, fixture_random_point(state, size));
        positions[3 * i] = corner.x;
        positions[3 * i + 1] = corner.y;
        positions[3 * i + 2] = corner.z;
    }
    fixture_add_polygon(f, positions, vertices, NULL, 0, flags);
}

/* A goniometric and a projection light. */
static void intensity_images_add(LightFixture *f, unsigned *state)
{
    static const double EXTENT[2] = {0.8, 0.4};
    const uint kinds[2] = {LIGHT_GONIOMETRIC, LIGHT_PROJECTION};
    float texels[3 * 16];
    for (int i = 0; i < 3 * 16; ++i)
        texels[i] = (float)fixture_uniform(state, 0.0, 1.0);
    for (int i = 0; i < 2; ++i) {
        Frame frame = frame_from_normal(fixture_random_unit(state));
        const double rotation[9] = {(double)frame.t.x, (double)frame.b.x, (double)frame.n.x,
                                    (double)frame.t.y, (double)frame.b.y, (double)frame.n.y,
                                    (double)frame.t.z, (double)frame.b.z, (double)frame.n.z};
        fixture_add_environment(f, texels, 4, 4, 0, rotation);
        fixture_to_intensity(f, kinds[i], fixture_random_point(state, 2.0), EXTENT);
    }
}

/* Lamps of all kinds in a cube of half width 2, among them one without power; `far`: a distant light and a sky, too. */
static void lights_add(LightFixture *f, unsigned *state, bool far)
{
    for (int i = 0; i < 12; ++i)
        polygon_add(f, state, 2.0, 0.2, i % 3 == 0 ? 4 : 3, i % 4 == 0 ? LIGHT_TWO_SIDED : 0);
    for (int i = 0; i < 4; ++i) {
        float brightness = i == 3 ? 0.0f : (float)fixture_uniform(state, 0.01, 1.0);
        fixture_add_light(f, (LightData){.kind = LIGHT_POINT,
                                         .emission = vec3_splat(brightness),
                                         .detail.position = fixture_random_point(state, 2.0)});
        fixture_add_light(f, (LightData){.kind = LIGHT_SPOT,
                                         .emission = vec3_splat(0.3f),
                                         .detail.position = fixture_random_point(state, 2.0),
                                         .detail.direction = fixture_random_unit(state),
                                         .detail.cos_total = 0.5f,
                                         .detail.cos_falloff = 0.75f});
    }
    intensity_images_add(f, state);
    if (!far)
        return;
    fixture_add_light(
        f, (LightData){.kind = LIGHT_DISTANT, .emission = {0.5f, 0.5f, 0.5f}, .detail.direction = {0, 0, 1}});
    fixture_add_light(f, (LightData){.kind = LIGHT_INFINITE, .emission = {0.1f, 0.1f, 0.1f}});
}

/* Counts of choices agree with light_choice_pdf, whose sum over all lights is 1, and what is left of the number is
 * uniform. */
START_TEST(test_probabilities)
{
    unsigned state = 7u + (unsigned)_i;
    LightFixture f;
    enum { SAMPLES = 100000, MOST = 32 };
    fixture_init(&f);
    lights_add(&f, &state, _i % 2 == 1);
    fixture_finish(&f);
    uint count = (uint)f.scene.lights.count;
    double observed[MOST] = {0.0}, expected[MOST] = {0.0}, sum = 0.0, rests[10] = {0.0}, tenths[10];
    Vec3 p = fixture_random_point(&state, 3.0), n = fixture_random_unit(&state);
    for (uint i = 0; i < count; ++i) {
        double pdf = (double)light_choice_pdf(&f.view, i, p, n);
        sum += pdf;
        expected[i] = pdf * SAMPLES;
    }
    ck_assert_double_lt(fabs(sum - 1.0), 1e-5);
    for (uint i = 0; i < SAMPLES; ++i) {
        Vec2 u;
        float pdf;
        uint light = light_choose_point(&f.view, p, n, random_four(i, 0, 0, 0, 77, 0), &u, &pdf);
        ck_assert_uint_lt(light, count);
        ck_assert((pdf == light_choice_pdf(&f.view, light, p, n)));
        ck_assert((u.x > 0.0f && u.x < 1.0f && u.y > 0.0f && u.y < 1.0f));
        observed[light] += 1.0;
        rests[(int)(u.x * 10.0f)] += 1.0;
    }
    for (int i = 0; i < 10; ++i)
        tenths[i] = SAMPLES / 10.0;
    for (uint i = 0; i < count; ++i) /* where next to none are expected, chi^2 does not hold */
        if (expected[i] < 5.0) {
            ck_assert_double_le(observed[i], expected[i] + 20.0);
            observed[i] = expected[i] = 0.0;
        }
    ck_assert_double_gt(test_chi_square(observed, expected, (int)count), 1e-4);
    ck_assert_double_gt(test_chi_square(rests, tenths, 10), 1e-4);
    fixture_destroy(&f);
}
END_TEST

/* A light that a point receives something from has a probability, wherever both are; and one without power has none. */
START_TEST(test_nothing_lost)
{
    unsigned state = 91;
    LightFixture f;
    fixture_init(&f);
    lights_add(&f, &state, true);
    fixture_finish(&f);
    unsigned lit = 0, dark = 0;
    for (uint i = 0; i < 200000u; ++i) {
        LightSample sample = {0};
        uint light = i % (uint)f.scene.lights.count;
        Vec3 p = fixture_random_point(&state, i % 3u == 0u ? 0.3 : 3.0), n = fixture_random_unit(&state);
        Vec2 u = vec2((float)test_random_unit(&state), (float)test_random_unit(&state));
        float pdf = light_choice_pdf(&f.view, light, p, n);
        if (light_sample(&f.view, light, p, u, &sample) && rgb_luminance(sample.radiance) > 0.0f) {
            ck_assert_msg(pdf > 0.0f, "light %u shines on (%g, %g, %g), and is never chosen", light, (double)p.x,
                          (double)p.y, (double)p.z);
            ++lit;
        }
        dark += pdf == 0.0f ? 1u : 0u;
    }
    ck_assert_uint_gt(lit, 80000);
    ck_assert_uint_gt(dark, 20000); /* those that face away, and the one without power */
    fixture_destroy(&f);
}
END_TEST

/* Variance over the squared mean of the irradiance from one light sample. */
static double irradiance_spread(const LightFixture *f, Vec3 p, Vec3 n, bool tree, double *mean)
{
    enum { SAMPLES = 20000 };
    double sum = 0.0, squares = 0.0;
    for (uint i = 0; i < SAMPLES; ++i) {
        Vec2 u;
        float choice;
        LightSample sample = {0};
        Random4 random = random_four(i, 1, 0, 0, 5, 0);
        uint light =
            tree ? light_choose_point(&f->view, p, n, random, &u, &choice) : light_select_point(&f->view, random, &u);
        choice = tree ? choice : f->view.lights[light].select_pdf;
        if (!light_sample(&f->view, light, p, u, &sample))
            continue;
        double cosine = fabs((double)vec3_dot(n, sample.wi));
        double value = (double)rgb_luminance(sample.radiance) * cosine / ((double)choice * (double)sample.pdf_w);
        sum += value;
        squares += value * value;
    }
    *mean = sum / SAMPLES;
    return (squares / SAMPLES - *mean * *mean) / (*mean * *mean);
}

/* On a plain of many lamps, the tree finds the near ones, with the mean of the choice by power. */
START_TEST(test_many)
{
    unsigned state = 3;
    LightFixture f;
    fixture_init(&f);
    f.scene.frame.scene.world_radius = 30.0f;
    for (int i = 0; i < 1000; ++i) {
        float x = (float)fixture_uniform(&state, -20.0, 20.0), y = (float)fixture_uniform(&state, -20.0, 20.0);
        const float lamp[9] = {x, y, 1.0f, x + 0.1f, y, 1.0f, x, y + (i % 2 == 0 ? 0.1f : -0.1f), 1.0f};
        fixture_add_polygon(&f, lamp, 3, NULL, 0, LIGHT_TWO_SIDED);
    }
    fixture_finish(&f);
    ck_assert_uint_eq(f.scene.light_nodes.count, 999);
    for (int i = 0; i < 4; ++i) {
        Vec3 p = vec3((float)fixture_uniform(&state, -15.0, 15.0), (float)fixture_uniform(&state, -15.0, 15.0), 0.0f);
        double mean, power_mean, spread = irradiance_spread(&f, p, vec3(0, 0, 1), true, &mean);
        double power_spread = irradiance_spread(&f, p, vec3(0, 0, 1), false, &power_mean);
        ck_assert_double_lt(fabs(mean / power_mean - 1.0), 4.0 * sqrt((spread + power_spread) / 20000.0));
        ck_assert_msg(spread < 0.02 * power_spread, "variance %g, by power %g", spread, power_spread);
    }
    fixture_destroy(&f);
}
END_TEST

/* Lamps in one place, on a line, and at distances that grow without limit; depth stays small. */
START_TEST(test_degenerate)
{
    LightFixture f;
    fixture_init(&f);
    for (int i = 0; i < 2000; ++i) {
        float x = _i == 0 ? 0.5f : _i == 1 ? (float)i : ldexpf(1.0f, i % 100 - 60) * (1.0f + (float)(i / 100));
        fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}, .detail.position = {x, 0, 0}});
    }
    fixture_finish(&f);
    double sum = 0.0;
    Vec3 p = vec3(0.5f, 0.0f, _i == 2 ? 1.0f : 0.0f);
    for (uint i = 0; i < 2000u; ++i)
        sum += (double)light_choice_pdf(&f.view, i, p, vec3(0, 0, 1));
    ck_assert_double_lt(fabs(sum - 1.0), 1e-3);
    const LightNode *nodes = f.scene.light_nodes.data;
    uint deepest = 0;
    for (uint leaf = 0; leaf < 2000u; ++leaf) {
        uint node = 0, first = 0, count = 2000, depth = 0;
        for (; count > 1; ++depth) {
            uint lower = nodes[node].left & LIGHTS_MAX;
            bool below = leaf - first < lower;
            node += below ? 1 : lower;
            first += below ? 0 : lower;
            count = below ? lower : count - lower;
        }
        ck_assert_uint_eq(light_leaf(f.view.lights + f.view.light_leaves[first]), leaf);
        deepest = depth > deepest ? depth : deepest;
    }
    ck_assert_uint_le(deepest, 52);
    fixture_destroy(&f);
}
END_TEST

/* The bounded share of lamps, at a lamp and far from all. */
START_TEST(test_far_share)
{
    LightFixture f;
    fixture_init(&f);
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}});
    fixture_add_light(&f, (LightData){.kind = LIGHT_INFINITE, .emission = {1.0f, 1.0f, 1.0f}});
    fixture_finish(&f);
    static const float distances[3] = {0.01f, 0.4f, 100.0f};
    const double near = 1.0 / 0.16, expected[3] = {0.875, near / (near + M_PI), 0.5};
    for (int i = 0; i < 3; ++i)
        ck_assert_double_lt(
            fabs((double)light_choice_pdf(&f.view, 0, vec3(0, 0, distances[i]), vec3(0, 0, 1)) - expected[i]), 1e-5);
    fixture_destroy(&f);
}
END_TEST

/* Bounds of two lights together contain what each sends, even where one has narrower emission, or both other normals. A
 * third light far away makes them a node of their own. */
START_TEST(test_joined)
{
    static const float flat[9] = {0.1f, 0, 0, 0.2f, 0, 0, 0.1f, 0.1f, 0},
                       tilted[9] = {0, 0, 0, 0, 0.1f, 0, 0.05f, 0, 0.1f};
    LightFixture f;
    fixture_init(&f);
    const LightData spot = {.kind = LIGHT_SPOT,
                            .emission = {1, 1, 1},
                            .detail.direction = {0, 0, 1},
                            .detail.cos_total = 0.99f,
                            .detail.cos_falloff = 0.995f};
    if (_i == 0)
        fixture_add_light(&f, spot);
    else if (_i == 1)
        fixture_add_polygon(&f, tilted, 3, NULL, 0, 0);
    fixture_add_polygon(&f, flat, 3, NULL, 0, 0);
    if (_i == 2) /* in the other order */
        fixture_add_light(&f, spot);
    fixture_add_light(
        &f,
        (LightData){
            .kind = LIGHT_SPOT,
            .emission = {1, 1, 1},
            .detail = {.position = {-100, 0, 0}, .direction = {-1, 0, 0}, .cos_total = -0.999f, .cos_falloff = 0.95f}});
    fixture_finish(&f);
    ck_assert_uint_eq(f.scene.light_nodes.count, 2);
    unsigned state = 29, lit = 0;
    for (int i = 0; i < 20000; ++i) {
        Vec3 p = vec3_scale(fixture_random_unit(&state), 3.0f);
        for (uint light = 0; light < 2u; ++light) {
            LightSample sample = {0};
            if (!light_sample(&f.view, light, p, vec2(0.3f, 0.3f), &sample))
                continue;
            ++lit;
            ck_assert((light_choice_pdf(&f.view, light, p, vec3_normalize(p)) > 0.0f));
        }
    }
    ck_assert_uint_gt(lit, 9000);
    fixture_destroy(&f);
}
END_TEST

/* The triangles of a square need no tree: only their areas matter. A lamp beside them does. */
START_TEST(test_square)
{
    static const float lower[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, upper[9] = {1, 0, 0, 1, 1, 0, 0, 1, 0};
    LightFixture f;
    fixture_init(&f);
    fixture_add_polygon(&f, lower, 3, NULL, 0, 0);
    fixture_add_polygon(&f, upper, 3, NULL, 0, 0);
    fixture_finish(&f);
    ck_assert_uint_eq(f.scene.features & FEATURE_LIGHT_TREE, 0);
    ck_assert_uint_ne(ARRAY_AT(&f.scene.light_nodes, LightNode, 0).left & LIGHT_NODE_EVEN, 0);
    ck_assert((light_choice_pdf(&f.view, 1, vec3(0.9f, 0.9f, 0.1f), vec3(0, 0, 1)) == 0.5f));
    fixture_add_light(&f, (LightData){.kind = LIGHT_POINT, .emission = {1, 1, 1}, .detail.position = {0, 0, 1}});
    fixture_finish(&f);
    ck_assert_uint_ne(f.scene.features & FEATURE_LIGHT_TREE, 0);
    fixture_destroy(&f);
}
END_TEST

START_TEST(test_direction_pack)
{
    unsigned state = 17;
    for (int i = 0; i < 100000; ++i) {
        Vec3 d = fixture_random_unit(&state), back = direction_unpack(direction_pack(d));
        ck_assert((vec3_length(vec3_sub(d, back)) < 0.02f));
    }
    const Vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < 6; ++i)
        ck_assert((vec3_length(vec3_sub(axes[i], direction_unpack(direction_pack(axes[i])))) < 1e-6f));
}
END_TEST

TCase *light_tree_case(void)
{
    TCase *tcase = tcase_create("tree");
    tcase_add_loop_test(tcase, test_probabilities, 0, 12);
    tcase_add_test(tcase, test_nothing_lost);
    tcase_add_test(tcase, test_many);
    tcase_add_loop_test(tcase, test_degenerate, 0, 3);
    tcase_add_test(tcase, test_far_share);
    tcase_add_loop_test(tcase, test_joined, 0, 3);
    tcase_add_test(tcase, test_square);
    tcase_add_test(tcase, test_direction_pack);
    return tcase;
}
