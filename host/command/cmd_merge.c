/* `twinlight merge`: from the parts that shards have rendered to an image. */
#include "command/command.h"

#include "base/interrupt.h"
#include "base/log.h"
#include "base/processors.h"
#include "command/output_check.h"
#include "command/part_output.h"
#include "command/render_options.h"
#include "render/merge.h"
#include "render/progress.h"
#include "render/report.h"

#include <stdlib.h>
#include <string.h>

static const RenderOptionUse USES[] = {
    {OPTION_OUTPUT, NULL, "the image (required)"},
    {OPTION_DESPECKLE, NULL, NULL},
    {OPTION_PNG, NULL, NULL},
    {OPTION_NO_PNG, NULL, NULL},
    {OPTION_EXPOSURE, NULL, NULL},
    {OPTION_THREADS, NULL, NULL},
    {OPTION_QUIET, NULL, NULL},
};

static const RenderOptionSet OPTIONS = {
    .command = "merge",
    .usage = "merge [OPTION]... -o FILE.exr PART...",
    .summary = "Adds parts of a picture, written by twinlight render --shard, and writes its image.",
    .footer = "The parts may come in any order; the image is the same, bit for bit.\nMore: man twinlight-merge.",
    .uses = USES,
    .use_count = sizeof USES / sizeof USES[0],
    .output_ending = ".exr",
    .several = true,
};

typedef struct MergeJob {
    const RenderCommand *command;
    char **paths;
    size_t count;
    Merge merge;
    Film film;
    RenderLayers layers;
    RenderOutput output;
} MergeJob;

static int threads_of(const RenderCommand *command)
{
    return command->threads > 0 ? command->threads : processors_usable();
}

/* Neither image nor PNG may overwrite a part. */
static bool outputs_check(const MergeJob *job, Error *error)
{
    CommandFile *files = calloc(job->count + 2, sizeof *files);
    if (!files)
        return error_memory(error, job->count * sizeof *files, "the list of parts");
    files[0] = (CommandFile){"the image", job->output.exr, true};
    files[1] = (CommandFile){"the PNG", job->output.png[0] ? job->output.png : NULL, true};
    for (size_t i = 0; i < job->count; ++i)
        files[i + 2] = (CommandFile){"a part", job->paths[i], false};
    bool good = output_files_check(files, job->count + 2, "give each its own name, with --output and --png", error);
    free(files);
    return good;
}

/* The first part is read for the size of everything. */
static bool job_begin(MergeJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    RenderOutput *output = &job->output;
    int threads = threads_of(command);
    if (!render_output_name(output, command->output, command->png, command->png_path, error) ||
        !outputs_check(job, error) || !merge_begin(&job->merge, job->paths, job->count, error) ||
        !part_film_init(&job->merge.head, threads, &job->film, &job->layers, error))
        return false;
    merge_warn(&job->merge);
    part_output_adopt(output, &job->merge.head);
    output->exposure = (float)command->exposure;
    output->picture.despeckle = command->despeckle;
    output->picture.layers = job->layers.wanted != 0 ? &job->layers : NULL;
    return render_output_reserve(output, job->film.crop, threads, error);
}

static void summary_report(const MergeJob *job, const RenderResult *result)
{
    char seconds[24];
    progress_time(result->seconds, seconds, sizeof seconds);
    log_message(LOG_INFO, "merged %zu of %u parts: %.6g samples per pixel in %s of rendering", job->merge.count,
                job->merge.head.shard.count, result->samples_per_pixel, seconds);
    log_message(LOG_INFO, "wrote %s%s%s", job->output.exr, job->output.png[0] ? " and " : "", job->output.png);
}

static int job_run(MergeJob *job, Error *error)
{
    RenderResult result;
    const atomic_int *stop = interrupt_flag();
    memset(&result, 0, sizeof result);
    if (!interrupt_install(error) || !job_begin(job, error) ||
        !merge_run(&job->merge, &job->film, &job->layers, stop, error))
        return EXIT_FAILED;
    if (*stop)
        return EXIT_STOPPED;
    render_result_totals(&result, job->merge.totals, film_pixels(&job->film));
    if (!render_output_write(&job->output, &job->film, result.samples_per_pixel, error))
        return EXIT_FAILED;
    render_report(&result, &job->film, job->output.picture.scale);
    summary_report(job, &result);
    return EXIT_OK;
}

static bool operands_check(const RenderCommand *command, size_t count, Error *error)
{
    if (count > 0 && command->output)
        return true;
    error_set(error, count == 0 ? "no part is given" : "no name is given for the image");
    return error_fix(error, "write twinlight merge -o image.exr PART...");
}

int cmd_merge(const BackendTable *backends, int argc, char **argv, Error *error)
{
    RenderCommand command = {.png = true};
    OptionsEnd end = render_options_parse(&command, &OPTIONS, backends, argc, argv, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    MergeJob job = {
        .command = &command, .paths = argv + command.first_operand, .count = (size_t)(argc - command.first_operand)};
    if (!operands_check(&command, job.count, error))
        return EXIT_USAGE;
    log_level_set(command.quiet ? LOG_WARNING : LOG_INFO);
    int status = job_run(&job, error);
    merge_destroy(&job.merge);
    render_output_release(&job.output);
    render_layers_destroy(&job.layers);
    film_destroy(&job.film);
    return status;
}
