/* The command line of `twinlight render`. */
#ifndef TWINLIGHT_RENDER_OPTIONS_H
#define TWINLIGHT_RENDER_OPTIONS_H

#include "backend_choice.h"

#include <stdio.h>

/* Strings are borrowed from argv, NULL when not given; numbers are 0 when not given. */
typedef struct RenderCommand {
    const char *scene;
    const char *output; /* ends in .exr */
    bool png; /* write a PNG */
    const char *png_path;
    double exposure; /* stops */
    const char *integrator;
    bool balance; /* balance heuristic */
    bool only_strategy, unweighted;
    unsigned strategy[2]; /* s, t */
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
    const char *stats;
    const char *trace;
    bool lenient;
    bool quiet;
    bool help; /* nothing else is valid */
} RenderCommand;

bool render_options_parse(RenderCommand *command, const BackendTable *backends, int argc, char **argv, Error *error);

void render_options_help(FILE *stream);

#endif
