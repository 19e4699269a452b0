/* Splats that are spread over the pixels whose filter covers them (camera/film_spread.h). */
#include "film/test_film.h"

#include "camera/film_splat.h"
#include "camera/film_spread.h"
#include "support/filter_cases.h"

#include <math.h>

/* A film of 12 x 11 pixels whose crop window touches the film's left edge only. */
enum { WIDTH = 12, HEIGHT = 11, X0 = 0, X1 = 6, Y0 = 3, Y1 = 8, ROWS = Y1 - Y0, COLUMNS = X1 - X0 };
enum { PIXELS = ROWS * COLUMNS };

static const int CROP[4] = {X0, Y0, X1, Y1};

static bool signed_filter(const FilterSettings *settings)
{
    return settings->kind == PIXEL_FILTER_MITCHELL || settings->kind == PIXEL_FILTER_SINC;
}

/* A fixture with the filter, and an empty film with sums for light, rare light and depths up to 4. */
static void setup(LightFixture *f, const FilterSettings *settings, uint reconstruction, Film *film)
{
    Error error;
    FilmParams *params = &f->scene.frame.film;
    fixture_init_filter(f, settings);
    params->width = WIDTH;
    params->height = HEIGHT;
    params->crop_x0 = X0;
    params->crop_y0 = Y0;
    params->crop_x1 = X1;
    params->crop_y1 = Y1;
    params->reconstruction = reconstruction;
    params->split_depths = 3;
    TEST_TRUE(film_init(film, WIDTH, HEIGHT, CROP, &error) && film_light_reserve(film, &error) &&
              film_rare_reserve(film, &error) && film_depths_reserve(film, 4, &error));
    film_filter_set(film, params, f->view.lookup);
}

static void teardown(LightFixture *f, Film *film)
{
    film_destroy(film);
    fixture_destroy(f);
}

static void splat_add(const LightFixture *f, Film *film, uint name, uint pixel, Vec2 place, Vec3 color)
{
    uint splat[SPLAT_WORDS];
    state_store(splat, 1, SPLAT_PIXEL, 0, name | pixel);
    state_store_vec3(splat, 1, SPLAT_COLOR, 0, color);
    state_store(splat, 1, SPLAT_OFFSET, 0, splat_offset(&f->scene.frame.film, pixel, place));
    film_add_splats(film, splat, 1, 1);
}

/* A position in the filter of a pixel, drawn like the sample of that pixel. */
static Vec2 place_draw(const LightFixture *f, uint x, uint y, uint stream, uint index, float *weight)
{
    Vec2 offset = pixel_filter_sample(&f->view, fixture_random(stream, index), weight);
    return vec2((float)x + 0.5f + offset.x, (float)y + 0.5f + offset.y);
}

/* f of an axis over the integral of |f|, as the scene's table has it, without regard to the crop. */
static double density_at(const FilmAxis *axis, double offset)
{
    float sign;
    if (fabs(offset) > (double)axis->radius)
        return 0.0;
    double density = (double)film_axis_density(axis, (float)offset, &sign);
    return sign < 0.0f ? -density : density;
}

/* A splat gives every pixel a part in proportion to the filter that covers it, to within one of SPREAD_PARTS; the parts
 * add up to the splat, to the last unit; and on the average over positions they are exact. */
