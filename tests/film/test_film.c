#include "film/test_film.h"

#include "base/zeros.h"
#include "camera/film_spread.h"

#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* 0.3 added 2^30 times: in float32 the sum stops at 8,388,608. Merging with a copy doubles both sum and count. */
START_TEST(test_billion_additions_exact)
{
    const int crop[4] = {0, 0, 1, 1};
    Error error;
    Film film = film_make(1, 1, crop), copy = film_make(1, 1, crop);
    int64_t unit = (int64_t)floor((double)0.3f * 0x1p30 + 0.5);
    for (int i = 0; i < 1 << 14; ++i)
        film_add_one(&film, 0, 0.3f, -0.3f, 0.0f);
    for (int i = 14; i < 30; ++i) {
        for (int c = 0; c < 3; ++c)
            copy.sums[c] = film.sums[c];
        copy.counts[0] = film.counts[0];
        ck_assert(film_merge(&film, &copy, &error));
    }
    ck_assert_int_eq(film.sums[0], unit << 30);
    ck_assert_int_eq(film.sums[1], -(unit << 30));
    ck_assert_int_eq(film.sums[2], 0);
    ck_assert_uint_eq(film.counts[0], 1u << 30);
    ck_assert_uint_eq(film.saturated, 0);
    float rgb[3];
    film_resolve(&film, 1.0f, rgb);
    ck_assert_double_eq_tol((double)rgb[0], (double)0.3f, 0x1p-31);
    film_destroy(&film);
    film_destroy(&copy);
}
END_TEST

/* The long test actually adds 10^9 times, some of them in one call. */
START_TEST(test_billion_additions_made)
{
    enum { BATCH = 4000, BATCHES = 250000 };
    static uint splats[SPLAT_WORDS * BATCH];
    const int crop[4] = {0, 0, 1, 1};
    if (test_effort() == 1)
        return;
    Film film = film_make(1, 1, crop);
    for (uint t = 0; t < BATCH; ++t)
        splat_set(splats, BATCH, t, 0, 0.3f, -0.3f, 1e-3f);
    for (int i = 0; i < BATCHES; ++i)
        film_add_splats(&film, splats, BATCH, BATCH);
    ck_assert_int_eq(film.sums[0], 1000000000 * (int64_t)floor((double)0.3f * 0x1p30 + 0.5));
    ck_assert_int_eq(film.sums[1], -film.sums[0]);
    ck_assert_int_eq(film.sums[2], 1000000000 * (int64_t)floor((double)1e-3f * 0x1p30 + 0.5));
    ck_assert_uint_eq(film.counts[0], 1000000000);
    film_destroy(&film);
}
END_TEST

#define SPLATS 40000u
#define THREADS 4u

typedef struct ThreadJob {
    Film *film;
    const uint *splats;
    uint count;
} ThreadJob;

static void *thread_add(void *argument)
{
    const ThreadJob *job = argument;
    film_add_splats(job->film, job->splats, job->count, SPLATS);
    return NULL;
}

/* Splats over twelve orders of magnitude with both signs, from a linear congruential generator. */
static void splats_fill(uint *splats)
{
    uint state = 1;
    for (uint t = 0; t < SPLATS; ++t) {
        float rgb[3];
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            rgb[c] = ldexpf((float)(int)state / 0x1p31f, (int)(state >> 3) % 40 - 30);
        }
        splat_set(splats, SPLATS, t, (state >> 7) % 13 == 12 ? NONE : (state >> 7) % 13, rgb[0], rgb[1], rgb[2]);
    }
}

/* Item t of the shuffled buffer is item 12347 t mod SPLATS of the original (the two are coprime). */
static void splats_shuffle(const uint *splats, uint *shuffled)
{
    for (uint t = 0; t < SPLATS; ++t)
        for (uint f = 0; f < SPLAT_WORDS; ++f)
            state_store(shuffled, SPLATS, f, t, state_load(splats, SPLATS, f, (uint)((uint64_t)t * 12347 % SPLATS)));
}

