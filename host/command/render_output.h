/* Where a rendering goes: an OpenEXR image and a PNG beside it, each written to a temporary file that then takes the
 * name, so that a reader never sees half an image. */
#ifndef TWINLIGHT_COMMAND_RENDER_OUTPUT_H
#define TWINLIGHT_COMMAND_RENDER_OUTPUT_H

#include "render/picture.h"
#include "scene/scene.h"

#include <limits.h>

typedef struct RenderOutput {
    char exr[PATH_MAX];
    char png[PATH_MAX]; /* "": none */
    PictureSettings picture;
    float exposure; /* stops, PNG only */
    PictureMemory memory;
    /* Called while a file is written, which part of it is: often, the first time with 0. May be NULL. */
    void (*writing)(void *context, const char *path, double part);
    void *writing_context;
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

/* Makes room for writing pictures of this crop, before the first sample: so that what is rendered can be written
 * whatever memory is left then. */
bool render_output_reserve(RenderOutput *output, const int crop[4], Error *error);
void render_output_release(RenderOutput *output);

/* Writes both files. `samples_per_pixel` goes to the header. */
bool render_output_write(RenderOutput *output, const Film *film, double samples_per_pixel, Error *error);

#endif
