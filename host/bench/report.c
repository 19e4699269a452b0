#include "bench/report.h"

#include "base/build_info.h"
#include "base/path_name.h"
#include "bench/analysis.h"
#include "bench/html.h"
#include "bench/svg_chart.h"

#include <math.h>
#include <stddef.h>
#include <time.h>

#define LATE 1.5 /* the report warns if a rendering took this many times its time */

/* ---- the head --------------------------------------------------------------------------------------------------- */

static void fact(FILE *stream, const char *name, const char *value)
{
    fprintf(stream, "<dt>%s</dt><dd>", name);
    html_text(stream, value);
    fputs("</dd>\n", stream);
}

static int runs_finished(const Bench *bench)
{
    int finished = 0;
    for (int i = 0; i < bench->options.scene_count; ++i)
        for (int r = 0; r < bench->scenes[i].run_count; ++r)
            finished += bench->scenes[i].runs[r].finished;
    return finished;
}

static int runs_wanted(const BenchOptions *options)
{
    return options->scene_count * options->integrator_count * options->backend_count * options->time_count *
           options->runs;
}

/* The device of each backend, as reported by its first run. */
static void devices_write(const Bench *bench, FILE *stream)
{
    const BenchScene *scene = &bench->scenes[0];
    for (int b = 0; b < bench->options.backend_count; ++b) {
        const BenchRun *found = NULL;
        for (int r = 0; r < scene->run_count && !found; ++r)
            if (scene->runs[r].finished && scene->series[scene->runs[r].series].backend == &bench->options.backends[b])
                found = &scene->runs[r];
        if (!found)
            continue;
        fprintf(stream, "<dt>%s</dt><dd>", bench->options.backends[b].name);
        html_text(stream, found->record.device);
        fprintf(stream, ", %llu thread%s</dd>\n", (unsigned long long)found->record.threads,
                found->record.threads == 1 ? "" : "s");
    }
}

static void head_write(const Bench *bench, FILE *stream)
{
    char machine[320], date[32];
    time_t now = time(NULL);
    struct tm broken;
    strftime(date, sizeof date, "%Y-%m-%d", gmtime_r(&now, &broken));
    build_machine(machine, sizeof machine);
    int finished = runs_finished(bench), wanted = runs_wanted(&bench->options);
    fputs("<header>\n<h1>Error against time</h1>\n<p class=\"soft\">Twinlight, ", stream);
    for (int i = 0; i < bench->options.integrator_count; ++i)
        fprintf(stream, "%s%s", i > 0 ? ", " : "", bench->options.integrators[i]->name);
    fprintf(stream, " on %d scene%s, %d renderings</p>\n", bench->options.scene_count,
            bench->options.scene_count > 1 ? "s" : "", finished);
    if (finished < wanted)
        fprintf(stream,
                "<p class=\"notice\">Not finished: %d of %d renderings are done. The same command renders the "
                "others.</p>\n",
                finished, wanted);
    fputs("<dl class=\"facts\">\n", stream);
    fact(stream, "machine", machine);
    devices_write(bench, stream);
    fact(stream, "compiler", build_compiler());
    fact(stream, "commit", build_commit());
    fact(stream, "command", bench->command);
    fact(stream, "date", date);
    fputs("</dl>\n</header>\n", stream);
}

/* ---- the summary ------------------------------------------------------------------------------------------------ */

static double best_speedup(const BenchScene *scene)
{
    double best = 0.0;
    for (int s = 0; s < scene->series_count; ++s)
        best = scene->series[s].speedup > best ? scene->series[s].speedup : best;
    return best;
}

static void summary_row(const Bench *bench, int number, FILE *stream)
{
    const BenchScene *scene = &bench->scenes[number];
    int time = bench_common_time(&bench->options, scene);
    fprintf(stream, "<tr><td><a href=\"#scene%d\">", number);
    html_text(stream, scene->name);
    fputs("</a></td>", stream);
    for (int s = 0; s < scene->series_count; ++s) {
        const BenchSeries *series = &scene->series[s];
        bool best = scene->series_count > 1 && series->speedup == best_speedup(scene);
        fputs(best ? "<td class=\"best\">" : "<td>", stream);
        bench_factor_write(stream, series->speedup);
        fprintf(stream, "%s<small>relMSE ", series->extrapolated ? " *" : "");
        html_number(stream, time < 0 ? (double)NAN : series->groups[time].rel_mse.median, 3);
        fputs("</small></td>", stream);
    }
    fputs("</tr>\n", stream);
}