START_TEST(test_shares)
{
    enum { SPLATS = 4000 };
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    LightFixture f;
    Film film;
    double excess = 0.0, square = 0.0, count = 0.0;
    setup(&f, s, RECONSTRUCTION_SPLAT, &film);
    for (uint k = 0; k < SPLATS; ++k) {
        uint x = X0 + k % COLUMNS, y = Y0 + k / COLUMNS % ROWS;
        float weight;
        Vec2 place = place_draw(&f, x, y, 1, k, &weight);
        uint offset = splat_offset(&f.scene.frame.film, y * WIDTH + x, place);
        double at_x = x + 0.5 + (double)splat_offset_of(offset & 0xffffu, s->radius_x);
        double at_y = y + 0.5 + (double)splat_offset_of(offset >> 16, s->radius_y);
        double shares[PIXELS], all = 0.0;
        TEST_NEAR(at_x, (double)place.x, (double)s->radius_x * 0x1p-15);
        TEST_NEAR(at_y, (double)place.y, (double)s->radius_y * 0x1p-15);
        int64_t units[3] = {0, 0, 0};
        film_clear(&film);
        splat_add(&f, &film, SPLAT_LIGHT, y * WIDTH + x, place, vec3(1.0f, 0.37f, -0.21f));
        for (int i = 0; i < PIXELS; ++i) {
            shares[i] = density_at(&film.axis_x, at_x - (X0 + i % COLUMNS) - 0.5) *
                        density_at(&film.axis_y, at_y - (Y0 + i / COLUMNS) - 0.5);
            all += fabs(shares[i]);
            for (int c = 0; c < 3; ++c)
                units[c] += llabs(film.light_sums[3 * i + c]);
        }
        ck_assert_int_eq(units[0], 1 << 30);
        ck_assert_int_eq(units[1], llrint((double)0.37f * 0x1p30));
        ck_assert_int_eq(units[2], llrint((double)0.21f * 0x1p30));
        for (int i = 0; i < PIXELS; ++i) {
            double got = (double)film.light_sums[3 * i] * 0x1p-30, difference = got - shares[i] / all;
            TEST_NEAR(difference, 0.0, 1.01 / SPREAD_PARTS);
            TEST_NEAR((double)film.light_sums[3 * i + 2] * 0x1p-30, (double)-0.21f * got, 4e-9);
            /* whether shares of less than half a part are given too little */
            if (fabs(shares[i]) > 0.0 && fabs(shares[i] / all) < 0.5 / SPREAD_PARTS) {
                excess += fabs(got) - fabs(shares[i] / all);
                square += difference * difference;
                ++count;
            }
        }
        for (int i = 0; i < PIXELS; ++i)
            ck_assert_uint_eq(film.counts[i], 0);
    }
    TEST_TRUE(fabs(excess) <= 4.5 * sqrt(square) + 1e-6);
    TEST_TRUE(count > 0 || s->kind == PIXEL_FILTER_BOX);
    teardown(&f, &film);
}
END_TEST

/* Adds a sample of `color` times the filter's weight to every pixel, `samples` times. */
static void samples_add(const LightFixture *f, Film *film, uint name, uint samples, uint first, Vec3 color)
{
    for (uint k = 0; k < samples * PIXELS; ++k) {
        uint x = X0 + k % COLUMNS, y = Y0 + k / COLUMNS % ROWS;
        float weight;
        Vec2 place = place_draw(f, x, y, 2, first + k, &weight);
        splat_add(f, film, name, y * WIDTH + x, place, vec3_scale(color, weight));
    }
}

/* Samples of equal color give a constant image wherever they lie, up to the border: a pixel is divided by what it
 * got. */
START_TEST(test_constant)
{
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    LightFixture f;
    Film film;
    float rgb[3 * PIXELS];
    uint64_t counts = 0;
    setup(&f, s, RECONSTRUCTION_SPLAT, &film);
    samples_add(&f, &film, SPLAT_SAMPLE, 3, 0, vec3(0.5f, 2.0f, 8.0f));
    film_resolve(&film, 1.0f, rgb);
    for (int i = 0; i < PIXELS; ++i) {
        counts += film.counts[i];
        if (signed_filter(s)) {
            ck_assert_uint_eq(film.counts[i], 3 * SPREAD_PARTS);
            continue;
        }
        TEST_TRUE(film.counts[i] > 0);
        for (int c = 0; c < 3; ++c)
            TEST_NEAR((double)rgb[3 * i + c], ldexp(0.5, 2 * c), 1e-6 * ldexp(1.0, 2 * c));
    }
    ck_assert_uint_eq(counts, 3 * PIXELS * SPREAD_PARTS);
    teardown(&f, &film);
}
END_TEST

