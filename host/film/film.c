#include "film/film.h"

#include "camera/film_sum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Octaves from the mean radiance of the image down to the quantum. The contributions of T samples add up to T times the
 * mean, in the worst case all in one pixel or even one path, and a sum shows at most 2^62 quanta (camera/film_sum.h).
 * So no pixel is too bright for a film of 2^(62 - 26) = 2^36 samples: 2^20 pixels of 65,536 samples, or two hours of
 * 10^7 samples per second. At the other end, a contribution vanishes below 2^-27 of the mean, and rounding changes one
 * of 2^-20 by less than 1 %. If the pilot has missed light and the true mean is 2^k times as large, the brightest
 * possible pixel has room for 2^(36 - k) samples. */
#define QUANTUM_OCTAVES 26
#define QUANTUM_EXPONENT_DEFAULT (-30)

size_t film_pixels(const Film *film)
{
    return (size_t)(film->crop[2] - film->crop[0]) * (size_t)(film->crop[3] - film->crop[1]);
}

bool film_init(Film *film, int width, int height, const int crop[4], Error *error)
{
    *film = (Film){.width = width, .height = height, .quantum_exponent = QUANTUM_EXPONENT_DEFAULT};
    memcpy(film->crop, crop, sizeof film->crop);
    if (width < 1 || height < 1 || crop[0] < 0 || crop[1] < 0 || crop[2] > width || crop[3] > height ||
        crop[0] >= crop[2] || crop[1] >= crop[3]) {
        error_set(error, "a film of %d x %d pixels with the crop %d,%d,%d,%d has no pixels", width, height, crop[0],
                  crop[1], crop[2], crop[3]);
        return error_fix(error, "x0 < x1 and y0 < y1 inside the film");
    }
    if ((uint64_t)width * (uint64_t)height > FILM_PIXELS_MAX) {
        error_set(error, "a film of %d x %d pixels is too large", width, height);
        return error_fix(error, "choose a smaller --resolution");
    }
    size_t pixels = film_pixels(film);
    film->sums = calloc(pixels * 3, sizeof *film->sums);
    film->counts = calloc(pixels, sizeof *film->counts);
    if (film->sums && film->counts)
        return true;
    film_destroy(film);
    return error_memory(error, pixels * (3 * sizeof *film->sums + sizeof *film->counts), "the film");
}

/* Allocates three zero sums per pixel, unless already there. */
static bool sums_reserve(const Film *film, int64_t **sums, const char *what, Error *error)
{
    size_t bytes = film_pixels(film) * 3 * sizeof **sums;
    if (!*sums)
        *sums = calloc(1, bytes);
    return *sums || error_memory(error, bytes, what);
}

bool film_light_reserve(Film *film, Error *error)
{
    return sums_reserve(film, &film->light_sums, "the film of the light's paths", error);
}

bool film_rare_reserve(Film *film, Error *error)
{
    return sums_reserve(film, &film->rare_sums, "the film of rare paths", error);
}

bool film_depths_reserve(Film *film, uint last, Error *error)
{
    if (film->depth_sums || last < SPLAT_DEPTH_MIN)
        return true;
    if ((uint64_t)film->width * (uint64_t)film->height >= 1u << SPLAT_DEPTH_SHIFT) {
        error_set(error, "a film of %d x %d pixels is too large for layers by depth", film->width, film->height);
        return error_fix(error, "choose a smaller --resolution, or leave by-depth out of --layers");
    }
    film->depth_kinds = film->rare_sums ? FILM_KIND_RARE + 1 : 1;
    film->depth_last = last;
    size_t words = film_depth_words((uint)film_pixels(film), film->depth_kinds, last);
    film->depth_sums = calloc(words, sizeof *film->depth_sums);
    return film->depth_sums || error_memory(error, words * sizeof *film->depth_sums, "the films of every depth");
}

int64_t *film_depth_sums(const Film *film, uint segments, uint kind)
{
    return film->depth_sums + film_depth_place((uint)film_pixels(film), film->depth_kinds, segments, kind);
}

void film_destroy(Film *film)
{
    free(film->sums);
    free(film->light_sums);
    free(film->rare_sums);
    free(film->depth_sums);
    free(film->counts);
    *film = (Film){0};
}

bool film_init_like(Film *film, const Film *model, Error *error)
{
    if (!film_init(film, model->width, model->height, model->crop, error))
        return false;
    film->quantum_exponent = model->quantum_exponent;
    return !model->light_sums || film_light_reserve(film, error);
}

void film_quantum_set(Film *film, double mean)
{
    int exponent = 0;
    film->quantum_exponent = QUANTUM_EXPONENT_DEFAULT;
    if (!(mean > 0.0) || !isfinite(mean))
        return;
    frexp(mean, &exponent); /* 2^(exponent - 1) <= mean < 2^exponent */
    film->quantum_exponent = exponent - 1 - QUANTUM_OCTAVES;
}

