/* The command line of `twinlight render`, and of commands that take a part of its options. */
#ifndef TWINLIGHT_COMMAND_RENDER_OPTIONS_H
#define TWINLIGHT_COMMAND_RENDER_OPTIONS_H

#include "backend/choice.h"
#include "base/options.h"
#include "render/layers.h"
#include "render/render.h"

/* Strings are borrowed from argv. */
typedef struct RenderCommand {
    const char *scene;
    const char *output; /* ends in .exr */
    bool png; /* write a PNG */
    const char *png_path;
    double exposure; /* stops */
    const char *integrator; /* NULL: not given */
    bool balance; /* balance heuristic */
    bool only_strategy, unweighted;
    unsigned strategy[2]; /* s, t */
    ChainOptions chains;
    unsigned layers; /* LAYER_BIT (render/layers.h) */
    bool has_layers; /* --layers was given */
    double despeckle; /* threshold; 0: no such layer */
    const char *dump_bad; /* file of chains that met something not finite; NULL: none */
    bool memory; /* print what chains take, instead of rendering */
    const char *chain_option; /* the last one given; NULL: none */
    BackendChoices backends; /* at least one */
    bool verify; /* compare them with `reference` instead of rendering */
    const BackendInterface *reference;
    const char *device; /* as given: items of `backends` have their own */
    unsigned batch;
    const char *film; /* "host" or "device" */
    uint64_t samples;
    double seconds;
    int threads;
    uint64_t seed;
    int max_depth;
    int resolution[2];
    bool has_crop;
    int crop[4];
    double save_every;
    const char *stats; /* "-": standard output */
    int frame; /* for names with a place for it (base/frame_name.h); -1: not given */
    const char *trace;
    bool lenient;
    bool quiet;
} RenderCommand;

typedef enum RenderOption {
    OPTION_OUTPUT,
    OPTION_INTEGRATOR,
    OPTION_HEURISTIC,
    OPTION_STRATEGY,
    OPTION_UNWEIGHTED,
    OPTION_SAMPLES,
    OPTION_TIME,
    OPTION_BACKEND,
    OPTION_DEVICE,
    OPTION_BATCH,
    OPTION_FILM,
    OPTION_MLT_SCHEME,
    OPTION_CHAINS,
    OPTION_STEPS,
    OPTION_POOL,
    OPTION_LARGE_STEP,
    OPTION_MUTATIONS,
    OPTION_MEMORY,
    OPTION_SORT,
    OPTION_NO_SORT,
    OPTION_NO_GROUP,
    OPTION_NO_SHIFT,
    OPTION_NO_AIM,
    OPTION_NO_BLEND,
    OPTION_DUMP_BAD,
    OPTION_THREADS,
    OPTION_SEED,
    OPTION_MAX_DEPTH,
    OPTION_RESOLUTION,
    OPTION_CROP,
    OPTION_SAVE_EVERY,
    OPTION_LAYERS,
    OPTION_DESPECKLE,
    OPTION_FRAME,
    OPTION_PNG,
    OPTION_NO_PNG,
    OPTION_EXPOSURE,
    OPTION_STATS,
    OPTION_TRACE,
    OPTION_VERIFY,
    OPTION_LENIENT,
    OPTION_QUIET,
    RENDER_OPTION_COUNT
} RenderOption;

/* An option as a command has it. */
typedef struct RenderOptionUse {
    RenderOption option;
    const char *argument, *help; /* of OptionSpec; NULL: render's */
} RenderOptionUse;

typedef struct RenderOptionSet {
    const char *command, *usage, *summary, *footer; /* of OptionTable */
    const RenderOptionUse *uses; /* NULL: all options are taken as render has them */
    int use_count;
    const char *output_ending; /* of --output's value */
    uint64_t depth_low, depth_high; /* of --max-depth */
} RenderOptionSet;

/* Fills in what is given; `command` holds what is meant where nothing is. */
OptionsEnd render_options_parse(RenderCommand *command, const RenderOptionSet *set, const BackendTable *backends,
                                int argc, char **argv, Error *error);

#endif
