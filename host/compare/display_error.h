/* Figures of how different two pictures look on a display: FLIP and SSIM.
 *
 * Both take linear RGB of a display, 0 ... 1, which display_linear makes of a rendering; that is what a PNG of it
 * shows, but not rounded to 8 bits. */
#ifndef TWINLIGHT_COMPARE_DISPLAY_ERROR_H
#define TWINLIGHT_COMPARE_DISPLAY_ERROR_H

#include "base/error.h"

#include <stddef.h>

/* How pictures are shown: linear values x 2^exposure, clamped to 0 ... 1, encoded as sRGB, on a display with so many
 * pixels to a degree of the eye's. */
typedef struct DisplaySettings {
    double exposure; /* stops */
    double pixels_per_degree; /* 1 ... FLIP_PIXELS_PER_DEGREE_MAX */
} DisplaySettings;

typedef struct DisplayError {
    double flip, ssim; /* means; see flip_compute and ssim_compute */
} DisplayError;

/* A display 0.7 m away, 0.7 m and 3840 pixels wide, as Andersson et al. 2020 have it. */
#define FLIP_PIXELS_PER_DEGREE 67.0
#define FLIP_PIXELS_PER_DEGREE_MAX 1000.0

/* The side of SSIM's window. */
#define SSIM_WINDOW 11

/* Both figures of two renderings (width x height x 3 linear RGB). Fails when memory is out. */
bool display_error_compute(const float *image, const float *reference, int width, int height,
                           const DisplaySettings *settings, DisplayError *result, Error *error);

/* The tone map: out = in x 2^exposure_stops, clamped to 0 ... 1; NaN is 0. `count` values. */
void display_linear(const float *in, size_t count, double exposure_stops, float *out);

/* *mean = the mean over all pixels of LDR-FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild,
 * "FLIP: A Difference Evaluator for Alternating Images", 2020), 0 (alike) to 1. `map`: a value a pixel; may be NULL. 1
 * <= pixels_per_degree <= FLIP_PIXELS_PER_DEGREE_MAX. Fails when memory is out. */
bool flip_compute(const float *image, const float *reference, int width, int height, double pixels_per_degree,
                  float *map, double *mean, Error *error);

/* *mean = the mean structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error
 * Visibility to Structural Similarity", 2004), 1 for equal pictures: window 11 x 11, Gaussian of sigma 1.5, K1 = 0.01,
 * K2 = 0.03, L = 1, of the luma 0.2126 R' + 0.7152 G' + 0.0722 B' of the sRGB-encoded values, over all places where the
 * window is within the picture. NaN where there is none. Fails when memory is out. */
bool ssim_compute(const float *image, const float *reference, int width, int height, double *mean, Error *error);

#endif
