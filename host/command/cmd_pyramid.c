/* `twinlight pyramid`: the contribution of every bidirectional strategy, on one sheet (Veach 1997, figure 10.4). Row d
 * has the paths of d segments, column s those with s vertices from the light. */
#include "command/command.h"

#include "base/interrupt.h"
#include "base/log.h"
#include "command/output_check.h"
#include "command/render_options.h"
#include "image/contact_sheet.h"
#include "image/png_write.h"
#include "gltf/load.h"
#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>

/* more rows would be too small on a screen */
#define PYRAMID_DEPTH_MAX 12
#define PYRAMID_DEPTH 5
#define PYRAMID_SAMPLES 16

static const RenderOptionUse USES[] = {
    {OPTION_OUTPUT, "FILE.png", "the sheet (default: pyramid.png)"},
    {OPTION_MAX_DEPTH, NULL, "maximum depth of paths, in segments: 2 to 12 (default: 5)"},
    {OPTION_SAMPLES, NULL, "samples per pixel of every image (default: 16)"},
    {OPTION_RESOLUTION, NULL, "size of every image (default: 160 pixels wide)"},
    {OPTION_UNWEIGHTED, NULL, "show strategies without MIS weights"},
    {OPTION_EXPOSURE, NULL, "multiply the images by 2^STOPS (default: 0)"},
    {OPTION_BACKEND, NULL, NULL},
    {OPTION_DEVICE, NULL, NULL},
    {OPTION_THREADS, NULL, NULL},
    {OPTION_SEED, NULL, NULL},
    {OPTION_LENIENT, NULL, NULL},
    {OPTION_QUIET, NULL, NULL},
};

static const RenderOptionSet OPTIONS = {
    .command = "pyramid",
    .usage = "pyramid [OPTION]... SCENE",
    .summary = "Renders the contribution of each strategy of bidirectional path tracing to the image of SCENE.",
    .footer =
        "Row d: paths of d segments; column s: s vertices from the light, t = d + 1 - s from the camera. Each row is "
        "twice\nas bright as the one before it.\nMore: man twinlight-pyramid.",
    .uses = USES,
    .use_count = sizeof USES / sizeof USES[0],
    .output_ending = ".png",
    .depth_low = 2,
    .depth_high = PYRAMID_DEPTH_MAX,
};

/* ---- rendering --------------------------------------------------------------------------------------------------- */

static bool scene_load(const RenderCommand *command, Scene *scene, Error *error)
{
    if (!scene_file_load(command->scene, command->lenient, scene, error))
        return false;
    int width = command->resolution[0], height = command->resolution[1];
    if (width == 0) {
        width = 160;
        height = (int)((long long)width * scene->settings.height / scene->settings.width);
        height = height < 1 ? 1 : height;
    }
    const int crop[4] = {0, 0, width, height};
    return scene_film_set(scene, width, height, crop, error);
}

/* Renders strategy (s, t) alone into rgb. */
static bool strategy_render(const RenderCommand *command, const Scene *scene, const BackendMember *backend, unsigned s,
                            unsigned t, float *rgb, Error *error)
{
    const SceneSettings *settings = &scene->settings;
    const RenderOptions options = {.samples = (unsigned)command->samples,
                                   .reconstruction = RECONSTRUCTION_SPLAT,
                                   .max_depth = (int)(s + t - 1),
                                   .seed = command->seed,
                                   .only_strategy = true,
                                   .strategy = {s, t},
                                   .unweighted = command->unweighted,
                                   .stop = interrupt_flag()};
    Film film;
    RenderResult result;
    if (!film_init(&film, settings->width, settings->height, settings->crop, error))
        return false;
    const RenderTask task = {.integrator = integrator_bdpt(), .scene = scene, .backend = *backend, .options = &options};
    bool done = render_film(&task, &film, &result, error);
    if (done)
        film_resolve(&film, settings->film_scale, rgb);
    film_destroy(&film);
    return done;
}

static bool sheet_fill(const RenderCommand *command, const Scene *scene, const BackendMember *backend,
                       ContactSheet *sheet, Error *error)
{
    size_t bytes = 3 * (size_t)sheet->cell_width * (size_t)sheet->cell_height * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "an image");
    bool done = true;
    for (unsigned depth = 2; depth <= (unsigned)command->max_depth && done; ++depth) {
        for (unsigned s = 0; s <= depth && done && !*interrupt_flag(); ++s) {
            char text[48];
            int brighter = 1 << (depth - 2);
            done = strategy_render(command, scene, backend, s, depth + 1 - s, rgb, error);
            snprintf(text, sizeof text, s == 0 ? "s=%u,t=%u x%d" : "s=%u,t=%u", s, depth + 1 - s, brighter);
            if (done && !*interrupt_flag()) /* otherwise it may be unfinished */
                contact_sheet_put(sheet, (int)s, (int)depth - 2, rgb, (float)brighter, text);
        }
        log_message(LOG_INFO, "paths of %u segments are done", depth);
    }
    free(rgb);
    return done;
}

static bool sheet_make(const RenderCommand *command, const Scene *scene, const BackendMember *backend, Error *error)
{
    ContactSheet sheet = {0};
    bool done = contact_sheet_init(&sheet, scene->settings.width, scene->settings.height, command->max_depth + 1,
                                   command->max_depth - 1, error) &&
                sheet_fill(command, scene, backend, &sheet, error) &&
                png_write(command->output, sheet.rgb, sheet.width, sheet.height, (float)command->exposure, error);
    contact_sheet_destroy(&sheet);
    if (done)
        log_message(LOG_INFO, "wrote %s", command->output);
    return done;
}

static int pyramid_run(const RenderCommand *command, Error *error)
{
    Scene scene;
    BackendMember backend = {NULL, NULL};
    const BackendOptions options = {.threads = command->threads};
    const CommandFile files[] = {{"the scene", command->scene, false}, {"the sheet", command->output, true}};
    scene_init(&scene);
    bool done = output_check(command->output, error) && scene_load(command, &scene, error) &&
                output_files_check(files, sizeof files / sizeof files[0], "give another name with --output", error);
    if (done) {
        const BackendScene view = scene_backend_view(&scene);
        done = interrupt_install(error) && backend_choices_open(&command->backends, &view, &options, &backend, error) &&
               sheet_make(command, &scene, &backend, error);
    }
    if (backend.backend)
        backend.interface->close(backend.backend);
    scene_destroy(&scene);
    return !done ? EXIT_FAILED : *interrupt_flag() ? EXIT_STOPPED : EXIT_OK;
}

int cmd_pyramid(const BackendTable *backends, int argc, char **argv, Error *error)
{
    RenderCommand command = {.output = "pyramid.png", .max_depth = PYRAMID_DEPTH, .samples = PYRAMID_SAMPLES};
    OptionsEnd end = render_options_parse(&command, &OPTIONS, backends, argc, argv, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    log_level_set(command.quiet ? LOG_WARNING : LOG_INFO);
    return pyramid_run(&command, error);
}