/* Geometric means over the scenes with known speed-ups. */
static void summary_mean(const Bench *bench, FILE *stream)
{
    fputs("<tr><td><b>geometric mean</b></td>", stream);
    for (int s = 0; s < bench->scenes[0].series_count; ++s) {
        double sum = 0.0;
        int count = 0;
        for (int i = 0; i < bench->options.scene_count; ++i) {
            const BenchScene *scene = &bench->scenes[i];
            if (s >= scene->series_count || !(scene->series[s].speedup > 0.0))
                continue;
            sum += log(scene->series[s].speedup);
            ++count;
        }
        fputs("<td><b>", stream);
        bench_factor_write(stream, count > 0 ? exp(sum / count) : (double)NAN);
        fputs("</b></td>", stream);
    }
    fputs("</tr>\n", stream);
}

static void summary_write(const Bench *bench, FILE *stream)
{
    const BenchScene *first = &bench->scenes[0];
    fputs("<section>\n"
          "<h2>Speed-up at equal error</h2>\n"
          "<p class=\"soft\">How many times sooner than the first integrator each reaches the relMSE that the first "
          "has after the longest time (medians over runs).</p>\n"
          "<div class=\"wide\"><table><thead><tr><th>scene</th>",
          stream);
    for (int s = 0; s < first->series_count; ++s) {
        fprintf(stream, "<th class=\"s%d\">", s % CHART_STYLES);
        html_text(stream, first->series[s].name);
        fputs("</th>", stream);
    }
    fputs("</tr></thead>\n<tbody>\n", stream);
    for (int i = 0; i < bench->options.scene_count; ++i)
        if (bench->scenes[i].run_count > 0)
            summary_row(bench, i, stream);
    if (bench->options.scene_count > 1)
        summary_mean(bench, stream);
    fputs("</tbody></table></div>\n"
          "<p class=\"soft\">* extrapolated beyond the measured times by error \u221d 1 / time.</p>\n"
          "</section>\n",
          stream);
}

/* ---- charts ----------------------------------------------------------------------------------------------------- */

/* A chart: the offsets in BenchGroup of the BenchBands on its axes, and the fit to note beside each name. */
typedef struct ChartKind {
    const char *title, *x_label, *y_label;
    size_t x, y;
    size_t fit; /* offset in BenchSeries of a SampleLine; 0: none */
} ChartKind;

static const ChartKind CHARTS[] = {
    {"Error against time", "seconds of rendering", "relMSE", offsetof(BenchGroup, seconds),
     offsetof(BenchGroup, rel_mse), offsetof(BenchSeries, by_time)},
    {"Error against samples", "samples per pixel", "relMSE", offsetof(BenchGroup, samples_per_pixel),
     offsetof(BenchGroup, rel_mse), offsetof(BenchSeries, by_samples)},
    {"Without the worst 0.1 % of pixels", "seconds of rendering", "relMSE without the worst 0.1 %",
     offsetof(BenchGroup, seconds), offsetof(BenchGroup, rel_mse_trimmed), 0},
    {"As seen on a display", "seconds of rendering", "FLIP", offsetof(BenchGroup, seconds), offsetof(BenchGroup, flip),
     0},
};

static const BenchBand *band_at(const BenchGroup *group, size_t offset)
{
    return (const BenchBand *)(const void *)((const char *)group + offset);
}

static void line_fill(const Bench *bench, const BenchScene *scene, int number, const ChartKind *kind, ChartLine *line)
{
    const BenchSeries *series = &scene->series[number];
    *line = (ChartLine){.name = series->name, .style = number, .dashed = number >= bench->options.integrator_count};
    if (kind->fit > 0) {
        const SampleLine *fit = (const SampleLine *)(const void *)((const char *)series + kind->fit);
        if (isfinite(fit->slope))
            snprintf(line->note, sizeof line->note, "%s%.2f", fit->slope < 0.0 ? "\u2212" : "", fabs(fit->slope));
    }
    for (int t = 0; t < bench->options.time_count; ++t) {
        const BenchGroup *group = &series->groups[t];
        const BenchBand *y = band_at(group, kind->y);
        if (group->runs > 0 && y->low > 0.0)
            line->points[line->count++] = (ChartPoint){band_at(group, kind->x)->median, y->low, y->median, y->high};
    }
}

