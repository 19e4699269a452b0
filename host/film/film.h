/* The film. Every contribution is rounded to 64-bit fixed point. Integer sums do not depend on order, so the image is
 * the same for any number of threads, devices or processes, after a resume, and after merging. Full sums stay full
 * (camera/film_sum.h). */
#ifndef TWINLIGHT_FILM_FILM_H
#define TWINLIGHT_FILM_FILM_H

#include "base/archive.h"
#include "base/parallel.h"
#include "camera/film_axis.h"
#include "camera/film_sum.h"

#include <math.h>

/* Maximum number of pixels: splats store a pixel in 29 bits (SPLAT_FILM_SHIFT). */
#define FILM_PIXELS_MAX ((1u << SPLAT_FILM_SHIFT) - 1u)

typedef struct Film {
    int width, height; /* of the whole film, pixels */
    int crop[4]; /* x0 y0 x1 y1: the part that is stored */
    int quantum_exponent; /* the quantum, one unit of a sum, is 2^quantum_exponent of radiance */
    /* Added to by many threads concurrently (camera/film_sum.h); read only when these are idle. */
    int64_t *sums; /* 3 per pixel of the crop, row by row */
    int64_t *light_sums; /* the same for splats with SPLAT_LIGHT; NULL before film_light_reserve */
    int64_t *rare_sums; /* for SPLAT_RARE, also in one of the other sums; NULL before film_rare_reserve */
    /* Sums per depth SPLAT_DEPTH_MIN ... depth_last, laid out by film_depth_place in camera/film_sum.h; NULL before
     * film_depths_reserve. */
    int64_t *depth_sums;
    uint depth_kinds, depth_last;
    uint64_t light_samples; /* number of paths behind light_sums; 0: as many as samples of pixels */
    /* Of all pixels' samples together, those that are complete: their `sums` hold all of their light. The rest are
     * shown with what is in light_sums, which counts in proportion to their number. 0, or all pixels have the same
     * number of samples. */
    uint64_t complete_samples;
    uint reconstruction; /* RECONSTRUCTION_*, with the pixel filter: film_filter_set */
    FilmAxis axis_x, axis_y;
    /* Samples per pixel of the crop, in units of film_sample_units (camera/film_spread.h), and more that every pixel
     * has (film_normalize): film_count. The memory for counts that have always been zero is not used. */
    uint32_t *counts, every_count;
    uint64_t saturated; /* contributions clamped because they were too large */
    uint64_t vanished; /* contributions that are not black, but below half a unit in every channel */
    uint64_t not_finite; /* contributions that were NaN or infinite and counted as zero */
    int threads; /* that merge, normalize or clear it: 1 unless set */
} Film;

/* All sums are zero; the quantum is 2^-30 until film_quantum_set. Fails for a crop without pixels or when out of
 * memory. */
bool film_init(Film *film, int width, int height, const int crop[4], Error *error);
void film_destroy(Film *film);

/* Takes reconstruction and filter from `params`, whose crop is that of the film. `lookup`: the scene's, for as long as
 * splats are added. Only while the film is empty. */
void film_filter_set(Film *film, const FilmParams *params, const float *lookup);

/* Largest number of samples per pixel. */
uint64_t film_samples_most(uint reconstruction);

/* An empty film with the size, crop, filter, quantum and threads of `model`, and with light sums if `model` has them
 * (but no rare or depth sums). */
bool film_init_like(Film *film, const Film *model, Error *error);

/* Allocates sums for splats with SPLAT_LIGHT. Only while the film is empty. */
bool film_light_reserve(Film *film, Error *error);

/* Allocates sums for splats with SPLAT_RARE, in a film that has light sums. film_init_like does not copy them, and
 * film_merge adds them only if both films have them. */
bool film_rare_reserve(Film *film, Error *error);

/* Allocates separate sums per depth up to `last`, for splats that store their depth (FrameParams.film.split_depths =
 * depth_kinds): of splats from the light only or, if rare sums are already reserved, of all kinds. film_init_like does
 * not copy them, and film_merge adds those that both films have. Only while the film is empty. */
bool film_depths_reserve(Film *film, uint last, Error *error);

/* Sums of paths of `segments` segments (at most depth_last), 3 per pixel. kind: FILM_KIND_*, below depth_kinds. */
int64_t *film_depth_sums(const Film *film, uint segments, uint kind);

/* Samples of a pixel of the crop, in units of film_sample_units. */
static inline uint32_t film_count(const Film *film, size_t pixel)
{
    return film->counts[pixel] + film->every_count;
}

/* Samples of all pixels together. Reads all counts. */
uint64_t film_samples(const Film *film);

/* Number of pixels of the crop. */
size_t film_pixels(const Film *film);

/* The film as kernels see it, also for reading a const film. */
FilmView film_view(const Film *film);

/* Calls part(context, row) for every row of pixels, several at a time in large films. */
void film_rows_run(const Film *film, ParallelPart *part, void *context);

