/* Sizes of generations, and of their pools and path tracing, without renderings. */
#include "support/test_util.h"

#include "mmlt/paths_estimator.h"
#include "mmlt/plan.h"
#include "mmlt/tuning.h"

#define PIXELS 16384u
#define GENERATIONS_MOST 1000u

/* Pixels that are sampled, most chains at a time, and samples of the pool or 0. */
static const struct {
    unsigned samples, chains, pool;
} PLANS[] = {
    {1, CHAINS_DEFAULT, 0}, {16, CHAINS_DEFAULT, 0}, {1000, CHAINS_DEFAULT, 0}, {1000, 512, 0}, {16, 64, 5000}};

static uint64_t work_of(const Plan *plan)
{
    const double samples[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = (double)plan->chains * plan->options->steps,
                                             [ESTIMATOR_POOL] = plan_pool_samples(plan, plan->chains),
                                             [ESTIMATOR_PATHS] = plan_paths_samples(plan, plan->chains) * PIXELS};
    return (uint64_t)estimators_work(samples);
}

/* The work of generation `index`, whose path tracing is whole samples of every pixel, of which *owed are due; sets
 * *owed to what remains due. */
static uint64_t rounded_work(const Plan *plan, uint index, double *owed)
{
    double wanted = *owed + plan_paths_samples(plan, plan->chains), whole = fmax(rint(wanted), 0.0);
    if (index < PATHS_FORCED && whole < 1.0)
        wanted = whole = 1.0;
    const double samples[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = (double)plan->chains * plan->options->steps,
                                             [ESTIMATOR_POOL] = plan_pool_samples(plan, plan->chains),
                                             [ESTIMATOR_PATHS] = whole * PIXELS};
    *owed = wanted - whole;
    return (uint64_t)estimators_work(samples);
}

/* Generations begin small, come in pairs of one size (the last pair but for what its first generation did too much),
 * are at most as large as chains are allowed and as a fraction of the work so far, and end where --samples says,
 * whatever the clock says. */
START_TEST(test_sizes)
{
    const ChainOptions options = {.chains = PLANS[_i].chains, .steps = STEPS_DEFAULT, .pool = PLANS[_i].pool};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, PIXELS * PLANS[_i].samples);
    ck_assert_uint_le(plan.chains, CHAINS_FIRST);
    uint pair = 0, index = 0;
    double owed = 0.0;
    while (plan.done < plan.total && index < GENERATIONS_MOST) {
        uint64_t work = rounded_work(&plan, index, &owed), left = plan.total - plan.done;
        ck_assert_uint_gt(plan.chains, 0);
        ck_assert_uint_le(plan.chains, options.chains);
        if (index % 2 == 0)
            pair = plan.chains;
        else if (work < left)
            ck_assert_uint_eq(plan.chains, pair);
        else if (PLANS[_i].pool == 0)
            ck_assert_uint_ge(8 * plan.chains + 8, 7 * pair);
        if (index >= 4 && index % 2 == 0 && plan.chains > CHAINS_FIRST)
            ck_assert_double_le((double)work, 1.1 * WHOLE_SAMPLE_PART * (double)plan.done);
        plan_count(&plan, work, owed);
        plan_next(&plan, ++index, 1e9, 1.0); /* a clock by which no generation would grow */
    }
    printf("%u samples: %u generations, the last pair of %u chains, %.3f times the work wanted\n", PLANS[_i].samples,
           index, pair, (double)plan.done / (double)plan.total);
    ck_assert_uint_ge(plan.done, plan.total);
    ck_assert_double_lt((double)plan.done / (double)plan.total, 1.5);
}
END_TEST

/* The end of a rendering of mostly path tracing, of which less than a whole sample is left. */
START_TEST(test_end)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    const unsigned samples = 12 + (unsigned)_i % 6;
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, (uint64_t)samples * PIXELS);
    double owed = 0.0;
    uint index = 0, late = 0;
    while (plan.done < plan.total && index < GENERATIONS_MOST) {
        late += plan.total - plan.done < PIXELS;
        plan_count(&plan, rounded_work(&plan, index, &owed), owed);
        plan.rates.paths = _i < 6 ? 4.0 : 45.0;
        plan_next(&plan, ++index, 1e9, 1.0);
    }
    printf("%u samples: %u generations, %u of them in the last sample, %.3f times the work wanted\n", samples, index,
           late, (double)plan.done / (double)plan.total);
    ck_assert_uint_le(late, 3);
    ck_assert_uint_lt(plan.done, plan.total + PIXELS);
}
END_TEST

