/* Films in one buffer of words (film/film_words.h): splats divided among several, whose words are added up, give the
 * film that gets all splats. */
#include "film/test_film.h"

#include "camera/film_sum.h"
#include "film/film_words.h"

#include <string.h>

enum { WIDTH = 9, HEIGHT = 7, PARTS = 3, SPLATS = 400, DEPTH = 5 };

static const int CROP[4] = {2, 1, 9, 6}; /* 35 pixels: an odd number */

/* Kinds of sums: light, rare, kinds per depth. */
typedef struct Kinds {
    bool light, rare;
    uint depths;
} Kinds;

static FrameParams frame_of(const Kinds *kinds)
{
    FrameParams frame;
    memset(&frame, 0, sizeof frame);
    frame.film.width = WIDTH;
    frame.film.height = HEIGHT;
    frame.film.crop_x0 = (uint)CROP[0];
    frame.film.crop_y0 = (uint)CROP[1];
    frame.film.crop_x1 = (uint)CROP[2];
    frame.film.crop_y1 = (uint)CROP[3];
    frame.film.exponent = -20;
    frame.film.split_depths = kinds->depths;
    frame.film.filter.table_x = frame.film.filter.table_y = NONE;
    frame.path.max_depth = DEPTH;
    return frame;
}

static void film_of_kinds(Film *film, const FrameParams *frame, const Kinds *kinds)
{
    Error error;
    ck_assert(film_init(film, WIDTH, HEIGHT, CROP, &error));
    film->quantum_exponent = frame->film.exponent;
    ck_assert(!kinds->light || film_light_reserve(film, &error));
    ck_assert(!kinds->rare || film_rare_reserve(film, &error));
    ck_assert(kinds->depths == 0 || film_depths_reserve(film, DEPTH, &error));
    ck_assert_uint_eq(film->depth_kinds, kinds->depths);
    film_filter_set(film, &frame->film, NULL);
}

/* Splat i: anywhere, of any kind that the film has; some too large, too small or not finite. */
static void splat_make(uint i, const Kinds *kinds, uint splat[SPLAT_WORDS])
{
    uint name = i * 2654435761u % (WIDTH * HEIGHT);
    name |= kinds->light && i % 3 == 0 ? SPLAT_LIGHT : 0;
    name |= kinds->rare && i % 5 == 0 ? SPLAT_RARE : 0;
    name |= kinds->depths > 0 ? splat_depth(kinds->depths, 3 + i % 4) : 0;
    float value = i % 101 == 7 ? INFINITY : i % 53 == 5 ? 1e30f : i % 31 == 3 ? 1e-9f : 0.1f * (float)(i % 17) - 0.3f;
    memset(splat, 0, SPLAT_WORDS * sizeof *splat);
    state_store(splat, 1, SPLAT_PIXEL, 0, name);
    state_store_vec3(splat, 1, SPLAT_COLOR, 0, vec3(value, i % 31 == 3 ? 0.0f : 2.0f, 0.0f));
}

/* As ranks do (ranks/communicator.h). */
static void words_add(FilmWords *sum, const FilmWords *more)
{
    film_words_add(sum->words, more->words, sum->plain);
    for (size_t i = sum->plain; i < sum->plain_end; ++i)
        sum->words[i] += more->words[i];
    film_words_add(sum->words + sum->plain_end, more->words + sum->plain_end, sum->count - sum->plain_end);
}

static void sums_same(const int64_t *got, const int64_t *expected, size_t count)
{
    ck_assert(!got == !expected);
    for (size_t i = 0; expected && i < count; ++i)
        TEST_TRUE(film_sum_shown(got[i]) == film_sum_shown(expected[i]));
}

