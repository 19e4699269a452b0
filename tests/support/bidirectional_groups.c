/* Images in independent groups, and statistics of their means. */
#include "support/bidirectional.h"

#include "backend_cpu.h"
#include "render/layers.h"

#include <string.h>

/* ---- rendering --------------------------------------------------------------------------------------------------- */

typedef struct Renderer {
    const RenderSetup *setup;
    unsigned layer_depth; /* as in GroupSetup */
    Scene scene;
    Backend *backend;
    int quantum_exponent;
    bool have_quantum;
    float *rgb;
} Renderer;

static void render_once(Renderer *renderer, uint64_t seed, int depth, float *rgb, bool *sound)
{
    Error error = {0};
    Film film;
    RenderResult result;
    const RenderSetup *setup = renderer->setup;
    RenderLayers layers = {.wanted = LAYER_BIT(LAYER_BY_DEPTH)};
    const SceneSettings *settings = &renderer->scene.settings;
    RenderOptions options = {.samples = setup->samples * test_effort(),
                             .max_depth = depth,
                             .seed = seed,
                             .chains = setup->chains,
                             .photons = setup->photons,
                             .layers = renderer->layer_depth > 0 ? &layers : NULL,
                             .balance = setup->balance,
                             .only_strategy = setup->only_strategy,
                             .strategy = {setup->strategy[0], setup->strategy[1]},
                             .unweighted = setup->unweighted};
    ck_assert_msg(film_init(&film, settings->width, settings->height, settings->crop, &error), "%s", error.message);
    film.quantum_exponent = renderer->quantum_exponent;
    const RenderTask task = {.integrator = setup->integrator ? setup->integrator : integrator_pt(),
                             .scene = &renderer->scene,
                             .backend = {backend_cpu(), renderer->backend},
                             .options = &options,
                             .keep_quantum = renderer->have_quantum};
    ck_assert_msg(render_film(&task, &film, &result, &error), "%s", error.message);
    renderer->quantum_exponent = film.quantum_exponent;
    renderer->have_quantum = true;
    if (renderer->layer_depth > 0)
        film_resolve_depth(&film, renderer->layer_depth, film_scale_of(&film, settings->film_scale), 0,
                           film_pixels(&film), rgb);
    else
        film_resolve(&film, settings->film_scale, rgb);
    render_layers_destroy(&layers);
    *sound = *sound && film.saturated == 0 && film_full_pixels(&film) == 0 && film.not_finite == 0;
    for (int i = 0; i < result.diagnostic_count; ++i)
        *sound = *sound && result.diagnostics[i] == 0;
    film_destroy(&film);
}

void groups_render(const GroupSetup *setup, PictureGroups *picture)
{
    Error error = {0};
    Renderer renderer = {.setup = &setup->render, .layer_depth = setup->layer_depth};
    fixture_scene(&setup->render, &renderer.scene);
    const SceneSettings *settings = &renderer.scene.settings;
    renderer.backend = fixture_open(&setup->render, &renderer.scene, &error);
    ck_assert_msg(renderer.backend != NULL, "%s", error.message);
    *picture = (PictureGroups){.groups = setup->groups,
                               .width = settings->crop[2] - settings->crop[0],
                               .height = settings->crop[3] - settings->crop[1],
                               .sound = true};
    size_t pixels = (size_t)(picture->width * picture->height);
    int depth = setup->render.max_depth > 0 ? setup->render.max_depth : settings->max_depth;
    float *rgb = calloc(2 * 3 * pixels, sizeof *rgb), *less = rgb + 3 * pixels;
    picture->values = calloc((size_t)setup->groups * pixels, sizeof *picture->values);
    ck_assert(rgb != NULL && picture->values != NULL);
    for (int g = 0; g < setup->groups; ++g) {
        uint64_t seed = setup->render.seed + (uint64_t)g;
        render_once(&renderer, seed, depth, rgb, &picture->sound);
        if (setup->at_depth && depth > 1) /* the same random numbers make the same shorter paths */
            render_once(&renderer, seed, depth - 1, less, &picture->sound);
        for (size_t i = 0; i < 3 * pixels; ++i)
            picture->values[(size_t)g * pixels + i / 3] += ((double)rgb[i] - (double)less[i]) / 3.0;
    }
    free(rgb);
    backend_cpu()->close(renderer.backend);
    scene_destroy(&renderer.scene);
}

void groups_destroy(PictureGroups *picture)
{
    free(picture->values);
    memset(picture, 0, sizeof *picture);
}

/* ---- statistics -------------------------------------------------------------------------------------------------- */

static double block_of_group(const PictureGroups *picture, int g, int x0, int y0, int x1, int y1)
{
    const double *values = picture->values + (size_t)g * (size_t)(picture->width * picture->height);
    double sum = 0.0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            sum += values[y * picture->width + x];
    return sum / ((x1 - x0) * (y1 - y0));
}

double groups_mean(const PictureGroups *picture)
{
    double sum = 0.0;
    for (int g = 0; g < picture->groups; ++g)
        sum += block_of_group(picture, g, 0, 0, picture->width, picture->height);
    return sum / picture->groups;
}

