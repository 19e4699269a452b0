#include "mmlt/scheme.h"

#include "mmlt/chain_groups.h"
#include "mmlt/tuning.h"

static const MmltScheme GENERATIONS = {.replicas = REPLICAS,
                                       .renews = true,
                                       .grows = true,
                                       .combines = true,
                                       .chains = CHAINS_DEFAULT,
                                       .shifts = SHIFTS,
                                       .groups = 1};

static const MmltScheme PUBLISHED = {.replicas = 1,
                                     .chains = PAPER_CHAINS_DEFAULT,
                                     .pool_per_chain = PAPER_POOL_PER_CHAIN,
                                     .large_step = LARGE_STEP_DEFAULT,
                                     .groups = CHAIN_GROUPS};

const MmltScheme *mmlt_scheme(bool published)
{
    return published ? &PUBLISHED : &GENERATIONS;
}