/* A film's view, also for reading a const film. */
static FilmView film_view(const Film *film)
{
    return (FilmView){.width = (uint)film->width,
                      .x0 = (uint)film->crop[0],
                      .y0 = (uint)film->crop[1],
                      .x1 = (uint)film->crop[2],
                      .y1 = (uint)film->crop[3],
                      .exponent = film->quantum_exponent,
                      .sums = (ulong *)film->sums,
                      .light_sums = (ulong *)film->light_sums,
                      .rare_sums = (ulong *)film->rare_sums,
                      .depth_sums = (ulong *)film->depth_sums,
                      .depth_kinds = film->depth_kinds,
                      .depth_last = film->depth_last,
                      .counts = film->counts,
                      .saturated = (ulong *)&film->saturated,
                      .vanished = (ulong *)&film->vanished,
                      .not_finite = (ulong *)&film->not_finite};
}

void film_add_splats(Film *film, const uint *splats, uint count, uint stride)
{
    const FilmView view = film_view(film);
    for (uint item = 0; item < count; ++item)
        film_splat_add(&view, splats, stride, item);
}

/* ---- adding films ------------------------------------------------------------------------------------------------ */

/* Most sums of a short pass are zero, and testing is cheaper than adding. */
static void word_add(ulong *sum, ulong units)
{
    if (units != 0)
        film_sum_add(sum, units);
}

/* Adds the sums per depth, of the kinds and depths that both films have. */
static void depths_add(const FilmView *film, const FilmView *from, size_t pixels)
{
    uint kinds = film->depth_kinds < from->depth_kinds ? film->depth_kinds : from->depth_kinds;
    uint last = film->depth_last < from->depth_last ? film->depth_last : from->depth_last;
    for (uint depth = SPLAT_DEPTH_MIN; depth <= last; ++depth)
        for (uint kind = 0; kind < kinds; ++kind) {
            ulong *into = film->depth_sums + film_depth_place((uint)pixels, film->depth_kinds, depth, kind);
            const ulong *more = from->depth_sums + film_depth_place((uint)pixels, from->depth_kinds, depth, kind);
            for (size_t i = 0; i < 3 * pixels; ++i)
                word_add(into + i, more[i]);
        }
}

/* Adds pixels [0, pixels) of another film, of the sums that both have. */
static void view_add(const FilmView *film, const FilmView *from, size_t pixels)
{
    for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
            word_add(film->sums + c, from->sums[c]);
            if (film->light_sums && from->light_sums)
                word_add(film->light_sums + c, from->light_sums[c]);
            if (film->rare_sums && from->rare_sums)
                word_add(film->rare_sums + c, from->rare_sums[c]);
        }
        if (from->counts[i] > 0)
            atomic_count_add(film->counts + i, from->counts[i]);
    }
    if (film->depth_kinds != 0u && from->depth_kinds != 0u)
        depths_add(film, from, pixels);
    atomic_sum_add(film->saturated, *from->saturated);
    atomic_sum_add(film->vanished, *from->vanished);
    atomic_sum_add(film->not_finite, *from->not_finite);
}

size_t film_sum_words(const Film *film)
{
    uint pixels = (uint)film_pixels(film);
    return film_words(pixels, (film->light_sums ? 1u : 0u) + (film->rare_sums ? 1u : 0u)) +
           film_depth_words(pixels, film->depth_kinds, film->depth_last);
}

void film_add_sums(Film *film, ulong *words)
{
    const FilmView view = film_view(film);
    FilmView from = view;
    film_view_words(&from, words, (uint)film_pixels(film));
    view_add(&view, &from, film_pixels(film));
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
    if (!film->light_sums != !from->light_sums)
        return error_set(error, "films of integrators with and without paths from the light cannot be merged");
    for (size_t i = 0; i < film_pixels(film); ++i)
        if ((uint64_t)film->counts[i] + from->counts[i] > UINT32_MAX)
            return error_set(error, "merged films have more than %u samples in a pixel", UINT32_MAX);
    return true;
}

bool film_merge(Film *film, const Film *from, Error *error)
{
    if (!film_merge_check(film, from, error))
        return false;
    const FilmView view = film_view(film), from_view = film_view(from);
    view_add(&view, &from_view, film_pixels(film));
    film->light_samples += from->light_samples;
    return true;
}

void film_swap_own(Film *a, Film *b)
{
    int64_t *sums = a->sums;
    uint32_t *counts = a->counts;
    a->sums = b->sums;
    a->counts = b->counts;
    b->sums = sums;
    b->counts = counts;
}

