/* Images of the difference between two images. */
#ifndef TWINLIGHT_COMPARE_ERROR_IMAGE_H
#define TWINLIGHT_COMPARE_ERROR_IMAGE_H

#include "base/error.h"

/* image, reference: width x height x 3 linear RGB. The ending of `path` selects the format:
 *
 * .exr: R, G, B = image - reference, and relative.Y = (a - r) / (|r| + 0.01 |mean of all r|), with a and r the means of
 *   a pixel's channels. Values that are not finite are kept.
 * .png: relative.Y in false colour, logarithmic from 0.1 % (black) to 100 % (light): too bright in red and yellow, too
 *   dark in blue and cyan, not finite in magenta.
 *
 * Fails for other endings and if the file cannot be written. */
bool error_image_write(const char *path, const float *image, const float *reference, int width, int height,
                       Error *error);

/* Only the false colours of the .png: rgb[3 x width x height], linear. */
bool error_image_rgb(const float *image, const float *reference, int width, int height, float *rgb, Error *error);

/* Writes a PNG with image, reference and false colours side by side, labelled 1, 2 and 3; the first two are multiplied
 * by 2^exposure. */
bool error_image_side_by_side(const char *path, const float *image, const float *reference, int width, int height,
                              double exposure, Error *error);

/* Whether `path` has one of the above endings; sets `error` if not. */
bool error_image_path_check(const char *path, Error *error);

/* False colour (linear RGB) of a relative error. */
void error_color(float relative, float rgb[3]);

/* False colour (linear RGB) of an error in [0, 1], in even steps of lightness: black, violet, red, orange, light
 * yellow. */
void magnitude_color(float magnitude, float rgb[3]);

#endif
