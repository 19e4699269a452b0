/* Single contributions: their rounding to units of the film, the largest and smallest, the crop; and which films there
 * can be. */
#include "film/test_film.h"

/* Ties round away from zero; the default quantum is 2^-30. */
START_TEST(test_rounding)
{
    const float values[] = {0x1p-31f, -0x1p-31f, 0x1.fffffep-32f, -0x1.fffffep-32f, 0x1.8p-30f, 1.0f, -0.0f, 1e-45f};
    const int64_t expected[] = {1, -1, 0, 0, 2, 1 << 30, 0, 0};
    for (int i = 0; i < 8; ++i) {
        Film film = film_make(4, 3, CROP_WHOLE);
        film_add_one(&film, 5, values[i], 0.0f, values[i]);
        ck_assert_int_eq(film.sums[15], expected[i]);
        ck_assert_int_eq(film.sums[17], expected[i]);
        film_destroy(&film);
    }
}
END_TEST

/* Integer rounding against double arithmetic, which is exact here: a float has 24 bits and the scale is a power of
 * two. */
static void units_compare(uint bits, int exponent)
{
    float value = bits_float(bits);
    double exact = ldexp(fabs((double)value), -exponent), most = value < 0.0f ? 0x1p48 : 0x1p62;
    bool clamped, more = exact > most;
    ulong units = film_units(value, exponent, &clamped);
    TEST_TRUE(clamped == more && units == (ulong)floor((more ? most : exact) + 0.5));
}

START_TEST(test_units_of_any_float)
{
    uint state = 1;
    for (int exponent = -200; exponent <= 110; ++exponent) {
        for (uint field = 0; field < 255; ++field) { /* around every power of two, and in between */
            units_compare(field << 23, exponent);
            units_compare(field << 23 | 1u, exponent);
            units_compare(field << 23 | 0x7fffffu, exponent);
            units_compare(field << 23 | 0x400000u | 0x80000000u, exponent);
            state = state * 1664525u + 1013904223u;
            units_compare(field << 23 | state >> 9, exponent);
        }
    }
}
END_TEST

START_TEST(test_saturation)
{
    Film film = film_make(4, 3, CROP_WHOLE);
    film_add_one(&film, 0, 1e30f, 1.0f, -FLOAT_MAX);
    ck_assert_uint_eq(film.saturated, 1);
    ck_assert_int_eq(film.sums[0], (int64_t)1 << 62);
    ck_assert_int_eq(film.sums[1], 1 << 30);
    ck_assert_int_eq(film.sums[2], -((int64_t)1 << 48));
    film_add_one(&film, 1, 0x1p32f, 0.0f, 0.0f); /* 2^62 units, the largest value that is not clamped */
    ck_assert_uint_eq(film.saturated, 1);
    film_destroy(&film);
}
END_TEST

/* Contributions that are not black but below half a unit in every channel count as vanished; others do not. */
START_TEST(test_vanished)
{
    Film film = film_make(4, 3, CROP_WHOLE);
    film_add_one(&film, 1, 0x1p-32f, 0.0f, -1e-45f);
    ck_assert_uint_eq(film.vanished, 1);
    film_add_one(&film, 1, 0x1p-32f, 0x1p-31f, 0.0f);
    film_add_one(&film, 1, 0.0f, -0.0f, 0.0f);
    film_add_one(&film, 1, NAN, 0x1p-32f, 0.0f);
    film_add_one(&film, 99, 0x1p-32f, 0.0f, 0.0f);
    ck_assert_uint_eq(film.vanished, 1);
    film_clear(&film);
    ck_assert_uint_eq(film.vanished, 0);
    film_destroy(&film);
}
END_TEST

START_TEST(test_not_finite_counts_as_zero)
{
    Film film = film_make(4, 3, CROP_WHOLE);
    float rgb[36];
    film_add_one(&film, 7, NAN, 1.0f, 1.0f);
    film_add_one(&film, 7, 1.0f, INFINITY, 1.0f);
    film_add_one(&film, 7, 1.0f, 1.0f, -INFINITY);
    film_add_one(&film, 7, 4.0f, 2.0f, 1.0f);
    ck_assert_uint_eq(film.not_finite, 3);
    ck_assert_uint_eq(film.counts[7], 4);
    film_resolve(&film, 2.0f, rgb);
    ck_assert_float_eq(rgb[21], 2.0f);
    ck_assert_float_eq(rgb[22], 1.0f);
    ck_assert_float_eq(rgb[23], 0.5f);
    ck_assert_float_eq(rgb[0], 0.0f);
    film_destroy(&film);
}
END_TEST

