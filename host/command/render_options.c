#include "command/render_options.h"

#include "base/frame_name.h"
#include "base/option_values.h"
#include "base/options.h"
#include "base/path_name.h"
#include "command/mlt_option.h"
#include "render/shard.h"

#include <string.h>

/* Parsing in progress. */
typedef struct Parse {
    RenderCommand *command;
    const RenderOptionSet *set;
    OptionSpec specs[RENDER_OPTION_COUNT]; /* the set's options, from specs_fill */
    const char *backend; /* --backend; NULL: not given */
} Parse;

/* Options with a numeric value. */
static bool number_set(const Parse *parse, int option, const char *value, Error *error)
{
    RenderCommand *command = parse->command;
    uint64_t whole = 0;
    const char *name = RENDER_OPTION_SPECS[option].name;
    switch (option) {
    case OPTION_SAMPLES:
        return option_whole(name, value, 1, 0x7fffffff, &command->samples, error);
    case OPTION_SEED:
        return option_whole(name, value, 0, UINT64_MAX, &command->seed, error);
    case OPTION_PHOTONS:
        if (!option_whole(name, value, 0, PHOTONS_MOST_ALLOWED, &whole, error))
            return false;
        command->photons = (unsigned)whole;
        return true;
    case OPTION_THREADS:
        if (!option_whole(name, value, 1, 1024, &whole, error))
            return false;
        command->threads = (int)whole;
        return true;
    case OPTION_FRAME:
        if (!option_whole(name, value, 0, FRAME_MAX, &whole, error))
            return false;
        command->frame = (int)whole;
        return true;
    case OPTION_BATCH:
        if (!option_whole(name, value, 1, 1u << 26, &whole, error))
            return false;
        command->batch = (unsigned)whole;
        return true;
    case OPTION_MAX_DEPTH:
        if (!option_whole(name, value, parse->set->depth_low, parse->set->depth_high, &whole, error))
            return false;
        command->max_depth = (int)whole;
        return true;
    default:
        return option_number(name, value, -64.0, 64.0, &command->exposure, error);
    }
}

static bool path_set(const char **path, int option, const char *value, const char *ending, Error *error)
{
    *path = value;
    if (!ending || path_ends(value, ending))
        return true;
    error_set(error, "--%s=%s: the name does not end in %s", RENDER_OPTION_SPECS[option].name, value, ending);
    return error_fix(error, "this file is written in that format only; give it a name like image%s", ending);
}

static bool sampler_set(RenderCommand *command, const char *value, Error *error)
{
    command->sampler = value;
    if (strcmp(value, "sobol") == 0 || strcmp(value, "independent") == 0)
        return true;
    error_set(error, "--sampler=%s: there is no such sampler", value);
    return error_fix(error, "use sobol or independent");
}

static bool reconstruction_set(RenderCommand *command, const char *value, Error *error)
{
    command->reconstruction = strcmp(value, "splat") == 0 ? RECONSTRUCTION_SPLAT : RECONSTRUCTION_SAMPLE;
    if (command->reconstruction == RECONSTRUCTION_SPLAT || strcmp(value, "sample") == 0)
        return true;
    error_set(error, "--reconstruction=%s: there is no such reconstruction", value);
    return error_fix(error, "use splat or sample");
}

static bool heuristic_set(RenderCommand *command, const char *value, Error *error)
{
    command->balance = strcmp(value, "balance") == 0;
    if (command->balance || strcmp(value, "power") == 0)
        return true;
    error_set(error, "--heuristic=%s: there is no such heuristic", value);
    return error_fix(error, "use power or balance");
}

static bool error_of_set(RenderCommand *command, const char *value, Error *error)
{
    command->error_of = value;
    command->error.blocks = strcmp(value, "blocks") == 0;
    if (command->error.blocks || strcmp(value, "pixels") == 0)
        return true;
    error_set(error, "--error-of=%s: the error is not of these", value);
    return error_fix(error, "use pixels or blocks");
}

