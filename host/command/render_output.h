/* The output of a rendering: an OpenEXR image and a PNG. Each is written to a temporary file that is then renamed, so a
 * reader never sees half an image. */
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
    /* Called often while a file is written, with the fraction written so far, first with 0. May be NULL. */
    void (*writing)(void *context, const char *path, double part);
    void *writing_context;
    /* For the EXR header. */
    const char *scene_file;
    const char *integrator;
    double error; /* estimated, for the header; 0: not known */
    uint64_t seed;
    int max_depth;
    float world_to_camera[16], world_to_ndc[16]; /* camera_matrices */
} RenderOutput;

/* Sets the names. The EXR's is `image` with the ending .exr. The PNG's is `png`, or if that is NULL the EXR's with the
 * ending .png; empty if !want_png. */
bool render_output_name(RenderOutput *output, const char *image, bool want_png, const char *png, Error *error);

/* Reserves the memory for writing pictures of this crop. Call it before the first sample: what is rendered can then be
 * written even if no memory is left. threads: that may write. */
bool render_output_reserve(RenderOutput *output, const int crop[4], int threads, Error *error);
void render_output_release(RenderOutput *output);

/* The seconds that the first write will take, from the size of the picture and its layers. After
 * render_output_reserve. */
double render_output_seconds(const RenderOutput *output);

/* Writes both files from the current film. `samples_per_pixel` goes to the EXR header. After render_output_reserve. */
bool render_output_write(RenderOutput *output, const Film *film, double samples_per_pixel, Error *error);

#endif
