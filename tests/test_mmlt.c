/* Metropolis light transport against bidirectional path tracing, from the first step on: chains that begin in proportion
 * to what they carry are unbiased however few steps they make. */
#include "bidirectional.h"

static const unsigned STEPS[] = {1, 4, 16, 64};
#define STEPS_COUNT (int)(sizeof STEPS / sizeof STEPS[0])

START_TEST(test_unbiased)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    PictureGroups expected;
    GroupSetup setup = {.groups = 16,
                        .render = {.text = bidirectional_text(scene),
                                   .samples = 16,
                                   .max_depth = scene->depth,
                                   .threads = 1,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    for (int i = 0; i < STEPS_COUNT; ++i) {
        if (test_effort() == 1 && i % 2 != _i % 2)
            continue; /* make check-long does them all */
        PictureGroups got;
        char name[96];
        setup.render.samples = STEPS[i] < 4 ? 8 : 32;
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

/* Many generations, so that shares and plans follow what earlier ones have shown: still right on average. */
START_TEST(test_blended)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    PictureGroups expected, got;
    if (test_effort() == 1 && _i % 3 != 0)
        return; /* make check-long does them all */
    GroupSetup setup = {.groups = 16,
                        .render = {.text = bidirectional_text(scene),
                                   .samples = 32,
                                   .max_depth = scene->depth,
                                   .threads = 1,
                                   .integrator = integrator_bdpt()}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.samples = 256;
    setup.render.seed = 5000;
    setup.render.chains = (ChainOptions){.chains = 64, .steps = 16};
    groups_render(&setup, &got);
    groups_compare(scene->name, &got, &expected, 4, false);
    groups_destroy(&got);
    groups_destroy(&expected);
}
END_TEST

/* ---- long tests -------------------------------------------------------------------------------------------------- */

/* The mean square error against what path tracing sees falls as one over the work: nothing is left over. */
START_TEST(test_slope)
{
    enum { BUDGETS = 3 };
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    const double work[BUDGETS] = {30.0, 300.0, 3000.0};
    double error[BUDGETS];
    PictureGroups expected;
    if (test_effort() == 1)
        return;
    GroupSetup setup = {
        .groups = 16,
        .render = {.text = bidirectional_text(scene), .samples = 6000, .max_depth = scene->depth, .threads = 2}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    for (int i = 0; i < BUDGETS; ++i) {
        PictureGroups got;
        setup.render.samples = (unsigned)work[i];
        setup.render.seed = 100u * (unsigned)(i + 1);
        groups_render(&setup, &got);
        error[i] = groups_square_error(&got, &expected);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
    double slope = log10(error[BUDGETS - 1] / error[0]) / log10(work[BUDGETS - 1] / work[0]);
    printf("%s: square error %.3g %.3g %.3g, slope %.3f\n", scene->name, error[0], error[1], error[2], slope);
    ck_assert_double_eq_tol(slope, -1.0, 0.1);
}
END_TEST

/* Five seconds' work on 64 x 64 pixels: the mean of every seed is that of bidirectional path tracing to 1 %. */
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
    setup.render.samples = 1200;
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

int main(void)
{
    Suite *suite = suite_create("mmlt");
    TCase *tcase = tcase_create("unbiased");
    tcase_set_timeout(tcase, 3000);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test_unbiased, 0, BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_loop_test(tcase, test_blended, 0, BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_loop_test(tcase, test_slope, 0, 3);
    tcase_add_loop_test(tcase, test_brightness, 0, 8);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