static void films_compare(const Film *a, const Film *b)
{
    ck_assert_mem_eq((const void *)a->sums, (const void *)b->sums, 12 * 3 * sizeof *a->sums);
    ck_assert_mem_eq((const void *)a->counts, (const void *)b->counts, 12 * sizeof *a->counts);
    ck_assert_uint_eq(a->saturated, b->saturated);
}

START_TEST(test_order_does_not_matter)
{
    uint *splats = malloc(SPLATS * SPLAT_WORDS * sizeof *splats), *shuffled = malloc(SPLATS * SPLAT_WORDS * 4);
    splats_fill(splats);
    splats_shuffle(splats, shuffled);
    Film one = film_make(4, 3, CROP_WHOLE), two = film_make(4, 3, CROP_WHOLE), many = film_make(4, 3, CROP_WHOLE);
    film_add_splats(&one, splats, SPLATS, SPLATS);
    film_add_splats(&two, shuffled, SPLATS, SPLATS);
    pthread_t threads[THREADS];
    ThreadJob jobs[THREADS];
    for (uint i = 0; i < THREADS; ++i) {
        jobs[i] = (ThreadJob){&many, shuffled + i * (SPLATS / THREADS), SPLATS / THREADS};
        pthread_create(&threads[i], NULL, thread_add, &jobs[i]);
    }
    for (uint i = 0; i < THREADS; ++i)
        pthread_join(threads[i], NULL);
    films_compare(&one, &two);
    films_compare(&one, &many);
    ck_assert_int_ne(one.sums[0], 0);
    film_destroy(&one);
    film_destroy(&two);
    film_destroy(&many);
    free(splats);
    free(shuffled);
}
END_TEST

START_TEST(test_merge_equals_one_film)
{
    uint *splats = malloc(SPLATS * SPLAT_WORDS * sizeof *splats);
    Error error;
    splats_fill(splats);
    Film whole = film_make(4, 3, CROP_WHOLE), first = film_make(4, 3, CROP_WHOLE), rest = film_make(4, 3, CROP_WHOLE);
    film_add_splats(&whole, splats, SPLATS, SPLATS);
    film_add_splats(&first, splats, 12345, SPLATS);
    film_add_splats(&rest, splats + 12345, SPLATS - 12345, SPLATS);
    ck_assert(film_merge(&first, &rest, &error));
    films_compare(&whole, &first);
    film_destroy(&whole);
    film_destroy(&first);
    film_destroy(&rest);
    free(splats);
}
END_TEST

/* Large films are merged and cleared by several threads; some sums are full, and stay so. Parts of a film are cleared,
 * too. */
START_TEST(test_threads)
{
    enum { WIDTH = 300, HEIGHT = 250, PIXELS = WIDTH * HEIGHT };
    const int whole[4] = {0, 0, WIDTH, HEIGHT};
    Error error = {0};
    Film films[2], sum[2];
    for (int i = 0; i < 2; ++i) {
        films[i] = film_make(WIDTH, HEIGHT, whole);
        sum[i] = film_make(WIDTH, HEIGHT, whole);
        ck_assert_int_eq(sum[i].threads, 1);
        ck_assert(film_light_reserve(&films[i], &error) && film_light_reserve(&sum[i], &error));
        for (size_t c = 0; c < 3 * PIXELS; ++c) {
            films[i].sums[c] = (int64_t)(c * (size_t)(i + 3) % 1009) - 500;
            films[i].light_sums[c] = c % 97 == 0 ? INT64_MAX : c % 89 == 0 && i == 0 ? -INT64_MAX : (int64_t)c;
            films[i].counts[c / 3] = (uint32_t)(c % 11);
        }
    }
    sum[1].threads = 3;
    for (int i = 0; i < 2; ++i)
        ck_assert(film_merge(&sum[i], &films[0], &error) && film_merge(&sum[i], &films[1], &error));
    for (size_t c = 0; c < 3 * PIXELS; ++c) {
        bool full = c % 97 == 0 || c % 89 == 0;
        TEST_TRUE(sum[1].sums[c] == films[0].sums[c] + films[1].sums[c]);
        TEST_TRUE(sum[1].light_sums[c] == (full ? films[0].light_sums[c] : (int64_t)(2 * c)));
        TEST_TRUE(sum[1].counts[c / 3] == films[0].counts[c / 3] + films[1].counts[c / 3]);
        TEST_TRUE(sum[0].sums[c] == sum[1].sums[c] && sum[0].light_sums[c] == sum[1].light_sums[c]);
    }
    film_pixels_clear(&sum[0], 5, 8);
    film_clear(&sum[1]);
    for (size_t c = 0; c < 3 * PIXELS; ++c) {
        bool cleared = c >= 15 && c < 24;
        TEST_TRUE(sum[0].light_sums[c] == (cleared                      ? 0
                                           : c % 97 == 0 || c % 89 == 0 ? films[0].light_sums[c]
                                                                        : (int64_t)(2 * c)));
        TEST_TRUE(sum[0].sums[c] == (cleared ? 0 : films[0].sums[c] + films[1].sums[c]));
        TEST_TRUE(sum[1].sums[c] == 0 && sum[1].light_sums[c] == 0 && sum[1].counts[c / 3] == 0);
    }
    for (int i = 0; i < 2; ++i) {
        film_destroy(&films[i]);
        film_destroy(&sum[i]);
    }
}
END_TEST

