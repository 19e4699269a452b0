/* `twinlight render`: from a scene to an image. */
#include "command/command.h"

#include "base/interrupt.h"
#include "base/log.h"
#include "base/timing.h"
#include "command/mlt_option.h"
#include "command/output_check.h"
#include "command/render_job.h"
#include "command/render_settings.h"
#include "command/render_verify.h"
#include "mmlt/chain_list.h"
#include "mmlt/scheme.h"
#include "gltf/load.h"
#include "ranks/ranks.h"
#include "render/checkpoint.h"
#include "render/report.h"
#include "render/shard.h"
#include "scene/warnings.h"

#include <string.h>
#include <unistd.h>

static const RenderOptionSet OPTIONS = {
    .command = "render",
    .usage = "render [OPTION]... SCENE",
    .summary = "Renders SCENE, a file in pbrt-v4's text format or glTF, to an OpenEXR image and a PNG.",
    .footer = "Switches of mmlt (--mlt=KEY=VALUE,...):\n" MLT_HELP "\n"
              "SIGINT, SIGTERM and SIGHUP end the rendering early: what is finished is written, and the exit status\n"
              "is 130. Another such signal at least a second later ends the program at once.\n"
              "Under mpirun several processes render one picture.\n"
              "More: man twinlight-render.",
    .output_ending = ".exr",
    .depth_low = 1,
    .depth_high = 65535,
};

/* ---- before rendering ------------------------------------------------------------------------------------------- */

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
        .no_openings = command->no_openings,
        .save_every = command->save_every,
        .checkpoint = job_checkpoint_options(command),
        .pilot = command->pilot,
        .stop = interrupt_flag(),
    };
    options.error.scale = (double)settings->film_scale;
    if (options.samples == 0 && options.seconds == 0.0 && !(options.error.goal > 0.0))
        options.samples = (unsigned)settings->samples;
    return options;
}

static bool scene_load(RenderJob *job, Error *error)
{
    if (!scene_file_load(job->command->scene, job->command->lenient, &job->scene, error))
        return false;
    const RenderOptions options = job_options(job);
    /* Whether there are any does not depend on the number of pixels. */
    scene_advise(&job->scene, render_photons(job->integrator, &options, 1) > 0);
    return true;
}

static BackendOptions backend_options(const RenderCommand *command)
{
    return (BackendOptions){.threads = command->threads,
                            .batch = command->batch,
                            .film = command->film_place,
                            .record_spans = command->trace != NULL};
}

static bool backend_build(RenderJob *job, Error *error)
{
    const BackendScene view = scene_backend_view(&job->scene);
    const RenderCommand *command = job->command;
    const BackendOptions options = backend_options(command);
    const RankSetup setup = {.choices = &command->backends, .options = &options};
    return ranks_open(&view, &setup, &job->backend, error);
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
    double start = timing_now(), samples = (double)totals->done / (double)film_pixels(&job->film);
    bool written = job->part.path[0] ? part_output_write(&job->part, &job->film, totals, error)
                                     : render_output_write(&job->output, &job->film, samples, error);
    job->progress.writing_seconds = timing_now() - start;
    return written;
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
                    job_watch(job, error);
    job->progress.writing_seconds = render_output_seconds(&job->output);
    rendered = rendered && render_film(&task, &job->film, &job->result, error);
    progress_end(&job->progress);
    if (rendered)
        watch_finish(&job->watch, &job->film);
    return rendered;
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

/* Whether ranks can share what the command asks for. */
static bool ranks_suit(const RenderCommand *command, Error *error)
{
    const char *option = command->verify ? "verify" : command->trace ? "trace" : NULL;
    if (ranks_count() == 1 || !option)
        return true;
    error_set(error, "--%s is for a single process, but there are %d ranks", option, ranks_count());
    return error_fix(error, "start the program without a launcher");
}

static int job_run(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    job->integrator = integrator_find(command->integrator, error);
    if (!job->integrator || !render_settings_check(command, job->integrator, error) ||
        !render_settings_layers(command, job->integrator, &job->layers.wanted, error))
        return EXIT_USAGE;
    if (!ranks_suit(command, error) || !job_names_fill(job, error))
        return EXIT_USAGE;
    int status;
    if (!ranks_greet(&status, error))
        return status;
    if (command->output && !output_check(command->output, error))
        return EXIT_FAILED; /* checked before loading the scene, which may take long */
    const CheckpointOptions checkpoint = job_checkpoint_options(command);
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
    if (!job_outputs_name(job, error) || !job_outputs_check(job, error) ||
        !stage_run(backend_build, job, &job->build, error) || !interrupt_install(error) ||
        (ranks_count() > 1 && !interrupt_install_user(error)) ||
        !bad_chains_begin(&job->bad_chains, command->dump_bad, error))
        return EXIT_FAILED;
    if (!stage_run(film_render, job, &job->rendering, error)) {
        film_rescue(job, error);
        return EXIT_FAILED;
    }
    if (!stage_run(film_write, job, &job->write, error))
        return EXIT_FAILED;
    render_report(&job->result, &job->film, job->output.picture.scale);
    job_summary(job);
    if (!bad_chains_end(&job->bad_chains, error) || (command->stats && !job_stats(job, error)) ||
        (command->trace && !job_trace(job, error)))
        return EXIT_FAILED;
    return job->result.stopped ? EXIT_STOPPED : EXIT_OK;
}

/* The main function of rank 0. */
static int command_render(RenderCommand *command, Error *error)
{
    RenderJob job;
    if (!command->integrator)
        command->integrator = "mmlt";
    log_level_set(command->quiet ? LOG_WARNING : LOG_INFO);
    memset(&job, 0, sizeof job);
    job.command = command;
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

/* The main function of the other ranks, which need the options of backends alone. What is wrong with them is told by
 * rank 0. */
static int command_serve(const RenderCommand *command, OptionsEnd end, const Error *error)
{
    const BackendOptions options = backend_options(command);
    const RankSetup setup = {.choices = &command->backends,
                             .options = &options,
                             .status = end == OPTIONS_WRONG ? options_status(end) : EXIT_OK,
                             .error = *error};
    ranks_serve(&setup);
    return EXIT_OK;
}

int cmd_render(const BackendTable *backends, int argc, char **argv, Error *error)
{
    RenderCommand command = {
        .png = true, .frame = -1, .photons = PHOTONS_DEFAULT, .reconstruction = RECONSTRUCTION_SPLAT};
    Error own = {0};
    if (!ranks_begin(error))
        return EXIT_FAILED;
    OptionsEnd end = render_options_parse(&command, &OPTIONS, backends, argc, argv, &own);
    int status;
    if (ranks_number() > 0) {
        status = command_serve(&command, end, &own);
    } else {
        *error = own;
        status = end == OPTIONS_READ ? command_render(&command, error) : options_status(end);
    }
    ranks_end();
    return status;
}
