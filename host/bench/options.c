#include "bench/options.h"

#include "base/option_values.h"
#include "base/path_name.h"

#include <stdio.h>
#include <string.h>

#define ITEM_MAX 128

enum {
    OPTION_OUTPUT,
    OPTION_INTEGRATORS,
    OPTION_TIMES,
    OPTION_RUNS,
    OPTION_REFERENCE,
    OPTION_REFERENCE_INTEGRATOR,
    OPTION_REFERENCE_TIME,
    OPTION_BACKENDS,
    OPTION_PATCH,
    OPTION_MAX_DEPTH,
    OPTION_RESOLUTION,
    OPTION_EXPOSURE,
    OPTION_SEED,
    OPTION_THREADS,
    OPTION_LENIENT,
    OPTION_QUIET
};

static const OptionSpec SPECS[] = {
    [OPTION_OUTPUT] = {"output", 'o', "FILE.html", "the report (default: bench.html)"},
    [OPTION_INTEGRATORS] = {"integrators", 0, "NAME,...",
                            "integrators to compare; the first is the baseline (default: pt,ibpt,bdpt,mmlt)"},
    [OPTION_TIMES] = {"times", 0, "TIME,...", "rendering times, each with its own renderings (default: 1s,2s,4s,8s)"},
    [OPTION_RUNS] = {"runs", 0, "N",
                     "renderings per integrator, backend and time, each with its own seed (default: 4)"},
    [OPTION_REFERENCE] = {"reference", 0, "FILE", "reference image; once per scene, in the order of the scenes"},
    [OPTION_REFERENCE_INTEGRATOR] = {"reference-integrator", 0, "NAME",
                                     "integrator that renders missing references (default: one not compared)"},
    [OPTION_REFERENCE_TIME] = {"reference-time", 0, "TIME",
                               "total rendering time of a reference (default: 8 times the longest of --times)"},
    [OPTION_BACKENDS] = {"backends", 0, "NAME,...", "where to render (default: cpu)"},
    [OPTION_PATCH] = {"patch", 0, "NAME:x,y,w,h", "show this rectangle enlarged and report its relMSE; up to 8 times"},
    [OPTION_MAX_DEPTH] = {"max-depth", 0, "D", "maximum depth of paths, in segments (default: the scene's)"},
    [OPTION_RESOLUTION] = {"resolution", 0, "WxH", "film size (default: the scene's)"},
    [OPTION_EXPOSURE] = {"exposure", 0, "STOPS",
                         "multiply values by 2^STOPS in images and for FLIP and SSIM (default: 0)"},
    [OPTION_SEED] = {"seed", 0, "N", "number from which the renderings' seeds are derived (default: 0)"},
    [OPTION_THREADS] = {"threads", 0, "N", "threads (default: one for each processor)"},
    [OPTION_LENIENT] = {"lenient", 0, NULL, "replace unsupported features of a scene, with a warning"},
    [OPTION_QUIET] = {"quiet", 'q', NULL, "print warnings and errors only"},
};

static const OptionTable TABLE = {
    "bench",
    "bench [OPTION]... SCENE...",
    "Renders every SCENE with several integrators for several times and reports error against time.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "FILE.html is self-contained; FILE.tsv and FILE.json hold its figures, and the folder FILE.runs the renderings, "
    "which a\n"
    "second run does not repeat. After SIGINT the report covers what is finished.\n"
    "More: man twinlight-bench.",
};

bool bench_is_compared(const BenchOptions *options, const Integrator *integrator)
{
    for (int i = 0; i < options->integrator_count; ++i)
        if (options->integrators[i] == integrator)
            return true;
    return false;
}

typedef struct Parse {
    BenchOptions *options;
    const BackendTable *table;
} Parse;

/* ---- lists ------------------------------------------------------------------------------------------------------ */

typedef bool (*ItemSetter)(Parse *parse, const char *item, Error *error);

/* Calls `set` for every item between commas. */
static bool list_set(Parse *parse, const char *option, const char *value, ItemSetter set, Error *error)
{
    for (const char *at = value;; ++at) {
        char item[ITEM_MAX];
        size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof item) {
            error_set(error, "--%s=%s: an item is empty or too long", option, value);
            return error_fix(error, "separate the items by commas");
        }
        memcpy(item, at, length);
        item[length] = '\0';
        if (!set(parse, item, error))
            return false;
        at += length;
        if (*at == '\0')
            return true;
    }
}

