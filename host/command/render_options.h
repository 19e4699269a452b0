/* The command line of `twinlight render`, and of commands that take some of its options. */
#ifndef TWINLIGHT_COMMAND_RENDER_OPTIONS_H
#define TWINLIGHT_COMMAND_RENDER_OPTIONS_H

#include "backend/choice.h"
#include "command/render_option_specs.h"
#include "render/layers.h"
#include "render/render.h"
#include "serve/watch.h"

/* Parsed options. Strings point into argv. */
typedef struct RenderCommand {
    const char *scene;
    int first_operand; /* in argv, after parsing */
    const char *output; /* ends in .exr, or with --shard not */
    bool png; /* write a PNG */
    const char *png_path;
    double exposure; /* stops */
    const char *integrator; /* NULL: not given */
    bool balance; /* balance heuristic */
    const char *sampler; /* "sobol" or "independent"; NULL: not given */
    unsigned reconstruction; /* RECONSTRUCTION_* */
    bool only_strategy, unweighted;
    unsigned strategy[2]; /* s, t */
    ChainOptions chains;
    unsigned layers; /* LAYER_BIT (render/layers.h) */
    bool has_layers; /* --layers was given */
    double despeckle; /* threshold; 0: no such layer */
    const char *dump_bad; /* file for chains with non-finite contributions; NULL: none */
    bool memory; /* print the chains' memory instead of rendering */
    const char *chain_option; /* the last option of Markov chains that was given; NULL: none */
    BackendChoices backends; /* one or more */
    bool verify; /* compare them bit by bit with `reference`, instead of rendering */
    const BackendInterface *reference;
    const char *device; /* as given; parsed into `backends` */
    unsigned batch;
    const char *film; /* "host" or "device" */
    FilmPlace film_place;
    uint64_t samples;
    double seconds;
    ErrorGoal error;
    const char *error_of; /* as given */
    int threads;
    uint64_t seed;
    unsigned photons;
    bool no_openings;
    int max_depth;
    int resolution[2];
    bool has_crop;
    int crop[4];
    double save_every;
    Shard shard; /* count 0: none */
    const char *checkpoint, *resume, *pilot; /* files; NULL: none */
    double checkpoint_every; /* seconds; 0: not given */
    const char *stats; /* "-": standard output */
    int frame; /* number for file names (base/frame_name.h); -1: not given */
    const char *trace;
    WatchOptions watch;
    bool lenient;
    bool quiet;
} RenderCommand;

/* An option of a command other than render. */
typedef struct RenderOptionUse {
    RenderOption option;
    const char *argument, *help; /* replace those of OptionSpec; NULL: render's */
} RenderOptionUse;

typedef struct RenderOptionSet {
    const char *command, *usage, *summary, *footer; /* as in OptionTable */
    const RenderOptionUse *uses; /* NULL: all of render's options */
    int use_count;
    const char *output_ending; /* required of --output */
    uint64_t depth_low, depth_high; /* allowed range of --max-depth */
    bool several; /* operands are not one scene: RenderCommand.first_operand */
} RenderOptionSet;

/* Parses the command line into `command`, which must hold the defaults. `error` says what is wrong on OPTIONS_WRONG. */
OptionsEnd render_options_parse(RenderCommand *command, const RenderOptionSet *set, const BackendTable *backends,
                                int argc, char **argv, Error *error);

#endif
