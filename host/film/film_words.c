#include "film/film_words.h"

#include "camera/film_sum.h"

/* The place of each kind of sum. The buffer's size says which there are. */
static void sums_place(Film *film, ulong *words, size_t count)
{
    uint pixels = (uint)film_pixels(film);
    size_t depths = film->depth_kinds > 0 ? film_depth_words(pixels, film->depth_kinds, film->depth_last) : 0;
    size_t kinds = (count - depths - film_words(pixels, 0)) / (3 * (size_t)pixels);
    FilmView view = {.depth_kinds = film->depth_kinds};
    film_view_words(&view, words, pixels);
    film->sums = (int64_t *)view.sums;
    film->counts = view.counts;
    film->light_sums = kinds > 0 ? (int64_t *)view.light_sums : NULL;
    film->rare_sums = kinds > 1 ? (int64_t *)view.rare_sums : NULL;
    film->depth_sums = depths > 0 ? (int64_t *)view.depth_sums : NULL;
}

void film_words_begin(FilmWords *film, const FrameParams *frame, const float *lookup, ulong *words, size_t count)
{
    const FilmParams *params = &frame->film;
    *film = (FilmWords){
        .film = {.width = (int)params->width,
                 .height = (int)params->height,
                 .crop = {(int)params->crop_x0, (int)params->crop_y0, (int)params->crop_x1, (int)params->crop_y1},
                 .quantum_exponent = params->exponent,
                 .depth_kinds = params->split_depths,
                 .depth_last = frame->path.max_depth,
                 .threads = 1},
        .words = words,
        .count = count};
    film_filter_set(&film->film, params, lookup);
    sums_place(&film->film, words, count);
    size_t pixels = film_pixels(&film->film);
    film->plain = 3 * pixels;
    film->plain_end = film_words((uint)pixels, 0);
}

void film_words_end(FilmWords *film)
{
    ulong *counters = film->words + film->plain;
    counters[0] = film->film.saturated;
    counters[1] = film->film.vanished;
    counters[2] = film->film.not_finite;
}