/* Where light is easy, pairs of generations that are path tracing alone, of whole samples, have most of the work: up to
 * ALONE_WORK times that of those between them, which go on and grow. In other scenes there are none. */
START_TEST(test_alone)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 1000ull * PIXELS);
    double owed = 0.0, alone = 0.0, pair = 0.0;
    uint index = 0, mixed = 0, largest = 0;
    while (plan.done < plan.total && index < GENERATIONS_MOST) {
        uint64_t work = plan.alone > 0.0 ? (uint64_t)(plan.alone * PIXELS) : rounded_work(&plan, index, &owed);
        ck_assert_uint_eq(plan_chains(&plan), plan.alone > 0.0 ? 0 : plan.chains);
        ck_assert_double_eq(plan.alone, floor(plan.alone));
        if (plan.alone > 0.0) {
            ck_assert_double_eq(plan_paths_samples(&plan, 0), plan.alone);
            ck_assert_double_le((double)work, fmax(GENERATION_PART * (double)plan.done, PIXELS));
            alone += (double)work;
        } else if (index >= 4) {
            ++mixed;
            largest = plan.chains > largest ? plan.chains : largest;
        }
        if (index % 2 == 1)
            ck_assert_double_eq(plan.alone, pair);
        pair = plan.alone;
        plan.rates.paths = index >= 3 ? 20.0 : plan.rates.paths;
        plan.easy = _i == 1 && index >= 3;
        plan_count(&plan, work, owed);
        plan_next(&plan, ++index, 1e9, 1.0);
    }
    double part = alone / (double)plan.done;
    printf("path tracing alone has %.3f of the work; %u other generations of up to %u chains\n", part, mixed, largest);
    ck_assert_uint_lt(plan.done, plan.total + PIXELS);
    ck_assert_double_le(part, _i == 1 ? ALONE_WORK / (1.0 + ALONE_WORK) : 0.0);
    ck_assert_double_ge(part, _i == 1 ? 0.6 : 0.0);
    ck_assert_uint_gt(mixed, 8);
    ck_assert_uint_gt(largest, 2 * CHAINS_FIRST);
}
END_TEST

/* Of path tracing alone as many whole samples as the time allows; if none, the generation has chains. */
START_TEST(test_alone_fit)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    plan_count(&plan, PIXELS, 0.0);
    plan.alone = 5.0;
    ck_assert_double_eq_tol(plan_seconds(&plan, 0.5), 2.5, 1e-9);
    ck_assert(plan_fit(&plan, 0.5, 0.0, 2.6, 10.0));
    ck_assert_double_eq(plan.alone, 5.0);
    ck_assert(plan_fit(&plan, 0.5, 0.0, 1.2, 10.0));
    ck_assert_double_eq(plan.alone, 2.0);
    plan_fit(&plan, 0.5, 0.0, 0.4, 10.0);
    ck_assert_uint_gt(plan_chains(&plan), 0);
}
END_TEST

/* A pair of generations is shortened to end where it is wanted, with chains or, in whole samples, of path tracing
 * alone; it never grows, and is never empty. */
START_TEST(test_shorten)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT, .chains_only = true};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    double work = (double)work_of(&plan);
    plan_count(&plan, (uint64_t)work, 0.0);
    plan_shorten(&plan, 9.0 * work);
    ck_assert_uint_eq(plan.chains, CHAINS_FIRST);
    plan_shorten(&plan, (double)INFINITY);
    ck_assert_uint_eq(plan.chains, CHAINS_FIRST);
    plan_shorten(&plan, 2.0 * work);
    ck_assert_uint_ge(plan.chains, CHAINS_FIRST / 2);
    ck_assert_uint_le(plan.chains, CHAINS_FIRST / 2 + 1);
    plan_next(&plan, 3, 1e9, 1.0); /* the second of the pair */
    ck_assert_uint_le(plan.chains, CHAINS_FIRST / 2 + 1);
    plan_shorten(&plan, 0.5 * work);
    ck_assert_uint_eq(plan.chains, 1);
    plan.alone = 7.0;
    plan_shorten(&plan, (double)plan.done + 9.0 * PIXELS);
    ck_assert_double_eq(plan.alone, 5.0);
    plan_shorten(&plan, 0.0);
    ck_assert_double_eq(plan.alone, 1.0);
}
END_TEST