/* Splats of rare paths go to the total sums and to sums of their own; a film initialised like this one lacks the
 * latter, and merging leaves them unchanged. */
START_TEST(test_rare)
{
    Error error = {0};
    Film film = film_make(4, 3, CROP_WHOLE), other;
    ck_assert(film_light_reserve(&film, &error) && film_rare_reserve(&film, &error));
    ck_assert(film_init_like(&other, &film, &error));
    ck_assert_ptr_null(other.rare_sums);
    film_add_one(&film, 5 | SPLAT_LIGHT, 1.0f, 1.0f, 1.0f);
    film_add_one(&film, 5 | SPLAT_LIGHT | SPLAT_RARE, 2.0f, 3.0f, 4.0f);
    film_add_one(&film, 5 | SPLAT_RARE, 8.0f, 8.0f, 8.0f);
    film_add_one(&film, NONE, 8.0f, 8.0f, 8.0f);
    ck_assert_int_eq(film.light_sums[15], (int64_t)3 << 30);
    ck_assert_int_eq(film.sums[15], (int64_t)8 << 30);
    ck_assert_int_eq(film.rare_sums[15], (int64_t)10 << 30);
    ck_assert_int_eq(film.rare_sums[16], (int64_t)11 << 30);
    ck_assert_uint_eq(film.counts[5], 1);
    film_add_one(&other, 5 | SPLAT_RARE, 1.0f, 1.0f, 1.0f);
    ck_assert_int_eq(other.sums[15], (int64_t)1 << 30);
    ck_assert(film_merge(&film, &other, &error) && film_merge(&other, &film, &error));
    ck_assert_int_eq(film.rare_sums[15], (int64_t)10 << 30);
    film_clear(&film);
    ck_assert_int_eq(film.rare_sums[15], 0);
    film_destroy(&film);
    film_destroy(&other);
}
END_TEST

/* Splats with a depth go to the total sums and once more to sums of that depth: to those from the light and, in a film
 * with rare sums, also to the film's own and to the rare ones. */
