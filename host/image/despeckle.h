/* Thresholded median filter (Frolov 2018, section 6) against the impulse noise that remains in a long rendering. The
 * result is biased: for viewing only, never for error metrics. */
#ifndef TWINLIGHT_IMAGE_DESPECKLE_H
#define TWINLIGHT_IMAGE_DESPECKLE_H

/* Filters rows first ... first + rows - 1 of `rgb` (width x height x 3) into `out` (width x rows x 3). A pixel whose
 * luminance exceeds `threshold` times the median luminance of its 3 x 3 neighbourhood (pixels inside the image only) is
 * replaced by that median pixel. Others are copied. */
void despeckle(const float *rgb, int width, int height, int first, int rows, float threshold, float *out);

#endif
