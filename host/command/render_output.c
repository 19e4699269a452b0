#include "command/render_output.h"

#include "config.h"

#include "base/path_name.h"
#include "image/exr.h"
#include "image/png_write.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* target = `path`, its ending (if any) replaced by `ending`; unchanged if it already ends so, in any case. */
static bool path_with_ending(char target[PATH_MAX], const char *path, const char *ending, Error *error)
{
    const char *name = path_file_name(path);
    const char *dot = strrchr(name, '.');
    bool ends = path_ends(path, ending);
    size_t stem = dot && dot != name && !ends ? (size_t)(dot - path) : strlen(path);
    if (stem + strlen(ending) >= PATH_MAX) {
        error_set(error, "the file name is too long: %.200s...", path);
        return error_fix(error, "give a shorter one with --output");
    }
    snprintf(target, PATH_MAX, "%.*s%s", (int)stem, path, ends ? "" : ending);
    return true;
}

bool render_output_name(RenderOutput *output, const char *image, bool want_png, const char *png, Error *error)
{
    output->png[0] = '\0';
    if (!path_with_ending(output->exr, image, ".exr", error))
        return false;
    return !want_png || path_with_ending(output->png, png ? png : output->exr, ".png", error);
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

bool render_output_reserve(RenderOutput *output, const int crop[4], int threads, Error *error)
{
    return picture_memory_init(&output->memory, &output->picture, crop[2] - crop[0], crop[3] - crop[1],
                               (uint)output->max_depth, threads, error);
}

void render_output_release(RenderOutput *output)
{
    picture_memory_destroy(&output->memory);
}

/* Resolving, compressing and writing a value takes a thread about so long (2 cores, 1920 x 1080 and 3840 x 2160,
 * default layers). */
#define SECONDS_PER_VALUE 4e-8

double render_output_seconds(const RenderOutput *output)
{
    const PictureMemory *memory = &output->memory;
    return memory->lane_count > 0 ? SECONDS_PER_VALUE * (double)memory->picture_values / memory->lane_count : 0.0;
}

/* A picture while it is written to a file, by one of several threads. */
typedef struct Writing {
    const RenderOutput *output;
    const char *path;
    bool reports; /* progress, for all threads */
    Picture picture;
} Writing;

/* Reports progress before row y is resolved. */
static void writing_report(const Writing *writing, int y)
{
    const RenderOutput *output = writing->output;
    if (output->writing && writing->reports)
        output->writing(output->writing_context, writing->path, (double)y / writing->picture.height);
}

static void writing_band(void *context, int first, int count)
{
    Writing *writing = context;
    writing_report(writing, first);
    picture_band(&writing->picture, first, count);
}

static const float *writing_row(void *context, int y)
{
    Writing *writing = context;
    writing_report(writing, y);
    return picture_row(&writing->picture, y);
}

static bool matrix_is_zero(const float m[16])
{
    int i = 0;
    while (i < 16 && m[i] == 0.0f)
        ++i;
    return i == 16;
}

static bool exr_output_write(const RenderOutput *output, const ExrLane *lanes, const Film *film, size_t channel_count,
                             double samples_per_pixel, Error *error)
{
    const RenderLayers *layers = output->picture.layers;
    /* No time, machine or thread count: equal pictures make equal files. */
    ExrAttribute attributes[] = {
        exr_text("integrator", output->integrator),
        exr_whole("maxDepth", (uint64_t)output->max_depth),
        exr_text("renderer", PACKAGE_NAME " " PACKAGE_VERSION),
        exr_real("samples", samples_per_pixel),
        exr_text("scene", path_file_name(output->scene_file)),
        exr_whole("seed", output->seed),
        exr_matrix("worldToCamera", output->world_to_camera),
        {0},
        {0},
        {0},
    };
    size_t attribute_count = sizeof attributes / sizeof attributes[0] - 3;
    if (!matrix_is_zero(output->world_to_ndc))
        attributes[attribute_count++] = exr_matrix("worldToNDC", output->world_to_ndc);
    if (layers && (layers->wanted & LAYER_BIT(LAYER_DEPTH)) != 0)
        attributes[attribute_count++] =
            exr_text("depthMeasure", "Z is the distance along the ray from the camera, in units of the world");
    if (output->error > 0.0)
        attributes[attribute_count++] = exr_real("estimatedError", output->error);
    ExrPicture picture = {.channels = lanes->channels,
                          .channel_count = channel_count,
                          .width = film->width,
                          .height = film->height,
                          .attributes = attributes,
                          .attribute_count = attribute_count,
                          .band = writing_band,
                          .lanes = lanes,
                          .lane_count = output->memory.lane_count};
    memcpy(picture.crop, film->crop, sizeof picture.crop);
    return exr_write_picture(output->exr, &picture, error);
}

static bool png_output_write(Writing *writing, Error *error)
{
    const RenderOutput *output = writing->output;
    writing->path = output->png;
    return png_write_picture(output->png, (PngRows){writing_row, writing}, writing->picture.width,
                             writing->picture.height, output->exposure, error);
}

bool render_output_write(RenderOutput *output, const Film *film, double samples_per_pixel, Error *error)
{
    Writing writings[PICTURE_LANES_MAX];
    ExrLane lanes[PICTURE_LANES_MAX];
    int i = 0;
    do { /* at least one */
        writings[i] = (Writing){.output = output, .path = output->exr, .reports = i == 0};
        picture_init(&writings[i].picture, &output->picture, film, &output->memory, i);
        lanes[i] = (ExrLane){writings[i].picture.channels, &writings[i], output->memory.lanes[i].plane};
    } while (++i < output->memory.lane_count);
    picture_memory_lend(&output->memory);
    bool written = exr_output_write(output, lanes, film, writings[0].picture.channel_count, samples_per_pixel, error) &&
                   (!output->png[0] || png_output_write(&writings[0], error));
    picture_memory_take_back(&output->memory);
    return written;
}
