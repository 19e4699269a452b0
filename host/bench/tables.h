/* The figures of `twinlight bench` for other programs; twinlight-bench(1) documents columns and keys. */
#ifndef TWINLIGHT_BENCH_TABLES_H
#define TWINLIGHT_BENCH_TABLES_H

#include "bench/bench.h"

/* A line for every finished run, under a line of names. */
void bench_tsv_write(const Bench *bench, FILE *stream);

/* One object: the setting, and for each scene its reference, series, groups and runs. */
void bench_json_write(const Bench *bench, FILE *stream);

#endif