/* Samples that every pixel has are added up, exchanged and cleared like those of single pixels. */
START_TEST(test_normalized_merge)
{
    const uint samples = 2;
    LightFixture f;
    Film film, sum;
    Error error;
    setup(&f, &FILTER_CASES[0].settings, RECONSTRUCTION_SPLAT, &film);
    ck_assert(film_init_like(&sum, &film, &error));
    samples_add(&f, &film, SPLAT_SAMPLE, samples, 0, vec3_splat(1.0f));
    film_normalize(&film, samples);
    ck_assert(film_merge(&sum, &film, &error) && film_merge(&sum, &film, &error));
    film.counts[1] = 5;
    film_swap_own(&film, &sum);
    for (size_t i = 0; i < PIXELS; ++i) {
        ck_assert_uint_eq(film_count(&film, i), 2 * samples * SPREAD_PARTS);
        ck_assert_uint_eq(film_count(&sum, i), samples * SPREAD_PARTS + (i == 1 ? 5 : 0));
        ck_assert_int_eq(film.sums[3 * i], 2 * sum.sums[3 * i]);
    }
    sum.every_count = UINT32_MAX - samples * SPREAD_PARTS;
    ck_assert(!film_merge(&sum, &film, &error));
    film_clear(&film);
    film_clear(&sum);
    for (size_t i = 0; i < PIXELS; ++i)
        ck_assert_uint_eq(film_count(&film, i) + film_count(&sum, i), 0);
    film_destroy(&sum);
    teardown(&f, &film);
}
END_TEST

/* film_normalize does the same for all layers of samples of which a part has SPLAT_LIGHT, and leaves films alone whose
 * splats are not spread. */
START_TEST(test_normalized)
{
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    const uint samples = 2;
    const float light[] = {1.0f, 3.0f, 5.0f, 7.0f};
    LightFixture f;
    Film film;
    if (signed_filter(s))
        return;
    setup(&f, s, RECONSTRUCTION_SPLAT, &film);
    samples_add(&f, &film, SPLAT_SAMPLE, samples, 0, vec3(light[0], 1.0f, 1.0f));
    samples_add(&f, &film, SPLAT_LIGHT | SPLAT_RARE | splat_depth(3, 4), samples, 0, vec3(light[1], 1.0f, 1.0f));
    samples_add(&f, &film, SPLAT_LIGHT | splat_depth(3, 3), samples, 0, vec3(light[2], 1.0f, 1.0f));
    film.threads = 1 + _i % 3;
    film_normalize(&film, samples);
    const double scale = 0x1p30 * samples;
    for (int i = 0; i < PIXELS; ++i) {
        ck_assert_uint_eq(film_count(&film, (size_t)i), samples * SPREAD_PARTS);
        TEST_NEAR((double)film.sums[3 * i] / scale, (double)light[0], 1e-6);
        TEST_NEAR((double)film.rare_sums[3 * i] / scale, (double)light[1], 1e-6);
        TEST_NEAR((double)film.light_sums[3 * i] / scale, (double)light[1] + (double)light[2], 1e-6);
        TEST_NEAR((double)film_depth_sums(&film, 3, FILM_KIND_LIGHT)[3 * i] / scale, (double)light[2], 1e-6);
        TEST_NEAR((double)film_depth_sums(&film, 4, FILM_KIND_LIGHT)[3 * i] / scale, (double)light[1], 1e-6);
        TEST_NEAR((double)film_depth_sums(&film, 4, FILM_KIND_RARE)[3 * i] / scale, (double)light[1], 1e-6);
    }
    film.sums[0] = (int64_t)SUM_FULL;
    film_normalize(&film, 1); /* full sums stay full */
    ck_assert_int_eq(film.sums[0], (int64_t)SUM_FULL);
    teardown(&f, &film);
    setup(&f, s, RECONSTRUCTION_SAMPLE, &film);
    samples_add(&f, &film, SPLAT_SAMPLE, 1, 0, vec3(light[0], 1.0f, 1.0f));
    int64_t before = film.sums[0];
    film_normalize(&film, 5);
    ck_assert_int_eq(film.sums[0], before);
    ck_assert_uint_eq(film.counts[0], 1);
    teardown(&f, &film);
}
END_TEST

