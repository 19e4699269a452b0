/* The film: every contribution is rounded to a 64-bit fixed-point number, and integer sums do not depend on order, so
 * the image is the same for any number of threads, devices or processes, after a resume, and after merging. Sums that
 * are full stay so (camera/film_sum.h). */
#ifndef TWINLIGHT_FILM_FILM_H
#define TWINLIGHT_FILM_FILM_H

#include "base/error.h"
#include "layout/state.h"

/* Pixels of a film: splats name them by 30 bits. */
#define FILM_PIXELS_MAX (SPLAT_RARE - 1u)

typedef struct Film {
    int width, height; /* of the whole film, pixels */
    int crop[4]; /* x0 y0 x1 y1: the part that is kept */
    int quantum_exponent; /* one unit of a sum is 2^quantum_exponent of radiance */
    /* Added to by many threads at once (camera/film_sum.h), read when they have come to rest. */
    int64_t *sums; /* 3 a pixel of the crop, row by row */
    int64_t *light_sums; /* the same for splats from the light; NULL before film_light_reserve */
    int64_t
        *rare_sums; /* of splats with SPLAT_RARE, which are in one of the others, too; NULL before film_rare_reserve */
    /* Of paths of 3, 4 ... depth_last segments, as camera/film_sum.h places them; NULL before film_depths_reserve. */
    int64_t *depth_sums;
    uint depth_kinds, depth_last;
    uint64_t light_samples; /* paths that they come from; 0: as many as samples of pixels */
    uint32_t *counts; /* samples of every pixel of the crop */
    uint64_t saturated; /* contributions that did not fit and were clamped */
    uint64_t vanished; /* contributions that are not black, but less than half a unit in every channel */
    uint64_t not_finite; /* contributions that were NaN or infinite and were counted as zero */
} Film;

/* All sums zero. The quantum is 2^-30 until film_quantum_set. */
bool film_init(Film *film, int width, int height, const int crop[4], Error *error);
void film_destroy(Film *film);

/* An empty film of the same size, crop and quantum as `model`, with room for splats from the light where that has
 * it. */
bool film_init_like(Film *film, const Film *model, Error *error);

/* Makes room for splats that paths from the light bring (SPLAT_LIGHT). Only while the film is empty. */
bool film_light_reserve(Film *film, Error *error);

/* Makes room for sums of the rare ones (SPLAT_RARE) of a film that has those of the light. They are this film's own: no
 * other film like it has them, nor gets them by film_merge. */
bool film_rare_reserve(Film *film, Error *error);

/* Makes room for sums of paths of each number of segments up to `last` by themselves, for splats that name it
 * (FrameParams.split_depths = depth_kinds): of those from the light, and where there is room for rare ones (reserved
 * before) of all kinds. They are this film's own as the rare ones are, but film_merge adds them where both films have
 * them. Only while the film is empty. */
bool film_depths_reserve(Film *film, uint last, Error *error);

/* Sums of paths of so many segments, depth_last at most: 3 a pixel. kind: FILM_KIND_*, below depth_kinds. */
int64_t *film_depth_sums(const Film *film, uint segments, uint kind);

/* Pixels of the crop. */
size_t film_pixels(const Film *film);

/* Chooses the quantum as a power of two 26 octaves under `mean`, the picture's mean radiance (0 or not finite: 2^-30).
 * Only while the film is empty. */
void film_quantum_set(Film *film, double mean);

/* Adds `count` items of a splat buffer (layout/state.h: SPLAT_PIXEL, SPLAT_COLOR at field * stride + item) and one
 * sample to each pixel named; splats from the light are not samples of their pixel. Pixels outside the crop and NONE
 * are skipped. Any number of threads may call it at once. */
void film_add_splats(Film *film, const uint *splats, uint count, uint stride);

/* Words of 64 bits that a device keeps for this film (camera/film_sum.h), and adding what has come together there to
 * it. */
size_t film_sum_words(const Film *film);
void film_add_sums(Film *film, ulong *words);

/* Adds the sums and counts of `from`, a film of the same size, crop and quantum; fails, naming the difference,
 * otherwise. */
bool film_merge(Film *film, const Film *from, Error *error);

/* Empties the film; size and quantum stay. */
void film_clear(Film *film);

/* What is read of a sum: at most 2^62 units of either sign, for sums beyond that depend on the order of additions. */
int64_t film_sum_shown(int64_t sum);

/* The nearest sum, full from 2^62 on. */
int64_t film_sum_rounded(double units);

/* Pixels of which a sum has come to 2^62 units: they are darker than they should be. */
size_t film_full_pixels(const Film *film);

/* Pixels of the whole picture, times `scale`, that a float cannot hold. */
size_t film_infinite_pixels(const Film *film, float scale);
/* Pixels that have no sample of their own. */
size_t film_empty_pixels(const Film *film);

/* One of the two parts of film_resolve alone: what the pixels' own samples saw, or what splats from the light
 * brought. */
typedef enum FilmPart { FILM_ALL, FILM_OWN, FILM_LIGHT } FilmPart;
void film_resolve_part(const Film *film, FilmPart part, float scale, float *rgb);

/* What a unit of a film's sums is worth: of those of pixels' own samples, before the division by their number, and of
 * those of splats from the light. */
typedef struct FilmScale {
    double own, light;
} FilmScale;

/* Of the film as it is: more samples make other units. Looks at all pixels. */
FilmScale film_scale_of(const Film *film, float scale);

/* Pixels first ... first + count - 1 of film_resolve_part, to rgb[3 * count]. */
void film_resolve_pixels(const Film *film, FilmPart part, FilmScale scale, size_t first, size_t count, float *rgb);

/* The same pixels of what splats from the light brought of paths of so many segments. */
void film_resolve_depth(const Film *film, uint segments, FilmScale scale, size_t first, size_t count, float *rgb);

/* rgb[3 * crop pixels] = scale * (sum / count + light sum / (light samples / pixels)); where nothing was sampled the
 * first is zero. Paths from the light meet all pixels alike, however far the samples of single pixels have come. */
void film_resolve(const Film *film, float scale, float *rgb);

#endif