static void films_same(const Film *got, const Film *expected)
{
    size_t pixels = film_pixels(expected);
    sums_same(got->sums, expected->sums, 3 * pixels);
    sums_same(got->light_sums, expected->light_sums, 3 * pixels);
    sums_same(got->rare_sums, expected->rare_sums, 3 * pixels);
    sums_same(got->depth_sums, expected->depth_sums,
              film_depth_words((uint)pixels, expected->depth_kinds, expected->depth_last));
    ck_assert_mem_eq(got->counts, expected->counts, pixels * sizeof *expected->counts);
    ck_assert_uint_eq(got->saturated, expected->saturated);
    ck_assert_uint_eq(got->vanished, expected->vanished);
    ck_assert_uint_eq(got->not_finite, expected->not_finite);
}

START_TEST(test_parts)
{
    static const Kinds KINDS[] = {
        {false, false, 0}, {true, false, 0}, {true, true, 0}, {true, false, 1}, {true, true, 3}};
    const Kinds *kinds = &KINDS[_i];
    const FrameParams frame = frame_of(kinds);
    Film expected, film;
    FilmWords parts[PARTS];
    film_of_kinds(&expected, &frame, kinds);
    film_of_kinds(&film, &frame, kinds);
    size_t count = film_sum_words(&film);
    for (int part = 0; part < PARTS; ++part) {
        film_words_begin(&parts[part], &frame, NULL, calloc(count, sizeof(ulong)), count);
        ck_assert_uint_eq(film_sum_words(&parts[part].film), count);
    }
    for (uint i = 0; i < SPLATS; ++i) {
        uint splat[SPLAT_WORDS];
        splat_make(i, kinds, splat);
        film_add_splats(&expected, splat, 1, 1);
        film_add_splats(&parts[i % PARTS].film, splat, 1, 1);
    }
    for (int part = 0; part < PARTS; ++part) {
        film_words_end(&parts[part]);
        if (part > 0)
            words_add(&parts[0], &parts[part]);
    }
    film_add_sums(&film, parts[0].words);
    ck_assert(expected.saturated > 0 && expected.vanished > 0 && expected.not_finite > 0);
    films_same(&film, &expected);
    for (int part = 0; part < PARTS; ++part)
        free(parts[part].words);
    film_destroy(&film);
    film_destroy(&expected);
}
END_TEST

/* Counts fill their 32 bits, two of them a word; sums stay full. */
START_TEST(test_large)
{
    static const Kinds KINDS = {true, false, 0};
    const FrameParams frame = frame_of(&KINDS);
    FilmWords parts[2];
    Film film;
    film_of_kinds(&film, &frame, &KINDS);
    size_t count = film_sum_words(&film);
    for (int part = 0; part < 2; ++part) {
        film_words_begin(&parts[part], &frame, NULL, calloc(count, sizeof(ulong)), count);
        for (int i = 0; i < 35; ++i)
            parts[part].film.counts[i] = 0x60000000u + (uint)i;
        parts[part].film.sums[4] = (int64_t)1 << 62;
        parts[part].film.light_sums[104] = -((int64_t)1 << 62) - part;
        parts[part].film.sums[5] = (int64_t)(part == 0 ? SUM_FULL : 0u - (ulong)1000);
    }
    words_add(&parts[0], &parts[1]);
    film_add_sums(&film, parts[0].words);
    for (uint i = 0; i < 35; ++i)
        ck_assert_uint_eq(film.counts[i], 0xc0000000u + 2 * i);
    ck_assert_int_eq(film.sums[4], (int64_t)SUM_FULL);
    ck_assert_int_eq(film.sums[5], (int64_t)SUM_FULL);
    ck_assert_int_eq(film.light_sums[104], -(int64_t)SUM_FULL);
    for (int part = 0; part < 2; ++part)
        free(parts[part].words);
    film_destroy(&film);
}
END_TEST

TCase *film_words_tcase(void)
{
    TCase *tcase = tcase_create("words");
    tcase_add_loop_test(tcase, test_parts, 0, 5);
    tcase_add_test(tcase, test_large);
    return tcase;
}