/* film_normalize_bidirectional divides direct light, and of the light sums what the rare sums repeat but not what came
 * from the light, whatever lies near a pixel; or nothing, and then no direct light is left. Full sums are full. */
START_TEST(test_normalized_bidirectional)
{
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    const uint samples = 2;
    LightFixture f;
    if (signed_filter(s))
        return;
    for (int divides = 0; divides < 2; ++divides) {
        Film film;
        setup(&f, s, RECONSTRUCTION_SPLAT, &film);
        samples_add(&f, &film, SPLAT_SAMPLE, samples, 0, vec3(3.0f, 1.0f, 1.0f));
        samples_add(&f, &film, SPLAT_LIGHT | SPLAT_RARE, samples, 0, vec3(5.0f, 1.0f, 1.0f));
        int64_t own[PIXELS];
        for (int i = 0; i < PIXELS; ++i) {
            own[i] = film.rare_sums[3 * i];
            film.light_sums[3 * i] += (int64_t)(i + 1) << 30;
        }
        film.rare_sums[3] = (int64_t)SUM_FULL;
        film.threads = 1 + _i % 3;
        film_normalize_bidirectional(&film, divides ? samples : 0);
        for (int i = 0; i < PIXELS; ++i) {
            double light = (i + 1) * 0x1p30 + (divides ? 5.0 * samples * 0x1p30 : (double)own[i]);
            if (i != 1)
                TEST_NEAR((double)film.light_sums[3 * i] / light, 1.0, 1e-6);
            TEST_NEAR((double)film.sums[3 * i] / 0x1p30, divides ? 3.0 * samples : 0.0, 1e-5);
            ck_assert_uint_eq(film_count(&film, (size_t)i), divides ? samples * SPREAD_PARTS : 0);
            ck_assert_int_eq(film.rare_sums[3 * i], 0);
        }
        if (divides)
            TEST_TRUE(film.light_sums[3] == (int64_t)SUM_FULL);
        teardown(&f, &film);
    }
}
END_TEST

/* More samples of direct light in the same film: all of them are divided by their number near the pixel, and what is
 * new in other layers by that of the new ones. */
START_TEST(test_normalized_again)
{
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    const uint before = 2, samples = 3;
    LightFixture f;
    Film film;
    if (signed_filter(s))
        return;
    for (int spread = 0; spread < 2; ++spread) {
        setup(&f, s, spread ? RECONSTRUCTION_SPLAT : RECONSTRUCTION_SAMPLE, &film);
        samples_add(&f, &film, SPLAT_SAMPLE, before, 0, vec3(4.0f, 1.0f, 1.0f));
        samples_add(&f, &film, SPLAT_LIGHT | SPLAT_RARE, before, 0, vec3(5.0f, 1.0f, 1.0f));
        film_normalize_bidirectional(&film, before);
        film_pixels_clear_light(&film, 0, PIXELS);
        samples_add(&f, &film, SPLAT_SAMPLE, samples, before, vec3(4.0f, 1.0f, 1.0f));
        samples_add(&f, &film, SPLAT_LIGHT, samples, before, vec3(6.0f, 1.0f, 1.0f));
        film_normalize(&film, samples);
        for (int i = 0; i < PIXELS && spread; ++i) {
            ck_assert_uint_eq(film_count(&film, (size_t)i), (before + samples) * SPREAD_PARTS);
            TEST_NEAR((double)film.sums[3 * i] / 0x1p30, 4.0 * (before + samples), 1e-5);
            TEST_NEAR((double)film.light_sums[3 * i] / 0x1p30, 6.0 * samples, 1e-5);
        }
        for (int i = 0; i < PIXELS && !spread; ++i) /* pixels have their own samples, as many as are counted */
            TEST_NEAR((double)film.sums[3 * i] / 0x1p30, 4.0 * film_count(&film, (size_t)i), 1e-5);
        teardown(&f, &film);
    }
}
END_TEST

