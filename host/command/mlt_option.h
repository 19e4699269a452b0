/* The switches of MMLT: `--mlt=KEY=VALUE,...`, and the options of earlier versions that each set one of them. */
#ifndef TWINLIGHT_COMMAND_MLT_OPTION_H
#define TWINLIGHT_COMMAND_MLT_OPTION_H

#include "base/error.h"
#include "render/job.h"

/* X(NAME, name, values, help). Values separated by | exclude each other; where they set a flag of ChainOptions, the
 * second sets it. Values of SORT are in the order of ChainOrder, those of MUTATIONS in that of MUTATION_*. */
#define MLT_KEY_LIST(X)                                                                                                \
    X(SCHEME, "scheme", "generations|paper", "new pools (default), or one pool and large steps, as published")         \
    X(CHAINS, "chains", "N", "largest number of Markov chains at a time (default: 524288)")                            \
    X(STEPS, "steps", "N", "steps of a chain between two pools (default: 64)")                                         \
    X(POOL, "pool", "N", "bootstrap samples of a pool (default: at least one for every 12 chain steps)")               \
    X(LARGE_STEP, "large-step", "P", "with scheme=paper: probability of a large step (default: 0.3)")                  \
    X(MUTATIONS, "mutations", "all+light+camera", "small steps to make, one or more (default: all three)")             \
    X(SORT, "sort", "strategy|depth|none", "order of chains: by depth and strategy (default), by depth, as drawn")     \
    X(GROUP, "group", "on|off", "all chains make the same kind of mutation in a step (default: on)")                   \
    X(SHIFT, "shift", "on|off", "steps across the film that reconnect to the rest of the path (default: on)")          \
    X(GUIDE, "guide", "on|off", "light guides, which keep directions near those to lights (default: on)")              \
    X(COMBINE, "combine", "on|off", "pools and path tracing show long paths, too, not chains alone (default: on)")

/* For --help: a line per key. */
#define MLT_HELP_OF(NAME, name, values, help) "  " name "=" values ": " help "\n"
#define MLT_HELP MLT_KEY_LIST(MLT_HELP_OF)

/* Sets what `text`, the value of --mlt, names, and leaves the rest of `chains` as it is. Fails on unknown keys and on
 * values that the key does not have. */
bool mlt_option_set(ChainOptions *chains, const char *text, Error *error);

/* Sets what the deprecated option --name=value stands for, after a warning that gives the new spelling. name: one of
 * those that mlt_option.c lists; value: NULL if it takes none. */
bool mlt_option_set_old(ChainOptions *chains, const char *name, const char *value, Error *error);

#endif