void groups_block(const PictureGroups *picture, int x0, int y0, int x1, int y1, double *mean, double *error)
{
    double sum = 0.0, squares = 0.0, floor_value = 1e-2 * groups_mean(picture);
    for (int g = 0; g < picture->groups; ++g)
        sum += block_of_group(picture, g, x0, y0, x1, y1);
    *mean = sum / picture->groups;
    for (int g = 0; g < picture->groups; ++g) {
        double difference = block_of_group(picture, g, x0, y0, x1, y1) - *mean;
        squares += difference * difference;
    }
    double variance = fmax(squares / (picture->groups - 1), floor_value * floor_value);
    *error = sqrt(variance / picture->groups);
}

/* Mean over the groups. */
static double pixel_mean(const PictureGroups *picture, size_t pixel)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    double mean = 0.0;
    for (int g = 0; g < picture->groups; ++g)
        mean += picture->values[(size_t)g * pixels + pixel] / picture->groups;
    return mean;
}

double groups_mean_variance(const PictureGroups *picture)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    double squares = 0.0;
    for (size_t i = 0; i < pixels; ++i) {
        double mean = pixel_mean(picture, i);
        for (int g = 0; g < picture->groups; ++g)
            squares += pow(picture->values[(size_t)g * pixels + i] - mean, 2.0);
    }
    return squares / (picture->groups - 1) / picture->groups / (double)pixels;
}

double groups_square_error(const PictureGroups *picture, const PictureGroups *reference)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    double sum = 0.0;
    for (size_t i = 0; i < pixels; ++i) {
        double mean = pixel_mean(reference, i);
        for (int g = 0; g < picture->groups; ++g)
            sum += pow(picture->values[(size_t)g * pixels + i] - mean, 2.0) / picture->groups;
    }
    return sum / (double)pixels - groups_mean_variance(reference);
}

/* Regularised incomplete beta function by its continued fraction (Abramowitz and Stegun 26.5.8), for x below the
 * mean. */
static double incomplete_beta(double a, double b, double x)
{
    if (x > (a + 1.0) / (a + b + 2.0))
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    if (x <= 0.0)
        return 0.0;
    double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x)) / a;
    double c = 1.0, d = 1.0 / (1.0 - (a + b) * x / (a + 1.0)), h = d;
    for (int m = 1; m < 1000; ++m) {
        double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1.0 / (1.0 + even * d);
        c = 1.0 + even / c;
        h *= c * d;
        d = 1.0 / (1.0 + odd * d);
        c = 1.0 + odd / c;
        h *= c * d;
        if (fabs(c * d - 1.0) < 1e-14)
            break;
    }
    return front * h;
}

double groups_p_value(const PictureGroups *a, const PictureGroups *b, int x0, int y0, int x1, int y1)
{
    double mean_a, mean_b, error_a, error_b;
    groups_block(a, x0, y0, x1, y1, &mean_a, &error_a);
    groups_block(b, x0, y0, x1, y1, &mean_b, &error_b);
    double va = error_a * error_a, vb = error_b * error_b;
    if (!(va + vb > 0.0))
        return mean_a == mean_b ? 1.0 : 0.0;
    double t2 = (mean_a - mean_b) * (mean_a - mean_b) / (va + vb);
    double freedom = (va + vb) * (va + vb) / (va * va / (a->groups - 1) + vb * vb / (b->groups - 1));
    return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t2));
}

/* ---- comparing --------------------------------------------------------------------------------------------------- */

typedef struct Comparison {
    const PictureGroups *got, *expected;
    double worst;
    int place[4];
} Comparison;

static void compare_block(Comparison *comparison, int x0, int y0, int x1, int y1)
{
    double p = groups_p_value(comparison->got, comparison->expected, x0, y0, x1, y1);
    if (p < comparison->worst) {
        int place[4] = {x0, y0, x1, y1};
        comparison->worst = p;
        memcpy(comparison->place, place, sizeof place);
    }
}

static void compare_grid(Comparison *comparison, int columns, int rows)
{
    int width = comparison->got->width, height = comparison->got->height;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            compare_block(comparison, width * i / columns, height * j / rows, width * (i + 1) / columns,
                          height * (j + 1) / rows);
}

void groups_compare(const char *name, const PictureGroups *got, const PictureGroups *expected, int grid, bool pixels)
{
    ck_assert_int_eq(got->width, expected->width);
    ck_assert_int_eq(got->height, expected->height);
    ck_assert_msg(got->sound && expected->sound, "%s: something was not finite or was clamped", name);
    ck_assert_msg(groups_mean(expected) > 0.0, "%s: the picture is black", name);
    Comparison comparison = {.got = got, .expected = expected, .worst = 1.0};
    compare_grid(&comparison, 1, 1);
    double whole = comparison.worst, mean, error, other, other_error;
    compare_grid(&comparison, grid, grid);
    if (pixels)
        compare_grid(&comparison, got->width, got->height);
    const int *place = comparison.place;
    groups_block(got, 0, 0, got->width, got->height, &mean, &error);
    groups_block(expected, 0, 0, got->width, got->height, &other, &other_error);
    printf("%-32s mean %9.4g ratio %.4f +- %.4f p %.2g, least p of blocks %.2g at %d %d\n", name, other, mean / other,
           sqrt(error * error + other_error * other_error) / other, whole, comparison.worst, place[0], place[1]);
    groups_block(got, place[0], place[1], place[2], place[3], &mean, &error);
    groups_block(expected, place[0], place[1], place[2], place[3], &other, &other_error);
    ck_assert_msg(comparison.worst > P_LIMIT, "%s: p = %.2g in pixels [%d, %d) x [%d, %d): %g +- %g, not %g +- %g",
                  name, comparison.worst, place[0], place[2], place[1], place[3], mean, error, other, other_error);
}