/* Chooses the quantum: a power of two 26 octaves below `mean`, the mean radiance of the image (if 0 or not finite:
 * 2^-30). Only while the film is empty. */
void film_quantum_set(Film *film, double mean);

/* Adds `count` items of a splat buffer (layout/state.h: SPLAT_PIXEL, SPLAT_COLOR at field * stride + item) and counts a
 * sample for each pixel named; splats from the light are not samples of their pixel. Pixels outside the crop and NONE
 * are skipped. Thread-safe. */
void film_add_splats(Film *film, const uint *splats, uint count, uint stride);

/* Number of 64-bit words in a device's copy of this film (BUFFER_FILM, camera/film_sum.h), and adding such a copy to
 * the film. */
size_t film_sum_words(const Film *film);
void film_add_sums(Film *film, ulong *words);

/* Adds sums to others of the same kind, saturating as those of films do. */
void film_words_add(ulong *words, const ulong *more, size_t count);

/* Adds the sums and counts of `from`. Fails, naming the difference, unless size, crop, quantum and the presence of
 * light sums agree. */
bool film_merge(Film *film, const Film *from, Error *error);

/* Exchanges `sums` and counts of two films of the same size. */
void film_swap_own(Film *a, Film *b);

/* For a film in which every pixel has `samples` samples, of which splats from the light are a part: divides each
 * pixel's sums, of all layers, by the number of samples that lie near it, and multiplies by `samples`. `sums` may have
 * had more samples before, which have been normalized and stay. Nothing changes unless the film spreads splats. */
void film_normalize(Film *film, uint64_t samples);

/* The same for a film of bidirectional samples, without sums per depth: of light_sums only for the pixels' own samples,
 * which rare_sums hold once more, and not for splats from the light. rare_sums are zero then. samples 0: some pixels
 * have none; nothing is divided, and `sums` are zero, too, and without samples. */
void film_normalize_bidirectional(Film *film, uint64_t samples);

/* Adds `change`, 3 values a pixel in units of the sums, to light_sums, and `samples` to light_samples. */
void film_light_add(Film *film, const float *change, int64_t samples);

/* Resets all sums and counters to zero; size and quantum stay. The next three: only the sums and counts of pixels
 * [first, end), only their light_sums, and only what the film counts as a whole. */
void film_clear(Film *film);
void film_pixels_clear(Film *film, size_t first, size_t end);
void film_pixels_clear_light(Film *film, size_t first, size_t end);
void film_counters_clear(Film *film);

/* Saves sums and counts, or restores them into a film with the same size, crop, quantum, reconstruction and kinds of
 * sums. */
void film_archive(Archive *archive, Film *film);

/* The value read from a sum: clamped to +-2^62 units, because larger sums depend on the order of additions. */
static inline int64_t film_sum_shown(int64_t sum)
{
    const int64_t most = (int64_t)SUM_MAX;
    return sum > most ? most : sum < -most ? -most : sum;
}

/* The sum nearest to `units`; full from 2^62 on. */
static inline int64_t film_sum_rounded(double units)
{
    const double most = (double)SUM_MAX;
    if (fabs(units) < most)
        return llrint(units);
    return units < 0.0 ? -(int64_t)SUM_FULL : (int64_t)SUM_FULL;
}

/* Number of pixels with a sum at or beyond 2^62 units; they are darker than they should be. */
size_t film_full_pixels(const Film *film);
size_t film_full_pixels_of(const Film *film, size_t first, size_t end); /* ... of the pixels first ... end - 1 */

/* Number of pixels of the whole image, times `scale`, that overflow a float. */
size_t film_infinite_pixels(const Film *film, float scale);
/* Number of pixels without a sample of their own. */
size_t film_empty_pixels(const Film *film);

/* One part of film_resolve: all, only the pixels' own samples, or only splats from the light. */
typedef enum FilmPart { FILM_ALL, FILM_OWN, FILM_LIGHT } FilmPart;
void film_resolve_part(const Film *film, FilmPart part, float scale, float *rgb);

/* Radiance per unit of a film's sums: `own` before the division by a pixel's number of samples, `light` complete. */
typedef struct FilmScale {
    double own, light;
} FilmScale;

/* The scale for the film's present number of samples, which `light` depends on. Reads all pixels. */
FilmScale film_scale_of(const Film *film, float scale);

/* film_resolve_part for pixels first ... first + count - 1 only, into rgb[3 * count]. */
void film_resolve_pixels(const Film *film, FilmPart part, FilmScale scale, size_t first, size_t count, float *rgb);

/* The same pixels of the light sums of paths of `segments` segments. */
void film_resolve_depth(const Film *film, uint segments, FilmScale scale, size_t first, size_t count, float *rgb);

/* rgb[3 * crop pixels] = scale * (sum / count + c light sum / (light samples / pixels)); the first term is zero for
 * pixels without samples; c is the part of the samples that are not complete. Paths from the light can reach every
 * pixel, whatever the sample count of the single pixel. */
void film_resolve(const Film *film, float scale, float *rgb);

#endif
