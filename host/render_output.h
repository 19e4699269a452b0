/* Where a rendering goes: an OpenEXR image and a PNG beside it, each written to a temporary file that then takes the
 * name, so that a reader never sees half an image. */
#ifndef TWINLIGHT_RENDER_OUTPUT_H
#define TWINLIGHT_RENDER_OUTPUT_H

#include "render_layers.h"
#include "scene.h"

#include <limits.h>

typedef struct RenderOutput {
    char exr[PATH_MAX];
    char png[PATH_MAX]; /* "": none */
    float film_scale; /* factor on every pixel */
    float exposure; /* stops, PNG only */
    double despeckle; /* threshold of the layer `despeckled`; 0: none */
    const RenderLayers *layers; /* NULL: none */
    /* What the EXR header says besides the picture. */
    const char *scene_file;
    const char *integrator;
    uint64_t seed;
    int max_depth;
    float world_to_camera[16], world_to_ndc[16]; /* camera_matrices */
} RenderOutput;

/* Sets the names: the EXR's is `image` with the ending .exr; the PNG's is `png`, or beside the EXR when that is NULL,
 * none when !want_png. */
bool render_output_name(RenderOutput *output, const char *image, bool want_png, const char *png, Error *error);

/* Writes both files. `samples_per_pixel` goes to the header. */
bool render_output_write(const RenderOutput *output, const Film *film, double samples_per_pixel, Error *error);

#endif
