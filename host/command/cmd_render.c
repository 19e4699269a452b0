/* `twinlight render`: from a scene to an image. */
#include "command/command.h"

#include "backend/trace_output.h"
#include "base/frame_name.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/path_name.h"
#include "base/timing.h"
#include "command/mlt_option.h"
#include "command/output_check.h"
#include "command/part_output.h"
#include "command/render_options.h"
#include "command/render_output.h"
#include "command/render_settings.h"
#include "command/render_verify.h"
#include "mmlt/bad_chains.h"
#include "mmlt/chain_list.h"
#include "mmlt/scheme.h"
#include "pbrt/import.h"
#include "render/checkpoint.h"
#include "render/progress.h"
#include "render/render.h"
#include "render/report.h"
#include "render/shard.h"
#include "render/stats.h"
#include "scene/camera_setup.h"
#include "scene/warnings.h"

#include <string.h>
#include <unistd.h>

static const RenderOptionSet OPTIONS = {
    .command = "render",
    .usage = "render [OPTION]... SCENE",
    .summary = "Renders SCENE, a file in pbrt-v4's text format, to an OpenEXR image and a PNG.",
    .footer = "Switches of mmlt (--mlt=KEY=VALUE,...):\n" MLT_HELP "\n"
              "SIGINT, SIGTERM and SIGHUP end the rendering early: what is finished is written, and the exit status\n"
              "is 130. Another such signal at least a second later ends the program at once.\n"
              "More: man twinlight-render.",
    .output_ending = ".exr",
    .depth_low = 1,
    .depth_high = 65535,
};

/* One rendering from command line to files. */
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

/* ---- before rendering ------------------------------------------------------------------------------------------- */

/* A number that no file name uses would make every frame overwrite the one before. */
static bool frame_check(const RenderJob *job, Error *error)
{
    if (job->command->frame < 0 || job->frame_used)
        return true;
    error_set(error, "--frame=%d: no file name has a place for the number", job->command->frame);
    return error_fix(error, "write it as %%04d, as in -o frame.%%04d.exr");
}

/* Fills the frame number into file names from the command line. */
static bool names_fill(RenderJob *job, Error *error)
{
    RenderCommand *command = job->command;
    const char **names[] = {&command->output,   &command->png_path,   &command->stats, &command->trace,
                            &command->dump_bad, &command->checkpoint, &command->resume};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (!*names[i] || !frame_name_has(*names[i]))
            continue;
        if (command->frame < 0) {
            error_set(error, "%s has a place for a frame number, but none is given", *names[i]);
            return error_fix(error, "add --frame=N");
        }
        *names[i] = frame_name_fill(&job->names, *names[i], command->frame, error);
        job->frame_used = true;
        if (!*names[i])
            return false;
    }
    return !command->output || frame_check(job, error);
}

/* The image's name: from the command line or the scene's Film, whose name may also have a place for the frame number,
 * or else after the scene file. */
static const char *image_name(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const char *film = path_file_name(job->scene.settings.output);
    if (command->output)
        return command->output;
    job->frame_used = job->frame_used || frame_name_has(film);
    if (!frame_check(job, error))
        return NULL;
    if (!film[0])
        return strcmp(command->scene, "-") == 0 ? "stdin" : path_file_name(command->scene);
    return command->frame < 0 ? film : frame_name_fill(&job->names, film, command->frame, error);
}

/* A file to resume is written to as well, unless --checkpoint names another. */
static CheckpointOptions checkpoint_options(const RenderCommand *command)
{
    const char *file = command->checkpoint ? command->checkpoint : command->resume;
    return (CheckpointOptions){.file = file,
                               .every =
                                   command->checkpoint_every > 0.0 ? command->checkpoint_every : CHECKPOINT_SECONDS,
                               .resume = command->resume,
                               .anew = command->checkpoint && command->resume && path_same(file, command->resume)};
}

/* The names of image and PNG, or of the part. */
static bool outputs_name(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const char *image = image_name(job, error);
    if (!image)
        return false;
    if (command->shard.count > 0)
        return part_output_name(&job->part, command->output, image, command->shard, error);
    return render_output_name(&job->output, image, command->png, command->png_path, error);
}

/* The main file that is written. */
static const char *job_target(const RenderJob *job)
{
    return job->part.path[0] ? job->part.path : job->output.exr;
}

