/* A rendering read back from its file: the picture, and the two halves that show its noise where the file has them. */
#ifndef TWINLIGHT_IMAGE_RENDERING_FILE_H
#define TWINLIGHT_IMAGE_RENDERING_FILE_H

#include "base/error.h"

typedef struct Rendering {
    int width, height;
    float *rgb; /* width x height x 3, linear */
    float *halves[2]; /* the same of layers halfA and halfB; NULL when the file lacks one */
} Rendering;

/* Reads any kind of image that image/image.h knows. On failure `rendering` is empty. */
bool rendering_load(const char *path, Rendering *rendering, Error *error);
void rendering_destroy(Rendering *rendering);

bool rendering_has_halves(const Rendering *rendering);

/* Writes the mean of two pictures of width x height x 3 as an EXR: as half floats or, with `layers`, as floats with
 * both as its halves, as `twinlight render` writes them. */
bool rendering_mean_write(const char *path, float *const halves[2], int width, int height, bool layers, Error *error);

/* Fails, naming both, when the sizes differ. */
bool rendering_same_size(const Rendering *a, const char *a_path, const Rendering *b, const char *b_path, Error *error);

#endif