void film_clear(Film *film)
{
    size_t pixels = film_pixels(film);
    memset(film->sums, 0, 3 * pixels * sizeof *film->sums);
    memset(film->counts, 0, pixels * sizeof *film->counts);
    if (film->light_sums)
        memset(film->light_sums, 0, 3 * pixels * sizeof *film->light_sums);
    if (film->rare_sums)
        memset(film->rare_sums, 0, 3 * pixels * sizeof *film->rare_sums);
    if (film->depth_sums)
        memset(film->depth_sums, 0,
               film_depth_words((uint)pixels, film->depth_kinds, film->depth_last) * sizeof *film->depth_sums);
    film->light_samples = film->saturated = film->vanished = film->not_finite = 0;
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

int64_t film_sum_shown(int64_t sum)
{
    const int64_t most = (int64_t)SUM_MAX;
    return sum > most ? most : sum < -most ? -most : sum;
}

int64_t film_sum_rounded(double units)
{
    const double most = (double)SUM_MAX;
    if (fabs(units) < most)
        return llrint(units);
    return units < 0.0 ? -(int64_t)SUM_FULL : (int64_t)SUM_FULL;
}

/* Whether one of a pixel's three sums is full; false if `sums` is NULL. */
static bool pixel_full(const int64_t *sums, size_t pixel)
{
    for (size_t c = 3 * pixel; sums && c < 3 * pixel + 3; ++c)
        if (sums[c] >= (int64_t)SUM_MAX || sums[c] <= -(int64_t)SUM_MAX)
            return true;
    return false;
}

size_t film_full_pixels(const Film *film)
{
    return film_full_pixels_of(film, 0, film_pixels(film));
}

size_t film_full_pixels_of(const Film *film, size_t first, size_t end)
{
    size_t full = 0;
    for (size_t i = first; i < end; ++i)
        if (pixel_full(film->sums, i) || pixel_full(film->light_sums, i) || pixel_full(film->rare_sums, i))
            ++full;
    return full;
}

size_t film_empty_pixels(const Film *film)
{
    size_t empty = 0;
    for (size_t i = 0; i < film_pixels(film); ++i)
        empty += film->counts[i] == 0;
    return empty;
}

/* Radiance per unit of the light sums. */
static double light_unit_of(const Film *film, double unit)
{
    size_t pixels = film_pixels(film);
    uint64_t samples = film->light_samples;
    for (size_t i = 0; film->light_sums && film->light_samples == 0 && i < pixels; ++i)
        samples += film->counts[i];
    return samples > 0 ? unit * (double)pixels / (double)samples : 0.0;
}

FilmScale film_scale_of(const Film *film, float scale)
{
    double unit = ldexp((double)scale, film->quantum_exponent);
    return (FilmScale){unit, light_unit_of(film, unit)};
}

/* Resolves value v (3 per pixel) of a part of the film. */
static float value_resolve(const Film *film, FilmPart part, FilmScale scale, size_t v)
{
    uint32_t count = film->counts[v / 3];
    double value = count && part != FILM_LIGHT ? (double)film_sum_shown(film->sums[v]) * scale.own / count : 0.0;
    if (film->light_sums && part != FILM_OWN)
        value += (double)film_sum_shown(film->light_sums[v]) * scale.light;
    return (float)value;
}

void film_resolve_pixels(const Film *film, FilmPart part, FilmScale scale, size_t first, size_t count, float *rgb)
{
    for (size_t v = 0; v < 3 * count; ++v)
        rgb[v] = value_resolve(film, part, scale, 3 * first + v);
}

size_t film_infinite_pixels(const Film *film, float scale)
{
    const FilmScale units = film_scale_of(film, scale);
    size_t infinite = 0;
    for (size_t i = 0; i < film_pixels(film); ++i) {
        bool finite = true;
        for (size_t c = 0; c < 3; ++c)
            finite = finite && isfinite(value_resolve(film, FILM_ALL, units, 3 * i + c));
        infinite += !finite;
    }
    return infinite;
}

void film_resolve_part(const Film *film, FilmPart part, float scale, float *rgb)
{
    film_resolve_pixels(film, part, film_scale_of(film, scale), 0, film_pixels(film), rgb);
}

void film_resolve_depth(const Film *film, uint segments, FilmScale scale, size_t first, size_t count, float *rgb)
{
    const int64_t *sums = film_depth_sums(film, segments, FILM_KIND_LIGHT) + 3 * first;
    for (size_t i = 0; i < 3 * count; ++i)
        rgb[i] = (float)((double)film_sum_shown(sums[i]) * scale.light);
}

void film_resolve(const Film *film, float scale, float *rgb)
{
    film_resolve_part(film, FILM_ALL, scale, rgb);
}