static bool outputs_check(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    RenderOutput *output = &job->output;
    const CheckpointOptions checkpoint = checkpoint_options(command);
    const char *stats = command->stats && !stats_to_output(command->stats) ? command->stats : NULL;
    output->picture = (PictureSettings){.scale = job->scene.settings.film_scale,
                                        .despeckle = command->despeckle,
                                        .layers = job->layers.wanted != 0 ? &job->layers : NULL};
    output->exposure = (float)command->exposure;
    output->scene_file = command->scene;
    output->integrator = command->integrator;
    output->seed = command->seed;
    output->max_depth = job->scene.settings.max_depth;
    camera_matrices(&job->scene.camera_settings, &job->scene.frame.camera, job->scene.origin, output->world_to_camera,
                    output->world_to_ndc);
    const CommandFile files[] = {{"the scene", strcmp(command->scene, "-") == 0 ? NULL : command->scene, false},
                                 {job->part.path[0] ? "the part" : "the image", job_target(job), true},
                                 {"the PNG", output->png[0] ? output->png : NULL, true},
                                 {"the statistics", stats, true},
                                 {"the trace", command->trace, true},
                                 {"the list of chains", command->dump_bad, true},
                                 {"the checkpoint", checkpoint.file, true}};
    return output_files_check(
        files, sizeof files / sizeof files[0],
        "give each its own name, with --output, --png, --stats, --trace, --dump-bad and --checkpoint", error);
}

static RenderOptions job_options(RenderJob *job)
{
    const RenderCommand *command = job->command;
    const SceneSettings *settings = &job->scene.settings;
    RenderOptions options = {
        .samples = (unsigned)command->samples,
        .shard = command->shard,
        .seconds = command->seconds,
        .max_depth = settings->max_depth,
        .chains = command->chains,
        .bad_chains = job->bad_chains.stream,
        .error = command->error,
        .layers = job->layers.wanted != 0 || command->error.goal > 0.0 ? &job->layers : NULL,
        .balance = command->balance,
        .reconstruction = command->reconstruction,
        .independent = command->sampler && strcmp(command->sampler, "independent") == 0,
        .only_strategy = command->only_strategy,
        .strategy = {command->strategy[0], command->strategy[1]},
        .unweighted = command->unweighted,
        .seed = command->seed,
        .photons = command->photons,
        .save_every = command->save_every,
        .checkpoint = checkpoint_options(command),
        .stop = interrupt_flag(),
    };
    options.error.scale = (double)settings->film_scale;
    if (options.samples == 0 && options.seconds == 0.0 && !(options.error.goal > 0.0))
        options.samples = (unsigned)settings->samples;
    return options;
}

static bool scene_load(RenderJob *job, Error *error)
{
    if (!pbrt_load(job->command->scene, job->command->lenient, &job->scene, error))
        return false;
    const RenderOptions options = job_options(job);
    /* Whether there are any does not depend on the number of pixels. */
    scene_advise(&job->scene, render_photons(job->integrator, &options, 1) > 0);
    return true;
}

static bool backend_build(RenderJob *job, Error *error)
{
    const BackendScene view = scene_backend_view(&job->scene);
    const RenderCommand *command = job->command;
    const BackendOptions options = {.threads = command->threads,
                                    .batch = command->batch,
                                    .film = command->film_place,
                                    .record_spans = command->trace != NULL};
    return backend_choices_open(&command->backends, &view, &options, &job->backend, error);
}

/* ---- rendering -------------------------------------------------------------------------------------------------- */

static void job_progress(void *context, const RenderProgress *progress)
{
    RenderJob *job = context;
    job->output.error = progress->error;
    progress_update(&job->progress, progress);
}

static void job_writing(void *context, const char *path, double part)
{
    RenderJob *job = context;
    progress_writing(&job->progress, path, part);
}

static void job_publish(void *context, RenderRun *run, const RenderProgress *progress)
{
    RenderJob *job = context;
    watch_publish(&job->watch, run, progress);
}

/* Writes what is finished: the part or the image. */
static bool target_write(RenderJob *job, const RenderTotals *totals, Error *error)
{
    if (job->part.path[0])
        return part_output_write(&job->part, &job->film, totals, error);
    return render_output_write(&job->output, &job->film, (double)totals->done / (double)film_pixels(&job->film), error);
}

static bool job_save(void *context, const Film *film, const RenderTotals *totals, Error *error)
{
    (void)film;
    return target_write(context, totals, error);
}

static bool job_watch(RenderJob *job, Error *error)
{
    const int *crop = job->scene.settings.crop;
    const WatchSubject subject = {.facts = {job->output.exr, job->command->scene, job->command->integrator},
                                  .width = crop[2] - crop[0],
                                  .height = crop[3] - crop[1],
                                  .settings = &job->output.picture,
                                  .memory = &job->output.memory};
    return watch_begin(&job->watch, &job->command->watch, &subject, error);
}

