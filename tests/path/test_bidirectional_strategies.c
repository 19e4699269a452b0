/* Every strategy alone and unweighted against path tracing of the same path length (Veach 1997, section 10.2: each is
 * an unbiased estimator of the paths it can make), and all strategies together, or IBPT's three, weighted, against path
 * tracing. */
#include "support/bidirectional.h"

/* ---- one strategy ------------------------------------------------------------------------------------------------ */

static void strategy_check(const BidirectionalScene *scene, unsigned s, unsigned t, const PictureGroups *expected)
{
    char name[96];
    PictureGroups got;
    GroupSetup setup = {.groups = expected->groups,
                        .render = {.text = bidirectional_text(scene),
                                   .width = 8,
                                   .height = 8,
                                   .samples = 80,
                                   .max_depth = (int)(s + t) - 1,
                                   .threads = 1,
                                   .seed = 1000 + 100 * s,
                                   .integrator = integrator_bdpt(),
                                   .only_strategy = true,
                                   .strategy = {s, t},
                                   .unweighted = true}};
    snprintf(name, sizeof name, "%s (%u,%u)", scene->name, s, t);
    groups_render(&setup, &got);
    groups_compare(name, &got, expected, 2, false);
    groups_destroy(&got);
}

START_TEST(test_strategies)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    for (int k = 2; (scene->support & SUPPORT_SUM_ONLY) == 0 && k <= scene->strategy_depth; ++k) {
        PictureGroups expected;
        GroupSetup setup = {.groups = 16,
                            .at_depth = true,
                            .render = {.text = bidirectional_text(scene),
                                       .width = 8,
                                       .height = 8,
                                       .samples = 128,
                                       .max_depth = k,
                                       .threads = 1}};
        groups_render(&setup, &expected);
        for (unsigned s = scene->support & SUPPORT_NO_HIT ? 2 : 0; s <= (unsigned)k; ++s)
            if (s != 1 || (scene->support & SUPPORT_NO_DRAW) == 0)
                strategy_check(scene, s, (unsigned)k + 1 - s, &expected);
        groups_destroy(&expected);
    }
}
END_TEST

/* ---- all of them ------------------------------------------------------------------------------------------------- */

START_TEST(test_sum)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    PictureGroups expected;
    GroupSetup setup = {
        .groups = 16,
        .render = {.text = bidirectional_text(scene), .samples = 24, .max_depth = scene->depth, .threads = 1}};
    groups_render(&setup, &expected);
    for (unsigned i = 0; i < 4; ++i) {
        PictureGroups got;
        char name[96];
        bool three = i >= 2;
        if (test_effort() == 1 && i % 2 != (unsigned)_i % 2)
            continue; /* the other heuristic only in make check-long */
        setup.render.integrator = three ? integrator_ibpt() : integrator_bdpt();
        setup.render.samples = three ? 16 : 8;
        setup.render.balance = i % 2 == 1;
        setup.render.seed = 1000u + 100u * i;
        groups_render(&setup, &got);
        snprintf(name, sizeof name, "%s, %s %s", scene->name, setup.render.integrator->name,
                 setup.render.balance ? "balance" : "power");
        groups_compare(name, &got, &expected, 4, true);
        groups_destroy(&got);
    }
    groups_destroy(&expected);
}
END_TEST

/* Runs `test` for every scene. */
static TCase *scenes_case(const char *name, const TTest *test)
{
    TCase *tcase = tcase_create(name);
    tcase_set_timeout(tcase, 3000);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test, 0, BIDIRECTIONAL_SCENE_COUNT);
    return tcase;
}

TCase *bidirectional_strategies_case(void)
{
    return scenes_case("strategies", test_strategies);
}

TCase *bidirectional_sums_case(void)
{
    return scenes_case("sums", test_sum);
}