/* What is left of the variance along an axis: the integral of f^2 at every pixel, where a draw has
 * that of f times the sum of all pixels' f. */
static double variance_left(const FilmAxis *axis)
{
    enum { N = 40000 };
    double low = (double)axis->begin - (double)axis->radius,
           wide = axis->end - axis->begin + 2.0 * (double)axis->radius;
    double spread = 0.0, drawn = 0.0;
    for (int i = 0; i < N; ++i) {
        double place = low + wide * (i + 0.5) / N, sum = 0.0;
        for (uint x = axis->begin; x < axis->end; ++x) {
            double density = density_at(axis, place - x - 0.5);
            spread += density * density;
            sum += density;
        }
        drawn += sum * sum;
    }
    return spread / drawn;
}

enum { BATCHES = 24, BATCH = 20000 };

/* Splats at positions that are uniform in and around the crop, in batches: each pixel's mean and the variance of a
 * batch. */
static void uniform_render(const FilterSettings *s, uint reconstruction, double *mean, double *variance, double *left)
{
    LightFixture f;
    Film film;
    double squares[PIXELS] = {0.0};
    float wide = COLUMNS + 2.0f * s->radius_x, high = ROWS + 2.0f * s->radius_y;
    setup(&f, s, reconstruction, &film);
    memset(mean, 0, PIXELS * sizeof *mean);
    for (uint k = 0; k < BATCHES; ++k) {
        film_clear(&film);
        for (uint i = k * BATCH; i < (k + 1) * BATCH; ++i) {
            Vec2 r = fixture_random(1, i);
            Vec2 place = vec2(X0 - s->radius_x + r.x * wide, Y0 - s->radius_y + r.y * high);
            float weight;
            uint pixel = film_splat_pixel(&f.view, place, fixture_random(3, i), &weight);
            if (pixel != NONE)
                splat_add(&f, &film, SPLAT_LIGHT, pixel, place, vec3(weight * wide * high, 0.0f, 0.0f));
        }
        for (int i = 0; i < PIXELS; ++i) {
            double value = (double)film.light_sums[3 * i] * 0x1p-30 / BATCH;
            mean[i] += value / BATCHES;
            squares[i] += value * value / BATCHES;
        }
    }
    for (int i = 0; i < PIXELS; ++i)
        variance[i] = (squares[i] - mean[i] * mean[i]) * BATCHES / (BATCHES - 1);
    *left = variance_left(&film.axis_x) * variance_left(&film.axis_y);
    teardown(&f, &film);
}

/* Every pixel gets 1, at the border, too; and the variance is that of f(x) at positions x instead of that of a draw. */
START_TEST(test_uniform)
{
    const FilterSettings *s = &FILTER_CASES[_i].settings;
    double means[2][PIXELS], variances[2][PIXELS], all[2] = {0.0, 0.0}, expected;
    uniform_render(s, RECONSTRUCTION_SAMPLE, means[0], variances[0], &expected);
    uniform_render(s, RECONSTRUCTION_SPLAT, means[1], variances[1], &expected);
    for (int i = 0; i < PIXELS; ++i) {
        double error = sqrt(variances[1][i] / BATCHES);
        TEST_NEAR(means[1][i], 1.0, 5.0 * error + 1e-9); /* Student's test, 23 degrees of freedom: p = 5e-5 */
        for (int k = 0; k < 2; ++k)
            all[k] += variances[k][i];
    }
    if (!signed_filter(s)) /* of the others, draws differ in sign, and the mean's square is no small part */
        TEST_NEAR(all[1] / all[0], expected, 0.2 * expected);
    TEST_TRUE(all[1] < 1.05 * all[0]);
}
END_TEST

