/* Tables of a scene in the report. */
#include "bench/analysis.h"
#include "bench/html.h"
#include "bench/report.h"
#include "render/progress.h"

#include <math.h>

typedef struct Tables {
    const BenchOptions *options;
    const BenchScene *scene;
    int time; /* index of the time that tables show */
    FILE *stream;
} Tables;

/* ---- cells ------------------------------------------------------------------------------------------------------ */

static void head_write(FILE *stream, const char *const *names, int count)
{
    fputs("<div class=\"wide\"><table>\n<thead><tr>", stream);
    for (int i = 0; i < count; ++i)
        fprintf(stream, "<th>%s</th>", names[i]);
    fputs("</tr></thead>\n<tbody>\n", stream);
}

static void table_end(FILE *stream)
{
    fputs("</tbody></table></div>\n", stream);
}

static void row_begin(const Tables *tables, int series)
{
    fprintf(tables->stream, "<tr><th class=\"s%d\">", series % 8);
    html_text(tables->stream, tables->scene->series[series].name);
    fputs("</th>", tables->stream);
}

static void number_cell(FILE *stream, double value, int digits, bool best)
{
    fputs(best ? "<td class=\"best\">" : "<td>", stream);
    html_number(stream, value, digits);
    fputs("</td>", stream);
}

/* The median, and the 10 % and 90 % quantiles below it if there are several runs. */
static void band_cell(FILE *stream, const BenchBand *band, int runs, bool best)
{
    fputs(best ? "<td class=\"best\">" : "<td>", stream);
    html_number(stream, band->median, 3);
    if (runs > 1) {
        fputs("<small>", stream);
        html_number(stream, band->low, 3);
        fputs(" \u2026 ", stream);
        html_number(stream, band->high, 3);
        fputs("</small>", stream);
    }
    fputs("</td>", stream);
}

/* ---- error ------------------------------------------------------------------------------------------------------ */

/* Columns in which the best value is marked: offset in BenchGroup, and whether larger is better. */
typedef struct Column {
    size_t offset;
    bool more;
} Column;

static const Column COLUMNS[] = {{offsetof(BenchGroup, rel_mse), false},
                                 {offsetof(BenchGroup, rel_mse_trimmed), false},
                                 {offsetof(BenchGroup, mape), false},
                                 {offsetof(BenchGroup, flip), false},
                                 {offsetof(BenchGroup, ssim), true}};

static const BenchBand *group_band(const BenchGroup *group, size_t offset)
{
    return (const BenchBand *)(const void *)((const char *)group + offset);
}

static bool is_best(const Tables *tables, const Column *column, int series)
{
    double own = group_band(&tables->scene->series[series].groups[tables->time], column->offset)->median;
    bool best = isfinite(own) && tables->scene->series_count > 1;
    for (int s = 0; s < tables->scene->series_count; ++s) {
        double other = group_band(&tables->scene->series[s].groups[tables->time], column->offset)->median;
        best = best && !(column->more ? other > own : other < own);
    }
    return best;
}

void bench_factor_write(FILE *stream, double factor)
{
    html_number(stream, factor, 3);
    fputs(isfinite(factor) ? "\u00d7" : "", stream);
}

static void speedup_cells(FILE *stream, const BenchSeries *series, bool best)
{
    fputs("<td>", stream);
    html_number(stream, series->equal_seconds, 3);
    fprintf(stream, "%s</td><td%s>", series->extrapolated ? " *" : "", best ? " class=\"best\"" : "");
    bench_factor_write(stream, series->speedup);
    fputs("</td>", stream);
}

static bool is_fastest(const BenchScene *scene, int series)
{
    bool fastest = isfinite(scene->series[series].speedup) && scene->series_count > 1;
    for (int s = 0; s < scene->series_count; ++s)
        fastest = fastest && !(scene->series[s].speedup > scene->series[series].speedup);
    return fastest;
}