START_TEST(test_depths)
{
    const uint four = splat_depth(3, 4), five = splat_depth(3, 5);
    const int whole[4] = {0, 0, 8192, 4096};
    Error error = {0};
    Film film = film_make(4, 3, CROP_WHOLE), other, huge = {.width = 8192, .height = 4096};
    ck_assert_uint_eq(splat_depth(0, 4), 0);
    ck_assert(film_light_reserve(&film, &error) && film_init_like(&other, &film, &error));
    ck_assert(film_rare_reserve(&film, &error) && film_depths_reserve(&film, 5, &error));
    ck_assert(film_depths_reserve(&other, 5, &error));
    ck_assert_uint_eq(film.depth_kinds, 3);
    ck_assert_uint_eq(other.depth_kinds, 1);
    ck_assert_uint_eq(film_sum_words(&film), 117 + 3 * 3 * 36);
    ck_assert_uint_eq(film_sum_words(&other), 81 + 3 * 36);
    film_add_one(&film, 5 | SPLAT_LIGHT | four, 1.0f, 1.0f, 1.0f);
    film_add_one(&film, 5 | SPLAT_LIGHT | SPLAT_RARE | five, 2.0f, 3.0f, 4.0f);
    film_add_one(&film, 5 | SPLAT_RARE | five, 8.0f, 8.0f, 8.0f);
    film_add_one(&film, 5, 16.0f, 16.0f, 16.0f);
    film_add_one(&film, 5 | SPLAT_LIGHT | splat_depth(3, 6), 32.0f, 0.0f, 0.0f);
    ck_assert_int_eq(film.light_sums[15], (int64_t)35 << 30);
    ck_assert_int_eq(film.sums[15], (int64_t)24 << 30);
    ck_assert_int_eq(film.rare_sums[15], (int64_t)10 << 30);
    const int64_t expected[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 8, 10}}; /* 3, 4, 5 segments; light, own, rare */
    for (uint segments = 3; segments <= 5; ++segments)
        for (uint kind = 0; kind < 3; ++kind)
            ck_assert_int_eq(film_depth_sums(&film, segments, kind)[15], expected[segments - 3][kind] << 30);
    ck_assert(film_merge(&other, &film, &error) && film_merge(&other, &film, &error));
    ck_assert_int_eq(film_depth_sums(&other, 5, FILM_KIND_LIGHT)[15], (int64_t)4 << 30);
    film_clear(&other);
    ck_assert_int_eq(film_depth_sums(&other, 5, FILM_KIND_LIGHT)[15], 0);
    memcpy(huge.crop, whole, sizeof whole);
    ck_assert(!film_depths_reserve(&huge, 5, &error));
    ck_assert_msg(strstr(error.message, "8192 x 4096") != NULL, "%s", error.message);
    film_destroy(&film);
    film_destroy(&other);
}
END_TEST

/* A device's buffer: 12 pixels of three sums, three counters, two counts per word, and light and rare sums if
 * present. */
START_TEST(test_sums_of_a_device)
{
    ulong words[3 * 12 + 3 + 6 + 2 * 3 * 12] = {0};
    Error error = {0};
    Film film = film_make(4, 3, CROP_WHOLE);
    ck_assert_uint_eq(film_sum_words(&film), 45);
    ck_assert(film_light_reserve(&film, &error));
    ck_assert_uint_eq(film_sum_words(&film), 81);
    ck_assert(film_rare_reserve(&film, &error));
    ck_assert_uint_eq(film_sum_words(&film), 117);
    film_add_one(&film, 2, 1.0f, 2.0f, 3.0f);
    film_add_one(&film, 2 | SPLAT_LIGHT, 1.0f, 1.0f, 1.0f);
    words[3 * 2 + 1] = (ulong)-5;
    words[36] = 7;
    words[37] = 8;
    words[38] = 9;
    ((uint *)(words + 39))[2] = 4;
    words[45 + 3 * 2 + 2] = 6;
    words[81 + 3 * 2 + 1] = 8;
    film_add_sums(&film, words);
    ck_assert_int_eq(film.sums[6], 1 << 30);
    ck_assert_int_eq(film.sums[7], ((int64_t)2 << 30) - 5);
    ck_assert_int_eq(film.light_sums[8], (1 << 30) + 6);
    ck_assert_int_eq(film.rare_sums[7], 8);
    ck_assert_uint_eq(film.counts[2], 5);
    ck_assert_uint_eq(film.saturated, 7);
    ck_assert_uint_eq(film.not_finite, 9);
    ck_assert_uint_eq(film.vanished, 8);
    words[3 * 2 + 1] = (ulong)1 << 61;
    film_add_sums(&film, words);
    ck_assert_uint_eq(film_full_pixels(&film), 0);
    film_add_sums(&film, words); /* the sum becomes 2^62 */
    ck_assert_uint_eq(film_full_pixels(&film), 1);
    for (int i = 0; i < 6; ++i) /* and would exceed 2^63 here */
        film_add_sums(&film, words);
    ck_assert_int_eq(film.sums[7], INT64_MAX);
    film_destroy(&film);
}
END_TEST

