/* A rendering read from its file: the image and, if present, the two half-images whose difference shows its noise. */
#ifndef TWINLIGHT_IMAGE_RENDERING_FILE_H
#define TWINLIGHT_IMAGE_RENDERING_FILE_H

#include "base/error.h"

typedef struct Rendering {
    int width, height;
    float *rgb; /* width x height x 3, linear */
    float *halves[2]; /* layers halfA and halfB, same format; NULL if the file lacks them */
} Rendering;

/* Reads any format of image/read.h. On failure `rendering` is empty. */
bool rendering_load(const char *path, Rendering *rendering, Error *error);
void rendering_destroy(Rendering *rendering);

bool rendering_has_halves(const Rendering *rendering);

/* Writes the mean of two images of width x height x 3 as an EXR: as half floats or, with `layers`, as floats with both
 * images as layers halfA and halfB, as `twinlight render` does. */
bool rendering_mean_write(const char *path, float *const halves[2], int width, int height, bool layers, Error *error);

/* Fails, naming both paths, if the sizes differ. */
bool rendering_same_size(const Rendering *a, const char *a_path, const Rendering *b, const char *b_path, Error *error);

#endif
