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

int main(void)
{
    Suite *suite = suite_create("mmlt");
    TCase *tcase = tcase_create("unbiased");
    tcase_set_timeout(tcase, 3000);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test_unbiased, 0, BIDIRECTIONAL_SCENE_COUNT);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