static bool film_set(RenderCommand *command, const char *value, Error *error)
{
    command->film = value;
    command->film_place = strcmp(value, "device") == 0 ? FILM_ON_DEVICE : FILM_ON_HOST;
    if (command->film_place == FILM_ON_DEVICE || strcmp(value, "host") == 0)
        return true;
    error_set(error, "--film=%s: there is no such place", value);
    return error_fix(error, "use host or device");
}

static bool layers_set(RenderCommand *command, const char *value, Error *error)
{
#define TEXT(NAME, name, text, ...) text,
    static const char *const NAMES[LAYER_COUNT] = {LAYER_LIST(TEXT)};
#undef TEXT
    const char *other;
    command->has_layers = true;
    command->layers = strcmp(value, "all") == 0 ? LAYERS_ALL : 0;
    if (command->layers || strcmp(value, "none") == 0 ||
        option_names(value, ',', NAMES, LAYER_COUNT, &command->layers, &other))
        return true;
    error_set(error, "--layers=%s: there is no layer %.*s", value, (int)strcspn(other, ","), other);
    return error_fix(error, "use " LAYER_LIST(LAYER_TEXT_OF) "separated by commas, or all (but by-depth) or none");
}

static bool shard_set(RenderCommand *command, const char *value, Error *error)
{
    char number[24];
    uint64_t k = 0, n = 0;
    const char *slash = strchr(value, '/');
    Error ignored;
    snprintf(number, sizeof number, "%.*s", slash ? (int)(slash - value) : 0, value);
    if (slash && (size_t)(slash - value) < sizeof number &&
        option_whole("shard", slash + 1, 1, SHARDS_MOST, &n, &ignored) &&
        option_whole("shard", number, 1, n, &k, &ignored)) {
        command->shard = (Shard){(unsigned)k, (unsigned)n};
        return true;
    }
    error_set(error, "--shard=%s: it is not of the form K/N with 1 <= K <= N <= %u", value, SHARDS_MOST);
    return error_fix(error, "use --shard=3/16 for the third of sixteen parts");
}

/* Options of Markov chains. */
static bool chain_option_set(RenderCommand *command, int option, const char *value, Error *error)
{
    const char *name = RENDER_OPTION_SPECS[option].name;
    command->chain_option = name;
    switch (option) {
    case OPTION_MLT:
        return mlt_option_set(&command->chains, value, error);
    case OPTION_MEMORY:
        command->memory = true;
        return true;
    case OPTION_DUMP_BAD:
        return path_set(&command->dump_bad, option, value, NULL, error);
    default:
        return mlt_option_set_old(&command->chains, name, value, error);
    }
}

