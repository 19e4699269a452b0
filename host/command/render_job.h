/* One rendering of `twinlight render`, from its command line to its files: the main function is in cmd_render.c. */
#ifndef TWINLIGHT_COMMAND_RENDER_JOB_H
#define TWINLIGHT_COMMAND_RENDER_JOB_H

#include "base/arena.h"
#include "command/part_output.h"
#include "command/render_options.h"
#include "command/render_output.h"
#include "mmlt/bad_chains.h"
#include "render/progress.h"
#include "render/render.h"
#include "serve/watch.h"

typedef struct RenderJob {
    RenderCommand *command;
    Arena names; /* file names with the frame number filled in */
    const Integrator *integrator;
    Scene scene;
    Film film;
    RenderLayers layers;
    BadChains bad_chains;
    BackendMember backend;
    RenderOutput output;
    PartOutput part; /* in place of it with --shard */
    Progress progress;
    Watch watch;
    bool left; /* no sample was rendered, and files were left as they are */
    bool frame_used; /* a file name has the frame's number */
    RenderResult result;
    double load, build, rendering, write; /* seconds */
    double start;
} RenderJob;

/* ---- names of files (render_names.c) ---- */

/* Fills the frame number into file names from the command line. */
bool job_names_fill(RenderJob *job, Error *error);

/* A file to resume is written to as well, unless --checkpoint names another. */
CheckpointOptions job_checkpoint_options(const RenderCommand *command);

/* Sets the names of image and PNG, or of the part, once the scene is known. */
bool job_outputs_name(RenderJob *job, Error *error);

/* Sets what the files say of the rendering, and fails if two of them have one name. */
bool job_outputs_check(RenderJob *job, Error *error);

/* The main file that is written. */
const char *job_target(const RenderJob *job);

/* ---- what is said of a rendering that is done (render_results.c) ---- */

/* In the log. */
void job_summary(const RenderJob *job);

/* --stats and --trace. */
bool job_stats(const RenderJob *job, Error *error);
bool job_trace(const RenderJob *job, Error *error);

#endif
