/* Splats against the pixel filter that they represent. */
#include "camera/film_splat.h"
#include "light/test_emit.h"
#include "support/filter_cases.h"

/* A film of 12 x 11 pixels whose crop window touches the film's left edge only. */
enum { WIDTH = 12, X0 = 0, X1 = 6, Y0 = 3, Y1 = 8, ROWS = Y1 - Y0, COLUMNS = X1 - X0 };

static void setup(LightFixture *f, const FilterSettings *settings)
{
    FrameParams *frame = &f->scene.frame;
    fixture_init_filter(f, settings);
    frame->film.width = WIDTH;
    frame->film.height = 11;
    frame->film.crop_x0 = X0;
    frame->film.crop_y0 = Y0;
    frame->film.crop_x1 = X1;
    frame->film.crop_y1 = Y1;
}

/* f over its integral at `offset`; for a tabulated filter the mean over the table's cell. */
static double filter_density(const FilterSettings *s, double radius, double offset)
{
    enum { N = 2048, SUB = 16 };
    double integral = 0.0;
    if (fabs(offset) > radius)
        return 0.0;
    for (int i = 0; i < N; ++i)
        integral += filter_evaluate(s, radius, radius * (2.0 * (i + 0.5) / N - 1.0)) * 2.0 * radius / N;
    if (s->kind == PIXEL_FILTER_BOX || s->kind == PIXEL_FILTER_TRIANGLE)
        return filter_evaluate(s, radius, offset) / integral;
    double h = 2.0 * radius / PIXEL_FILTER_CELLS, cell = floor((offset + radius) / h), sum = 0.0;
    for (int i = 0; i < SUB; ++i)
        sum += filter_evaluate(s, radius, -radius + h * (cell + (i + 0.5) / SUB)) / SUB;
    return sum / integral;
}

/* At a few film positions, inside and around the crop window, the mean over u of each pixel's share. A table's cells
 * are differences of floats up to 1, which rounds densities by up to 1e-5. */
START_TEST(test_expectation)
{
    enum { N = 256, POSITIONS = 60 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    const double rx = (double)s->radius_x, ry = (double)s->radius_y;
    LightFixture f;
    setup(&f, s);
    for (uint k = 0; k < POSITIONS; ++k) {
        double pixels[ROWS * COLUMNS] = {0.0}, largest = 0.0;
        Vec2 r = fixture_random(1, k);
        Vec2 film = vec2(X0 - 4.5f + r.x * (COLUMNS + 9.0f), Y0 - 4.5f + r.y * (ROWS + 9.0f));
        for (uint i = 0; i < N * N; ++i) {
            float weight;
            uint column = i % N, row = i / N;
            Vec2 u = vec2(((float)column + 0.5f) / N, ((float)row + 0.5f) / N);
            uint pixel = film_splat_pixel(&f.view, film, u, &weight);
            if (pixel == NONE)
                continue;
            uint x = pixel % WIDTH, y = pixel / WIDTH;
            TEST_TRUE(x < X1 && y >= Y0 && y < Y1);
            pixels[(y - Y0) * COLUMNS + x - X0] += (double)weight / ((double)N * N);
            largest = fmax(largest, fabs((double)weight));
        }
        for (int y = Y0; y < Y1; ++y)
            for (int x = X0; x < X1; ++x) {
                double expected =
                    filter_density(s, rx, (double)film.x - x - 0.5) * filter_density(s, ry, (double)film.y - y - 0.5);
                double got = pixels[(y - Y0) * COLUMNS + x - X0];
                if (fabs(got - expected) > largest * 3.0 / N + 1e-4 * fabs(expected) + 2e-5)
                    ck_abort_msg("%s at %g %g: pixel %d %d gets %g, not %g", FILTER_CASES[_i].name, (double)film.x,
                                 (double)film.y, x, y, got, expected);
            }
    }
    fixture_destroy(&f);
}
END_TEST

/* Film positions uniform in and around the crop window: every pixel gets 1, at the border, too. */
START_TEST(test_constant)
{
    enum { SAMPLES = 600000 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    LightFixture f;
    setup(&f, s);
    double sums[ROWS * COLUMNS] = {0.0}, squares[ROWS * COLUMNS] = {0.0};
    float wide = COLUMNS + 2.0f * s->radius_x, high = ROWS + 2.0f * s->radius_y;
    for (uint i = 0; i < SAMPLES; ++i) {
        Vec2 r = fixture_random(1, i);
        float weight;
        Vec2 film = vec2(X0 - s->radius_x + r.x * wide, Y0 - s->radius_y + r.y * high);
        uint pixel = film_splat_pixel(&f.view, film, fixture_random(2, i), &weight);
        if (pixel == NONE)
            continue;
        double value = (double)weight * (double)wide * (double)high;
        uint at = (pixel / WIDTH - Y0) * COLUMNS + pixel % WIDTH - X0;
        sums[at] += value;
        squares[at] += value * value;
    }
    for (int i = 0; i < ROWS * COLUMNS; ++i) {
        double mean = sums[i] / SAMPLES, error = sqrt((squares[i] / SAMPLES - mean * mean) / SAMPLES);
        ck_assert_msg(fabs(mean - 1.0) < 4.5 * error && error < 0.04, "%s: pixel %d gets %g +- %g",
                      FILTER_CASES[_i].name, i, mean, error);
    }
    fixture_destroy(&f);
}
END_TEST

/* A box of one pixel assigns each position to the pixel that contains it, with weight 1. Positions that no pixel sees,
 * and NaN, go nowhere. */
START_TEST(test_box)
{
    LightFixture f;
    float weight;
    setup(&f, &FILTER_CASES[FILTER_BOX].settings);
    for (uint i = 0; i < 20000; ++i) {
        Vec2 r = fixture_random(1, i);
        Vec2 film = vec2(X0 + r.x * COLUMNS, Y0 + r.y * ROWS);
        uint column = X0 + i % COLUMNS, row = Y0 + i / COLUMNS;
        if (i < ROWS * COLUMNS) /* a corner belongs to the pixel to its lower right */
            film = vec2((float)column, (float)row);
        uint pixel = film_splat_pixel(&f.view, film, fixture_random(2, i), &weight);
        TEST_TRUE(pixel == (uint)film.y * WIDTH + (uint)film.x && weight == 1.0f);
    }
    static const float OUTSIDE[][2] = {{-0.01f, 5}, {6, 5}, {3, 2.99f}, {3, 8}, {1e30f, 5}, {-1e30f, 5}};
    for (size_t i = 0; i < sizeof OUTSIDE / sizeof *OUTSIDE; ++i)
        ck_assert(film_splat_pixel(&f.view, vec2(OUTSIDE[i][0], OUTSIDE[i][1]), vec2(0.5f, 0.5f), &weight) == NONE);
    fixture_destroy(&f);
    for (int i = 0; i < FILTER_CASE_COUNT; ++i) {
        setup(&f, &FILTER_CASES[i].settings);
        film_splat_pixel(&f.view, vec2(NAN, INFINITY), vec2(0.5f, 0.5f), &weight);
        ck_assert(film_splat_pixel(&f.view, vec2(3.0f, INFINITY), vec2(0.5f, 0.5f), &weight) == NONE);
        fixture_destroy(&f);
    }
}
END_TEST

TCase *emit_splat_case(void)
{
    TCase *tcase = tcase_create("splats");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_expectation, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_constant, 0, FILTER_CASE_COUNT);
    tcase_add_test(tcase, test_box);
    return tcase;
}
