#include "film/film.h"

#include "base/zeros.h"
#include "camera/film_spread.h"

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
    *film = (Film){.width = width, .height = height, .quantum_exponent = QUANTUM_EXPONENT_DEFAULT, .threads = 1};
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
    film->sums = zeros_alloc(pixels * 3, sizeof *film->sums);
    film->counts = zeros_alloc(pixels, sizeof *film->counts);
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
        *sums = zeros_alloc(1, bytes);
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
    film->depth_sums = zeros_alloc(words, sizeof *film->depth_sums);
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
    film->threads = model->threads;
    film->reconstruction = model->reconstruction;
    film->axis_x = model->axis_x;
    film->axis_y = model->axis_y;
    return !model->light_sums || film_light_reserve(film, error);
}

void film_filter_set(Film *film, const FilmParams *params, const float *lookup)
{
    film->reconstruction = params->reconstruction;
    film->axis_x = film_axis_x(params, lookup);
    film->axis_y = film_axis_y(params, lookup);
}

uint64_t film_samples_most(uint reconstruction)
{
    /* Pixels get some samples more or less than others. */
    return reconstruction == RECONSTRUCTION_SPLAT ? UINT32_MAX / film_sample_units(reconstruction) - 0xffffu
                                                  : UINT32_MAX;
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

FilmView film_view(const Film *film)
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
                      .reconstruction = film->reconstruction,
                      .axis_x = film->axis_x,
                      .axis_y = film->axis_y,
                      .counts = film->counts,
                      .saturated = (ulong *)&film->saturated,
                      .vanished = (ulong *)&film->vanished,
                      .not_finite = (ulong *)&film->not_finite};
}

void film_add_splats(Film *film, const uint *splats, uint count, uint stride)
{
    const FilmView view = film_view(film);
    FilmPending pending;
    for (uint first = 0; first < count; first += FILM_PENDING_SPLATS) {
        uint left = count - first;
        film_pending_begin(&pending);
        for (uint i = 0; i < left && i < FILM_PENDING_SPLATS; ++i)
            film_splat_add(&view, &pending, splats, stride, first + i);
        film_pending_end(&view, &pending);
    }
}

void film_rows_run(const Film *film, ParallelPart *part, void *context)
{
    int threads = film_pixels(film) < PARALLEL_PIXELS ? 1 : film->threads;
    parallel_run((size_t)(film->crop[3] - film->crop[1]), threads, part, context);
}

void film_swap_own(Film *a, Film *b)
{
    int64_t *sums = a->sums;
    uint32_t every = a->every_count;
    a->sums = b->sums;
    b->sums = sums;
    a->every_count = b->every_count;
    b->every_count = every;
    for (size_t i = 0; i < film_pixels(a); ++i) {
        uint32_t count = a->counts[i];
        if (count != b->counts[i]) {
            a->counts[i] = b->counts[i];
            b->counts[i] = count;
        }
    }
}

/* Multiplies a pixel's sums of one kind. Full ones stay full. */
static void sums_scale(int64_t *sums, size_t pixel, double factor)
{
    for (size_t c = 3 * pixel; sums && c < 3 * pixel + 3; ++c)
        if (sums[c] != 0 && sums[c] == film_sum_shown(sums[c]))
            sums[c] = film_sum_rounded((double)sums[c] * factor);
}

typedef struct FilmNormalizing {
    Film *film;
    uint32_t count; /* of the samples of a pixel; 0: nothing is divided */
} FilmNormalizing;

/* What a pixel's sums of `before` normalized samples and of those under way are to be multiplied by. */
static double count_factor(const FilmNormalizing *normalizing, size_t pixel, uint32_t before)
{
    uint32_t count = normalizing->film->counts[pixel] + before;
    return normalizing->count > 0 && count > 0 ? ((double)normalizing->count + before) / count : 1.0;
}

static void pixel_normalize(const FilmNormalizing *normalizing, size_t pixel)
{
    Film *film = normalizing->film;
    double factor = count_factor(normalizing, pixel, 0);
    sums_scale(film->sums, pixel, count_factor(normalizing, pixel, film->every_count));
    sums_scale(film->light_sums, pixel, factor);
    sums_scale(film->rare_sums, pixel, factor);
    for (uint depth = SPLAT_DEPTH_MIN; film->depth_kinds > 0 && depth <= film->depth_last; ++depth)
        for (uint kind = 0; kind < film->depth_kinds; ++kind)
            sums_scale(film_depth_sums(film, depth, kind), pixel, factor);
    film->counts[pixel] = 0;
}

