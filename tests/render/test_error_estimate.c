/* The estimate of an error from two halves, against pictures whose truth is known. */
#include "render/test_error.h"

#include "support/test_util.h"

#include "compare/metrics.h"
#include "render/halves_error.h"

#define BRIGHT 49.0

/* A number with mean 0 and variance 1. */
static double noise(unsigned short state[3])
{
    double sum = -6.0;
    for (int i = 0; i < 12; ++i)
        sum += erand48(state);
    return sum;
}

/* Pictures with a known truth and noise. */
typedef struct NoiseCase {
    double light; /* mean of the truth */
    double contrast; /* of stripes within tiles */
    double noise; /* standard deviation of half 0, relative to the truth ... */
    double additive; /* ... and alike in all pixels */
    double more; /* how many times the work of half 0 half 1 has: its variance is smaller */
    double bright; /* part of the pixels of half 0 that has met a bright path, of BRIGHT times its light */
    bool from_light; /* in light_sums, not as samples of the pixels */
    ErrorGoal goal;
    bool alike; /* samples are counted once for all pixels */
} NoiseCase;

static const NoiseCase CASES[] = {
    {1.0, 0.0, 0.1, 0.0, 1.0, 0.0, false, {.scale = 1.0}, false},
    {1.0, 0.9, 0.1, 0.0, 1.0, 0.0, false, {.scale = 1.0}, false},
    {1.0, 0.9, 0.5, 0.0, 1.0, 0.0, true, {.scale = 1.0}, false},
    {0.05, 0.5, 0.0, 0.5, 1.0, 0.0, false, {.scale = 1.0}, false},
    {20.0, 0.5, 0.0, 0.5, 1.0, 0.0, false, {.scale = 0.01}, false},
    {1.0, 0.5, 0.2, 0.1, 9.0, 0.0, true, {.scale = 1.0}, false},
    {1.0, 0.5, 0.2, 0.1, 3.0, 0.0, false, {.scale = 1.0}, false},
    {1.0, 0.5, 0.2, 0.1, 3.0, 0.0, false, {.scale = 1.0}, true},
    {1.0, 0.5, 0.2, 0.1, 1.0, 0.0, false, {.scale = 1.0, .blocks = true}, false},
    {1.0, 0.5, 0.2, 0.1, 4.0, 0.0, true, {.scale = 1.0, .blocks = true}, false},
    {1.0, 0.5, 0.2, 0.1, 1.0, 0.0, false, {.scale = 1.0, .percentile = 95.0}, false},
    {1.0, 0.5, 0.2, 0.0, 1.0, 0.0, false, {.scale = 1.0, .percentile = 50.0}, false},
    {1.0, 0.2, 0.05, 0.0, 1.0, 0.01, false, {.scale = 1.0}, false},
    {1.0, 0.0, 0.1, 0.0, 1.0, 0.01, true, {.scale = 1.0}, false},
    {1.0, 0.0, 0.1, 0.0, 2.0, 0.01, true, {.scale = 1.0}, false},
};

static double truth_at(const NoiseCase *of, size_t pixel, size_t channel)
{
    double wave = sin(1.3 * (double)(pixel % WIDTH)) * cos(0.9 * (double)(pixel / WIDTH));
    return of->light * (1.0 + of->contrast * wave) * (1.0 - 0.2 * (double)channel);
}

static void picture_make(const NoiseCase *of, long seed, NoisyPicture *made)
{
    const int crop[4] = {0, 0, WIDTH, HEIGHT};
    const uint32_t samples = 4;
    const double counts[2] = {samples, of->more * samples};
    unsigned short state[3] = {(unsigned short)seed, 17, 23}, paths[3] = {(unsigned short)seed, 5, 3};
    bool met[2] = {false, false};
    Error error = {0};
    for (int half = 0; half < 2; ++half) {
        Film *film = &made->halves[half];
        ck_assert(film_init(film, WIDTH, HEIGHT, crop, &error));
        ck_assert(!of->from_light || film_light_reserve(film, &error));
        film->every_count = of->alike ? (uint32_t)counts[half] : 0;
        film->light_samples = of->from_light ? (uint64_t)(counts[half] * WIDTH * HEIGHT) : 0;
    }
    for (size_t value = 0; value < 3u * WIDTH * HEIGHT; ++value) {
        double truth = truth_at(of, value / 3, value % 3), sum = 0.0;
        made->truth[value] = (float)(truth * of->goal.scale);
        for (int half = 0; half < 2; ++half) {
            Film *film = &made->halves[half];
            double deviation = (of->noise * truth + of->additive) / sqrt(counts[half] / counts[0]);
            double more = counts[half] / counts[0]; /* as many times the paths, each of as much less of the mean */
            if (value % 3 == 0)
                met[half] = erand48(paths) < more * of->bright;
            double paths_light = met[half] ? BRIGHT * truth / more : 0.0;
            double total = (truth + paths_light + deviation * noise(state)) * counts[half];
            (of->from_light ? film->light_sums : film->sums)[value] = llrint(ldexp(total, 30));
            film->counts[value / 3] = of->alike ? 0 : (uint32_t)counts[half];
            sum += total;
        }
        made->picture[value] = (float)(sum / (counts[0] + counts[1]) * of->goal.scale);
    }
}