static bool film_render(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const SceneSettings *settings = &job->scene.settings;
    RenderOptions options = job_options(job);
    RenderCallbacks callbacks = {job_progress, job_save, job_publish, job};
    const RenderTask task = {.integrator = job->integrator,
                             .scene = &job->scene,
                             .backend = job->backend,
                             .options = &options,
                             .callbacks = &callbacks};
    BackendStatistics statistics;
    job->backend.interface->statistics(job->backend.backend, &statistics);
    progress_init(&job->progress, stderr, command->quiet);
    job->output.writing = job_writing;
    job->output.writing_context = job;
    job->part.threads = statistics.threads;
    if (job->part.path[0])
        part_output_begin(&job->part, &job->output, job->integrator, &job->scene, &options);
    bool pictures = !job->part.path[0] || watch_wanted(&command->watch);
    bool rendered = film_init(&job->film, settings->width, settings->height, settings->crop, error) &&
                    (!pictures || render_output_reserve(&job->output, settings->crop, statistics.threads, error)) &&
                    job_watch(job, error) && render_film(&task, &job->film, &job->result, error);
    progress_end(&job->progress);
    if (rendered)
        watch_finish(&job->watch, &job->film);
    return rendered;
}

/* ---- after rendering -------------------------------------------------------------------------------------------- */

/* What --error has estimated. */
static void goal_report(const RenderJob *job)
{
    const ErrorWatch *watch = &job->result.error;
    const double percent = 100.0;
    if (watch->work == 0)
        log_message(LOG_WARNING, "the rendering ended before its error could be estimated; --error had no effect");
    else
        log_message(job->result.error_reached ? LOG_INFO : LOG_WARNING, "estimated error %.3g %% +- %.2g %%%s%.3g %%",
                    percent * watch->estimate, percent * watch->deviation,
                    job->result.error_reached ? ": below --error=" : ", not yet below --error=",
                    percent * job->command->error.goal);
}

static void summary_report(const RenderJob *job)
{
    const RenderResult *result = &job->result;
    char seconds[24], samples[24], rays[24];
    double per_second = result->seconds > 0.0 ? 1.0 / result->seconds : 0.0;
    progress_time(result->seconds, seconds, sizeof seconds);
    progress_rate((double)result->samples * per_second, samples, sizeof samples);
    progress_rate((double)(result->backend.closest_rays + result->backend.shadow_rays) * per_second, rays, sizeof rays);
    log_message(LOG_INFO, "%s%.6g samples per pixel in %s (%ssamples/s, %srays/s)", result->stopped ? "stopped: " : "",
                result->samples_per_pixel, seconds, samples, rays);
    if (job->command->error.goal > 0.0)
        goal_report(job);
    if (job->left)
        log_message(LOG_WARNING, "%s is left unchanged: no sample is finished yet", job_target(job));
    else if (job->part.path[0])
        log_message(LOG_INFO, "wrote %s: shard %u of %u, for twinlight merge", job->part.path,
                    job->part.head.shard.number, job->part.head.shard.count);
    else
        log_message(LOG_INFO, "wrote %s%s%s", job->output.exr, job->output.png[0] ? " and " : "", job->output.png);
}

static bool stats_output(const RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const RenderStats stats = {
        .scene_file = command->scene,
        .scene = &job->scene,
        .film = &job->film,
        .integrator = command->integrator,
        .backend = command->backends.name,
        .seed = command->seed,
        .part = job->part.path,
        .exr = job->output.exr,
        .png = job->output.png,
        .result = &job->result,
        .error = &command->error,
        .load = job->load,
        .build = job->build,
        .render = job->rendering,
        .write = job->write,
        .total = timing_now() - job->start,
    };
    return stats_write(command->stats, &stats, error);
}

static bool trace_output(const RenderJob *job, Error *error)
{
    BackendMember members[BACKEND_GROUP_MAX];
    TraceSource sources[BACKEND_GROUP_MAX];
    size_t count = 0, found = backend_group_members(job->backend, members);
    for (size_t i = 0; i < found; ++i) {
        if (!members[i].interface->spans)
            continue;
        TraceSource *source = &sources[count++];
        source->count = members[i].interface->spans(members[i].backend, &source->spans, &source->dropped);
        members[i].interface->statistics(members[i].backend, &source->statistics);
        if (source->dropped > 0)
            log_message(LOG_WARNING, "the trace holds the first %zu spans only; %llu more were not recorded",
                        source->count, (unsigned long long)source->dropped);
    }
    return trace_write(job->command->trace, sources, count, error);
}

/* ---- the whole job ---------------------------------------------------------------------------------------------- */

/* Runs a stage and adds its wall-clock time to *seconds. */
static bool stage_run(bool (*stage)(RenderJob *, Error *), RenderJob *job, double *seconds, Error *error)
{
    double start = timing_now();
    bool done = stage(job, error);
    *seconds += timing_now() - start;
    return done;
}

/* Writes the image or the part. If there is no sample, an existing image is not replaced, and no part is written. */
static bool film_write(RenderJob *job, Error *error)
{
    job->left = job->result.samples == 0 && (job->part.path[0] || access(job->output.exr, F_OK) == 0);
    if (job->left)
        return true;
    job->output.error = job->result.error.estimate;
    bool written = target_write(job, &job->result.totals, error);
    progress_end(&job->progress);
    return written;
}