static void charts_write(const Bench *bench, const BenchScene *scene, FILE *stream)
{
    static ChartLine lines[BENCH_SERIES_MAX];
    fputs("<div class=\"charts\">\n", stream);
    for (size_t i = 0; i < sizeof CHARTS / sizeof CHARTS[0]; ++i) {
        const ChartKind *kind = &CHARTS[i];
        for (int s = 0; s < scene->series_count; ++s)
            line_fill(bench, scene, s, kind, &lines[s]);
        const Chart chart = {.title = kind->title,
                             .x_label = kind->x_label,
                             .y_label = kind->y_label,
                             .level = kind->fit > 0 ? scene->reference.own_error : 0.0,
                             .level_label = "the reference\u2019s own error",
                             .lines = lines,
                             .count = scene->series_count};
        chart_write(stream, &chart);
    }
    fputs("</div>\n"
          "<p class=\"soft\">Medians, and bands from the 10 to the 90 % quantile over the runs; next to a name the "
          "slope of the least-squares line through all runs, \u22121 for independent samples. Samples of different "
          "integrators are different amounts of work.</p>\n",
          stream);
}

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

static void scene_facts(const Bench *bench, const BenchScene *scene, FILE *stream)
{
    fputs("<dl class=\"facts\">\n", stream);
    fact(stream, "file", scene->path);
    fprintf(stream,
            "<dt>scene</dt><dd>%d \u00d7 %d pixels, paths of up to %d segments; primitives: %zu, lights: %zu</dd>\n",
            scene->width, scene->height, scene->max_depth, scene->primitives, scene->lights);
    fprintf(stream, "<dt>runs</dt><dd>%d per integrator and time, each with its own seed</dd>\n", bench->options.runs);
    fputs("<dt>reference</dt><dd>", stream);
    html_text(stream, scene->reference.path[0] ? scene->reference.origin : "not finished");
    fputs("</dd>\n<dt>its own error</dt><dd>", stream);
    if (isfinite(scene->reference.own_error)) {
        fputs("relMSE ", stream);
        html_number(stream, scene->reference.own_error, 3);
        fputs(", from its halves; every relMSE below includes it, since it is never subtracted", stream);
    } else {
        fputs(scene->reference.path[0] ? "unknown: it has no halves" : "unknown", stream);
    }
    fputs("</dd>\n</dl>\n", stream);
}

/* Warns of problems counted in the runs, if there are any. */
static void scene_warnings(const BenchScene *scene, FILE *stream)
{
    unsigned long long saturated = 0, not_finite = 0, diagnostics = 0;
    for (int r = 0; r < scene->run_count; ++r) {
        saturated += scene->runs[r].record.saturated;
        not_finite += scene->runs[r].record.not_finite;
        diagnostics += scene->runs[r].record.diagnostics;
    }
    if (saturated + not_finite + diagnostics > 0)
        fprintf(stream,
                "<p class=\"notice\">Over all runs: %llu contributions clamped, %llu not finite, %llu unexpected "
                "events counted by the kernels.</p>\n",
                saturated, not_finite, diagnostics);
}

/* Warns of integrators that took much longer than asked. */
static void scene_late(const BenchOptions *options, const BenchScene *scene, FILE *stream)
{
    int time = bench_common_time(options, scene);
    for (int s = 0; s < scene->series_count && time >= 0; ++s) {
        const BenchSeries *series = &scene->series[s];
        double seconds = series->groups[time].seconds.median;
        if (seconds < LATE * options->times[time])
            continue;
        fputs("<p class=\"notice\">", stream);
        html_text(stream, series->name);
        fprintf(stream,
                " took %.3g s instead of %g s: the first sample of every pixel is always completed. Longer times or a "
                "smaller film would make the comparison fairer.</p>\n",
                seconds, options->times[time]);
    }
}