static void row_normalize(void *context, size_t row)
{
    const FilmNormalizing *normalizing = context;
    size_t width = (size_t)(normalizing->film->crop[2] - normalizing->film->crop[0]);
    for (size_t pixel = row * width; pixel < (row + 1) * width; ++pixel)
        pixel_normalize(normalizing, pixel);
}

static bool spreads(const Film *film)
{
    return film->reconstruction == RECONSTRUCTION_SPLAT;
}

static uint32_t count_of(const Film *film, uint64_t samples)
{
    return (uint32_t)(samples * film_sample_units(film->reconstruction));
}

void film_normalize(Film *film, uint64_t samples)
{
    FilmNormalizing normalizing = {film, count_of(film, samples)};
    if (!spreads(film) || samples == 0)
        return;
    film_rows_run(film, row_normalize, &normalizing);
    film->every_count += normalizing.count;
}

static void sums_clear(int64_t *sums, size_t first, size_t end)
{
    if (sums)
        memset(sums + 3 * first, 0, 3 * (end - first) * sizeof *sums);
}

/* Adds (factor - 1) times the own samples. Full sums stay full. */
static int64_t sum_normalized(int64_t light, int64_t own, double factor)
{
    if (own != film_sum_shown(own))
        return own;
    if (light != film_sum_shown(light))
        return light;
    return film_sum_rounded((double)light + (factor - 1.0) * (double)own);
}

static void row_normalize_bidirectional(void *context, size_t row)
{
    const FilmNormalizing *normalizing = context;
    Film *film = normalizing->film;
    size_t width = (size_t)(film->crop[2] - film->crop[0]), first = row * width, end = first + width;
    const bool divides = normalizing->count > 0;
    for (size_t pixel = first; pixel < end && divides && spreads(film); ++pixel) {
        double factor = count_factor(normalizing, pixel, 0);
        sums_scale(film->sums, pixel, factor);
        for (size_t c = 3 * pixel; c < 3 * pixel + 3; ++c)
            film->light_sums[c] = sum_normalized(film->light_sums[c], film->rare_sums[c], factor);
    }
    sums_clear(film->rare_sums, first, end);
    if (!divides)
        sums_clear(film->sums, first, end);
    if (!divides || spreads(film))
        memset(film->counts + first, 0, width * sizeof *film->counts);
}

void film_normalize_bidirectional(Film *film, uint64_t samples)
{
    FilmNormalizing normalizing = {film, count_of(film, samples)};
    film_rows_run(film, row_normalize_bidirectional, &normalizing);
    film->every_count = spreads(film) ? normalizing.count : 0;
}

typedef struct LightAdding {
    Film *film;
    const float *change;
} LightAdding;

static void row_light_add(void *context, size_t row)
{
    const LightAdding *adding = context;
    int64_t *sums = adding->film->light_sums;
    size_t values = 3 * (size_t)(adding->film->crop[2] - adding->film->crop[0]);
    for (size_t i = row * values; i < (row + 1) * values; ++i)
        sums[i] = film_sum_rounded((double)film_sum_shown(sums[i]) + (double)adding->change[i]);
}

void film_light_add(Film *film, const float *change, int64_t samples)
{
    LightAdding adding = {film, change};
    film_rows_run(film, row_light_add, &adding);
    film->light_samples += (uint64_t)samples;
}

void film_pixels_clear(Film *film, size_t first, size_t end)
{
    sums_clear(film->sums, first, end);
    sums_clear(film->light_sums, first, end);
    sums_clear(film->rare_sums, first, end);
    for (uint depth = SPLAT_DEPTH_MIN; film->depth_kinds > 0 && depth <= film->depth_last; ++depth)
        for (uint kind = 0; kind < film->depth_kinds; ++kind)
            sums_clear(film_depth_sums(film, depth, kind), first, end);
    for (size_t i = first; i < end; ++i)
        if (film->counts[i] > 0)
            film->counts[i] = 0;
}

void film_pixels_clear_light(Film *film, size_t first, size_t end)
{
    sums_clear(film->light_sums, first, end);
}

static void row_clear(void *context, size_t row)
{
    Film *film = context;
    size_t width = (size_t)(film->crop[2] - film->crop[0]);
    film_pixels_clear(film, row * width, (row + 1) * width);
}

void film_counters_clear(Film *film)
{
    film->light_samples = film->complete_samples = film->saturated = film->vanished = film->not_finite = 0;
    film->every_count = 0;
}

void film_clear(Film *film)
{
    film_rows_run(film, row_clear, film);
    film_counters_clear(film);
}
