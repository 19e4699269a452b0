/* What the parts of test_film share. */
#ifndef TWINLIGHT_TESTS_FILM_TEST_FILM_H
#define TWINLIGHT_TESTS_FILM_TEST_FILM_H

#include "film/film.h"
#include "support/test_util.h"

static const int CROP_WHOLE[4] = {0, 0, 4, 3};

static inline Film film_make(int width, int height, const int *crop)
{
    Film film;
    Error error = {0};
    ck_assert_msg(film_init(&film, width, height, crop, &error), "%s", error.message);
    return film;
}

static inline void splat_set(uint *splats, uint stride, uint t, uint pixel, float r, float g, float b)
{
    state_store(splats, stride, SPLAT_PIXEL, t, pixel);
    state_store_vec3(splats, stride, SPLAT_COLOR, t, vec3(r, g, b));
}

static inline void film_add_one(Film *film, uint pixel, float r, float g, float b)
{
    uint splat[SPLAT_WORDS];
    splat_set(splat, 1, 0, pixel, r, g, b);
    film_add_splats(film, splat, 1, 1);
}

TCase *film_complete_tcase(void);
TCase *film_files_tcase(void);
TCase *film_output_tcase(void);
TCase *film_spread_tcase(void);
TCase *film_uniform_tcase(void);
TCase *film_units_tcase(void);
TCase *film_words_tcase(void);

#endif
