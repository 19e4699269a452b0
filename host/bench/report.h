/* The report of `twinlight bench`: a self-contained page. */
#ifndef TWINLIGHT_BENCH_REPORT_H
#define TWINLIGHT_BENCH_REPORT_H

#include "bench/bench.h"

/* The style sheet, for light and dark screens and for paper. */
extern const char BENCH_STYLE[];

/* Writes the page; scenes without runs are left out. */
bool bench_html_write(const Bench *bench, FILE *stream, Error *error);

/* Writes a scene's pictures, error maps and patches. */
bool bench_pictures_write(const Bench *bench, int scene, FILE *stream, Error *error);

/* Writes a scene's tables: figures, work, chains, and all times. */
void bench_figures_write(const Bench *bench, const BenchScene *scene, FILE *stream);

/* Writes for every series with chains: pools, weights, acceptance by kind of mutation and depth, and mixing, over all
 * runs with one time. */
void bench_chains_write(const BenchScene *scene, int time, FILE *stream);

/* Writes "2.34x" with a true multiplication sign; a dash if unknown. */
void bench_factor_write(FILE *stream, double factor);

#endif
