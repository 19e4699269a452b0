#include "film.h"

#include "state.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Octaves between the scene's mean radiance and one unit of a sum. */
#define QUANTUM_OCTAVES 26
#define QUANTUM_EXPONENT_DEFAULT (-30)

/* A contribution larger than this many units is clamped: with 26 octaves that is four million times the mean. Of the
 * largest ones 2^14 fit into a sum. */
#define CONTRIBUTION_MAX 281474976710656.0 /* 2^48 */

/* A sum beyond this is reported as saturated, long before it could wrap. */
#define SUM_MAX ((int64_t)1 << 62)

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
    /* Splats name pixels by 31 bits. */
    if ((uint64_t)width * (uint64_t)height >= SPLAT_FROM_LIGHT) {
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

bool film_light_reserve(Film *film, Error *error)
{
    size_t bytes = film_pixels(film) * 3 * sizeof *film->light_sums;
    if (!film->light_sums)
        film->light_sums = calloc(1, bytes);
    return film->light_sums || error_memory(error, bytes, "the film of the light's paths");
}

void film_destroy(Film *film)
{
    free((void *)film->sums);
    free((void *)film->light_sums);
    free((void *)film->counts);
    *film = (Film){0};
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

static void count_add(_Atomic uint64_t *counter, uint64_t n)
{
    if (n)
        atomic_fetch_add_explicit(counter, n, memory_order_relaxed);
}

/* The nearest whole number of units, halves away from zero. `value` has 24 significant bits and `scale` is a power of
 * two, so the product is exact; the sum with 1/2 is, too, where it decides. The same on every machine. */
static int64_t film_quantize(float value, double scale, bool *clamped)
{
    double units = fabs((double)value) * scale;
    *clamped = units > CONTRIBUTION_MAX;
    int64_t whole = (int64_t)floor((*clamped ? CONTRIBUTION_MAX : units) + 0.5);
    return value < 0.0f ? -whole : whole;
}

/* Adds to one sum. The addition is modulo 2^64, so even a wrapped sum does not depend on order. Returns false when the
 * sum has left +-SUM_MAX. */
static bool sum_add(_Atomic int64_t *sum, int64_t value)
{
    int64_t before = atomic_fetch_add_explicit(sum, value, memory_order_relaxed);
    int64_t after = (int64_t)((uint64_t)before + (uint64_t)value);
    return after < SUM_MAX && after > -SUM_MAX;
}

/* Where in `counts` film pixel number `pixel` is kept; false outside the crop. */
static bool film_slot(const Film *film, uint pixel, size_t *slot)
{
    if (pixel == NONE)
        return false;
    int64_t x = pixel % (uint)film->width, y = pixel / (uint)film->width;
    if (x < film->crop[0] || x >= film->crop[2] || y < film->crop[1] || y >= film->crop[3])
        return false;
    *slot = (size_t)((y - film->crop[1]) * (film->crop[2] - film->crop[0]) + x - film->crop[0]);
    return true;
}

/* Adds a contribution to three sums; false when it was clamped or a sum is full. */
static bool sums_add(_Atomic int64_t *sums, Vec3 color, double scale)
{
    const float values[3] = {color.x, color.y, color.z};
    bool fits = true;
    for (size_t c = 0; c < 3; ++c) {
        bool clamped;
        int64_t units = film_quantize(values[c], scale, &clamped);
        if (units != 0 && !sum_add(&sums[c], units))
            fits = false;
        fits = fits && !clamped;
    }
    return fits;
}

void film_add_splats(Film *film, const uint *splats, uint count, uint stride)
{
    const double scale = ldexp(1.0, -film->quantum_exponent);
    uint64_t saturated = 0, not_finite = 0;
    for (uint t = 0; t < count; ++t) {
        size_t slot;
        uint pixel = state_load(splats, stride, SPLAT_PIXEL, t);
        bool from_light = pixel != NONE && (pixel & SPLAT_FROM_LIGHT) != 0;
        if (!film_slot(film, from_light ? pixel & ~SPLAT_FROM_LIGHT : pixel, &slot))
            continue;
        assert(!from_light || film->light_sums);
        Vec3 color = state_load_vec3(splats, stride, SPLAT_COLOR, t);
        if (!from_light)
            atomic_fetch_add_explicit(&film->counts[slot], 1u, memory_order_relaxed);
        if (!vec3_finite(color))
            ++not_finite;
        else if (!sums_add((from_light ? film->light_sums : film->sums) + 3 * slot, color, scale))
            ++saturated;
    }
    count_add(&film->saturated, saturated);
    count_add(&film->not_finite, not_finite);
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
    size_t pixels = film_pixels(film);
    for (size_t i = 0; i < pixels; ++i) {
        atomic_fetch_add_explicit(&film->counts[i], from->counts[i], memory_order_relaxed);
        bool fits = true;
        for (size_t c = 0; c < 3; ++c)
            if (!sum_add(&film->sums[3 * i + c], from->sums[3 * i + c]) ||
                (film->light_sums && !sum_add(&film->light_sums[3 * i + c], from->light_sums[3 * i + c])))
                fits = false;
        count_add(&film->saturated, fits ? 0 : 1);
    }
    film->light_samples += from->light_samples;
    count_add(&film->saturated, from->saturated);
    count_add(&film->not_finite, from->not_finite);
    return true;
}

void film_clear(Film *film)
{
    size_t pixels = film_pixels(film);
    for (size_t i = 0; i < pixels; ++i)
        atomic_store_explicit(&film->counts[i], 0u, memory_order_relaxed);
    for (size_t i = 0; i < 3 * pixels; ++i) {
        atomic_store_explicit(&film->sums[i], 0, memory_order_relaxed);
        if (film->light_sums)
            atomic_store_explicit(&film->light_sums[i], 0, memory_order_relaxed);
    }
    film->light_samples = 0;
    film->saturated = film->not_finite = 0;
}

void film_resolve(const Film *film, float scale, float *rgb)
{
    const double unit = ldexp((double)scale, film->quantum_exponent);
    size_t pixels = film_pixels(film);
    uint64_t samples = film->light_samples;
    for (size_t i = 0; film->light_sums && film->light_samples == 0 && i < pixels; ++i)
        samples += atomic_load_explicit(&film->counts[i], memory_order_relaxed);
    double light_unit = samples > 0 ? unit * (double)pixels / (double)samples : 0.0;
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t count = atomic_load_explicit(&film->counts[i], memory_order_relaxed);
        for (size_t c = 0; c < 3; ++c) {
            int64_t sum = atomic_load_explicit(&film->sums[3 * i + c], memory_order_relaxed);
            double value = count ? (double)sum * unit / count : 0.0;
            if (film->light_sums)
                value += (double)atomic_load_explicit(&film->light_sums[3 * i + c], memory_order_relaxed) * light_unit;
            rgb[3 * i + c] = (float)value;
        }
    }
}