/* A pixel is full if one of its sums is SUM_MAX from 0 or farther, on either side. */
START_TEST(test_full_sums)
{
    const int64_t most = (int64_t)SUM_MAX,
                  values[] = {0, 1, -1, most - 1, 1 - most, most, -most, INT64_MAX, -INT64_MAX};
    Error error;
    Film film = film_make(4, 3, CROP_WHOLE);
    ck_assert(film_light_reserve(&film, &error) && film_rare_reserve(&film, &error));
    int64_t *sums[] = {film.sums, film.light_sums, film.rare_sums};
    for (size_t i = 0; i < 3 * sizeof values / sizeof values[0]; ++i) {
        sums[i % 3][3 * 5 + i / 3 % 3] = values[i / 3];
        ck_assert_uint_eq(film_full_pixels(&film), i / 3 >= 5);
        ck_assert_uint_eq(film_full_pixels_of(&film, 0, 5) + film_full_pixels_of(&film, 6, 12), 0);
        sums[i % 3][3 * 5 + i / 3 % 3] = 0;
    }
    film_destroy(&film);
}
END_TEST

/* A sum that would overflow 64 bits saturates, reads as 2^62 units, and its pixel counts as full. */
START_TEST(test_full)
{
    Error error;
    Film film = film_make(4, 3, CROP_WHOLE), other = film_make(4, 3, CROP_WHOLE);
    float rgb[36];
    for (int i = 0; i < 1 << 18; ++i)
        film_add_one(&film, 1, 0x1p18f, -0x1p18f, 0x1p11f);
    ck_assert_int_eq(film.sums[3], INT64_MAX);
    ck_assert_int_eq(film.sums[4], -INT64_MAX);
    ck_assert_int_eq(film.sums[5], (int64_t)1 << 59);
    ck_assert_uint_eq(film_full_pixels(&film), 1);
    film_add_one(&film, 1, -1.0f, 1.0f, 0.0f);
    film_add_one(&other, 1, -1.0f, 1.0f, 0.0f);
    ck_assert(film_merge(&film, &other, &error) && film_merge(&other, &film, &error));
    for (int i = 0; i < 2; ++i) {
        const Film *full = i == 0 ? &film : &other;
        ck_assert_int_eq(full->sums[3], INT64_MAX);
        ck_assert_int_eq(full->sums[4], -INT64_MAX);
        film_resolve(full, 1.0f, rgb);
        ck_assert_float_eq(rgb[3], (float)(0x1p32 / full->counts[1]));
        ck_assert_float_eq(rgb[4], -rgb[3]);
    }
    ck_assert_int_eq(film_sum_shown(INT64_MIN), -((int64_t)1 << 62));
    ck_assert_int_eq(film_sum_rounded(-0x1p61 - 512.0), -((int64_t)1 << 61) - 512);
    ck_assert_int_eq(film_sum_rounded(-0x1p62), -INT64_MAX);
    ck_assert_int_eq(film_sum_rounded(HUGE_VAL), INT64_MAX);
    film_destroy(&film);
    film_destroy(&other);
}
END_TEST

/* Pixel i is 2^-i times as bright as the first; every fifth contribution is a small negative one. */
static void splats_fill_bright(uint *splats)
{
    uint state = 1;
    for (uint t = 0; t < SPLATS; ++t) {
        state = state * 1664525u + 1013904223u;
        float value = (float)(state >> 8) / 0x1p24f * (t % 5 == 0 ? -0x1p-12f : ldexpf(1.0f, -(int)(t % 12)));
        splat_set(splats, SPLATS, t, t % 12, value, value, value);
    }
}

/* Sums that are full, that exceed the largest value read, or that stay below it, read the same for any order of
 * additions. */