/* A shortened generation still has a path tracing sample of every pixel, where that is little work. */
START_TEST(test_shorten_whole)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    plan_count(&plan, 100 * PIXELS, 0.0);
    plan.chains = CHAINS_DEFAULT;
    plan_shorten(&plan, 0.0);
    double samples = (double)plan.chains * options.steps * plan.rates.paths / PIXELS;
    ck_assert_double_eq_tol(samples, 1.0, 0.05);
}
END_TEST

/* If rates change so that a chain has ten times the work, a generation has as much as before, or a part of the work so
 * far. */
START_TEST(test_rates)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    for (uint index = 0; index < 6; ++index) {
        plan_count(&plan, work_of(&plan), 0.0);
        plan_next(&plan, index + 1, 1e9, 1.0); /* a clock by which no generation would grow */
    }
    uint64_t before = work_of(&plan), most = (uint64_t)(WHOLE_SAMPLE_PART * (double)plan.done);
    plan_count(&plan, before, 0.0);
    plan_next(&plan, 7, 1e9, 1.0);
    plan.rates.paths *= 20.0;
    plan_count(&plan, before, 0.0);
    plan_next(&plan, 8, 1e9, 1.0);
    uint64_t after = work_of(&plan);
    printf("work of a generation: %llu, then %llu, the part %llu\n", (unsigned long long)before,
           (unsigned long long)after, (unsigned long long)most);
    ck_assert_double_le((double)after, 1.1 * fmax((double)before, WHOLE_SAMPLE_PART * (double)plan.done));
    ck_assert_double_ge((double)after, 0.5 * (double)before);
}
END_TEST

/* With a limit of time alone generations double in pairs while one takes less than a part of the time so far. */
START_TEST(test_clock)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT, .chains_only = true};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    uint chains = plan.chains;
    plan_next(&plan, 1, 0.01, 1.0); /* the second of a pair */
    ck_assert_uint_eq(plan.chains, chains);
    plan_next(&plan, 2, 0.49 * GENERATION_PART, 1.0);
    ck_assert_uint_eq(plan.chains, 2 * chains);
    plan_next(&plan, 4, 0.51 * GENERATION_PART, 1.0);
    ck_assert_uint_eq(plan.chains, 2 * chains);
}
END_TEST

/* A device that few chains leave idle takes hardly longer for more of them, so generations grow whatever the time up to
 * half of its width, then by time. With a limit of work the width does not matter. */
START_TEST(test_width)
{
    static const struct {
        double part; /* seconds of the latest generation / elapsed, in units of GENERATION_PART */
        uint chains; /* in units of CHAINS_FIRST */
    } NEXT[] = {{9.0, 8},   {9.0, 16},  {9.0, 32},   {9.0, 32},
                {0.74, 64}, {0.68, 64}, {0.66, 128}, {0.51, 256}}; /* 4/3, 3/2, 3/2, 5/3 times longer */
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT, .chains_only = true};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, _i == 0 ? 0 : PIXELS * 1000000ull);
    plan.width = 64 * CHAINS_FIRST;
    plan_count(&plan, 1000, 0.0);
    for (uint i = 0; i < sizeof NEXT / sizeof NEXT[0]; ++i) {
        plan_next(&plan, 2 * i + 2, NEXT[i].part * GENERATION_PART, 1.0);
        ck_assert_uint_eq(plan.chains, CHAINS_FIRST * (_i == 0 ? NEXT[i].chains : 1));
    }
}
END_TEST

/* The last generation takes the rest of the time, or is left out if that is little. */
START_TEST(test_last)
{
    const ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = STEPS_DEFAULT, .chains_only = true};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    plan_count(&plan, work_of(&plan), 0.0);
    plan.chains = 10 * CHAINS_FIRST; /* ten times the work of the latest generation */
    ck_assert(plan_fit(&plan, 0.1, 0.0, 1.1, 10.0));
    ck_assert_uint_eq(plan.chains, 10 * CHAINS_FIRST);
    ck_assert(!plan_fit(&plan, 0.1, 0.0, 0.99 * LAST_PART, 10.0));
    ck_assert(plan_fit(&plan, 0.1, 0.0, 0.5, 10.0));
    ck_assert_uint_ge(plan.chains, 5 * CHAINS_FIRST - 1);
    ck_assert_uint_le(plan.chains, 5 * CHAINS_FIRST + 1);
    /* what cannot be made shorter may end late by a little */
    ck_assert(plan_fit(&plan, 0.1, 0.8, 0.5, 10.0));
    ck_assert(!plan_fit(&plan, 0.1, 1.2, 0.5, 10.0));
}
END_TEST

