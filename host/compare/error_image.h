/* Pictures of where one image differs from another. */
#ifndef TWINLIGHT_COMPARE_ERROR_IMAGE_H
#define TWINLIGHT_COMPARE_ERROR_IMAGE_H

#include "base/error.h"

/* image, reference: width x height x 3 linear RGB. By the ending of `path`:
 *
 * .exr: R, G, B = image - reference, and relative.Y = (a - r) / (|r| + 0.01 |mean of all r|), with a and r the means of
 *   a pixel's channels. What is not finite stays so.
 * .png: relative.Y in false colour, logarithmic from 0.1 % (black) to 100 % (light): too bright in red and yellow, too
 *   dark in blue and cyan, not finite in magenta.
 *
 * Fails for another ending and when the file cannot be written. */
bool error_image_write(const char *path, const float *image, const float *reference, int width, int height,
                       Error *error);

/* The false colours of the .png alone: rgb[3 x width x height], linear. */
bool error_image_rgb(const float *image, const float *reference, int width, int height, float *rgb, Error *error);

/* A PNG with image, reference and the false colours in a row, numbered 1, 2 and 3; the first two times 2^exposure. */
bool error_image_side_by_side(const char *path, const float *image, const float *reference, int width, int height,
                              double exposure, Error *error);

/* Whether the ending is one of the above; fills `error` when not. */
bool error_image_path_check(const char *path, Error *error);

/* The false colour (linear RGB) of a relative error. */
void error_color(float relative, float rgb[3]);

/* The false colour (linear RGB) of an error of 0 ... 1 that looks as large as it is: black, violet, red, orange, light
 * yellow. */
void magnitude_color(float magnitude, float rgb[3]);

#endif