/* After a failed rendering: writes an image of the samples that were finished, and says so in the error. */
static void film_rescue(RenderJob *job, Error *error)
{
    Error failed = {0}, first = *error;
    const char *what = error_text(&first);
    if (job->result.samples == 0)
        return;
    if (stage_run(film_write, job, &job->write, &failed))
        error_set(error, "%s; what was finished, %.6g samples per pixel, is in %s", what, job->result.samples_per_pixel,
                  job_target(job));
    else
        error_set(error, "%s; what was finished could not be written either: %s", what, error_text(&failed));
    if (first.fix[0])
        error_fix(error, "%s", first.fix);
}

static int job_verify(RenderJob *job, Error *error)
{
    const RenderOptions options = job_options(job);
    if (!interrupt_install(error) || !render_verify(job->command, job->integrator, &job->scene, &options, error))
        return EXIT_FAILED;
    return *options.stop ? EXIT_STOPPED : EXIT_OK;
}

static int memory_print(const RenderJob *job)
{
    const ChainOptions *options = &job->command->chains;
    FrameParams frame = job->scene.frame;
    frame.path.max_depth = (uint)job->scene.settings.max_depth;
    unsigned usual = mmlt_scheme(options->paper)->chains;
    chain_memory_print(&frame, options->chains ? options->chains : usual);
    return EXIT_OK;
}

/* Whether each shard has something to do. Only now are samples and size known that the scene file may set. */
static bool shards_check(RenderJob *job, Error *error)
{
    const RenderOptions options = job_options(job);
    const int *crop = job->scene.settings.crop;
    uint64_t pixels = (uint64_t)(crop[2] - crop[0]) * (uint64_t)(crop[3] - crop[1]);
    return !shard_given(&options) || shard_check(&options, !job->integrator->render, pixels, error);
}

static int job_run(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    job->integrator = integrator_find(command->integrator, error);
    if (!job->integrator || !render_settings_check(command, job->integrator, error) ||
        !render_settings_layers(command, job->integrator, &job->layers.wanted, error))
        return EXIT_USAGE;
    if (!names_fill(job, error))
        return EXIT_USAGE;
    if (command->output && !output_check(command->output, error))
        return EXIT_FAILED; /* checked before loading the scene, which may take long */
    const CheckpointOptions checkpoint = checkpoint_options(command);
    if (!checkpoint_files_check(&checkpoint, error))
        return EXIT_FAILED;
    if (!stage_run(scene_load, job, &job->load, error))
        return EXIT_FAILED;
    if (!render_settings_apply(command, job->integrator, &job->scene, error) || !shards_check(job, error))
        return EXIT_USAGE;
    if (command->memory)
        return memory_print(job);
    if (command->verify)
        return job_verify(job, error);
    if (!outputs_name(job, error) || !outputs_check(job, error) || !stage_run(backend_build, job, &job->build, error) ||
        !interrupt_install(error) || !bad_chains_begin(&job->bad_chains, command->dump_bad, error))
        return EXIT_FAILED;
    if (!stage_run(film_render, job, &job->rendering, error)) {
        film_rescue(job, error);
        return EXIT_FAILED;
    }
    if (!stage_run(film_write, job, &job->write, error))
        return EXIT_FAILED;
    render_report(&job->result, &job->film, job->output.picture.scale);
    summary_report(job);
    if (!bad_chains_end(&job->bad_chains, error) || (command->stats && !stats_output(job, error)) ||
        (command->trace && !trace_output(job, error)))
        return EXIT_FAILED;
    return job->result.stopped ? EXIT_STOPPED : EXIT_OK;
}

int cmd_render(const BackendTable *backends, int argc, char **argv, Error *error)
{
    RenderCommand command = {
        .png = true, .frame = -1, .photons = PHOTONS_DEFAULT, .reconstruction = RECONSTRUCTION_SPLAT};
    OptionsEnd end = render_options_parse(&command, &OPTIONS, backends, argc, argv, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    if (!command.integrator)
        command.integrator = "mmlt";
    log_level_set(command.quiet ? LOG_WARNING : LOG_INFO);
    RenderJob job;
    memset(&job, 0, sizeof job);
    job.command = &command;
    job.start = timing_now();
    scene_init(&job.scene);
    int status = job_run(&job, error);
    watch_end(&job.watch);
    if (job.backend.backend)
        job.backend.interface->close(job.backend.backend);
    bad_chains_cancel(&job.bad_chains);
    arena_destroy(&job.names);
    render_output_release(&job.output);
    render_layers_destroy(&job.layers);
    film_destroy(&job.film);
    scene_destroy(&job.scene);
    return status;
}