START_TEST(test_order_of_full_sums)
{
    uint *splats = malloc(SPLATS * SPLAT_WORDS * sizeof *splats), *shuffled = malloc(SPLATS * SPLAT_WORDS * 4);
    Film films[4];
    float rgb[4][36];
    pthread_t threads[THREADS];
    ThreadJob jobs[THREADS];
    Error error;
    splats_fill_bright(splats);
    splats_shuffle(splats, shuffled);
    for (int i = 0; i < 4; ++i) {
        films[i] = film_make(4, 3, CROP_WHOLE);
        films[i].quantum_exponent = -60;
    }
    film_add_splats(&films[0], splats, SPLATS, SPLATS);
    film_add_splats(&films[1], shuffled, SPLATS, SPLATS);
    for (uint i = 0; i < THREADS; ++i) {
        jobs[i] = (ThreadJob){&films[2], shuffled + i * (SPLATS / THREADS), SPLATS / THREADS};
        pthread_create(&threads[i], NULL, thread_add, &jobs[i]);
    }
    for (uint i = 0; i < THREADS; ++i)
        pthread_join(threads[i], NULL);
    for (uint first = 0; first < SPLATS; first += SPLATS / 8) {
        Film part = film_make(4, 3, CROP_WHOLE);
        part.quantum_exponent = -60;
        film_add_splats(&part, splats + first, SPLATS / 8, SPLATS);
        ck_assert(film_merge(&films[3], &part, &error));
        film_destroy(&part);
    }
    for (int i = 0; i < 4; ++i) {
        film_resolve(&films[i], 1.0f, rgb[i]);
        ck_assert_mem_eq(rgb[0], rgb[i], sizeof rgb[0]);
        ck_assert_uint_eq(film_full_pixels(&films[i]), 9);
        ck_assert_float_ge(rgb[i][24], 0x1.fffp1f / (float)films[i].counts[8]);
        film_destroy(&films[i]);
    }
    free(splats);
    free(shuffled);
}
END_TEST

/* The allocator's memory has been used before (mallopt: it is not returned to the system): large arrays are zeros
 * nevertheless, and sizes that overflow have none. */
START_TEST(test_zeros)
{
    const size_t count = (size_t)5 << 20, sizes[] = {count, 1000};
    (void)mallopt(M_MMAP_THRESHOLD, 32 << 20); /* a sanitizer's allocator does nothing and returns 0 */
    (void)mallopt(M_TRIM_THRESHOLD, 64 << 20);
    for (int round = 0; round < 8; ++round) {
        size_t words = sizes[round % 2] / sizeof(uint32_t), others = 0;
        uint32_t *zeros = zeros_alloc(words, sizeof *zeros);
        volatile uint32_t *values = zeros; /* are written, although nothing reads them before they are freed */
        ck_assert_ptr_nonnull(zeros);
        for (size_t i = 0; i < words; ++i) {
            others += values[i] != 0;
            values[i] = UINT32_MAX;
        }
        ck_assert_uint_eq(others, 0);
        free(zeros);
    }
    ck_assert_ptr_null(zeros_alloc(SIZE_MAX / 4, 5));
    ck_assert_ptr_null(zeros_alloc(1, SIZE_MAX));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("film");
    TCase *tcase = tcase_create("film");
    tcase_set_timeout(tcase, 300); /* for the long test */
    tcase_add_test(tcase, test_billion_additions_exact);
    tcase_add_test(tcase, test_billion_additions_made);
    tcase_add_test(tcase, test_order_does_not_matter);
    tcase_add_test(tcase, test_merge_equals_one_film);
    tcase_add_test(tcase, test_threads);
    tcase_add_test(tcase, test_rare);
    tcase_add_test(tcase, test_depths);
    tcase_add_test(tcase, test_sums_of_a_device);
    tcase_add_test(tcase, test_full_sums);
    tcase_add_test(tcase, test_full);
    tcase_add_test(tcase, test_order_of_full_sums);
    tcase_add_test(tcase, test_zeros);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, film_units_tcase());
    suite_add_tcase(suite, film_complete_tcase());
    suite_add_tcase(suite, film_output_tcase());
    suite_add_tcase(suite, film_spread_tcase());
    suite_add_tcase(suite, film_uniform_tcase());
    suite_add_tcase(suite, film_files_tcase());
    suite_add_tcase(suite, film_words_tcase());
    return test_run(suite);
}