static bool option_set(void *context, int index, const char *value, Error *error)
{
    Parse *parse = context;
    RenderCommand *command = parse->command;
    const int option = parse->set->uses ? (int)parse->set->uses[index].option : index;
    switch (option) {
    case OPTION_OUTPUT:
        command->output = value;
        return true;
    case OPTION_STATS:
        return path_set(&command->stats, option, value, NULL, error);
    case OPTION_TRACE:
        return path_set(&command->trace, option, value, NULL, error);
    case OPTION_TEV:
        return option_address("tev", value, 1, &command->watch.tev, error);
    case OPTION_SERVE:
        return server_available(error) &&
               option_address("serve", value ? value : "127.0.0.1:0", 0, &command->watch.serve, error);
    case OPTION_DEVICE:
        command->device = value;
        return true;
    case OPTION_PNG:
        command->png = true;
        return !value || path_set(&command->png_path, option, value, ".png", error);
    case OPTION_NO_PNG:
        command->png = false;
        return true;
    case OPTION_NO_OPENINGS:
        command->no_openings = true;
        return true;
    case OPTION_INTEGRATOR:
        command->integrator = value;
        return true;
    case OPTION_HEURISTIC:
        return heuristic_set(command, value, error);
    case OPTION_SAMPLER:
        return sampler_set(command, value, error);
    case OPTION_RECONSTRUCTION:
        return reconstruction_set(command, value, error);
    case OPTION_FILM:
        return film_set(command, value, error);
    case OPTION_STRATEGY:
        command->only_strategy = true;
        return option_strategy("strategy", value, command->strategy, error);
    case OPTION_UNWEIGHTED:
        command->unweighted = true;
        return true;
    case OPTION_BACKEND:
        parse->backend = value;
        return true;
    case OPTION_TIME:
        return option_seconds("time", value, &command->seconds, error);
    case OPTION_ERROR:
        return option_part("error", value, 1e-6, 10.0, &command->error.goal, error);
    case OPTION_ERROR_PERCENTILE:
        return option_number("error-percentile", value, 1.0, 99.99, &command->error.percentile, error);
    case OPTION_ERROR_OF:
        return error_of_set(command, value, error);
    case OPTION_SHARD:
        return shard_set(command, value, error);
    case OPTION_PILOT:
        return path_set(&command->pilot, option, value, NULL, error);
    case OPTION_SAVE_EVERY:
        return option_seconds("save-every", value, &command->save_every, error);
    case OPTION_CHECKPOINT:
        return path_set(&command->checkpoint, option, value, NULL, error);
    case OPTION_CHECKPOINT_EVERY:
        return option_seconds("checkpoint-every", value, &command->checkpoint_every, error);
    case OPTION_RESUME:
        return path_set(&command->resume, option, value, NULL, error);
    case OPTION_RESOLUTION:
        return option_resolution("resolution", value, command->resolution, error);
    case OPTION_CROP:
        command->has_crop = true;
        return option_crop("crop", value, command->crop, error);
    case OPTION_LAYERS:
        return layers_set(command, value, error);
    case OPTION_DESPECKLE:
        return option_number("despeckle", value, 1.0, 1e6, &command->despeckle, error);
    case OPTION_VERIFY:
        command->verify = true;
        return true;
    case OPTION_LENIENT:
        command->lenient = true;
        return true;
    case OPTION_QUIET:
        command->quiet = true;
        return true;
    case OPTION_MLT:
    case OPTION_MLT_SCHEME:
    case OPTION_CHAINS:
    case OPTION_STEPS:
    case OPTION_POOL:
    case OPTION_LARGE_STEP:
    case OPTION_MUTATIONS:
    case OPTION_MEMORY:
    case OPTION_SORT:
    case OPTION_NO_SORT:
    case OPTION_NO_GROUP:
    case OPTION_NO_SHIFT:
    case OPTION_NO_AIM:
    case OPTION_NO_BLEND:
    case OPTION_DUMP_BAD:
        return chain_option_set(command, option, value, error);
    default:
        return number_set(parse, option, value, error);
    }
}

/* Rejects options that contradict --verify, which renders no picture and has no time limit. */
static bool verify_alone(const RenderCommand *command, Error *error)
{
    const char *option = command->output                ? "output"
                         : command->png_path            ? "png"
                         : command->seconds > 0.0       ? "time"
                         : command->error.goal > 0.0    ? "error"
                         : command->save_every > 0.0    ? "save-every"
                         : command->shard.count > 0     ? "shard"
                         : command->pilot               ? "pilot"
                         : command->checkpoint          ? "checkpoint"
                         : command->resume              ? "resume"
                         : command->stats               ? "stats"
                         : command->trace               ? "trace"
                         : command->watch.tev.host[0]   ? "tev"
                         : command->watch.serve.host[0] ? "serve"
                         : command->dump_bad            ? "dump-bad"
                         : command->film                ? "film"
                         : command->has_layers          ? "layers"
                         : command->despeckle > 0.0     ? "despeckle"
                                                        : NULL;
    if (!command->verify || !option)
        return true;
    error_set(error, "--%s cannot be used with --verify, which renders no image", option);
    return error_fix(error, "leave --%s out; --samples=N sets how much is compared", option);
}

