/* --error: the estimate from two halves, when the error is looked at, and what it is where a rendering ends. */
#include "support/render_fixture.h"
#include "support/test_util.h"

#include "compare/metrics.h"
#include "render/error_watch.h"
#include "render/halves_error.h"
#include "render/layers.h"

#include <string.h>

/* ---- the estimate ------------------------------------------------------------------------------------------------ */

#define WIDTH 61 /* the last tiles are not whole */
#define HEIGHT 45
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

typedef struct NoisyPicture {
    Film halves[2];
    float truth[3 * WIDTH * HEIGHT], picture[3 * WIDTH * HEIGHT];
} NoisyPicture;

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

/* The error by the truth, in the measure of the goal. */
static double error_true(const NoisyPicture *made, const ErrorGoal *goal)
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

/* The mean of the estimates is the error itself, to a few percent, more where noise hides what the pixels' own values are;
 * estimates scatter as their standard errors say, or less. */
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

/* ---- looks ------------------------------------------------------------------------------------------------------- */

/* Looks are at even numbers of samples, and each after enough of them since the last. */
START_TEST(test_looks)
{
    uint64_t samples = error_watch_next(0);
    ck_assert_uint_eq(samples, ERROR_LOOK_FIRST);
    while (samples < 1000000) {
        uint64_t next = error_watch_next(samples);
        ck_assert_uint_eq(next % 2, 0);
        ck_assert_double_ge((double)next, fmax((double)samples + 2.0, ERROR_LOOK_GROWTH * (double)samples));
        ck_assert_double_le((double)next, ERROR_LOOK_GROWTH * (double)samples + 2.0);
        samples = next;
    }
}
END_TEST

/* A goal is reached when the estimate and its standard error are below it, and the forecast is that of an error that falls with
 * the square root of the work. */
START_TEST(test_reached)
{
    const RenderOptions options = {.error = {.goal = 0.1}};
    RenderRun run = {.options = &options, .crop_pixels = 100, .done = 399};
    ck_assert(!error_watch_due(&run) && !error_watch_reached(&run));
    ck_assert_double_eq(render_run_error_fraction(&run), 0.0);
    ck_assert(isinf(error_watch_target(&run)));
    run.done = 400;
    ck_assert(error_watch_due(&run));
    run.error = (ErrorWatch){.estimate = 0.19, .deviation = 0.01, .work = 400};
    ck_assert(!error_watch_due(&run) && !error_watch_reached(&run));
    ck_assert_double_eq_tol(render_run_error_fraction(&run), 0.25, 1e-9);
    ck_assert_double_eq_tol(error_watch_target(&run), 1600.0, 1e-9);
    run.done = 800;
    ck_assert(error_watch_due(&run));
    ck_assert_double_eq_tol(render_run_error_fraction(&run), 0.5, 1e-9);
    run.error = (ErrorWatch){.estimate = 0.099, .deviation = 0.002, .work = 800};
    ck_assert(!error_watch_reached(&run));
    ck_assert_double_eq_tol(error_watch_target(&run), 800.0 * ERROR_LOOK_GROWTH, 1e-9);
    run.error.deviation = 0.001;
    ck_assert(error_watch_reached(&run));
}
END_TEST

/* ---- renderings -------------------------------------------------------------------------------------------------- */

/* A lamp over two spheres on a floor. */
#define SCENE                                                                                                          \
    "LookAt 0 3 6  0 .7 0  0 1 0  Camera \"perspective\" \"float fov\" 40\n"                                           \
    "Integrator \"path\" \"integer maxdepth\" 4 WorldBegin\n"                                                          \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [12 10 8] Translate 1 4 1 Rotate 90 1 0 0\n"                 \
    "Shape \"disk\" \"float radius\" .7 AttributeEnd\n"                                                                \
    "Material \"diffuse\" \"rgb reflectance\" [.7 .6 .5]\n"                                                            \
    "Shape \"bilinearmesh\" \"point3 P\" [-4 0 -4  4 0 -4  -4 0 4  4 0 4]\n"                                           \
    "AttributeBegin Translate -1 .7 0 Shape \"sphere\" \"float radius\" .7 AttributeEnd\n"                             \
    "AttributeBegin Material \"conductor\" \"float roughness\" .3 Translate 1 .7 0\n"                                  \
    "Shape \"sphere\" \"float radius\" .7 AttributeEnd\n"

#define SEEDS 6

static const struct {
    const Integrator *(*integrator)(void);
    ErrorGoal goal;
    uint reconstruction;
} RENDERINGS[] = {
    {integrator_pt, {.goal = 0.03, .scale = 1.0}, RECONSTRUCTION_SPLAT},
    {integrator_pt, {.goal = 0.04, .scale = 1.0}, RECONSTRUCTION_SAMPLE},
    {integrator_pt, {.goal = 0.006, .scale = 1.0, .blocks = true}, RECONSTRUCTION_SPLAT},
    {integrator_pt, {.goal = 0.05, .scale = 1.0, .percentile = 95.0}, RECONSTRUCTION_SPLAT},
    {integrator_bdpt, {.goal = 0.03, .scale = 1.0}, RECONSTRUCTION_SPLAT},
    {integrator_ibpt, {.goal = 0.03, .scale = 1.0}, RECONSTRUCTION_SPLAT},
    {integrator_mmlt, {.goal = 0.015, .scale = 1.0}, RECONSTRUCTION_SPLAT},
    {integrator_mmlt, {.goal = 0.006, .scale = 1.0, .blocks = true}, RECONSTRUCTION_SPLAT},
};

