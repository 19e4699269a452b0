/* `twinlight bench`: renderings, figures, report. */
#include "command/command.h"

#include "base/interrupt.h"
#include "base/log.h"
#include "base/output_file.h"
#include "bench/analysis.h"
#include "bench/options.h"
#include "bench/renderings.h"
#include "bench/report.h"
#include "bench/tables.h"
#include "command/output_check.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The report's path with another ending. */
static void sibling(const Bench *bench, const char *ending, char path[PATH_MAX])
{
    const char *output = bench->options.output;
    snprintf(path, PATH_MAX, "%.*s%s", (int)(strlen(output) - strlen(".html")), output, ending);
}

/* Checks that page and tables can be written and are neither scenes nor references. */
static bool outputs_check(const Bench *bench, Error *error)
{
    const BenchOptions *options = &bench->options;
    CommandFile files[2 * BENCH_SCENES_MAX + 3];
    char tsv[PATH_MAX], json[PATH_MAX];
    size_t count = 0;
    sibling(bench, ".tsv", tsv);
    sibling(bench, ".json", json);
    for (int i = 0; i < options->scene_count; ++i)
        files[count++] = (CommandFile){"a scene", options->scenes[i], false};
    for (int i = 0; i < options->reference_count; ++i)
        files[count++] = (CommandFile){"a reference", options->references[i], false};
    files[count++] = (CommandFile){"the report", options->output, true};
    files[count++] = (CommandFile){"the table", tsv, true};
    files[count++] = (CommandFile){"the data", json, true};
    return output_files_check(files, count, "give another name with --output", error);
}

static bool folder_make(Bench *bench, Error *error)
{
    if (!outputs_check(bench, error))
        return false;
    sibling(bench, ".runs", bench->folder);
    return mkdir(bench->folder, 0777) == 0 || errno == EEXIST || error_errno(error, "make the folder", bench->folder);
}

/* Checks that all input files are readable before the first scene is rendered. */
static bool inputs_check(const BenchOptions *options, Error *error)
{
    for (int i = 0; i < options->scene_count; ++i)
        if (access(options->scenes[i], R_OK) != 0)
            return error_errno(error, "read", options->scenes[i]);
    for (int i = 0; i < options->reference_count; ++i)
        if (access(options->references[i], R_OK) != 0)
            return error_errno(error, "read", options->references[i]);
    return true;
}

static void plan(Bench *bench)
{
    const BenchOptions *options = &bench->options;
    for (int i = 0; i < options->scene_count; ++i) {
        int renderings;
        bench->planned += bench_scene_seconds(options, i < options->reference_count, &renderings);
        bench->renderings_planned += renderings;
    }
}

/* Renders and analyses the scenes, until a signal or a failure. */
static bool scenes_run(Bench *bench, Error *error)
{
    const BenchOptions *options = &bench->options;
    for (int i = 0; i < options->scene_count && !*interrupt_flag(); ++i) {
        BenchScene *scene = &bench->scenes[i];
        const char *reference = i < options->reference_count ? options->references[i] : NULL;
        bool rendered = bench_scene_render(bench, scene, options->scenes[i], reference, error);
        Error unread = {0};
        if (!bench_scene_analyse(options, scene, &unread)) {
            scene->run_count = 0; /* it has no figures: leave it out of the report */
            if (rendered)
                *error = unread;
            return false;
        }
        if (!rendered)
            return false;
    }
    return true;
}

/* ---- the report ------------------------------------------------------------------------------------------------- */

typedef bool (*ReportWriter)(const Bench *bench, FILE *stream, Error *error);

static bool tsv_report(const Bench *bench, FILE *stream, Error *error)
{
    (void)error;
    bench_tsv_write(bench, stream);
    return true;
}

static bool json_report(const Bench *bench, FILE *stream, Error *error)
{
    (void)error;
    bench_json_write(bench, stream);
    return true;
}

static bool report_write(const Bench *bench, const char *path, ReportWriter write, Error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return error_errno(error, "make", path);
    bool good = write(bench, stream, error);
    bool whole = fclose(stream) == 0;
    if (good && !whole)
        good = error_errno(error, "make", path);
    good = good && output_file_write(path, text, size, error);
    free(text);
    return good;
}

static bool reports_write(const Bench *bench, Error *error)
{
    char tsv[PATH_MAX], json[PATH_MAX];
    sibling(bench, ".tsv", tsv);
    sibling(bench, ".json", json);
    if (!report_write(bench, tsv, tsv_report, error) || !report_write(bench, json, json_report, error) ||
        !report_write(bench, bench->options.output, bench_html_write, error))
        return false;
    log_message(LOG_INFO, "wrote %s, %s and %s", bench->options.output, tsv, json);
    return true;
}

/* ---- the command ------------------------------------------------------------------------------------------------ */

static void command_line(Bench *bench, int argc, char **argv)
{
    size_t used = (size_t)snprintf(bench->command, sizeof bench->command, "twinlight");
    for (int i = 0; i < argc && used < sizeof bench->command; ++i)
        used += (size_t)snprintf(bench->command + used, sizeof bench->command - used, " %s", argv[i]);
}

static int bench_run(Bench *bench, Error *error)
{
    if (!interrupt_install(error) || !inputs_check(&bench->options, error) || !folder_make(bench, error))
        return EXIT_FAILED;
    plan(bench);
    Error late = {0};
    bool done = scenes_run(bench, error);
    /* Even after a failure, report what was finished. */
    bool any = false;
    for (int i = 0; i < bench->options.scene_count; ++i)
        any = any || bench->scenes[i].run_count > 0;
    bool written = !any || reports_write(bench, done ? error : &late);
    if (!done || !written)
        return EXIT_FAILED;
    return *interrupt_flag() ? EXIT_STOPPED : EXIT_OK;
}

int cmd_bench(const BackendTable *backends, int argc, char **argv, Error *error)
{
    Bench *bench = calloc(1, sizeof *bench);
    if (!bench) {
        error_memory(error, sizeof *bench, "the report");
        return EXIT_FAILED;
    }
    command_line(bench, argc, argv); /* before parsing, which moves the operands to the end */
    OptionsEnd end = bench_options_parse(&bench->options, backends, argc, argv, error);
    int status = options_status(end);
    if (end == OPTIONS_READ) {
        log_level_set(bench->options.quiet ? LOG_WARNING : LOG_INFO);
        status = bench_run(bench, error);
        for (int i = 0; i < bench->options.scene_count; ++i)
            bench_scene_destroy(&bench->scenes[i]);
    }
    free(bench);
    return status;
}