static void picture_destroy(NoisyPicture *made)
{
    for (int half = 0; half < 2; ++half)
        film_destroy(&made->halves[half]);
}

static int squares_compare(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

double error_true(const NoisyPicture *made, const ErrorGoal *goal)
{
    static double squares[WIDTH * HEIGHT];
    Metrics metrics;
    Error error = {0};
    ck_assert(metrics_compute(made->picture, made->truth, WIDTH, HEIGHT, 1, &metrics, &error));
    if (!(goal->percentile > 0.0))
        return sqrt(goal->blocks ? metrics.rel_mse_8x8 : metrics.rel_mse_trimmed);
    for (size_t pixel = 0; pixel < WIDTH * HEIGHT; ++pixel) {
        squares[pixel] = 0.0;
        for (size_t value = 3 * pixel; value < 3 * pixel + 3; ++value) {
            double distance = (double)made->picture[value] - (double)made->truth[value];
            squares[pixel] += metrics_relative_square(distance * distance, (double)made->truth[value]) / 3.0;
        }
    }
    qsort(squares, WIDTH * HEIGHT, sizeof squares[0], squares_compare);
    return sqrt(squares[(size_t)(0.01 * goal->percentile * WIDTH * HEIGHT)]);
}

#define PICTURES 60

/* The mean of the estimates is the error itself, to a few percent, more where noise hides what the pixels' own values
 * are; estimates scatter as their standard errors say, or less. */
START_TEST(test_estimate)
{
    static NoisyPicture made;
    const NoiseCase *of = &CASES[_i];
    double found = 0.0, square = 0.0, stated = 0.0, truth = 0.0;
    for (int i = 0; i < PICTURES; ++i) {
        HalvesError estimate;
        Error error = {0};
        picture_make(of, i + 1, &made);
        ck_assert(halves_error(made.halves, &of->goal, &estimate, &error));
        found += estimate.value / PICTURES;
        square += estimate.value * estimate.value / PICTURES;
        stated += estimate.deviation / PICTURES;
        truth += error_true(&made, &of->goal) / PICTURES;
        picture_destroy(&made);
    }
    double scatter = sqrt(fmax(square - found * found, 0.0) * PICTURES / (PICTURES - 1.0));
    printf("case %d: estimated %.4f, true %.4f; scatter %.5f, stated %.5f\n", _i, found, truth, scatter, stated);
    ck_assert_double_eq_tol(found / truth, 1.0, truth < 0.3 ? 0.03 : 0.1);
    /* The scatter of 60 estimates is known to a tenth. */
    ck_assert_double_ge(stated, 0.7 * scatter);
    ck_assert_double_le(stated, of->goal.percentile > 0.0 ? 5.0 * scatter : 2.0 * scatter);
}
END_TEST

/* One in METRICS_TRIMMED_SHARE pixels may differ by anything, unless all of them count. */
START_TEST(test_worst)
{
    enum { SIZE = 3 * WIDTH * HEIGHT, WORST = WIDTH * HEIGHT / METRICS_TRIMMED_SHARE };
    static float images[2][SIZE];
    const float *const halves[2] = {images[0], images[1]};
    const ErrorGoal pixels = {.goal = 0.1}, blocks = {.goal = 0.1, .blocks = true};
    HalvesError found;
    Error error = {0};
    for (size_t value = 0; value < SIZE; ++value)
        images[0][value] = images[1][value] = 1.0f;
    for (size_t worst = 1; worst <= WORST + 1; ++worst) {
        images[0][600 * worst] = 1e6f * (float)worst;
        ck_assert(halves_error_of_images(halves, WIDTH, HEIGHT, &pixels, &found, &error));
        ck_assert((found.value > 0.0) == (worst > WORST));
        ck_assert(halves_error_of_images(halves, WIDTH, HEIGHT, &blocks, &found, &error));
        ck_assert_double_gt(found.value, 0.0);
    }
}
END_TEST

/* Where all pixels have one error, it is theirs: as many are left out as elsewhere. */
START_TEST(test_ties)
{
    enum { SIZE = 3 * WIDTH * HEIGHT };
    static float images[2][SIZE];
    const float *const halves[2] = {images[0], images[1]};
    const ErrorGoal pixels = {.goal = 0.1};
    HalvesError found;
    Error error = {0};
    for (size_t value = 0; value < SIZE; ++value) {
        images[0][value] = 1.9f;
        images[1][value] = 2.1f;
    }
    ck_assert(halves_error_of_images(halves, WIDTH, HEIGHT, &pixels, &found, &error));
    ck_assert_double_eq_tol(found.value, sqrt(metrics_relative_square(0.01, 2.0)), 1e-6);
}
END_TEST

TCase *estimate_case(void)
{
    TCase *tcase = tcase_create("estimate");
    tcase_add_loop_test(tcase, test_estimate, 0, sizeof CASES / sizeof CASES[0]);
    tcase_add_test(tcase, test_worst);
    tcase_add_test(tcase, test_ties);
    return tcase;
}