/* Films that spread splats merge with each other alone, count samples in parts, and hold fewer. */
START_TEST(test_merge)
{
    LightFixture f, g;
    Film a, b;
    Error error;
    float rgb[3 * PIXELS];
    setup(&f, &FILTER_CASES[FILTER_GAUSSIAN].settings, RECONSTRUCTION_SPLAT, &a);
    setup(&g, &FILTER_CASES[FILTER_GAUSSIAN].settings, RECONSTRUCTION_SAMPLE, &b);
    ck_assert(!film_merge(&a, &b, &error));
    film_destroy(&b);
    ck_assert(film_init_like(&b, &a, &error));
    samples_add(&f, &a, SPLAT_SAMPLE, 2, 0, vec3(1.0f, 1.0f, 1.0f));
    samples_add(&f, &b, SPLAT_SAMPLE, 1, 1000, vec3(4.0f, 4.0f, 4.0f));
    samples_add(&f, &b, SPLAT_LIGHT, 6, 1000, vec3(1.0f, 1.0f, 1.0f));
    ck_assert(film_merge(&a, &b, &error));
    film_resolve_part(&a, FILM_OWN, 1.0f, rgb);
    double mean = 0.0;
    for (int i = 0; i < PIXELS; ++i)
        mean += (double)rgb[3 * i] / PIXELS;
    TEST_NEAR(mean, 2.0, 0.1);
    film_resolve_part(&a, FILM_LIGHT, 1.0f, rgb); /* 6 splats per pixel over 3 samples per pixel */
    mean = 0.0;
    for (int i = 0; i < PIXELS; ++i)
        mean += (double)rgb[3 * i] / PIXELS;
    TEST_NEAR(mean, 2.0, 1e-5);
    a.counts[0] = UINT32_MAX;
    ck_assert(!film_merge(&a, &b, &error));
    ck_assert_uint_eq(film_samples_most(RECONSTRUCTION_SAMPLE), UINT32_MAX);
    ck_assert_uint_lt(film_samples_most(RECONSTRUCTION_SPLAT) * SPREAD_PARTS, UINT32_MAX);
    ck_assert_uint_gt(film_samples_most(RECONSTRUCTION_SPLAT), 1u << 23);
    teardown(&f, &a);
    teardown(&g, &b);
}
END_TEST

/* Contributions beyond UNITS_SMALL are not kept back, and full sums stay full; a color that is not finite counts as a
 * black sample. */
START_TEST(test_extremes)
{
    LightFixture f;
    Film film;
    float weight;
    setup(&f, &FILTER_CASES[FILTER_BOX + 1].settings, RECONSTRUCTION_SPLAT, &film);
    Vec2 place = place_draw(&f, 2, 5, 1, 1, &weight);
    for (int k = 0; k < 3; ++k)
        splat_add(&f, &film, SPLAT_SAMPLE, 5 * WIDTH + 2, place, vec3(1e30f, 0x1p12f, 0.0f));
    ck_assert_uint_eq(film.saturated, 3);
    int64_t most = 0, second = 0;
    uint64_t counts = 0;
    for (int i = 0; i < PIXELS; ++i) {
        most = film.sums[3 * i] > most ? film.sums[3 * i] : most;
        second += film.sums[3 * i + 1];
    }
    ck_assert_int_gt(most, (int64_t)1 << 60);
    ck_assert_int_eq(second, (int64_t)3 << 42);
    film_clear(&film);
    splat_add(&f, &film, SPLAT_SAMPLE, 5 * WIDTH + 2, place, vec3(NAN, 1.0f, 1.0f));
    ck_assert_uint_eq(film.not_finite, 1);
    for (int i = 0; i < PIXELS; ++i) {
        counts += film.counts[i];
        ck_assert_int_eq(film.sums[3 * i + 1], 0);
    }
    ck_assert_uint_eq(counts, SPREAD_PARTS);
    teardown(&f, &film);
}
END_TEST