/* The name of what is written, once it is known whether that is an image or a part. */
static bool output_ending_check(RenderCommand *command, const RenderOptionSet *set, Error *error)
{
    if (!command->output)
        return true;
    if (command->shard.count == 0)
        return path_set(&command->output, OPTION_OUTPUT, command->output, set->output_ending, error);
    if (!path_ends(command->output, set->output_ending))
        return true;
    error_set(error, "--output=%s: with --shard a part is written, which is no image", command->output);
    return error_fix(error, "give it a name like image-%uof%u.part; twinlight merge makes the image of all parts",
                     command->shard.number, command->shard.count);
}

/* Rejects options of the image with --shard, which writes none. */
static bool shard_alone(const RenderCommand *command, Error *error)
{
    const char *option = command->png_path          ? "png"
                         : command->exposure != 0.0 ? "exposure"
                         : command->despeckle > 0.0 ? "despeckle"
                                                    : NULL;
    if (command->shard.count == 0 || !option)
        return true;
    error_set(error, "--%s cannot be used with --shard, which writes no image", option);
    return error_fix(error, "give --%s to twinlight merge", option);
}

/* Chooses the backends, once all options are known. */
static bool backends_set(RenderCommand *command, const BackendTable *table, const char *backend, Error *error)
{
    command->reference = table->backends[0];
    if (command->verify && !backend && table->count > 1)
        backend = table->backends[1]->name;
    if (!backend_choices_make(&command->backends, table, backend, command->device, error))
        return false;
    if (command->verify && !backend_choices_have_devices(&command->backends)) {
        error_set(error, "--verify compares devices with the CPU, but --backend=%s uses none", command->backends.name);
        return error_fix(error, "use --backend=opencl, in a build that has it");
    }
    const char *option = command->device      ? "device"
                         : command->batch > 0 ? "batch"
                         : command->film      ? "film"
                         : command->trace     ? "trace"
                                              : NULL;
    if (!option || backend_choices_have_devices(&command->backends))
        return true;
    error_set(error, "--%s is for devices, but --backend=%s uses none", option, command->backends.name);
    return error_fix(error, "add --backend=opencl, or leave --%s out", option);
}

/* Copies the set's options to `specs`; returns their number. */
static int specs_fill(const RenderOptionSet *set, OptionSpec *specs)
{
    if (!set->uses) {
        memcpy(specs, RENDER_OPTION_SPECS, sizeof RENDER_OPTION_SPECS);
        return RENDER_OPTION_COUNT;
    }
    for (int i = 0; i < set->use_count; ++i) {
        const RenderOptionUse *use = &set->uses[i];
        specs[i] = RENDER_OPTION_SPECS[use->option];
        specs[i].argument = use->argument ? use->argument : specs[i].argument;
        specs[i].help = use->help ? use->help : specs[i].help;
    }
    return set->use_count;
}

OptionsEnd render_options_parse(RenderCommand *command, const RenderOptionSet *set, const BackendTable *backends,
                                int argc, char **argv, Error *error)
{
    Parse parse = {.command = command, .set = set};
    const OptionTable table = {set->command, set->usage, set->summary, parse.specs, specs_fill(set, parse.specs),
                               set->footer};
    int first = 0;
    OptionsEnd end = options_parse(&table, argc, argv, option_set, &parse, &first, error);
    if (end != OPTIONS_READ)
        return end;
    command->first_operand = first;
    bool good = (set->several || options_scene(&table, argc, argv, first, &command->scene, error)) &&
                verify_alone(command, error) && output_ending_check(command, set, error) &&
                shard_alone(command, error) && backends_set(command, backends, parse.backend, error);
    return good ? OPTIONS_READ : OPTIONS_WRONG;
}