static bool too_many(const char *option, int most, Error *error)
{
    error_set(error, "--%s: more than %d items", option, most);
    return error_fix(error, "make several reports, each with some of them");
}

static bool integrator_add(Parse *parse, const char *item, Error *error)
{
    BenchOptions *options = parse->options;
    const Integrator *integrator = integrator_find(item, error);
    if (!integrator)
        return false;
    if (bench_is_compared(options, integrator)) {
        error_set(error, "--integrators: %s is named twice", item);
        return error_fix(error, "name each integrator once");
    }
    if (options->integrator_count == BENCH_INTEGRATORS_MAX)
        return too_many("integrators", BENCH_INTEGRATORS_MAX, error);
    options->integrators[options->integrator_count++] = integrator;
    return true;
}

static bool time_add(Parse *parse, const char *item, Error *error)
{
    BenchOptions *options = parse->options;
    double seconds = 0.0;
    if (!option_seconds("times", item, &seconds, error))
        return false;
    if (options->time_count == BENCH_TIMES_MAX)
        return too_many("times", BENCH_TIMES_MAX, error);
    if (options->time_count > 0 && seconds <= options->times[options->time_count - 1]) {
        error_set(error, "--times: %s is not longer than the time before it", item);
        return error_fix(error, "write them in ascending order, e.g. --times=1s,2s,4s");
    }
    options->times[options->time_count++] = seconds;
    return true;
}

static bool backend_add(Parse *parse, const char *item, Error *error)
{
    BenchOptions *options = parse->options;
    if (options->backend_count == BENCH_BACKENDS_MAX)
        return too_many("backends", BENCH_BACKENDS_MAX, error);
    BackendChoices *choices = &options->backends[options->backend_count++];
    return backend_choices_make(choices, parse->table, item, NULL, error);
}

/* ---- single values ---------------------------------------------------------------------------------------------- */

static bool patch_wrong(const char *value, Error *error)
{
    error_set(error, "--patch=%s: not a patch", value);
    return error_fix(error, "write a name, the upper left pixel, width and height, e.g. --patch=caustic:200,120,64,48");
}

/* "name:x,y,w,h" */
static bool patch_add(BenchOptions *options, const char *value, Error *error)
{
    const char *colon = strchr(value, ':');
    size_t length = colon ? (size_t)(colon - value) : 0;
    uint64_t numbers[4];
    if (options->patch_count == BENCH_PATCHES_MAX)
        return too_many("patch", BENCH_PATCHES_MAX, error);
    BenchPatch *patch = &options->patches[options->patch_count++];
    if (length == 0 || length >= sizeof patch->name)
        return patch_wrong(value, error);
    memcpy(patch->name, value, length);
    for (const BenchPatch *other = options->patches; other < patch; ++other)
        if (strcmp(other->name, patch->name) == 0) {
            error_set(error, "--patch=%s: another patch has the same name", value);
            return error_fix(error, "give each patch its own name");
        }
    const char *at = colon + 1;
    for (int i = 0; i < 4; ++i) {
        char item[16];
        size_t digits = strcspn(at, ",");
        if (digits >= sizeof item || (at[digits] == ',') != (i < 3))
            return patch_wrong(value, error);
        memcpy(item, at, digits);
        item[digits] = '\0';
        if (!option_whole("patch", item, i < 2 ? 0 : 1, OPTION_SIZE_MAX, &numbers[i], error))
            return patch_wrong(value, error);
        at += digits + 1;
    }
    patch->x = (int)numbers[0];
    patch->y = (int)numbers[1];
    patch->width = (int)numbers[2];
    patch->height = (int)numbers[3];
    return true;
}

static bool reference_add(BenchOptions *options, const char *value, Error *error)
{
    if (options->reference_count == BENCH_SCENES_MAX)
        return too_many("reference", BENCH_SCENES_MAX, error);
    options->references[options->reference_count++] = value;
    return true;
}

static bool output_set(BenchOptions *options, const char *value, Error *error)
{
    options->output = value;
    if (path_ends(value, ".html"))
        return true;
    error_set(error, "--output=%s: the name does not end in .html", value);
    return error_fix(error, "use -o FILE.html");
}

static bool count_set(const char *option, const char *value, uint64_t most, int *count, Error *error)
{
    uint64_t whole = 0;
    if (!option_whole(option, value, 1, most, &whole, error))
        return false;
    *count = (int)whole;
    return true;
}