static void error_table(const Tables *tables)
{
    static const char *const HEAD[] = {"integrator",
                                       "relMSE",
                                       "without worst 0.1 %",
                                       "MAPE",
                                       "FLIP",
                                       "SSIM",
                                       "seconds to the first integrator\u2019s relMSE",
                                       "speed-up",
                                       "slope against time",
                                       "slope against samples"};
    FILE *stream = tables->stream;
    head_write(stream, HEAD, sizeof HEAD / sizeof HEAD[0]);
    for (int s = 0; s < tables->scene->series_count; ++s) {
        const BenchSeries *series = &tables->scene->series[s];
        const BenchGroup *group = &series->groups[tables->time];
        row_begin(tables, s);
        for (size_t i = 0; i < sizeof COLUMNS / sizeof COLUMNS[0]; ++i)
            band_cell(stream, group_band(group, COLUMNS[i].offset), group->runs, is_best(tables, &COLUMNS[i], s));
        speedup_cells(stream, series, is_fastest(tables->scene, s));
        const SampleLine *lines[] = {&series->by_time, &series->by_samples};
        for (int i = 0; i < 2; ++i) {
            fputs("<td>", stream);
            html_number(stream, lines[i]->slope, 3);
            fputs("<small>\u00b1 ", stream);
            html_number(stream, lines[i]->slope_error, 1);
            fputs("</small></td>", stream);
        }
        fputs("</tr>\n", stream);
    }
    table_end(stream);
}

/* ---- variance --------------------------------------------------------------------------------------------------- */

static void variance_table(const Tables *tables)
{
    static const char *const HEAD[] = {"integrator",
                                       "runs",
                                       "relative variance",
                                       "efficiency 1 / (variance \u00d7 s)",
                                       "relative to the first",
                                       "relMSE of the mean, minus variance / runs",
                                       "mean / reference\u2019s mean"};
    FILE *stream = tables->stream;
    double first = tables->scene->series[0].groups[tables->time].efficiency;
    head_write(stream, HEAD, sizeof HEAD / sizeof HEAD[0]);
    for (int s = 0; s < tables->scene->series_count; ++s) {
        const BenchGroup *group = &tables->scene->series[s].groups[tables->time];
        row_begin(tables, s);
        fprintf(stream, "<td>%d</td>", group->runs);
        number_cell(stream, group->variance, 3, false);
        number_cell(stream, group->efficiency, 3, false);
        number_cell(stream, group->efficiency / first, 3, false);
        number_cell(stream, group->bias, 3, false);
        fputs("<td>", stream);
        html_number(stream, group->mean_ratio, 4);
        fputs("<small>\u00b1 ", stream);
        html_number(stream, group->mean_ratio_error, 2);
        fputs("</small></td></tr>\n", stream);
    }
    table_end(stream);
}

/* ---- work ------------------------------------------------------------------------------------------------------- */

/* Means over the runs with one time, in seconds. */
typedef struct Work {
    int runs;
    double load, build, seconds, write, rays, pool, chains, direct;
} Work;

static Work work_mean(const Tables *tables, int series)
{
    Work work = {0};
    const BenchScene *scene = tables->scene;
    for (const BenchRun *run = scene->runs; run < scene->runs + scene->run_count; ++run) {
        const BenchRecord *record = &run->record;
        if (!run->finished || run->series != series || run->time != tables->time)
            continue;
        double n = ++work.runs, threads = (double)(record->threads > 0 ? record->threads : 1);
        const double values[] = {record->load,
                                 record->build,
                                 record->seconds,
                                 record->write,
                                 record->ray_seconds / threads,
                                 record->chains.pool_seconds,
                                 record->chains.chain_seconds,
                                 record->chains.direct_seconds + record->chains.bidirectional_seconds};
        double *const means[] = {&work.load, &work.build, &work.seconds, &work.write,
                                 &work.rays, &work.pool,  &work.chains,  &work.direct};
        for (int i = 0; i < 8; ++i)
            *means[i] += (values[i] - *means[i]) / n;
    }
    return work;
}