static RenderSetup setup_of(int which)
{
    return (RenderSetup){.text = SCENE,
                         .width = WIDTH,
                         .height = HEIGHT,
                         .integrator = RENDERINGS[which].integrator(),
                         .reconstruction = RENDERINGS[which].reconstruction,
                         .error = RENDERINGS[which].goal};
}

static NoisyPicture rendered; /* and its reference */

/* The error of an image by the reference, in the measure of the goal. */
static double error_of(const RenderedImage *image, const ErrorGoal *goal)
{
    memcpy(rendered.picture, image->rgb, sizeof rendered.picture);
    return error_true(&rendered, goal);
}

/* The error by a reference is what was promised, on average over seeds: it may be less by what the last look is late, and by the
 * margin of a standard error. */
START_TEST(test_promise)
{
    RenderedImage image;
    RenderSetup setup = setup_of(_i);
    RenderSetup reference = {.text = SCENE,
                             .width = WIDTH,
                             .height = HEIGHT,
                             .samples = 2000,
                             .seed = 99,
                             .reconstruction = setup.reconstruction};
    double ratio = 0.0, least = 1e9, most = 0.0;
    fixture_render(&reference, &image);
    memcpy(rendered.truth, image.rgb, sizeof rendered.truth);
    fixture_destroy(&image);
    for (unsigned seed = 1; seed <= SEEDS; ++seed) {
        RenderLayers layers = {0};
        setup.seed = seed;
        setup.layers = &layers;
        fixture_render(&setup, &image);
        ck_assert(image.result.error_reached);
        ck_assert_double_le(image.result.error.estimate + image.result.error.deviation, setup.error.goal);
        double found = error_of(&image, &setup.error) / setup.error.goal;
        ratio += found / SEEDS;
        least = fmin(least, found);
        most = fmax(most, found);
        render_layers_destroy(&layers);
        fixture_destroy(&image);
    }
    printf("rendering %d: error / goal %.3f on average, %.3f to %.3f\n", _i, ratio, least, most);
    /* The picture has 48 blocks, whose errors are few numbers to estimate one from. */
    ck_assert_double_ge(ratio, setup.error.blocks ? 0.7 : 0.8);
    ck_assert_double_le(ratio, 1.05);
    ck_assert_double_ge(least, setup.error.blocks ? 0.5 : 0.6);
    ck_assert_double_le(most, setup.error.blocks ? 1.7 : 1.25);
}
END_TEST

/* Scenes with references, for check-long. */
static const struct {
    const char *scene;
    const Integrator *(*integrator)(void);
    double goal;
} LONG_RENDERINGS[] = {
    {"cornell", integrator_pt, 0.05}, {"cornell", integrator_mmlt, 0.05}, {"cornell", integrator_bdpt, 0.05},
    {"door", integrator_mmlt, 0.4},   {"glossy", integrator_mmlt, 0.3},   {"lamp", integrator_mmlt, 0.4},
    {"pool", integrator_mmlt, 0.2},   {"relief", integrator_mmlt, 0.3},
};

#define LONG_SEEDS 20

static double relative_error(const RenderedImage *image, PictureView reference)
{
    Metrics metrics;
    Error error = {0};
    ck_assert(metrics_compute(image->rgb, reference.rgb, reference.width, reference.height, 1, &metrics, &error));
    return sqrt(metrics.rel_mse_trimmed);
}

/* The same over 20 seeds on scenes with references: most renderings end within 0.8 to 1.25 of what was promised. */
START_TEST(test_promise_of_scenes)
{
    char path[2][512];
    PictureView reference;
    RenderedImage image;
    unsigned within = 0;
    double sum = 0.0;
    if (test_effort() < 2)
        return;
    snprintf(path[0], sizeof path[0], "%s/scenes/%s.pbrt", test_source_folder(), LONG_RENDERINGS[_i].scene);
    snprintf(path[1], sizeof path[1], "%s/scenes/reference/%s.exr", test_source_folder(), LONG_RENDERINGS[_i].scene);
    float *rgb = fixture_picture_read(path[1], &reference);
    for (unsigned seed = 1; seed <= LONG_SEEDS; ++seed) {
        RenderLayers layers = {0};
        const RenderSetup setup = {.path = path[0],
                                   .width = reference.width,
                                   .height = reference.height,
                                   .integrator = LONG_RENDERINGS[_i].integrator(),
                                   .reconstruction = RECONSTRUCTION_SPLAT,
                                   .error = {.goal = LONG_RENDERINGS[_i].goal, .scale = 1.0},
                                   .seed = seed,
                                   .photons = PHOTONS_DEFAULT,
                                   .layers = &layers};
        fixture_render(&setup, &image);
        ck_assert(image.result.error_reached);
        double found = relative_error(&image, reference) / setup.error.goal;
        within += found >= 0.8 && found <= 1.25;
        sum += found;
        render_layers_destroy(&layers);
        fixture_destroy(&image);
    }
    free(rgb);
    printf("%s, %s: error / goal %.3f on average, %u of %u within 0.8 to 1.25\n", LONG_RENDERINGS[_i].scene,
           LONG_RENDERINGS[_i].integrator()->name, sum / LONG_SEEDS, within, LONG_SEEDS);
    ck_assert_uint_ge(within, 19);
}
END_TEST

