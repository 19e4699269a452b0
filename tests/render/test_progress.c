/* What callbacks are told of a rendering under way: the time that is left, with the pass or generation under way, and
 * whether that is the last. */
#include "support/render_fixture.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "base/timing.h"
#include "render/run.h"

/* ---- the time that is left --------------------------------------------------------------------------------------- */

typedef struct LeftCase {
    double elapsed; /* seconds */
    double limit, fraction; /* of time; of samples; 0: none */
    double pass; /* seconds that the pass under way is expected to take; 0: not known */
    bool pass_last;
    double left;
    bool finishing;
} LeftCase;

static const LeftCase CASES[] = {
    {1000.0, 4000.0, 0.0, 0.0, false, 3000.0, false}, /* of the limit of time */
    {1000.0, 0.0, 0.25, 0.0, false, 3000.0, false}, /* by the speed so far */
    {1000.0, 4000.0, 0.5, 0.0, false, 1000.0, false}, /* whichever ends first */
    {1000.0, 4000.0, 0.0, 500.0, false, 3000.0, false}, /* others follow the pass */
    {3000.0, 4000.0, 0.0, 2000.0, false, 2000.0, true}, /* it will exceed the limit of time */
    {3000.0, 4000.0, 0.0, 950.0, false, 1000.0, true}, /* it nearly reaches it */
    {5000.0, 4000.0, 0.0, 2000.0, false, 2000.0, true}, /* the limit is exceeded */
    {5000.0, 4000.0, 0.0, 0.0, false, 0.0, true},
    {1000.0, 0.0, 0.5, 200.0, true, 1000.0, true}, /* known to be the last */
    {1000.0, 0.0, 0.0, 0.0, false, -1.0, false}, /* nothing is known */
    {1000.0, 0.0, 0.0, 300.0, false, 300.0, false}, /* but of the pass */
};

static void nothing_done(Backend *backend, BackendStatistics *statistics)
{
    (void)backend;
    *statistics = (BackendStatistics){0};
}

static void progress_copy(void *context, const RenderProgress *progress)
{
    *(RenderProgress *)context = *progress;
}

START_TEST(test_left)
{
    const LeftCase *of = &CASES[_i];
    const double slack = 60.0; /* of clocks */
    const BackendInterface interface = {.statistics = nothing_done};
    const RenderOptions options = {.seconds = of->limit};
    RenderProgress told = {0};
    const RenderCallbacks callbacks = {.progress = progress_copy, .context = &told};
    RenderRun run = {.interface = &interface, .options = &options, .callbacks = &callbacks};
    run.start = timing_now() - of->elapsed;
    run.pass_last = of->pass_last;
    render_run_report(&run, of->fraction);
    render_run_expect(&run, of->pass);
    render_run_tell(&run);
    ck_assert_double_eq_tol(told.left, of->left, of->left > 0.0 ? slack : 1e-9);
    ck_assert_int_eq(told.finishing, of->finishing);
}
END_TEST

/* ---- renderings -------------------------------------------------------------------------------------------------- */

#define TOLD_MAX 1000

typedef struct Told {
    RenderProgress all[TOLD_MAX];
    size_t count;
} Told;

static void told_add(void *context, const RenderProgress *progress)
{
    Told *told = context;
    ck_assert_uint_lt(told->count, TOLD_MAX);
    told->all[told->count++] = *progress;
}

static void rendering_watch(const Integrator *integrator, const char *name, unsigned samples, Told *told)
{
    char path[512];
    Scene scene;
    Film film;
    RenderResult result;
    Error error = {0};
    snprintf(path, sizeof path, "%s/scenes/%s.pbrt", test_source_folder(), name);
    const RenderSetup setup = {.path = path, .width = 32, .height = 24, .threads = 2};
    fixture_scene(&setup, &scene);
    Backend *backend = fixture_open(&setup, &scene, &error);
    ck_assert_msg(backend != NULL, "%s", error.message);
    const SceneSettings *settings = &scene.settings;
    ck_assert(film_init(&film, settings->width, settings->height, settings->crop, &error));
    const RenderOptions options = {
        .samples = samples, .max_depth = settings->max_depth, .reconstruction = RECONSTRUCTION_SPLAT};
    const RenderCallbacks callbacks = {.progress = told_add, .context = told};
    const RenderTask task = {.integrator = integrator,
                             .scene = &scene,
                             .backend = {backend_cpu(), backend},
                             .options = &options,
                             .callbacks = &callbacks};
    ck_assert_msg(render_film(&task, &film, &result, &error), "%s", error.message);
    backend_cpu()->close(backend);
    film_destroy(&film);
    scene_destroy(&scene);
}

/* From the last report before the rendering's end: more is left than nothing, and no pass follows that is under way. */
static void last_check(const Told *told)
{
    const RenderProgress *last = &told->all[told->count - 2];
    ck_assert_uint_ge(told->count, 3);
    ck_assert_double_lt(last->fraction, 1.0);
    ck_assert_double_gt(last->left, 0.0);
    ck_assert(last->finishing);
    ck_assert_double_eq(told->all[told->count - 1].fraction, 1.0);
}

START_TEST(test_passes)
{
    Told told = {.count = 0};
    rendering_watch(integrator_pt(), "cornell", 4000, &told);
    ck_assert(!told.all[0].finishing);
    ck_assert_double_gt(told.all[0].left, 0.0);
    last_check(&told);
}
END_TEST

/* A generation is told of when it begins, and between its estimators: where light is easy, many have only one. */
static const struct {
    const char *scene;
    size_t least; /* reports of a generation before its end */
} GENERATIONS[] = {{"door", 3}, {"cornell", 1}}; /* it begins, its pool ends, its chains end */

START_TEST(test_generations)
{
    Told told = {.count = 0};
    size_t within = 0, ends = 0;
    rendering_watch(integrator_mmlt(), GENERATIONS[_i].scene, 300, &told);
    ck_assert_uint_eq(told.all[0].samples, 0);
    ck_assert_double_lt(told.all[0].left, 0.0);
    ck_assert(!told.all[0].finishing);
    for (size_t i = 1; i < told.count; ++i) {
        bool same = told.all[i].samples == told.all[i - 1].samples;
        within += same ? 1 : 0;
        ends += same ? 0 : 1;
        if (told.all[i].samples > 0 && told.all[i].fraction < 1.0)
            ck_assert_double_gt(told.all[i].left, 0.0);
    }
    ck_assert_uint_gt(ends, 4);
    ck_assert_uint_ge(within, GENERATIONS[_i].least * (ends - 2));
    last_check(&told);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("progress");
    TCase *left = tcase_create("left"), *renderings = tcase_create("renderings");
    tcase_add_loop_test(left, test_left, 0, sizeof CASES / sizeof CASES[0]);
    tcase_set_timeout(renderings, 120);
    tcase_add_test(renderings, test_passes);
    tcase_add_loop_test(renderings, test_generations, 0, 2);
    suite_add_tcase(suite, left);
    suite_add_tcase(suite, renderings);
    return test_run(suite);
}
