/* Image differences as seen on a display: FLIP and SSIM.
 *
 * flip_compute and ssim_compute take linear display RGB in [0, 1], which display_linear makes from a rendering: what a
 * PNG of it shows, without rounding to 8 bits. */
#ifndef TWINLIGHT_COMPARE_DISPLAY_ERROR_H
#define TWINLIGHT_COMPARE_DISPLAY_ERROR_H

#include "base/error.h"

#include <stddef.h>

/* How images are displayed: linear values x 2^exposure, clamped to [0, 1], encoded as sRGB, on a display with
 * pixels_per_degree pixels per degree of visual angle. */
typedef struct DisplaySettings {
    double exposure; /* stops */
    double pixels_per_degree; /* 1 ... FLIP_PIXELS_PER_DEGREE_MAX */
} DisplaySettings;

typedef struct DisplayError {
    double flip, ssim; /* means; see flip_compute and ssim_compute */
} DisplayError;

/* A display 0.7 m away, 0.7 m and 3840 pixels wide, as in Andersson et al. 2020. */
#define FLIP_PIXELS_PER_DEGREE 67.0
#define FLIP_PIXELS_PER_DEGREE_MAX 1000.0

/* Width and height of SSIM's window, pixels. */
#define SSIM_WINDOW 11

/* Computes both for two renderings (width x height x 3 linear RGB). Fails when out of memory. */
bool display_error_compute(const float *image, const float *reference, int width, int height,
                           const DisplaySettings *settings, DisplayError *result, Error *error);

/* Tone map: out = in x 2^exposure_stops, clamped to [0, 1]; NaN becomes 0. `count` values. */
void display_linear(const float *in, size_t count, double exposure_stops, float *out);

/* *mean = mean over all pixels of LDR-FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP:
 * A Difference Evaluator for Alternating Images", 2020), from 0 (equal) to 1. shown: an image and its reference.
 * `map`: one value per pixel; may be NULL. 1 <= pixels_per_degree <= FLIP_PIXELS_PER_DEGREE_MAX. Fails when out of
 * memory. */
bool flip_compute(const float *const shown[2], int width, int height, double pixels_per_degree, float *map,
                  double *mean, Error *error);

/* *mean = mean structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error
 * Visibility to Structural Similarity", 2004), 1 for equal images: window 11 x 11, Gaussian of sigma 1.5, K1 = 0.01,
 * K2 = 0.03, L = 1, on the luma 0.2126 R' + 0.7152 G' + 0.0722 B' of the sRGB-encoded values, over all positions of the
 * window inside the image; NaN if the image is smaller than the window. Fails when out of memory. */
bool ssim_compute(const float *image, const float *reference, int width, int height, double *mean, Error *error);

#endif
