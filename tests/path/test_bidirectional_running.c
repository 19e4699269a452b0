/* IBPT, which keeps running products for its three strategies, against BDPT restricted to the same three, which stores
 * all densities: the same random numbers make the same paths, so images differ by rounding alone. */
#include "support/bidirectional.h"

#include "backend/step_recorder.h"

static void picture(const BidirectionalScene *scene, const Integrator *integrator, bool balance, RenderedImage *image)
{
    RenderSetup setup = {.text = bidirectional_text(scene),
                         .samples = 24,
                         .max_depth = 7,
                         .seed = 5,
                         .integrator = integrator,
                         .balance = balance};
    fixture_render(&setup, image);
}

/* Individual paths may diverge where rounding decides a hit, so a few pixels in a thousand may differ by more. */
START_TEST(test_running_products)
{
    RenderedImage a, b;
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i / 2];
    if (test_effort() == 1 && _i % 2 != _i / 2 % 2)
        return; /* the other heuristic only in make check-long */
    Integrator stored = *integrator_bdpt();
    stored.strategies = STRATEGIES_IBPT;
    stored.roulette_scale = integrator_ibpt()->roulette_scale;
    picture(scene, integrator_ibpt(), _i % 2 == 1, &a);
    picture(scene, &stored, _i % 2 == 1, &b);
    int pixels = a.width * a.height, different = 0;
    double mean = fixture_mean(&b);
    ck_assert(mean > 0.01);
    for (int i = 0; i < 3 * pixels; ++i)
        different += !(fabs((double)a.rgb[i] - (double)b.rgb[i]) <= 1e-4 * ((double)b.rgb[i] + mean));
    ck_assert_msg(different * 500 <= 3 * pixels, "%s: %d of %d values differ", scene->name, different, 3 * pixels);
    ck_assert_double_eq_tol(fixture_mean(&a) / mean, 1.0, 1e-5);
    fixture_destroy(&a);
    fixture_destroy(&b);
}
END_TEST

/* The size of a path's state does not depend on its maximum length. */
START_TEST(test_state_independent_of_depth)
{
    FrameParams frame = {.path.max_depth = 2};
    StepList list;
    Error error = {0};
    uint words[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
        frame.path.max_depth = i == 0 ? 2 : 60;
        ck_assert(integrator_ibpt()->list(&frame, &list, &error));
        for (int id = 0; id < BUFFER_COUNT; ++id)
            words[i] += list.words_per_item[id];
        step_list_destroy(&list);
    }
    ck_assert_uint_eq(words[0], words[1]);
    ck_assert_uint_lt(words[0], 104);
}
END_TEST

TCase *bidirectional_running_case(void)
{
    TCase *tcase = tcase_create("running products");
    tcase_set_timeout(tcase, 600);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test_running_products, 0, 2 * BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_test(tcase, test_state_independent_of_depth);
    return tcase;
}