/* Splats that come together in a buffer add up to the same as one by one. */
START_TEST(test_together)
{
    enum { SPLATS = 1500 };
    static uint words[SPLAT_WORDS * SPLATS];
    LightFixture f, g;
    Film one, all;
    setup(&f, &FILTER_CASES[FILTER_GAUSSIAN].settings, RECONSTRUCTION_SPLAT, &one);
    setup(&g, &FILTER_CASES[FILTER_GAUSSIAN].settings, RECONSTRUCTION_SPLAT, &all);
    for (uint k = 0; k < SPLATS; ++k) {
        static const uint NAMES[] = {SPLAT_SAMPLE, SPLAT_LIGHT, SPLAT_LIGHT | SPLAT_RARE, SPLAT_RARE};
        uint x = X0 + k * 7 % COLUMNS, y = Y0 + k * 3 % ROWS, name = NAMES[k % 4] | splat_depth(3, 3 + k % 3);
        float weight;
        Vec2 place = place_draw(&f, x, y, 1, k, &weight);
        Vec3 color = vec3(k % 97 == 0 ? 0x1p20f : 0.1f * (float)k, -1.0f, 1e-3f);
        splat_add(&f, &one, name, y * WIDTH + x, place, color);
        state_store(words, SPLATS, SPLAT_PIXEL, k, name | (y * WIDTH + x));
        state_store_vec3(words, SPLATS, SPLAT_COLOR, k, color);
        state_store(words, SPLATS, SPLAT_OFFSET, k, splat_offset(&f.scene.frame.film, y * WIDTH + x, place));
    }
    film_add_splats(&all, words, SPLATS, SPLATS);
    size_t bytes = 3 * PIXELS * sizeof *one.sums;
    ck_assert_mem_eq(one.sums, all.sums, bytes);
    ck_assert_mem_eq(one.light_sums, all.light_sums, bytes);
    ck_assert_mem_eq(one.rare_sums, all.rare_sums, bytes);
    ck_assert_mem_eq(one.counts, all.counts, PIXELS * sizeof *one.counts);
    ck_assert_mem_eq(one.depth_sums, all.depth_sums, film_depth_words(PIXELS, 3, 4) * sizeof *one.depth_sums);
    teardown(&f, &one);
    teardown(&g, &all);
}
END_TEST

/* Rare light is in its own sums and in the others, in films without depths, too. */
START_TEST(test_rare)
{
    LightFixture f;
    Film film;
    setup(&f, &FILTER_CASES[FILTER_GAUSSIAN].settings, RECONSTRUCTION_SPLAT, &film);
    film.depth_kinds = 0;
    samples_add(&f, &film, SPLAT_SAMPLE | SPLAT_RARE, 2, 0, vec3(1.0f, 2.0f, 3.0f));
    size_t bytes = 3 * PIXELS * sizeof *film.sums;
    ck_assert_int_gt(film.sums[0], 0);
    ck_assert_mem_eq(film.sums, film.rare_sums, bytes);
    film_clear(&film);
    samples_add(&f, &film, SPLAT_LIGHT | SPLAT_RARE, 2, 0, vec3(1.0f, 2.0f, 3.0f));
    ck_assert_int_gt(film.light_sums[0], 0);
    ck_assert_mem_eq(film.light_sums, film.rare_sums, bytes);
    teardown(&f, &film);
}
END_TEST

TCase *film_spread_tcase(void)
{
    TCase *tcase = tcase_create("spread");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_shares, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_constant, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_normalized_bidirectional, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_normalized_again, 0, FILTER_CASE_COUNT);
    tcase_add_loop_test(tcase, test_normalized, 0, FILTER_CASE_COUNT);
    tcase_add_test(tcase, test_normalized_merge);
    tcase_add_test(tcase, test_merge);
    tcase_add_test(tcase, test_extremes);
    tcase_add_test(tcase, test_together);
    tcase_add_test(tcase, test_rare);
    return tcase;
}

TCase *film_uniform_tcase(void)
{
    TCase *tcase = tcase_create("uniform");
    tcase_set_timeout(tcase, 120);
    tcase_set_tags(tcase, "pictures");
    tcase_add_loop_test(tcase, test_uniform, 0, FILTER_CASE_COUNT);
    return tcase;
}
