#include "render_output.h"

#include "config.h"

#include "despeckle.h"
#include "exr.h"
#include "path_name.h"
#include "png_write.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* target = `path` with its ending (if it has one) replaced by `ending`; as it is when it ends so already, in any case. */
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

/* ---- layers ------------------------------------------------------------------------------------------------------ */

/* Everything that goes into the file, in groups of three channels. */
#define GROUPS_FIXED 10
#define GROUPS_MAX (GROUPS_FIXED + (int)(SPLAT_DEPTH_MAX + 1u - SPLAT_DEPTH_MIN))

typedef char DepthNames[3][16]; /* "depth03.R" ... */

typedef struct Picture {
    size_t pixels;
    float *values;
    size_t used; /* values */
    ExrChannel channels[3 * GROUPS_MAX];
    size_t count;
    DepthNames depths[SPLAT_DEPTH_MAX + 1];
} Picture;

/* Room for three values a pixel, which are the channels `red`, `green` and `blue`. */
static float *picture_rgb(Picture *picture, const char *red, const char *green, const char *blue, bool half)
{
    const char *const names[3] = {red, green, blue};
    float *rgb = picture->values + picture->used;
    for (size_t c = 0; c < 3; ++c)
        picture->channels[picture->count++] = (ExrChannel){names[c], rgb + c, 3, half};
    picture->used += 3 * picture->pixels;
    return rgb;
}

static void picture_depths(Picture *picture, const Film *film, float scale)
{
    for (uint depth = SPLAT_DEPTH_MIN; depth <= film->depth_last; ++depth) {
        DepthNames *names = &picture->depths[depth];
        for (int c = 0; c < 3; ++c)
            snprintf((*names)[c], sizeof(*names)[c], "depth%02u.%c", depth, "RGB"[c]);
        film_resolve_depth(film, depth, scale, picture_rgb(picture, (*names)[0], (*names)[1], (*names)[2], false));
    }
}

/* The picture's own layers: of light alone, so everything but the variables. */
static void picture_parts(Picture *picture, const RenderOutput *output, const Film *film)
{
    unsigned wanted = output->layers ? output->layers->wanted : 0;
    float scale = output->film_scale;
    if (film->light_samples == 0)
        return;
    if ((wanted & LAYER_BIT(LAYER_DIRECT)) != 0)
        film_resolve_part(film, FILM_OWN, scale, picture_rgb(picture, "direct.R", "direct.G", "direct.B", false));
    if ((wanted & LAYER_BIT(LAYER_INDIRECT)) != 0)
        film_resolve_part(film, FILM_LIGHT, scale,
                          picture_rgb(picture, "indirect.R", "indirect.G", "indirect.B", false));
    if ((wanted & LAYER_BIT(LAYER_HALVES)) != 0) {
        const Film *halves = output->layers->halves;
        film_resolve(&halves[0], scale, picture_rgb(picture, "halfA.R", "halfA.G", "halfA.B", false));
        film_resolve(&halves[1], scale, picture_rgb(picture, "halfB.R", "halfB.G", "halfB.B", false));
    }
    if ((wanted & LAYER_BIT(LAYER_VARIANCE)) != 0)
        render_layers_variance(output->layers, scale,
                               picture_rgb(picture, "variance.R", "variance.G", "variance.B", false));
    picture_depths(picture, film, scale);
}

static void picture_aovs(Picture *picture, const RenderOutput *output)
{
    if (!output->layers)
        return;
    const RenderLayers *layers = output->layers;
    if ((layers->wanted & LAYER_BIT(LAYER_ALBEDO)) != 0)
        film_resolve(&layers->aovs[AOV_ALBEDO], 1.0f, picture_rgb(picture, "albedo.R", "albedo.G", "albedo.B", true));
    if ((layers->wanted & LAYER_BIT(LAYER_NORMAL)) != 0)
        film_resolve(&layers->aovs[AOV_NORMAL], 1.0f, picture_rgb(picture, "normal.X", "normal.Y", "normal.Z", true));
    if ((layers->wanted & LAYER_BIT(LAYER_DEPTH)) != 0) {
        film_resolve(&layers->aovs[AOV_DEPTH], 1.0f, picture_rgb(picture, "Z", "", "", false));
        picture->count -= 2; /* all three are the same */
    }
}

static bool exr_output_write(const RenderOutput *output, const Film *film, const Picture *picture,
                             double samples_per_pixel, Error *error)
{
    /* Nothing of time, machine or threads: the same picture is the same file. */
    const ExrAttribute attributes[] = {
        exr_text("integrator", output->integrator),
        exr_whole("maxDepth", (uint64_t)output->max_depth),
        exr_text("renderer", PACKAGE_NAME " " PACKAGE_VERSION),
        exr_real("samples", samples_per_pixel),
        exr_text("scene", path_file_name(output->scene_file)),
        exr_whole("seed", output->seed),
        exr_matrix("worldToCamera", output->world_to_camera),
        exr_matrix("worldToNDC", output->world_to_ndc),
        exr_text("depthMeasure", "Z is the distance along the ray from the camera, in units of the world"),
    };
    /* The last one is for a layer that may not be there. */
    bool depth = output->layers && (output->layers->wanted & LAYER_BIT(LAYER_DEPTH)) != 0;
    size_t count = sizeof attributes / sizeof attributes[0] - (depth ? 0 : 1);
    return exr_write(output->exr, picture->channels, picture->count, film->width, film->height, film->crop, attributes,
                     count, error);
}

bool render_output_write(const RenderOutput *output, const Film *film, double samples_per_pixel, Error *error)
{
    int width = film->crop[2] - film->crop[0], height = film->crop[3] - film->crop[1];
    Picture picture = {.pixels = film_pixels(film)};
    size_t groups = GROUPS_FIXED + (film->depth_last >= SPLAT_DEPTH_MIN ? film->depth_last + 1 - SPLAT_DEPTH_MIN : 0);
    size_t bytes = groups * 3 * picture.pixels * sizeof *picture.values;
    picture.values = malloc(bytes); /* pages that no layer touches take no memory */
    if (!picture.values)
        return error_memory(error, bytes, "the picture");
    float *rgb = picture_rgb(&picture, "R", "G", "B", false);
    film_resolve(film, output->film_scale, rgb);
    picture_parts(&picture, output, film);
    picture_aovs(&picture, output);
    if (output->despeckle > 0.0)
        despeckle(rgb, width, height, (float)output->despeckle,
                  picture_rgb(&picture, "despeckled.R", "despeckled.G", "despeckled.B", false));
    bool written = exr_output_write(output, film, &picture, samples_per_pixel, error) &&
                   (!output->png[0] || png_write(output->png, rgb, width, height, output->exposure, error));
    free(picture.values);
    return written;
}
