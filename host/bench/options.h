/* The command line of `twinlight bench`. */
#ifndef TWINLIGHT_BENCH_OPTIONS_H
#define TWINLIGHT_BENCH_OPTIONS_H

#include "backend/table.h"
#include "base/options.h"
#include "bench/bench.h"

/* Parses the command line, with defaults filled in. Strings point into argv. */
OptionsEnd bench_options_parse(BenchOptions *options, const BackendTable *backends, int argc, char **argv,
                               Error *error);

/* Whether the integrator is one of --integrators. */
bool bench_is_compared(const BenchOptions *options, const Integrator *integrator);

#endif
