/* Light guides: which lights of a scene become guides; random numbers of 0, 0 sample the direction to the guide at any
 * surface with any orientation, and every pair of numbers remains equally probable. */
#include "math/test_math.h"

#include "light/light_guide.h"
#include "math/rng.h"
#include "support/render_fixture.h"

#include <string.h>

#define HEAD "Film \"rgb\" \"integer xresolution\" [4] \"integer yresolution\" [4] Camera \"perspective\" WorldBegin "
#define LAMP(L) "AreaLightSource \"diffuse\" \"rgb L\" [" L "] Shape \"sphere\" \"float radius\" [0.1] "

static void guides_of(const char *text, Scene *scene)
{
    fixture_scene(&(RenderSetup){.text = text}, scene);
}

/* Light guide i is at `place`, to within 1e-4, with that `near`. */
static void guide_require(const Scene *scene, uint i, Vec3 place, float near)
{
    Vec3 guide = scene->guide.lights[i];
    ck_assert_uint_lt(i, scene->frame.scene.guide_count);
    ck_assert_msg(vec3_length(vec3_sub(guide, place)) < 1e-4f, "guide %u is at (%g, %g, %g)", i, (double)guide.x,
                  (double)guide.y, (double)guide.z);
    ck_assert_float_eq(scene->guide.lights_near[i], near);
}

/* ---- which lights ------------------------------------------------------------------------------------------------ */

START_TEST(test_shapes)
{
    Scene scene;
    /* Two triangles of a mesh, the first with three times the area of the second, become one guide at the mean of their
     * boxes. */
    guides_of(HEAD "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] "
                   "Shape \"trianglemesh\" \"point3 P\" [0 0 0  3 0 0  0 2 0  0 0 4  1 0 4  0 2 4] "
                   "\"integer indices\" [0 1 2 3 4 5] AttributeEnd "
                   "AttributeBegin Translate 5 6 7 " LAMP("100 100 100") "AttributeEnd",
              &scene);
    ck_assert_uint_eq(scene.frame.scene.guide_count, 2);
    guide_require(&scene, 0, vec3(5.0f, 6.0f, 7.0f), 1.0f);
    guide_require(&scene, 1, vec3(0.75f * 1.5f + 0.25f * 0.5f, 1.0f, 1.0f), 1.0f);
    double sphere = 100.0 * 4.0 * M_PI * 0.01, mesh = 4.0;
    ck_assert_double_eq_tol((double)(scene.guide.lights_power[0] / scene.guide.lights_power[1]), sphere / mesh,
                            1e-4 * sphere / mesh);
    scene_destroy(&scene);
}
END_TEST

START_TEST(test_none)
{
    Scene scene;
    guides_of(HEAD "LightSource \"point\" \"point3 from\" [1 2 3] LightSource \"infinite\" \"rgb L\" [1 1 1] "
                   "LightSource \"distant\" Shape \"sphere\"",
              &scene);
    ck_assert_uint_eq(scene.frame.scene.guide_count, 0);
    const Random4 random = {{1, 2, 3, 4}};
    const SceneView view = {.frame = &scene.frame, .guide = &scene.guide};
    Random4 same =
        light_guide_numbers(&view, vec3(0.5f, 0.0f, 0.0f), frame_from_normal(vec3(0.0f, 1.0f, 0.0f)), random);
    ck_assert_mem_eq(&random, &same, sizeof same);
    scene_destroy(&scene);
}
END_TEST

/* If there are more lights than guides, the strongest are taken, in descending order. */
START_TEST(test_strongest)
{
    enum { LIGHTS = 3 * LIGHT_GUIDES_MAX };
    char text[LIGHTS * 160 + sizeof HEAD] = HEAD;
    for (int i = 0; i < LIGHTS; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "AttributeBegin Translate %d 0 0 " LAMP("%d 1 1") "AttributeEnd ", i, 1 + 7 * i % LIGHTS);
    Scene scene;
    guides_of(text, &scene);
    ck_assert_uint_eq(scene.frame.scene.guide_count, LIGHT_GUIDES_MAX);
    for (uint i = 0; i < LIGHT_GUIDES_MAX; ++i)
        for (int k = 0; k < LIGHTS; ++k)
            if (7 * k % LIGHTS == LIGHTS - 1 - (int)i)
                guide_require(&scene, i, vec3((float)k, 0.0f, 0.0f), 1.0f);
    scene_destroy(&scene);
}
END_TEST

/* The sun of scenes/windows.pbrt, which is not the light of a shape; the sky has no position that could be a guide. */
START_TEST(test_sun)
{
    Scene scene;
    char path[4096];
    snprintf(path, sizeof path, "%s/scenes/windows.pbrt", test_source_folder());
    fixture_scene(&(RenderSetup){.path = path}, &scene);
    ck_assert_uint_eq(scene.frame.scene.guide_count, 1);
    ck_assert_float_eq(scene.guide.lights_near[0], 0.0f);
    Vec3 sun = scene.guide.lights[0];
    ck_assert_float_eq_tol(vec3_length(sun), 1.0f, 1e-5f);
    ck_assert_float_eq_tol(sun.y, sinf(23.0f * (float)M_PI / 180.0f), 0.01f); /* 23 degrees high */
    ck_assert_float_lt(sun.x, -0.5f); /* behind the left wall */
    scene_destroy(&scene);
}
END_TEST

