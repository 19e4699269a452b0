/* Metropolis light transport against bidirectional path tracing, from the first step: chains that start in proportion
 * to their contribution have the right mean, however few steps they make. Combined images are consistent. */
#include "support/bidirectional.h"
#include "support/room_scene.h"

#include "backend/group.h"
#include "backend_cpu.h"
#include "mmlt/combination.h"

static const unsigned STEPS[] = {1, 4, 16, 64};
#define STEPS_COUNT (int)(sizeof STEPS / sizeof STEPS[0])

static GroupSetup bdpt_setup(const BidirectionalScene *scene, unsigned samples)
{
    return (GroupSetup){.groups = 16,
                        .render = {.text = bidirectional_text(scene),
                                   .samples = samples,
                                   .max_depth = scene->depth,
                                   .threads = 1,
                                   .integrator = integrator_bdpt()}};
}

/* Renders the scene by bidirectional path tracing; returns the setup that renders the same by chains. */
static GroupSetup expected_render(const BidirectionalScene *scene, unsigned samples, PictureGroups *expected)
{
    GroupSetup setup = bdpt_setup(scene, samples);
    groups_render(&setup, expected);
    setup.render.integrator = integrator_mmlt();
    return setup;
}

START_TEST(test_unbiased)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    PictureGroups expected;
    if (test_effort() == 1 && _i % 2 != 0)
        return; /* only in make check-long, as the other numbers of steps */
    GroupSetup setup = expected_render(scene, 16, &expected);
    for (int i = 0; i < STEPS_COUNT; ++i) {
        if (test_effort() == 1 && i != _i / 2 % STEPS_COUNT)
            continue;
        PictureGroups got;
        char name[96];
        setup.groups = 64; /* of few, most see nothing in dark blocks, which is too skewed for Student's test */
        setup.render.samples = STEPS[i] < 4 ? 8 : 16;
        setup.render.seed = 1000u * (unsigned)(i + 1);
        setup.render.chains =
            (ChainOptions){.chains = setup.render.samples * 256 / STEPS[i] / 2, .steps = STEPS[i], .pool = 2048};
        groups_render(&setup, &got);
        snprintf(name, sizeof name, "%s, %u steps", scene->name, STEPS[i]);
        groups_compare(name, &got, &expected, 4, false);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

/* Many generations, so that weights and plans depend on what earlier ones have shown: no visible bias. */
START_TEST(test_combined)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    PictureGroups expected, got;
    if (test_effort() == 1 && _i % 3 != 0)
        return; /* only in make check-long */
    GroupSetup setup = expected_render(scene, 16, &expected);
    setup.render.samples = 64;
    setup.render.seed = 5000;
    setup.render.chains = (ChainOptions){.chains = 64, .steps = 16};
    groups_render(&setup, &got);
    groups_compare(scene->name, &got, &expected, 4, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* Each estimator alone plus what it leaves to chains is the whole image. */
START_TEST(test_estimators)
{
    const int estimator = _i % ESTIMATOR_COUNT;
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i / ESTIMATOR_COUNT];
    PictureGroups expected, got;
    char name[96];
    const int turn = _i / ESTIMATOR_COUNT % 6;
    if (test_effort() == 1 && !(estimator == ESTIMATOR_PATHS && turn % 3 == 1) &&
        !(estimator == ESTIMATOR_BIDIRECTIONAL && turn == 2))
        return; /* only in make check-long */
    GroupSetup setup = expected_render(scene, 16, &expected);
    setup.render.samples = 64;
    setup.render.seed = 7000;
    setup.render.chains = (ChainOptions){.chains = 64, .steps = 16, .shown = 1 + estimator};
    groups_render(&setup, &got);
    snprintf(name, sizeof name, "%s, estimator %d", scene->name, estimator);
    groups_compare(name, &got, &expected, 4, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* The layer of each depth against bidirectional path tracing of paths of that depth, alternately combined and by chains
 * alone. */
START_TEST(test_depths)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    if (test_effort() == 1 && _i % 6 != 2)
        return; /* only in make check-long */
    for (int depth = 3; depth <= scene->depth; ++depth) {
        PictureGroups expected, got;
        char name[96];
        GroupSetup setup = bdpt_setup(scene, 16);
        setup.at_depth = true;
        setup.render.max_depth = depth;
        groups_render(&setup, &expected);
        setup.at_depth = false;
        setup.layer_depth = (unsigned)depth;
        setup.render.max_depth = scene->depth;
        setup.render.samples = 64;
        setup.render.seed = 9000;
        setup.render.integrator = integrator_mmlt();
        setup.render.chains = (ChainOptions){.chains = 64, .steps = 16, .chains_only = depth % 2 == 0};
        groups_render(&setup, &got);
        snprintf(name, sizeof name, "%s, %d segments", scene->name, depth);
        groups_compare(name, &got, &expected, 4, false);
        groups_destroy(&got);
        groups_destroy(&expected);
    }
}
END_TEST

/* ---- modes ------------------------------------------------------------------------------------------------------- */

/* A glass ball shows two isolated caustics on the floor, each of a small lamp through a small ball. */
#define TWO_CAUSTICS_HALF(x)                                                                                           \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 64 64 64 ] Translate " x "2.2 1.7 0\n"                     \
    "Shape \"sphere\" \"float radius\" 0.2 AttributeEnd\n"                                                             \
    "AttributeBegin Material \"dielectric\" Translate " x "1.2 0.7 0 Shape \"sphere\" \"float radius\" 0.3 "           \
    "AttributeEnd\n"
static const char TWO_CAUSTICS[] =
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 PixelFilter \"box\"\n"
    "LookAt 0 9 0  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" 18\n"
    "WorldBegin\n" TWO_CAUSTICS_HALF("-") TWO_CAUSTICS_HALF("") BD_GREY
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 0 -4  4 0 -4  -4 0 4  4 0 4 ]\n"
    "Material \"dielectric\" Translate 0 3.2 0 Shape \"sphere\"\n";

/* Mean of the pixels around one caustic. */
static double caustic_mean(const PictureGroups *picture, int group, int x0)
{
    double sum = 0.0;
    for (int y = 12; y < 21; ++y)
        for (int x = x0; x < x0 + 6; ++x)
            sum += picture->values[(group * 32 + y) * 32 + x] / 54.0;
    return sum;
}

/* The scene is symmetric: with every seed, both caustics get half. 97,000 samples of path tracing show 0.759. */
START_TEST(test_modes)
{
    PictureGroups got;
    GroupSetup setup = {.groups = test_effort() > 1 ? 5 : 1,
                        .render = {.text = TWO_CAUSTICS,
                                   .samples = 4800 / test_effort(),
                                   .max_depth = 8,
                                   .threads = 2,
                                   .seed = 1,
                                   .integrator = integrator_mmlt()}};
    groups_render(&setup, &got);
    for (int seed = 0; seed < got.groups; ++seed) {
        double left = caustic_mean(&got, seed, 3), right = caustic_mean(&got, seed, 23);
        printf("two caustics, seed %d: %.3f and %.3f, %.3f of both\n", seed, left, right, left / (left + right));
        ck_assert_double_eq_tol(left + right, 0.76, 0.2);
        ck_assert_double_eq_tol(left / (left + right), 0.5, 0.1);
    }
    groups_destroy(&got);
}
END_TEST

/* ---- several backends -------------------------------------------------------------------------------------------- */

/* Renders by two backends of one thread each or, if `alone`, by one of two threads. `rgb`: 3 x 256 floats. */
static void picture_render(const RenderSetup *setup, const Scene *scene, bool alone, float *rgb)
{
    Error error = {0};
    Film film;
    RenderResult result;
    const RenderOptions options = {.samples = setup->samples, .max_depth = setup->max_depth, .chains = setup->chains};
    const BackendInterface *interface = alone ? backend_cpu() : backend_group_interface();
    BackendMember members[2];
    for (int i = 0; i < 2; ++i) {
        members[i] = (BackendMember){backend_cpu(), fixture_open(setup, scene, &error)};
        ck_assert_msg(members[i].backend != NULL, "%s", error.message);
    }
    Backend *backend = alone ? members[0].backend : backend_group_create(members, 2, &error);
    ck_assert_msg(backend != NULL, "%s", error.message);
    ck_assert(film_init(&film, scene->settings.width, scene->settings.height, scene->settings.crop, &error));
    const RenderTask task = {
        .integrator = integrator_mmlt(), .scene = scene, .backend = {interface, backend}, .options = &options};
    ck_assert_msg(render_film(&task, &film, &result, &error), "%s", error.message);
    film_resolve(&film, scene->settings.film_scale, rgb);
    film_destroy(&film);
    interface->close(backend);
    if (alone)
        backend_cpu()->close(members[1].backend);
}

/* A continuing chain does not depend on who ran it before or on who runs its neighbours. */
START_TEST(test_shared)
{
    float one[3 * 256], two[3 * 256];
    Scene scene;
    RenderSetup setup = {.text = bidirectional_text(&BIDIRECTIONAL_SCENES[2]),
                         .samples = 200,
                         .max_depth = 6,
                         .threads = 1,
                         .chains = {.chains = 500, .paper = _i == 1}};
    fixture_scene(&setup, &scene);
    picture_render(&setup, &scene, true, one);
    picture_render(&setup, &scene, false, two);
    ck_assert_mem_eq(one, two, sizeof one);
    scene_destroy(&scene);
}
END_TEST

/* Sums over images large enough for threads, with tiles that the image cuts. */
START_TEST(test_threads)
{
    RenderedImage one, three;
    RenderSetup setup = {.text = TWO_CAUSTICS,
                         .width = 262,
                         .height = 252,
                         .samples = 6,
                         .max_depth = 6,
                         .threads = 1,
                         .integrator = integrator_mmlt()};
    fixture_render(&setup, &one);
    setup.threads = 3;
    fixture_render(&setup, &three);
    ck_assert_uint_gt(one.result.chains.steps, 50000);
    ck_assert_mem_eq(one.rgb, three.rgb, 3 * sizeof(float) * 262 * 252);
    fixture_destroy(&one);
    fixture_destroy(&three);
}
END_TEST

/* ---- statistics -------------------------------------------------------------------------------------------------- */

/* With `paper`, passes do not affect chains: runs of rejected proposals are equally long in short and in long
 * passes. */
START_TEST(test_runs)
{
    ChainStatistics counted[2];
    for (int i = 0; i < 2; ++i) {
        RenderedImage image;
        const RenderSetup setup = {.text = TWO_CAUSTICS,
                                   .width = 16,
                                   .height = 16,
                                   .samples = 22,
                                   .max_depth = 6,
                                   .threads = 2,
                                   .integrator = integrator_mmlt(),
                                   .chains = {.chains = 16, .steps = i == 0 ? 4 : 64, .paper = true}};
        fixture_render(&setup, &image);
        counted[i] = image.result.chains;
        fixture_destroy(&image);
    }
    for (int depth = 3; depth <= 6; ++depth)
        printf("longest run of refused proposals at depth %d: %u\n", depth, (unsigned)counted[0].longest_run[depth]);
    ck_assert_uint_eq(counted[0].steps, counted[1].steps); /* 22 samples suffice for 192 steps of each chain */
    ck_assert_mem_eq(counted[0].accepted, counted[1].accepted, sizeof counted[0].accepted);
    ck_assert_mem_eq(counted[0].longest_run, counted[1].longest_run, sizeof counted[0].longest_run);
    uint64_t longest = 0;
    for (int depth = 3; depth <= 6; ++depth)
        longest = counted[0].longest_run[depth] > longest ? counted[0].longest_run[depth] : longest;
    ck_assert_uint_gt(longest, 4); /* spans several passes */
}
END_TEST

/* With small steps alone, groups of chains stay where they started; large steps mix them. */
START_TEST(test_groups)
{
    double r_hat[2];
    for (int i = 0; i < 2; ++i) {
        RenderedImage image;
        const RenderSetup setup = {.text = bidirectional_text(&BIDIRECTIONAL_SCENES[0]),
                                   .samples = 4096,
                                   .max_depth = 4,
                                   .threads = 2,
                                   .integrator = integrator_mmlt(),
                                   .chains = {.chains = 64, .paper = true, .large_step = i == 0 ? 1e-6 : 0.5}};
        fixture_render(&setup, &image);
        r_hat[i] = image.result.chains.r_hat[3];
        fixture_destroy(&image);
    }
    printf("R-hat of paths of 3 segments: %.4f by small steps, %.4f with large ones\n", r_hat[0], r_hat[1]);
    ck_assert_double_eq_tol(r_hat[1], 1.0, 0.01);
    ck_assert_double_gt(r_hat[0] - 1.0, 3.0 * fabs(r_hat[1] - 1.0));
}
END_TEST

/* ---- long tests -------------------------------------------------------------------------------------------------- */

/* Samples of the reference's groups. */
#define SLOPE_REFERENCE 6000

/* The mean square error against a reference by bidirectional path tracing falls as 1 / work, without a floor. For
 * chains alone over two decades; combined, it falls faster as long as weights and the pools' visits are learnt (glass,
 * from 3000 samples to 30,000: slope -1.19; from 10,000 to 100,000 -1.13 before light subpaths were aimed, -0.92
 * since), so that its slope has an upper bound alone. */
START_TEST(test_slope)
{
    enum { BUDGETS = 3 };
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i / 2];
    const bool combined = _i % 2 == 0;
    const double work[BUDGETS] = {combined ? 1e3 : 3e2, combined ? 1e4 : 3e3, combined ? 1e5 : 3e4};
    const int first = combined ? 1 : 0;
    double error[BUDGETS];
    PictureGroups expected;
    if (test_effort() == 1)
        return;
    GroupSetup setup = {.groups = 16,
                        .render = {.text = bidirectional_text(scene),
                                   .samples = SLOPE_REFERENCE / test_effort(),
                                   .max_depth = scene->depth,
                                   .integrator = integrator_bdpt(),
                                   .threads = 2}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.chains = (ChainOptions){.chains = 64, .chains_only = !combined}; /* many generations from the start */
    for (int i = 0; i < BUDGETS; ++i) {
        PictureGroups got;
        setup.render.samples = (unsigned)work[i] / test_effort();
        setup.render.seed = 100u * (unsigned)(i + 1);
        groups_render(&setup, &got);
        error[i] = groups_square_error(&got, &expected);
        groups_destroy(&got);
    }
    double own = groups_mean_variance(&expected);
    groups_destroy(&expected);
    double slope = log10(error[BUDGETS - 1] / error[first]) / log10(work[BUDGETS - 1] / work[first]);
    printf("%s, %s: square error %.3g %.3g %.3g, slope %.3f, variance of the reference %.3g\n", scene->name,
           combined ? "combined" : "chains alone", error[0], error[1], error[2], slope, own);
    fflush(stdout);
    ck_assert_double_lt(own, error[2] / 2.0); /* else its uncertainty is that of the error */
    ck_assert_double_lt(error[1], error[0] / 8.0);
    ck_assert_double_lt(slope, -0.9);
    ck_assert(combined || slope > -1.1);
}
END_TEST

/* About five seconds' work on 64 x 64 pixels: for every seed the mean equals that of bidirectional path tracing to 1
 * %. */
START_TEST(test_brightness)
{
    enum { SEEDS = 5 };
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[3 * _i];
    PictureGroups expected, got;
    if (test_effort() == 1)
        return;
    GroupSetup setup = {.groups = 16,
                        .render = {.text = bidirectional_text(scene),
                                   .width = 64,
                                   .height = 64,
                                   .samples = 64,
                                   .max_depth = scene->depth,
                                   .threads = 2,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.groups = SEEDS;
    setup.render.integrator = integrator_mmlt();
    setup.render.samples = 1200 / test_effort();
    groups_render(&setup, &got);
    for (int seed = 0; seed < SEEDS; ++seed) {
        PictureGroups one = got;
        one.groups = 1;
        one.values = got.values + (size_t)seed * 64 * 64;
        double ratio = groups_mean(&one) / groups_mean(&expected);
        printf("%s: brightness of seed %d: %.4f\n", scene->name, seed, ratio);
        ck_assert_double_eq_tol(ratio, 1.0, 0.01);
    }
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* A lamp in a glass ball: pools rarely hit it by camera subpaths, so that weights, clamping thresholds and visits
 * change most from one generation to the next. */
static const char LAMP_IN_GLASS[] = BD_BEGIN
    "AttributeBegin Translate 0 0.2 0 AreaLightSource \"diffuse\" \"rgb L\" [ 60 60 60 ]\n"
    "Shape \"sphere\" \"float radius\" 0.15 AttributeEnd\n"
    "AttributeBegin Translate 0 0.2 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.5 "
    "AttributeEnd\n" BD_GREY BD_FLOOR "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 3  4 -1 3  -4 4 3  4 4 3 ]\n";

/* The sun, which no ray hits, shines through a window on a mirror that lies on the floor of a room. */
static const char SUN_ON_MIRROR[] =
    ROOM_SCENE "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ] \"float roughness\" 0 " ROOM_WALL(
        "-0.6 0 0.01 1.2 0 0.01 -0.6 1.4 0.01 1.2 1.4 0.01");

static bool hides_light(const char *text)
{
    RenderSetup setup = {.text = text};
    Scene scene;
    fixture_scene(&setup, &scene);
    bool hides = scene_hides_light(&scene);
    scene_destroy(&scene);
    return hides;
}

/* Light is hidden where lights that no ray hits and smooth surfaces are together. */
START_TEST(test_hides)
{
    ck_assert(hides_light(SUN_ON_MIRROR));
    ck_assert(!hides_light(ROOM_SCENE));
    ck_assert(!hides_light(LAMP_IN_GLASS));
}
END_TEST

/* Light that path tracing cannot find is not missed: what it has not shown of rare light is no sign that there is
 * none. */
START_TEST(test_hidden)
{
    enum { SEEDS = 6, SIDE = 32 };
    PictureGroups expected, got;
    double mean[2], error[2];
    GroupSetup setup = {.groups = SEEDS,
                        .render = {.text = SUN_ON_MIRROR,
                                   .width = SIDE,
                                   .height = SIDE,
                                   .samples = 64,
                                   .max_depth = 5,
                                   .threads = 2,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.samples = 128;
    groups_render(&setup, &got);
    groups_block(&expected, 0, 0, SIDE, SIDE, &mean[0], &error[0]);
    groups_block(&got, 0, 0, SIDE, SIDE, &mean[1], &error[1]);
    ck_assert_msg(fabs(mean[1] - mean[0]) < 3.0 * hypot(error[0], error[1]), "%g +- %g by mmlt, %g +- %g by bdpt",
                  mean[1], error[1], mean[0], error[0]);
    ck_assert_msg(hypot(error[0], error[1]) < 0.04 * mean[0], "%g +- %g by mmlt, %g +- %g by bdpt", mean[1], error[1],
                  mean[0], error[0]);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* Because the replicas learn from each other, the image is a ratio of dependent sums: consistent, not unbiased. Means
 * of many short renderings, which have most of the bias, against bidirectional path tracing. A rendering has at least
 * two generations. */
START_TEST(test_bias)
{
    enum { SIZES = 5, REPETITIONS = 80000 };
    static const unsigned SAMPLES[SIZES] = {8, 16, 32, 64, 128}; /* 3, 5, 6, 10, 20 generations of the first scene */
    PictureGroups expected, got;
    double mean, error, expected_mean, expected_error;
    if (test_effort() < 8)
        return;
    GroupSetup setup = {.groups = 256,
                        .render = {.text = _i == 0 ? LAMP_IN_GLASS : bidirectional_text(&BIDIRECTIONAL_SCENES[2]),
                                   .samples = 256 / test_effort(),
                                   .max_depth = 6,
                                   .threads = 1,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    groups_block(&expected, 0, 0, 16, 16, &expected_mean, &expected_error);
    setup.render.seed = 20000;
    setup.render.integrator = integrator_mmlt();
    setup.render.chains = (ChainOptions){.chains = 32, .steps = 16};
    for (int i = 0; i < SIZES; ++i) {
        setup.groups = REPETITIONS / (int)SAMPLES[i];
        setup.render.samples = SAMPLES[i] / test_effort();
        groups_render(&setup, &got);
        groups_block(&got, 0, 0, 16, 16, &mean, &error);
        double ratio = mean / expected_mean, ratio_error = hypot(error / mean, expected_error / expected_mean);
        printf("%s, %u samples, %d pictures: %.5f +- %.5f, of the reference %.5f\n",
               _i == 0 ? "lamp in glass" : "glass", SAMPLES[i], got.groups, ratio, ratio_error,
               expected_error / expected_mean);
        fflush(stdout);
        ck_assert(got.sound && expected.sound);
        ck_assert_double_gt(groups_p_value(&got, &expected, 0, 0, 16, 16), P_LIMIT);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

static TCase *case_make(Suite *suite, const char *name)
{
    TCase *tcase = tcase_create(name);
    tcase_set_timeout(tcase, 3000);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    suite_add_tcase(suite, tcase);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("mmlt");
    TCase *unbiased = case_make(suite, "unbiased");
    tcase_add_loop_test(unbiased, test_unbiased, 0, BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_loop_test(unbiased, test_combined, 0, BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_loop_test(case_make(suite, "estimators"), test_estimators, 0,
                        BIDIRECTIONAL_SCENE_COUNT * ESTIMATOR_COUNT);
    suite_add_tcase(suite, mmlt_shown_case());
    suite_add_tcase(suite, mmlt_easy_case());
    tcase_add_loop_test(case_make(suite, "depths"), test_depths, 0, BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_test(case_make(suite, "modes"), test_modes);
    tcase_add_loop_test(case_make(suite, "shared"), test_shared, 0, 2);
    tcase_add_test(case_make(suite, "threads"), test_threads);
    TCase *counts = case_make(suite, "counts");
    tcase_add_test(counts, test_runs);
    tcase_add_test(counts, test_groups);
    tcase_add_loop_test(case_make(suite, "slope"), test_slope, 0, 6);
    tcase_add_loop_test(case_make(suite, "brightness"), test_brightness, 0, 8);
    TCase *hidden = case_make(suite, "hidden");
    tcase_add_test(hidden, test_hides);
    tcase_add_test(hidden, test_hidden);
    tcase_add_loop_test(case_make(suite, "bias"), test_bias, 0, 2);
    return test_run(suite);
}
