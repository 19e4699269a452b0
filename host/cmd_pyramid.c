/* `twinlight pyramid`: what every bidirectional strategy brings to the picture, on one sheet (Veach 1997, figure 10.4).
 * Row d holds the paths of d segments, column s those with s vertices from the light. */
#include "command.h"

#include "backend_choice.h"
#include "contact_sheet.h"
#include "interrupt.h"
#include "log.h"
#include "option_values.h"
#include "options.h"
#include "path_name.h"
#include "pbrt_import.h"
#include "png_write.h"
#include "render.h"
#include "render_output.h"

#include <stdlib.h>
#include <string.h>

/* More rows would not be seen on a screen. */
#define PYRAMID_DEPTH_MAX 12
#define PYRAMID_DEPTH 5
#define PYRAMID_SAMPLES 16

typedef struct PyramidCommand {
    const char *scene, *output, *backend, *device;
    BackendChoices backends;
    uint64_t max_depth, samples, seed, threads;
    int resolution[2];
    double exposure;
    bool unweighted, lenient, quiet, help;
} PyramidCommand;

enum {
    OPTION_OUTPUT,
    OPTION_MAX_DEPTH,
    OPTION_SAMPLES,
    OPTION_RESOLUTION,
    OPTION_UNWEIGHTED,
    OPTION_EXPOSURE,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_THREADS,
    OPTION_SEED,
    OPTION_LENIENT,
    OPTION_QUIET,
    OPTION_HELP
};

static const OptionSpec SPECS[] = {
    [OPTION_OUTPUT] = {"output", 'o', "FILE.png", "the sheet (default: pyramid.png)"},
    [OPTION_MAX_DEPTH] = {"max-depth", 0, "D", "rows up to paths of D segments, 2 to 12 (default: 5)"},
    [OPTION_SAMPLES] = {"samples", 0, "N", "samples per pixel of every picture (default: 16)"},
    [OPTION_RESOLUTION] = {"resolution", 0, "WxH", "size of every picture (default: 160 pixels wide)"},
    [OPTION_UNWEIGHTED] = {"unweighted", 0, NULL, "every strategy as if there were no other"},
    [OPTION_EXPOSURE] = {"exposure", 0, "STOPS", "brighten everything by 2^STOPS (default: 0)"},
    [OPTION_BACKEND] = {"backend", 0, "NAME", "where to render: cpu (default), opencl, or all together"},
    [OPTION_DEVICE] = {"device", 0, "INDEX|NAME", "OpenCL devices, as for twinlight render"},
    [OPTION_THREADS] = {"threads", 0, "N", "threads (default: one per processor)"},
    [OPTION_SEED] = {"seed", 0, "N", "seed of the random numbers (default: 0)"},
    [OPTION_LENIENT] = {"lenient", 0, NULL, "replace what is not supported, with a warning"},
    [OPTION_QUIET] = {"quiet", 'q', NULL, "print warnings and errors only"},
    [OPTION_HELP] = {"help", 'h', NULL, "print this and exit"},
};

static const OptionTable TABLE = {
    "pyramid",
    "pyramid [OPTION]... SCENE",
    "Renders what each strategy of bidirectional path tracing brings to the picture of SCENE.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "Row d: paths of d segments; column s: s vertices from the light, t = d + 1 - s from the camera. Each row is "
    "twice\n"
    "as bright as the one before it.\nMore: man twinlight-pyramid.",
};

static bool option_set(void *context, int index, const char *value, Error *error)
{
    PyramidCommand *command = context;
    const char *name = SPECS[index].name;
    switch (index) {
    case OPTION_OUTPUT:
        command->output = value;
        if (path_ends(value, ".png"))
            return true;
        error_set(error, "--output=%s: the name does not end in .png", value);
        return error_fix(error, "give it a name like pyramid.png");
    case OPTION_MAX_DEPTH:
        return option_whole(name, value, 2, PYRAMID_DEPTH_MAX, &command->max_depth, error);
    case OPTION_SAMPLES:
        return option_whole(name, value, 1, 0x7fffffff, &command->samples, error);
    case OPTION_RESOLUTION:
        return option_resolution(name, value, command->resolution, error);
    case OPTION_EXPOSURE:
        return option_number(name, value, -64.0, 64.0, &command->exposure, error);
    case OPTION_BACKEND:
        command->backend = value;
        return true;
    case OPTION_DEVICE:
        command->device = value;
        return true;
    case OPTION_THREADS:
        return option_whole(name, value, 1, 1024, &command->threads, error);
    case OPTION_SEED:
        return option_whole(name, value, 0, UINT64_MAX, &command->seed, error);
    case OPTION_UNWEIGHTED:
        command->unweighted = true;
        return true;
    case OPTION_LENIENT:
        command->lenient = true;
        return true;
    case OPTION_QUIET:
        command->quiet = true;
        return true;
    default:
        command->help = true;
        return true;
    }
}

