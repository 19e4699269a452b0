/* Adding films to films, and what devices have summed. */
#include "film/film.h"

#include <string.h>

/* Adding a film to another. */
typedef struct FilmAdding {
    FilmView film, from;
    size_t pixels;
    bool shared; /* other threads may add to the film meanwhile */
} FilmAdding;

/* Most sums of a short pass are zero, and testing is cheaper than adding. */
static void word_add(const FilmAdding *adding, ulong *sum, ulong units)
{
    if (units != 0 && adding->shared)
        film_sum_add(sum, units);
    else if (units != 0 && !film_sum_full(*sum))
        *sum = film_sum_of(*sum, units);
}

/* Adds the sums per depth, of the kinds and depths that both films have. */
static void depths_add(const FilmAdding *adding, size_t first, size_t end)
{
    const FilmView *film = &adding->film, *from = &adding->from;
    uint kinds = film->depth_kinds < from->depth_kinds ? film->depth_kinds : from->depth_kinds;
    uint last = film->depth_last < from->depth_last ? film->depth_last : from->depth_last;
    for (uint depth = SPLAT_DEPTH_MIN; depth <= last; ++depth)
        for (uint kind = 0; kind < kinds; ++kind) {
            uint pixels = (uint)adding->pixels;
            ulong *into = film->depth_sums + film_depth_place(pixels, film->depth_kinds, depth, kind);
            const ulong *more = from->depth_sums + film_depth_place(pixels, from->depth_kinds, depth, kind);
            for (size_t i = 3 * first; i < 3 * end; ++i)
                word_add(adding, into + i, more[i]);
        }
}

/* Adds pixels [first, end), of the sums that both films have. */
static void pixels_add(const FilmAdding *adding, size_t first, size_t end)
{
    const FilmView *film = &adding->film, *from = &adding->from;
    for (size_t i = first; i < end; ++i) {
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
            word_add(adding, film->sums + c, from->sums[c]);
            if (film->light_sums && from->light_sums)
                word_add(adding, film->light_sums + c, from->light_sums[c]);
            if (film->rare_sums && from->rare_sums)
                word_add(adding, film->rare_sums + c, from->rare_sums[c]);
        }
        if (from->counts[i] > 0)
            atomic_count_add(film->counts + i, from->counts[i]);
    }
    if (film->depth_kinds != 0u && from->depth_kinds != 0u)
        depths_add(adding, first, end);
}

static void counters_add(const FilmAdding *adding)
{
    atomic_sum_add(adding->film.saturated, *adding->from.saturated);
    atomic_sum_add(adding->film.vanished, *adding->from.vanished);
    atomic_sum_add(adding->film.not_finite, *adding->from.not_finite);
}

size_t film_sum_words(const Film *film)
{
    uint pixels = (uint)film_pixels(film);
    return film_words(pixels, (film->light_sums ? 1u : 0u) + (film->rare_sums ? 1u : 0u)) +
           film_depth_words(pixels, film->depth_kinds, film->depth_last);
}

static void row_merge(void *context, size_t row)
{
    const FilmAdding *adding = context;
    size_t width = adding->film.x1 - adding->film.x0;
    pixels_add(adding, row * width, (row + 1) * width);
}

void film_add_sums(Film *film, ulong *words)
{
    FilmAdding adding = {.film = film_view(film), .from = film_view(film), .pixels = film_pixels(film), .shared = true};
    film_view_words(&adding.from, words, (uint)adding.pixels);
    film_rows_run(film, row_merge, &adding);
    counters_add(&adding);
}

void film_words_add(ulong *words, const ulong *more, size_t count)
{
    const FilmAdding alone = {.shared = false};
    for (size_t i = 0; i < count; ++i)
        word_add(&alone, words + i, more[i]);
}

static bool film_merge_check(const Film *film, const Film *from, Error *error)
{
    if (film->width != from->width || film->height != from->height)
        return error_set(error, "films of different sizes cannot be merged: %d x %d and %d x %d", film->width,
                         film->height, from->width, from->height);
    if (memcmp(film->crop, from->crop, sizeof film->crop) != 0)
        return error_set(error, "films of different crops cannot be merged: %d,%d,%d,%d and %d,%d,%d,%d", film->crop[0],
                         film->crop[1], film->crop[2], film->crop[3], from->crop[0], from->crop[1], from->crop[2],
                         from->crop[3]);
    if (film->quantum_exponent != from->quantum_exponent)
        return error_set(error, "films of different quanta cannot be merged: 2^%d and 2^%d", film->quantum_exponent,
                         from->quantum_exponent);
    if (film->reconstruction != from->reconstruction)
        return error_set(error, "films of different --reconstruction cannot be merged");
    if (!film->light_sums != !from->light_sums)
        return error_set(error, "films of integrators with and without paths from the light cannot be merged");
    for (size_t i = 0; i < film_pixels(film); ++i)
        if ((uint64_t)film_count(film, i) + film_count(from, i) > UINT32_MAX)
            return error_set(error, "merged films have more than %llu samples in a pixel",
                             (unsigned long long)film_samples_most(film->reconstruction));
    return true;
}

bool film_merge(Film *film, const Film *from, Error *error)
{
    if (!film_merge_check(film, from, error))
        return false;
    FilmAdding adding = {.film = film_view(film), .from = film_view(from), .pixels = film_pixels(film)};
    film_rows_run(film, row_merge, &adding);
    counters_add(&adding);
    film->light_samples += from->light_samples;
    film->complete_samples += from->complete_samples;
    film->every_count += from->every_count;
    return true;
}
