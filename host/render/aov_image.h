/* The image of an auxiliary variable (layout/aov_list.h). Its few samples per pixel are added pass by pass, one of each
 * pixel in a pass, so that sums of floats do not depend on the order in which a pass ends. */
#ifndef TWINLIGHT_RENDER_AOV_IMAGE_H
#define TWINLIGHT_RENDER_AOV_IMAGE_H

#include "camera/film_sum.h"
#include "film/film.h"

/* Most samples per pixel. */
#define AOV_SAMPLES_MAX 255u

typedef struct AovImage {
    FilmView film; /* size and crop alone */
    size_t channels; /* 1 or 3 */
    float *sums; /* channels per pixel of the crop; NULL: see trues */
    unsigned char *trues; /* of an AOV_PART, whose samples are 0 or 1: their sum */
    unsigned char *counts; /* samples per pixel */
    bool counts_borrowed;
} AovImage;

/* What the values of an image are. */
typedef struct AovKind {
    size_t channels; /* 1 or 3 */
    bool part; /* AOV_PART; of one channel */
} AovKind;

/* An empty image for the crop of `film`. counted: an image that gets a sample of a pixel whenever this one does, whose
 * counts it shares, and which must outlive it; NULL: none. Fails when out of memory. */
bool aov_image_init(AovImage *image, const Film *film, AovKind kind, const AovImage *counted, Error *error);
void aov_image_destroy(AovImage *image);

/* Saves the samples so far, or restores them into an image of the same size. */
void aov_image_archive(Archive *archive, AovImage *image);

/* Adds the splats of a pass of several variables (SPLAT_FILM_SHIFT): `images`, of which `number` exist. A sample that
 * is not finite counts as zero. Any number of threads may add those of different pixels concurrently. */
void aov_images_add(AovImage *images, uint number, const uint *splats, uint count, uint stride);

/* rgb[3 * count]: the means of pixels first ... first + count - 1, of a variable with one channel three times; 0
 * without samples. */
void aov_image_resolve(const AovImage *image, size_t first, size_t count, float *rgb);

#endif
