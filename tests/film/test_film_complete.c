/* Complete samples, whose own sums hold all of their light, beside samples whose light is partly in the light sums. */
#include "film/test_film.h"

#include "camera/film_spread.h"

enum { WIDTH = 7, HEIGHT = 5, PIXELS = WIDTH * HEIGHT, VALUES = 3 * PIXELS };

static const int CROP[4] = {0, 0, WIDTH, HEIGHT};

/* Direct light of a value of the image, and the rest. */
static double direct_at(int value)
{
    return 0.5 + 0.1 * (value % 11);
}

static double rest_at(int value)
{
    return 0.25 + 0.05 * (value % 7);
}

/* A film whose pixels have `samples` each, with direct light and, in light sums that count as `light_samples` per
 * pixel, the rest; complete samples if that is 0. */
static void film_of_samples(Film *film, uint reconstruction, unsigned samples, unsigned light_samples)
{
    Error error;
    ck_assert(film_init(film, WIDTH, HEIGHT, CROP, &error));
    ck_assert(film_light_reserve(film, &error));
    film->reconstruction = reconstruction;
    film->every_count = samples * film_sample_units(reconstruction);
    film->light_samples = (uint64_t)light_samples * PIXELS;
    film->complete_samples = light_samples == 0 ? (uint64_t)samples * PIXELS : 0;
    for (int i = 0; i < VALUES; ++i) {
        double own = direct_at(i) + (light_samples == 0 ? rest_at(i) : 0.0);
        film->sums[i] = llrint(ldexp(own * samples, -film->quantum_exponent));
        film->light_sums[i] = llrint(ldexp(rest_at(i) * light_samples, -film->quantum_exponent));
    }
}

static void film_check(const Film *film)
{
    float rgb[VALUES], parts[VALUES];
    film_resolve(film, 1.0f, rgb);
    for (int i = 0; i < VALUES; ++i)
        TEST_NEAR((double)rgb[i], direct_at(i) + rest_at(i), 1e-6);
    film_resolve_part(film, FILM_LIGHT, 1.0f, rgb);
    film_resolve_part(film, FILM_OWN, 1.0f, parts);
    double split = 1.0 - (double)film->complete_samples / (double)film_samples(film);
    for (int i = 0; i < VALUES; ++i) {
        TEST_NEAR((double)rgb[i], split * rest_at(i), 1e-6);
        TEST_NEAR((double)parts[i], direct_at(i) + (1.0 - split) * rest_at(i), 1e-6);
    }
}

/* Any number of each, in any order, whatever the light sums count. */
START_TEST(test_merged)
{
    static const unsigned SAMPLES[][2] = {{2, 1}, {3, 0}, {1, 7}, {5, 0}, {4, 3}};
    const int count = sizeof SAMPLES / sizeof SAMPLES[0];
    for (int first = 0; first < count; ++first) {
        Film film;
        uint64_t complete = 0, all = 0;
        film_of_samples(&film, (uint)_i, SAMPLES[first][0], SAMPLES[first][1]);
        film_check(&film);
        for (int i = 0; i < count; ++i) {
            Film part;
            Error error;
            film_of_samples(&part, (uint)_i, SAMPLES[i][0], SAMPLES[i][1]);
            ck_assert(i == first || film_merge(&film, &part, &error));
            all += SAMPLES[i][0];
            complete += SAMPLES[i][1] == 0 ? SAMPLES[i][0] : 0;
            film_destroy(&part);
        }
        film_check(&film);
        ck_assert_uint_eq(film_samples(&film), all * PIXELS);
        ck_assert_uint_eq(film.complete_samples, complete * PIXELS);
        film_clear(&film);
        ck_assert_uint_eq(film.complete_samples, 0);
        film_destroy(&film);
    }
}
END_TEST

/* A part of the light sums is exchanged for another, which counts as more samples or as fewer. */
START_TEST(test_light_add)
{
    for (int more = -1; more <= 1; ++more) {
        Film film, later;
        Error error;
        float change[VALUES];
        film_of_samples(&film, (uint)_i, 6, 2);
        film_of_samples(&later, (uint)_i, 3, 0);
        for (int i = 0; i < VALUES; ++i) {
            int64_t wrong = llrint(ldexp(0.125 * (i % 5), -film.quantum_exponent));
            change[i] = (float)(ldexp(more * rest_at(i), -film.quantum_exponent) - (double)wrong);
            film.light_sums[i] += wrong;
        }
        film_light_add(&film, change, (int64_t)more * PIXELS);
        ck_assert_uint_eq(film.light_samples, (uint64_t)(2 + more) * PIXELS);
        film_check(&film);
        ck_assert(film_merge(&film, &later, &error));
        film_check(&film);
        film_destroy(&film);
        film_destroy(&later);
    }
}
END_TEST

/* Full sums stay full. */
START_TEST(test_light_add_full)
{
    Film film;
    float change[VALUES] = {0x1p62f, -0x1p40f};
    film_of_samples(&film, RECONSTRUCTION_SAMPLE, 1, 1);
    film.light_sums[1] = (int64_t)SUM_FULL;
    film_light_add(&film, change, 0);
    ck_assert_uint_eq(film_full_pixels(&film), 1);
    ck_assert_int_eq(film.light_sums[0], (int64_t)SUM_FULL);
    film_destroy(&film);
}
END_TEST

TCase *film_complete_tcase(void)
{
    TCase *tcase = tcase_create("complete");
    tcase_add_loop_test(tcase, test_merged, RECONSTRUCTION_SAMPLE, RECONSTRUCTION_SPLAT + 1);
    tcase_add_loop_test(tcase, test_light_add, RECONSTRUCTION_SAMPLE, RECONSTRUCTION_SPLAT + 1);
    tcase_add_test(tcase, test_light_add_full);
    return tcase;
}