/* How rendering time divides into stages. */
static void stack_cell(FILE *stream, const Work *work)
{
    const double chain_parts[] = {work->pool, work->chains, work->direct};
    const char *const chain_names[] = {"pool", "chains", "path tracing"};
    double known = work->pool + work->chains + work->direct;
    fputs("<td class=\"text\"><span class=\"stack\">", stream);
    for (int i = 0; i < 3 && known > 0.0; ++i)
        fprintf(stream, "<span class=\"k%d\" style=\"width:%.2f%%\" title=\"%s %.3g s\"></span>", i,
                100.0 * chain_parts[i] / work->seconds, chain_names[i], chain_parts[i]);
    if (known == 0.0)
        fputs("<span class=\"k2\" style=\"width:100%\" title=\"path tracing\"></span>", stream);
    fputs("</span></td>", stream);
}

static void rate_cell(FILE *stream, double rate)
{
    char text[24];
    progress_rate(rate, text, sizeof text);
    fprintf(stream, "<td>%s</td>", text);
}

static void work_table(const Tables *tables)
{
    static const char *const HEAD[] = {"integrator",     "samples per pixel", "samples/s", "rays/s",
                                       "load, s",        "build, s",          "render, s", "write, s",
                                       "in ray queries", "render by stage"};
    FILE *stream = tables->stream;
    head_write(stream, HEAD, sizeof HEAD / sizeof HEAD[0]);
    for (int s = 0; s < tables->scene->series_count; ++s) {
        const BenchGroup *group = &tables->scene->series[s].groups[tables->time];
        const Work work = work_mean(tables, s);
        row_begin(tables, s);
        number_cell(stream, group->samples_per_pixel.median, 4, false);
        rate_cell(stream, group->samples_per_second);
        rate_cell(stream, group->rays_per_second);
        number_cell(stream, work.load, 2, false);
        number_cell(stream, work.build, 2, false);
        number_cell(stream, work.seconds, 3, false);
        number_cell(stream, work.write, 2, false);
        fprintf(stream, "<td class=\"share\" style=\"--v:%.1f\">%.0f %%</td>", 100.0 * work.rays / work.seconds,
                100.0 * work.rays / work.seconds);
        stack_cell(stream, &work);
        fputs("</tr>\n", stream);
    }
    table_end(stream);
    fputs("<p class=\"soft key\">Stages: <i class=\"k0\"></i>pools <i class=\"k1\"></i>chains <i class=\"k2\"></i>path "
          "tracing; grey is the rest. Scene and acceleration structure are loaded and built once for all "
          "renderings.</p>\n",
          stream);
}

/* ---- all times -------------------------------------------------------------------------------------------------- */

static void times_table(const Tables *tables)
{
    FILE *stream = tables->stream;
    fputs("<details><summary>Median relMSE after all times, with samples per pixel</summary>\n"
          "<div class=\"wide\"><table><thead><tr><th>integrator</th>",
          stream);
    for (int t = 0; t < tables->options->time_count; ++t) {
        fputs("<th>", stream);
        html_number(stream, tables->options->times[t], 3);
        fputs(" s</th>", stream);
    }
    fputs("</tr></thead>\n<tbody>\n", stream);
    for (int s = 0; s < tables->scene->series_count; ++s) {
        row_begin(tables, s);
        for (int t = 0; t < tables->options->time_count; ++t) {
            const BenchGroup *group = &tables->scene->series[s].groups[t];
            fputs("<td>", stream);
            html_number(stream, group->runs > 0 ? group->rel_mse.median : (double)NAN, 3);
            fputs("<small>", stream);
            html_number(stream, group->runs > 0 ? group->samples_per_pixel.median : (double)NAN, 3);
            fputs("</small></td>", stream);
        }
        fputs("</tr>\n", stream);
    }
    table_end(stream);
    fputs("</details>\n", stream);
}

void bench_figures_write(const Bench *bench, const BenchScene *scene, FILE *stream)
{
    const Tables tables = {&bench->options, scene, bench_common_time(&bench->options, scene), stream};
    if (tables.time >= 0) {
        double seconds = bench->options.times[tables.time];
        fprintf(stream, "<h3>Error after %g s</h3>\n", seconds);
        error_table(&tables);
        fprintf(stream, "<h3>Variance and bias after %g s</h3>\n", seconds);
        variance_table(&tables);
        fprintf(stream, "<h3>Work in %g s</h3>\n", seconds);
        work_table(&tables);
        bench_chains_write(scene, tables.time, stream);
    }
    times_table(&tables);
}