static bool scene_write(const Bench *bench, int number, FILE *stream, Error *error)
{
    const BenchScene *scene = &bench->scenes[number];
    fprintf(stream, "<section id=\"scene%d\">\n<h2>", number);
    html_text(stream, scene->name);
    fputs("</h2>\n", stream);
    scene_facts(bench, scene, stream);
    scene_warnings(scene, stream);
    scene_late(&bench->options, scene, stream);
    bool good = true;
    if (scene->reference.path[0]) {
        charts_write(bench, scene, stream);
        bench_figures_write(bench, scene, stream);
        good = bench_pictures_write(bench, number, stream, error);
    }
    fputs("</section>\n", stream);
    return good;
}

/* ---- the page --------------------------------------------------------------------------------------------------- */

static void chain_terms_write(FILE *stream)
{
    fputs(
        "<dt>longest run of rejections</dt><dd>the most proposals that a chain rejected in a row, over generations: "
        "long if chains cannot leave a path</dd>\n"
        "<dt>distinct starts</dt><dd>the fraction of distinct paths among those with which chains start or continue in "
        "a generation: small if one path or a few started most chains</dd>\n"
        "<dt>R\u0302</dt><dd>potential scale reduction factor (Gelman and Rubin 1992; Vehtari et al. 2021) between the "
        "chains of the two replicas, from the paths at which they end a generation: the maximum over log luminance, "
        "film x and film y. It is 1 if the groups agree; 50 independent paths in each show 1.01 by chance; above 1.1, "
        "where it is marked, chains of one replica have not been where those of the other have</dd>\n",
        stream);
}

static void method_write(const Bench *bench, FILE *stream)
{
    fputs("<section>\n"
          "<h2>What the figures mean</h2>\n"
          "<dl class=\"facts\">\n"
          "<dt>relMSE</dt><dd>mean of (I \u2212 R)\u00b2 / (R\u00b2 + 0.01) over pixels and channels, I the image and "
          "R the reference, linear</dd>\n"
          "<dt>MAPE</dt><dd>mean of |I \u2212 R| / (|R| + 0.01)</dd>\n"
          "<dt>FLIP</dt><dd>mean of LDR-FLIP (Andersson et al. 2020), 0 to 1, lower is better; ",
          stream);
    fprintf(stream, "%g pixels per degree, of values \u00d7 2^%g clamped to 0 \u2026 1</dd>\n",
            bench->options.display.pixels_per_degree, bench->options.display.exposure);
    fputs("<dt>SSIM</dt><dd>mean structural similarity (Wang et al. 2004) of the same values\u2019 luma, 1 for equal "
          "images</dd>\n"
          "<dt>time to equal error</dt><dd>when the median relMSE falls to the first integrator\u2019s at the longest "
          "time common to all, interpolated between times by a power law</dd>\n"
          "<dt>relative variance</dt><dd>mean of s\u00b2 / (R\u00b2 + 0.01), s\u00b2 a pixel\u2019s variance over the "
          "runs of one time; efficiency is 1 / (variance \u00d7 time)</dd>\n"
          "<dt>relMSE of the mean</dt><dd>relMSE of the mean of all runs of one time, minus variance / runs: what "
          "remains is the squared bias plus the reference\u2019s own error; it may be negative by chance</dd>\n"
          "<dt>\u00b1</dt><dd>one standard error</dd>\n"
          "<dt>seconds</dt><dd>wall-clock time of rendering, pools included; a rendering completes the pass it has "
          "started, and the time actually taken counts</dd>\n",
          stream);
    chain_terms_write(stream);
    fputs("</dl>\n</section>\n", stream);
}

bool bench_html_write(const Bench *bench, FILE *stream, Error *error)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
          "charset=\"utf-8\"/>\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
          "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>Error against time: ",
          stream);
    for (int i = 0; i < bench->options.scene_count; ++i) {
        fputs(i > 0 ? ", " : "", stream);
        html_text(stream, path_file_name(bench->options.scenes[i]));
    }
    fprintf(stream, "</title>\n<style>\n%s</style>\n</head>\n<body>\n", BENCH_STYLE);
    head_write(bench, stream);
    fputs("<main>\n", stream);
    summary_write(bench, stream);
    bool good = true;
    for (int i = 0; i < bench->options.scene_count && good; ++i)
        if (bench->scenes[i].run_count > 0)
            good = scene_write(bench, i, stream, error);
    method_write(bench, stream);
    fputs("</main>\n</body>\n</html>\n", stream);
    return good;
}
