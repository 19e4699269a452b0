/* Statistics of Markov chains in the report. */
#include "bench/html.h"
#include "bench/report.h"
#include "render/stats.h"

#include <math.h>

/* Adds up the statistics of the chains of all runs with one time; returns the number of runs with chains. */
static int chains_sum(const BenchScene *scene, int series, int time, ChainStatistics *sum)
{
    int runs = 0;
    *sum = (ChainStatistics){0};
    for (const BenchRun *run = scene->runs; run < scene->runs + scene->run_count; ++run) {
        const ChainStatistics *chains = &run->record.chains;
        if (!run->finished || run->series != series || run->time != time || chains->steps == 0)
            continue;
        ++runs;
        chain_statistics_add(sum, chains);
    }
    return runs;
}

static uint64_t depths_total(const uint64_t counts[CHAIN_DEPTHS])
{
    uint64_t total = 0;
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
        total += counts[depth];
    return total;
}

static void share_cell(FILE *stream, uint64_t part, uint64_t whole)
{
    double share = whole > 0 ? 100.0 * (double)part / (double)whole : (double)NAN;
    if (whole == 0)
        fputs("<td>\u2013</td>", stream);
    else
        fprintf(stream, "<td class=\"share\" style=\"--v:%.1f\" title=\"%llu of %llu\">%.1f</td>", share,
                (unsigned long long)part, (unsigned long long)whole, share);
}

/* The range of depths that have chains: [*first, *last]. */
static void depths_find(const ChainStatistics *chains, int *first, int *last)
{
    *first = CHAIN_DEPTHS;
    *last = -1;
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
        if (chain_statistics_proposals(chains, depth) > 0) {
            *first = depth < *first ? depth : *first;
            *last = depth;
        }
}

static void table_begin(FILE *stream, const char *columns, int first, int last)
{
    fprintf(stream, "<div class=\"wide\"><table>\n<thead><tr>%s", columns);
    for (int depth = first; depth <= last; ++depth)
        fprintf(stream, "<th>%d</th>", depth);
    fputs("</tr></thead>\n<tbody>\n", stream);
}

static void table_end(FILE *stream)
{
    fputs("</tbody></table></div>\n", stream);
}

static void acceptance_table(FILE *stream, const ChainStatistics *chains, int first, int last)
{
    table_begin(stream, "<th>mutation of</th><th>proposals</th><th>all depths</th>", first, last);
    for (int kind = 0; kind < CHAIN_KINDS; ++kind) {
        uint64_t proposals = depths_total(chains->proposals[kind]);
        if (proposals == 0)
            continue;
        fprintf(stream, "<tr><th>%s</th>", stats_chain_kind(kind));
        fputs("<td>", stream);
        html_number(stream, (double)proposals, 3);
        fputs("</td>", stream);
        share_cell(stream, depths_total(chains->accepted[kind]), proposals);
        for (int depth = first; depth <= last; ++depth)
            share_cell(stream, chains->accepted[kind][depth], chains->proposals[kind][depth]);
        fputs("</tr>\n", stream);
    }
    table_end(stream);
}

static void runs_row(FILE *stream, const ChainStatistics *chains, int first, int last)
{
    uint64_t longest = 0;
    for (int depth = first; depth <= last; ++depth)
        longest = chains->longest_run[depth] > longest ? chains->longest_run[depth] : longest;
    fprintf(stream, "<tr><th>longest run of rejections</th><td>%llu</td>", (unsigned long long)longest);
    for (int depth = first; depth <= last; ++depth)
        fprintf(stream, "<td>%llu</td>", (unsigned long long)chains->longest_run[depth]);
    fputs("</tr>\n", stream);
}

static void starts_row(FILE *stream, const ChainStatistics *chains, int first, int last)
{
    fputs("<tr><th>distinct starts, %</th>", stream);
    share_cell(stream, depths_total(chains->distinct_starts), depths_total(chains->starts));
    for (int depth = first; depth <= last; ++depth)
        share_cell(stream, chains->distinct_starts[depth], chains->starts[depth]);
    fputs("</tr>\n", stream);
}

/* Above this, groups of chains have not converged to the same light (Gelman and Rubin 1992). */
#define R_HAT_DOUBTFUL 1.1

/* r_hat as a cell; 0: unknown. */
static void r_hat_cell(FILE *stream, double r_hat)
{
    fputs(r_hat > R_HAT_DOUBTFUL ? "<td class=\"warn\">" : "<td>", stream);
    if (isinf(r_hat))
        fputs("∞", stream);
    else
        html_number(stream, r_hat > 0.0 ? r_hat : (double)NAN, 4);
    fputs("</td>", stream);
}

static void r_hat_row(FILE *stream, const ChainStatistics *chains, int first, int last)
{
    double largest = 0.0;
    for (int depth = first; depth <= last; ++depth)
        largest = fmax(largest, chains->r_hat[depth]);
    fputs("<tr><th>R̂ over groups of chains</th>", stream);
    r_hat_cell(stream, largest);
    for (int depth = first; depth <= last; ++depth)
        r_hat_cell(stream, chains->r_hat[depth]);
    fputs("</tr>\n", stream);
}

static void health_table(FILE *stream, const ChainStatistics *chains, int first, int last)
{
    fprintf(stream,
            "<p class=\"soft\">How well the chains mix, by depth in segments; runs and R\u0302 are the largest of all "
            "renderings. In the worst generation %.1f %% of the starts were distinct:</p>\n",
            100.0 * chains->least_distinct);
    table_begin(stream, "<th></th><th>all depths</th>", first, last);
    runs_row(stream, chains, first, last);
    starts_row(stream, chains, first, last);
    r_hat_row(stream, chains, first, last);
    table_end(stream);
}

void bench_chains_write(const BenchScene *scene, int time, FILE *stream)
{
    for (int s = 0; s < scene->series_count; ++s) {
        ChainStatistics chains;
        int first, last;
        int runs = chains_sum(scene, s, time, &chains);
        if (runs == 0)
            continue;
        fputs("<h3>Chains of ", stream);
        html_text(stream, scene->series[s].name);
        fputs("</h3>\n"
              "<p class=\"soft\">On average a run draws ",
              stream);
        html_number(stream, (double)chains.pool_samples / runs, 3);
        fputs(" pool samples, starts ", stream);
        html_number(stream, (double)chains.seeds / runs, 3);
        fputs(" chains and makes ", stream);
        html_number(stream, (double)chains.steps / runs, 3);
        fprintf(stream,
                " mutations. In the last generation\u2019s image the weight of chains is %.0f %%, of the pool %.0f %%, "
                "of path tracing %.0f %% and of bidirectional path tracing %.0f %%. Acceptance in per cent, by kind of "
                "mutation and depth in segments:</p>\n",
                100.0 * chains.weights[0] / runs, 100.0 * chains.weights[1] / runs, 100.0 * chains.weights[2] / runs,
                100.0 * chains.weights[3] / runs);
        depths_find(&chains, &first, &last);
        acceptance_table(stream, &chains, first, last);
        health_table(stream, &chains, first, last);
    }
}
