/* The results of `twinlight bench` for other programs; twinlight-bench(1) documents columns and keys. */
#ifndef TWINLIGHT_BENCH_TABLES_H
#define TWINLIGHT_BENCH_TABLES_H

#include "bench/bench.h"

/* Writes a header line and a line per finished run. */
void bench_tsv_write(const Bench *bench, FILE *stream);

/* Writes one object: the setting, and for each scene its reference, series, groups and runs. */
void bench_json_write(const Bench *bench, FILE *stream);

#endif