/* The image is the sum of its halves, which are of different samples, and it is the same for any number of threads. */
START_TEST(test_halves)
{
    RenderLayers layers = {0}, others = {0};
    RenderSetup setup = setup_of(_i);
    RenderedImage image, other;
    setup.threads = 1;
    setup.layers = &layers;
    fixture_render(&setup, &image);
    setup.threads = 3;
    setup.layers = &others;
    fixture_render(&setup, &other);
    size_t pixels = film_pixels(&image.film), bytes = 3 * pixels * sizeof *image.film.sums, equal = 0, lit = 0;
    ck_assert(memcmp(image.film.sums, other.film.sums, bytes) == 0);
    for (size_t value = 0; value < 3 * pixels; ++value) {
        const Film *halves = layers.halves;
        ck_assert_int_eq(image.film.sums[value], halves[0].sums[value] + halves[1].sums[value]);
        lit += halves[0].sums[value] != 0;
        equal += halves[0].sums[value] != 0 && halves[0].sums[value] == halves[1].sums[value];
    }
    ck_assert_uint_gt(lit, pixels);
    ck_assert_uint_lt(100 * equal, lit);
    render_layers_destroy(&layers);
    render_layers_destroy(&others);
    fixture_destroy(&image);
    fixture_destroy(&other);
}
END_TEST

/* Whether the first half is a rendering without a goal of half of the samples. */
static void first_half_compare(const RenderSetup *setup, const Film *half)
{
    RenderSetup plain = *setup;
    RenderedImage image;
    plain.error.goal = 0.0;
    plain.layers = NULL;
    plain.samples = (setup->samples + 1) / 2;
    fixture_render(&plain, &image);
    ck_assert(memcmp(image.film.sums, half->sums, 3 * film_pixels(half) * sizeof *half->sums) == 0);
    ck_assert(memcmp(image.film.counts, half->counts, film_pixels(half) * sizeof *half->counts) == 0);
    ck_assert_uint_eq(image.film.every_count, half->every_count);
    fixture_destroy(&image);
}

/* --samples ends a rendering that does not reach its goal, with as many samples as without a goal, odd numbers included. */
START_TEST(test_samples)
{
    RenderLayers layers = {0};
    RenderedImage image;
    RenderSetup setup = setup_of(0);
    setup.error.goal = 1e-5;
    setup.samples = (unsigned)_i;
    setup.layers = &layers;
    fixture_render(&setup, &image);
    ck_assert(!image.result.error_reached);
    ck_assert_uint_eq(image.result.samples, (uint64_t)_i * WIDTH * HEIGHT);
    bool looked = setup.samples >= ERROR_LOOK_FIRST;
    ck_assert(looked == (image.result.error.estimate > 0.0));
    ck_assert_uint_eq(image.result.error.work, looked ? image.result.samples : 0);
    first_half_compare(&setup, &layers.halves[0]);
    render_layers_destroy(&layers);
    fixture_destroy(&image);
}
END_TEST

int main(void)
{
    const int renderings = sizeof RENDERINGS / sizeof RENDERINGS[0];
    Suite *suite = suite_create("error");
    TCase *estimate = tcase_create("estimate"), *looks = tcase_create("looks"), *promise = tcase_create("promise");
    tcase_add_loop_test(estimate, test_estimate, 0, sizeof CASES / sizeof CASES[0]);
    tcase_add_test(estimate, test_worst);
    tcase_add_test(estimate, test_ties);
    suite_add_tcase(suite, estimate);
    tcase_add_test(looks, test_looks);
    tcase_add_test(looks, test_reached);
    suite_add_tcase(suite, looks);
    tcase_set_timeout(promise, test_effort() > 1 ? 1200 : 120);
    tcase_set_tags(promise, "pictures");
    tcase_add_loop_test(promise, test_promise, 0, renderings);
    tcase_add_loop_test(promise, test_promise_of_scenes, 0, sizeof LONG_RENDERINGS / sizeof LONG_RENDERINGS[0]);
    tcase_add_loop_test(promise, test_halves, 0, renderings);
    tcase_add_loop_test(promise, test_samples, 1, 8);
    suite_add_tcase(suite, promise);
    return test_run(suite);
}
