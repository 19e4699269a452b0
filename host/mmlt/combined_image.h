/* The picture of a generation under way. Its estimators run one after the other and share one film; what each leaves
 * there is learnt from, weighted and added, and the film is free for the next. So a generation needs the memory of
 * one film and this.
 *
 * Layers of the film: light_sums hold paths that all estimators make, up to the estimator's clamping threshold. Of
 * path tracing and of bidirectional path tracing `sums` hold direct light, and stay in the film from one to the
 * other; of the former rare_sums hold what of the light is rare. Of chains, `sums` hold the excess and rare_sums the
 * rare light. */
#ifndef TWINLIGHT_MMLT_COMBINED_IMAGE_H
#define TWINLIGHT_MMLT_COMBINED_IMAGE_H

#include "mmlt/combination.h"

/* What changes in the film's light sums, 3 per pixel in units of the film's, and in their number of samples if path
 * tracing alone is shown in some generations. */
typedef struct PathsChange {
    float *values; /* NULL: it is not known */
    int64_t samples;
} PathsChange;

typedef struct CombinedImage {
    float *light; /* 3 per pixel, in units of the film's sums */
    float *depths; /* the same for each depth that the film has, or NULL */
    size_t values, depth_values; /* in `light` and in `depths` */
    PathsChange *change; /* that the generation is added to; NULL: none */
    Combination *learner; /* learns from the generation ... */
    Combination *teacher; /* ... and this has the weights; the same if generations are independent */
    double samples[ESTIMATOR_COUNT];
    uint64_t worth;
    uint64_t saturated, vanished, not_finite; /* of the film (film/film.h), so far */
} CombinedImage;

/* Allocates for films like `film`. Call combined_image_destroy even on failure. */
bool combined_image_init(CombinedImage *image, const Film *film, Error *error);
void combined_image_destroy(CombinedImage *image);

/* Begins with no change for `values` values; or forgets what it was. */
bool paths_change_init(PathsChange *change, size_t values, Error *error);
void paths_change_forget(PathsChange *change);

/* Saves what changes, or restores it. */
void paths_change_archive(Archive *archive, PathsChange *change, size_t values);

/* An empty image of a generation in which the estimators have `samples` (0: none), by the weights that the teacher now
 * has for them. */
void combined_image_begin(CombinedImage *image, Combination *learner, Combination *teacher,
                          const double samples[ESTIMATOR_COUNT]);

/* Adds what an estimator has left in the film, and learns from it, unless it has no samples. take: empties the film,
 * too, but for direct light of bidirectional path tracing. Path tracing comes after that, if not first. */
void combined_image_add(CombinedImage *image, EstimatorKind kind, Film *film);
void combined_image_take(CombinedImage *image, EstimatorKind kind, Film *film);

/* Puts the image into the film's light_sums. Its number of samples becomes the generation's worth, by which film_merge
 * weights it. The film's `sums` and counts are to hold direct light. */
void combined_image_finish(const CombinedImage *image, Film *film);

#endif
