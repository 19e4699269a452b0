/* The report of `twinlight bench` as a page that needs no other file. */
#ifndef TWINLIGHT_BENCH_REPORT_H
#define TWINLIGHT_BENCH_REPORT_H

#include "bench/bench.h"

/* The style sheet: light and dark, screen and paper. */
extern const char BENCH_STYLE[];

/* The page; scenes from the first without runs on are left out. */
bool bench_html_write(const Bench *bench, FILE *stream, Error *error);

/* A scene's pictures, errors and patches. */
bool bench_pictures_write(const Bench *bench, int scene, FILE *stream, Error *error);

/* A scene's tables of figures, of work, of chains, and of all times. */
void bench_figures_write(const Bench *bench, const BenchScene *scene, FILE *stream);

/* Of every series that has chains: pools, shares, and acceptance by kind of mutation and depth, over all runs of a
 * time. */
void bench_chains_write(const BenchScene *scene, int time, FILE *stream);

/* "2.34x" with a true sign of multiplication; a dash when it is not known. */
void bench_factor_write(FILE *stream, double factor);

#endif
