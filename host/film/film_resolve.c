/* Reading a film: from sums to pixels. */
#include "camera/film_spread.h"
#include "film/film.h"

#include <math.h>

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
        empty += film_count(film, i) == 0;
    return empty;
}

uint64_t film_samples(const Film *film)
{
    uint64_t units = 0;
    for (size_t i = 0; i < film_pixels(film); ++i)
        units += film_count(film, i);
    return units / film_sample_units(film->reconstruction);
}

/* Radiance per unit of the light sums. */
static double light_unit_of(const Film *film, double unit)
{
    bool needs_samples = film->light_samples == 0 || film->complete_samples > 0;
    double samples = film->light_sums && needs_samples ? (double)film_samples(film) : 0.0;
    double light_samples = film->light_samples > 0 ? (double)film->light_samples : samples;
    double part = film->complete_samples > 0 ? fmax(1.0 - (double)film->complete_samples / samples, 0.0) : 1.0;
    return light_samples > 0.0 ? part * unit * (double)film_pixels(film) / light_samples : 0.0;
}

FilmScale film_scale_of(const Film *film, float scale)
{
    double unit = ldexp((double)scale, film->quantum_exponent);
    return (FilmScale){unit * film_sample_units(film->reconstruction), light_unit_of(film, unit)};
}

/* Resolves value v (3 per pixel) of a part of the film. */
static float value_resolve(const Film *film, FilmPart part, FilmScale scale, size_t v)
{
    uint32_t count = film_count(film, v / 3);
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