/* ---- directions -------------------------------------------------------------------------------------------------- */

/* Two guides with a position and one with a direction. */
static const FrameParams THREE = {.scene.guide_count = 3};
static const Guide THREE_GUIDE = {.lights = {{0.0f, 3.0f, 0.0f}, {10.0f, 3.0f, 0.0f}, {0.0f, 0.0f, 1.0f}},
                                  .lights_near = {1.0f, 1.0f, 0.0f},
                                  .lights_power = {1.0f, 4.0f, 0.01f}};

static Vec3 three_from(Vec3 p)
{
    return light_guide_from(THREE.scene.guide_count, &THREE_GUIDE, p);
}

/* Selects the guide that is strongest at the point, whatever their order. */
START_TEST(test_nearest)
{
    Vec3 d = three_from(vec3(0.0f, 0.0f, 0.0f));
    ck_assert_float_eq(d.y, 3.0f);
    ck_assert_float_eq(d.x, 0.0f);
    d = three_from(vec3(4.0f, 3.0f, 0.0f)); /* 1 / 16 < 4 / 36 */
    ck_assert_float_eq(d.x, 6.0f);
    d = three_from(vec3(0.0f, -40.0f, 0.0f));
    ck_assert_float_eq(d.z, 1.0f);
    d = three_from(vec3(0.0f, 3.0f, 0.0f)); /* at the guide itself: any finite direction */
    ck_assert(vec3_finite(d));
}
END_TEST

START_TEST(test_zero_is_the_light)
{
    const SceneView view = {.frame = &THREE, .guide = &THREE_GUIDE};
    const Random4 zero = {{5, 0, 0, 6}};
    uint64_t state = 3;
    for (int i = 0; i < 100000; ++i) {
        Vec3 p = vec3(20.0f * test_uniform(&state) - 5.0f, 8.0f * test_uniform(&state) - 4.0f, test_uniform(&state));
        Frame shading = frame_from_normal(warp_sphere(vec2(test_uniform(&state), test_uniform(&state))));
        Vec3 to = frame_to_local(shading, vec3_normalize(three_from(p)));
        Random4 random = light_guide_numbers(&view, p, shading, zero);
        ck_assert(random.x[0] == 5 && random.x[3] == 6);
        Vec3 w = warp_cosine_hemisphere(vec2(random_float(random.x[1]), random_float(random.x[2])));
        /* A light behind the surface is mirrored. z is the root of a difference, so its square is compared. */
        double away = hypot((double)(w.x - to.x), (double)(w.y - to.y));
        test_require(away < 1e-5 && fabs((double)(w.z * w.z - to.z * to.z)) < 1e-5, "(%g, %g, %g) for (%g, %g, %g)",
                     (double)w.x, (double)w.y, (double)w.z, (double)to.x, (double)to.y, (double)to.z);
    }
}
END_TEST

/* Numbers are offset modulo 2^32 by amounts that depend on the position alone. */
START_TEST(test_shift)
{
    const SceneView view = {.frame = &THREE, .guide = &THREE_GUIDE};
    const Vec3 p = vec3(1.0f, -1.0f, 0.5f);
    const Frame shading = frame_from_normal(vec3_normalize(vec3(0.3f, 0.9f, -0.2f)));
    const Random4 zero = light_guide_numbers(&view, p, shading, (Random4){{0, 0, 0, 0}});
    for (uint i = 0; i < 10000; ++i) {
        Random4 random = random_four(i, 0, 0, 0, 1, 2), shifted = light_guide_numbers(&view, p, shading, random);
        TEST_TRUE(shifted.x[1] - random.x[1] == zero.x[1] && shifted.x[2] - random.x[2] == zero.x[2]);
    }
}
END_TEST

/* ---- integrators ------------------------------------------------------------------------------------------------- */

/* Chains use light guides unless switched off; other integrators and the paper's scheme do not. */
START_TEST(test_users)
{
    Scene scene;
    FrameParams frame;
    guides_of(HEAD LAMP("1 1 1"), &scene);
    RenderOptions options = {.max_depth = 5};
    const Integrator *const others[] = {integrator_pt(), integrator_ibpt(), integrator_bdpt()};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        render_frame(others[i], &scene, &options, &frame);
        ck_assert_uint_eq(frame.scene.guide_count, 0);
    }
    render_frame(integrator_mmlt(), &scene, &options, &frame);
    ck_assert_uint_eq(frame.scene.guide_count, 1);
    options.chains.unguided = true;
    render_frame(integrator_mmlt(), &scene, &options, &frame);
    ck_assert_uint_eq(frame.scene.guide_count, 0);
    options.chains = (ChainOptions){.paper = true};
    render_frame(integrator_mmlt(), &scene, &options, &frame);
    ck_assert_uint_eq(frame.scene.guide_count, 0);
    scene_destroy(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("light_guide");
    TCase *tcase = tcase_create("light_guide");
    tcase_add_test(tcase, test_shapes);
    tcase_add_test(tcase, test_none);
    tcase_add_test(tcase, test_strongest);
    tcase_add_test(tcase, test_sun);
    tcase_add_test(tcase, test_nearest);
    tcase_add_test(tcase, test_zero_is_the_light);
    tcase_add_test(tcase, test_shift);
    tcase_add_test(tcase, test_users);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