START_TEST(test_crop)
{
    const int crop[4] = {1, 1, 3, 2};
    Film film = film_make(4, 3, crop);
    for (uint pixel = 0; pixel < 14; ++pixel)
        film_add_one(&film, pixel, 1.0f + (float)pixel, 0.0f, 0.0f);
    film_add_one(&film, NONE, 1.0f, 1.0f, 1.0f);
    float rgb[6];
    film_resolve(&film, 1.0f, rgb);
    ck_assert_float_eq(rgb[0], 6.0f);
    ck_assert_float_eq(rgb[3], 7.0f);
    ck_assert_uint_eq(film.counts[0] + film.counts[1], 2);
    film_destroy(&film);
}
END_TEST

/* The parts of a device's buffer (film_view_words) do not overlap, also for an odd number of pixels, and fit
 * film_words. */
START_TEST(test_buffer)
{
    static ulong words[1024];
    for (uint pixels = 1; pixels < 10; ++pixels) {
        FilmView view = {.depth_kinds = 3};
        film_view_words(&view, words, pixels);
        ck_assert_ptr_eq(view.sums, words);
        ck_assert(view.saturated >= view.sums + 3 * pixels);
        ck_assert(view.vanished > view.saturated && view.not_finite > view.vanished);
        ck_assert((void *)view.counts >= (void *)(view.not_finite + 1));
        ck_assert((void *)view.light_sums >= (void *)(view.counts + pixels));
        ck_assert(view.rare_sums >= view.light_sums + 3 * pixels);
        ck_assert(view.depth_sums >= view.rare_sums + 3 * pixels);
        ck_assert_ptr_eq(view.depth_sums, words + film_words(pixels, 2));
    }
}
END_TEST

START_TEST(test_quantum)
{
    const double means[] = {1.0, 0.75, 1.5, 1e-40, 1e30, 0.0, -1.0, NAN, INFINITY};
    const int expected[] = {-26, -27, -26, -159, 73, -30, -30, -30, -30};
    Film film = film_make(4, 3, CROP_WHOLE);
    for (int i = 0; i < 9; ++i) {
        film_quantum_set(&film, means[i]);
        ck_assert_int_eq(film.quantum_exponent, expected[i]);
    }
    film_quantum_set(&film, 1e30);
    film_add_one(&film, 0, 1e30f, 3e30f, 1e10f);
    float rgb[36];
    film_resolve(&film, 1.0f, rgb);
    ck_assert_float_eq_tol(rgb[0], 1e30f, 1e23f);
    ck_assert_float_eq_tol(rgb[1], 3e30f, 3e23f);
    film_destroy(&film);
}
END_TEST

START_TEST(test_merge_refuses_other_films)
{
    const int crop[4] = {0, 0, 3, 3};
    Error error;
    Film film = film_make(4, 3, CROP_WHOLE), wide = film_make(5, 3, CROP_WHOLE), cropped = film_make(4, 3, crop);
    Film coarse = film_make(4, 3, CROP_WHOLE), full = film_make(4, 3, CROP_WHOLE);
    coarse.quantum_exponent = -20;
    film.counts[3] = 2;
    full.counts[3] = UINT32_MAX - 1;
    ck_assert(!film_merge(&film, &wide, &error));
    ck_assert_str_eq(error.message, "error: films of different sizes cannot be merged: 4 x 3 and 5 x 3");
    ck_assert(!film_merge(&film, &cropped, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "0,0,4,3 and 0,0,3,3"));
    ck_assert(!film_merge(&film, &coarse, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "2^-30 and 2^-20"));
    ck_assert(!film_merge(&film, &full, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "4294967295 samples"));
    Film *films[] = {&film, &wide, &cropped, &coarse, &full};
    for (int i = 0; i < 5; ++i)
        film_destroy(films[i]);
}
END_TEST

START_TEST(test_init_refuses)
{
    const int crops[][4] = {{2, 0, 2, 3}, {0, 0, 5, 3}, {-1, 0, 4, 3}, {0, 3, 4, 3}};
    Film film;
    Error error;
    for (int i = 0; i < 4; ++i)
        ck_assert(!film_init(&film, 4, 3, crops[i], &error));
    ck_assert(!film_init(&film, 0, 3, CROP_WHOLE, &error));
    const int huge[4] = {0, 0, 1, 1};
    ck_assert(!film_init(&film, 70000, 70000, huge, &error));
    film_destroy(&film);
}
END_TEST

TCase *film_units_tcase(void)
{
    TCase *tcase = tcase_create("units");
    tcase_add_test(tcase, test_rounding);
    tcase_add_test(tcase, test_units_of_any_float);
    tcase_add_test(tcase, test_saturation);
    tcase_add_test(tcase, test_vanished);
    tcase_add_test(tcase, test_not_finite_counts_as_zero);
    tcase_add_test(tcase, test_crop);
    tcase_add_test(tcase, test_buffer);
    tcase_add_test(tcase, test_quantum);
    tcase_add_test(tcase, test_merge_refuses_other_films);
    tcase_add_test(tcase, test_init_refuses);
    return tcase;
}