/* Pools have whole samples of all pixels if they have one at least; --mlt=pool is their size. */
START_TEST(test_pools)
{
    ChainOptions options = {.chains = CHAINS_DEFAULT, .steps = 12};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(false), PIXELS, 0);
    plan.rates.pool = 1.0 / 12.0;
    ck_assert_uint_eq(plan_pool_samples(&plan, PIXELS / 4), PIXELS / 4);
    ck_assert_uint_eq(plan_pool_samples(&plan, PIXELS + PIXELS / 4), PIXELS);
    ck_assert_uint_eq(plan_pool_samples(&plan, 3 * PIXELS - PIXELS / 4), 3 * PIXELS);
    plan.rates.paths = 0.5;
    ck_assert_double_eq_tol(plan_paths_samples(&plan, PIXELS), 6.0, 1e-9);
    options.pool = 777;
    ck_assert_uint_eq(plan_pool_samples(&plan, 3 * PIXELS), 777);
}
END_TEST

/* The published scheme has all of its chains from the start to the end, and one pool. */
START_TEST(test_published)
{
    const ChainOptions options = {
        .chains = PAPER_CHAINS_DEFAULT, .steps = STEPS_DEFAULT, .pool = 8, .chains_only = true};
    Plan plan;
    plan_init(&plan, &options, mmlt_scheme(true), PIXELS, PIXELS * 1000);
    for (uint index = 1; index < 8; ++index) {
        ck_assert_uint_eq(plan.chains, PAPER_CHAINS_DEFAULT);
        plan_count(&plan, 1000, 0.0);
        plan_next(&plan, index, 0.0, 1.0);
    }
}
END_TEST

/* The first generations of both replicas have a sample of every pixel each, though a tenth is wanted; those that follow
 * have as many as are wanted, to half a sample, and make up for none of these. Numbers of samples are one sequence or
 * two. */
START_TEST(test_paths)
{
    const RenderOptions options = {.first_sample = 7};
    RenderRun run = {.options = &options, .crop_pixels = 10};
    Film film = {.reconstruction = RECONSTRUCTION_SPLAT};
    PathsEstimator paths = {
        .own = {.film = &film}, .sequences = (uint)_i, .combined = true, .forced_end = 4, .forced_each = 1};
    const double more[12] = {0.1, 0.1, 0.1, 0.1, 0.6, 0.6, 0.3, 0.3, 0.9, 2.2, 0.0, 0.4};
    uint next[2] = {7u, 7u + 0x40000000u};
    double wanted = 4.0;
    uint64_t all = 0;
    for (uint g = 0; g < 12; ++g) {
        const Generation generation = {.run = &run, .index = g};
        paths_estimator_plan(&paths, &generation, more[g]);
        ck_assert_uint_eq(paths.own.samples, 10 * paths.fresh);
        all += paths.fresh;
        wanted += g < 4 ? 0.0 : more[g];
        if (g < 4)
            ck_assert_uint_eq(paths.fresh, 1);
        else
            ck_assert_double_le(fabs(wanted - (double)all), 0.5 + 1e-9);
        ck_assert_uint_eq(paths_estimator_number(&paths, &generation), next[_i == 2 ? g % 2 : 0]);
        next[_i == 2 ? g % 2 : 0] += (uint)paths.fresh;
        paths_estimator_count(&paths, &generation);
    }
    ck_assert_uint_eq(paths.done, all);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("plan");
    TCase *tcase = tcase_create("plan");
    tcase_add_test(tcase, test_last);
    tcase_add_loop_test(tcase, test_sizes, 0, sizeof PLANS / sizeof PLANS[0]);
    tcase_add_test(tcase, test_rates);
    tcase_add_test(tcase, test_shorten);
    tcase_add_test(tcase, test_shorten_whole);
    tcase_add_loop_test(tcase, test_end, 0, 12);
    tcase_add_loop_test(tcase, test_alone, 0, 2);
    tcase_add_test(tcase, test_alone_fit);
    tcase_add_test(tcase, test_clock);
    tcase_add_loop_test(tcase, test_width, 0, 2);
    tcase_add_test(tcase, test_pools);
    tcase_add_test(tcase, test_published);
    tcase_add_loop_test(tcase, test_paths, 1, 3);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