/* ---- rendering --------------------------------------------------------------------------------------------------- */

static bool scene_load(const PyramidCommand *command, Scene *scene, Error *error)
{
    ImportOptions options = {.lenient = command->lenient};
    if (!pbrt_import(command->scene, &options, scene, error) ||
        !(scene_finish(scene, error) || error_in(error, command->scene)))
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

/* The strategy (s, t) alone, into rgb. */
static bool strategy_render(const PyramidCommand *command, const Scene *scene, const BackendMember *backend, unsigned s,
                            unsigned t, float *rgb, Error *error)
{
    const SceneSettings *settings = &scene->settings;
    const RenderOptions options = {.samples = (unsigned)command->samples,
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
    bool done = render_film(integrator_bdpt(), scene, backend->interface, backend->backend, &options, false, NULL,
                            &film, &result, error);
    if (done)
        film_resolve(&film, settings->film_scale, rgb);
    film_destroy(&film);
    return done;
}

static bool sheet_fill(const PyramidCommand *command, const Scene *scene, const BackendMember *backend,
                       ContactSheet *sheet, Error *error)
{
    size_t bytes = 3 * (size_t)sheet->cell_width * (size_t)sheet->cell_height * sizeof(float);
    float *rgb = malloc(bytes);
    if (!rgb)
        return error_memory(error, bytes, "a picture");
    bool done = true;
    for (unsigned depth = 2; depth <= command->max_depth && done; ++depth) {
        for (unsigned s = 0; s <= depth && done && !*interrupt_flag(); ++s) {
            char text[48];
            int brighter = 1 << (depth - 2);
            done = strategy_render(command, scene, backend, s, depth + 1 - s, rgb, error);
            snprintf(text, sizeof text, s == 0 ? "s=%u,t=%u x%d" : "s=%u,t=%u", s, depth + 1 - s, brighter);
            if (done)
                contact_sheet_put(sheet, (int)s, (int)depth - 2, rgb, (float)brighter, text);
        }
        log_message(LOG_INFO, "paths of %u segments are done", depth);
    }
    free(rgb);
    return done;
}

static bool sheet_make(const PyramidCommand *command, const Scene *scene, const BackendMember *backend, Error *error)
{
    ContactSheet sheet = {0};
    bool done = contact_sheet_init(&sheet, scene->settings.width, scene->settings.height, (int)command->max_depth + 1,
                                   (int)command->max_depth - 1, error) &&
                sheet_fill(command, scene, backend, &sheet, error) &&
                png_write(command->output, sheet.rgb, sheet.width, sheet.height, (float)command->exposure, error);
    contact_sheet_destroy(&sheet);
    if (done)
        log_message(LOG_INFO, "wrote %s", command->output);
    return done;
}

static int pyramid_run(const PyramidCommand *command, Error *error)
{
    Scene scene;
    BackendMember backend = {NULL, NULL};
    const BackendOptions options = {.threads = (int)command->threads};
    scene_init(&scene);
    bool done = render_output_check(command->output, error) && scene_load(command, &scene, error);
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
    PyramidCommand command = {.output = "pyramid.png", .max_depth = PYRAMID_DEPTH, .samples = PYRAMID_SAMPLES};
    int first = 0;
    if (!options_parse(&TABLE, argc, argv, option_set, &command, &first, error))
        return EXIT_USAGE;
    if (command.help) {
        options_help(&TABLE, stdout);
        return EXIT_OK;
    }
    if (argc - first != 1) {
        error_set(error, first >= argc ? "no scene is given" : "more than one scene");
        error_fix(error, "write twinlight pyramid SCENE");
        return EXIT_USAGE;
    }
    command.scene = argv[first];
    if (!backend_choices_make(&command.backends, backends, command.backend, command.device, error))
        return EXIT_USAGE;
    log_level_set(command.quiet ? LOG_WARNING : LOG_INFO);
    return pyramid_run(&command, error);
}