static bool number_set(BenchOptions *options, int index, const char *value, Error *error)
{
    switch (index) {
    case OPTION_RUNS:
        return count_set("runs", value, BENCH_RUNS_MAX, &options->runs, error);
    case OPTION_MAX_DEPTH:
        return count_set("max-depth", value, 65535, &options->max_depth, error);
    case OPTION_THREADS:
        return count_set("threads", value, 4096, &options->threads, error);
    case OPTION_RESOLUTION:
        return option_resolution("resolution", value, options->resolution, error);
    case OPTION_EXPOSURE:
        return option_number("exposure", value, -100.0, 100.0, &options->display.exposure, error);
    case OPTION_REFERENCE_TIME:
        return option_seconds("reference-time", value, &options->reference_seconds, error);
    default:
        return option_whole("seed", value, 0, UINT64_MAX, &options->seed, error);
    }
}

static bool option_set(void *context, int index, const char *value, Error *error)
{
    Parse *parse = context;
    BenchOptions *options = parse->options;
    switch (index) {
    case OPTION_OUTPUT:
        return output_set(options, value, error);
    case OPTION_INTEGRATORS:
        return list_set(parse, "integrators", value, integrator_add, error);
    case OPTION_TIMES:
        return list_set(parse, "times", value, time_add, error);
    case OPTION_BACKENDS:
        return list_set(parse, "backends", value, backend_add, error);
    case OPTION_REFERENCE:
        return reference_add(options, value, error);
    case OPTION_REFERENCE_INTEGRATOR:
        options->reference_integrator = integrator_find(value, error);
        return options->reference_integrator != NULL;
    case OPTION_PATCH:
        return patch_add(options, value, error);
    case OPTION_LENIENT:
        options->lenient = true;
        return true;
    case OPTION_QUIET:
        options->quiet = true;
        return true;
    default:
        return number_set(options, index, value, error);
    }
}

/* The default reference integrator: one that is not compared itself, if possible. */
static const Integrator *reference_choose(const BenchOptions *options)
{
    const Integrator *const candidates[] = {integrator_bdpt(), integrator_mmlt(), integrator_ibpt(), integrator_pt()};
    for (size_t i = 0; i < sizeof candidates / sizeof candidates[0]; ++i)
        if (!bench_is_compared(options, candidates[i]))
            return candidates[i];
    return candidates[0];
}

/* Fills in defaults. */
static bool defaults_set(Parse *parse, Error *error)
{
    BenchOptions *options = parse->options;
    if (options->integrator_count == 0 && !list_set(parse, "integrators", "pt,ibpt,bdpt,mmlt", integrator_add, error))
        return false;
    if (options->time_count == 0 && !list_set(parse, "times", "1s,2s,4s,8s", time_add, error))
        return false;
    if (options->backend_count == 0 && !backend_add(parse, parse->table->backends[0]->name, error))
        return false;
    if (options->runs == 0)
        options->runs = 4;
    if (options->reference_seconds == 0.0)
        options->reference_seconds = 8.0 * options->times[options->time_count - 1];
    if (!options->reference_integrator)
        options->reference_integrator = reference_choose(options);
    return true;
}

static bool scenes_set(BenchOptions *options, int argc, char **argv, int first, Error *error)
{
    options->scene_count = argc - first;
    if (options->scene_count < 1) {
        error_set(error, "no scene is given");
        return error_fix(error, "write twinlight bench SCENE...");
    }
    if (options->scene_count > BENCH_SCENES_MAX)
        return too_many("scenes", BENCH_SCENES_MAX, error);
    for (int i = 0; i < options->scene_count; ++i)
        options->scenes[i] = argv[first + i];
    if (options->reference_count <= options->scene_count)
        return true;
    error_set(error, "%d references for %d scenes", options->reference_count, options->scene_count);
    return error_fix(error, "give one for each scene, in the order of the scenes");
}

OptionsEnd bench_options_parse(BenchOptions *options, const BackendTable *backends, int argc, char **argv, Error *error)
{
    Parse parse = {options, backends};
    int first = 0;
    *options = (BenchOptions){.output = "bench.html", .display = {.pixels_per_degree = FLIP_PIXELS_PER_DEGREE}};
    OptionsEnd end = options_parse(&TABLE, argc, argv, option_set, &parse, &first, error);
    if (end != OPTIONS_READ)
        return end;
    return scenes_set(options, argc, argv, first, error) && defaults_set(&parse, error) ? OPTIONS_READ : OPTIONS_WRONG;
}
