#include "mmlt/chain_seeds.h"

#include "chain/pool.h"

#include <stdlib.h>

/* Depths and numbers of vertices are below 64 (path/bd_state.h). */
#define KEY_SIDE 64u
#define KEY_COUNT (KEY_SIDE * KEY_SIDE)

static uint key_rank(uint key, ChainOrder order)
{
    uint depth = order == CHAIN_ORDER_NONE ? 0 : chain_key_depth(key) % KEY_SIDE;
    return depth * KEY_SIDE + (order == CHAIN_ORDER_STRATEGY ? chain_key_s(key) % KEY_SIDE : 0);
}

/* Lists the candidates that have a path, sorted by key, in numbers[]; returns their number. A counting sort: stable. */
static uint candidates_order(const SeedCandidates *candidates, ChainOrder order, uint *numbers)
{
    const uint *keys = candidates->keys;
    uint starts[KEY_COUNT + 1] = {0}, found = 0;
    for (uint i = 0; i < candidates->count; ++i)
        if (keys[i] != 0)
            ++starts[key_rank(keys[i], order) + 1];
    for (uint k = 0; k < KEY_COUNT; ++k)
        starts[k + 1] += starts[k];
    for (uint i = 0; i < candidates->count; ++i)
        if (keys[i] != 0) {
            numbers[starts[key_rank(keys[i], order)]++] = i;
            ++found;
        }
    return found;
}

bool chain_seeds_choose(const SeedCandidates *candidates, const SystematicResampling *resampling, uint *seeds,
                        double *sum, Error *error)
{
    const double *weights = candidates->weights, offset = resampling->offset;
    uint *numbers = malloc(candidates->count * sizeof *numbers), count = resampling->count;
    if (!numbers)
        return error_memory(error, candidates->count * sizeof *numbers, "the order of seeds");
    uint found = candidates_order(candidates, resampling->order, numbers), chosen = 0;
    double before = 0.0;
    *sum = 0.0;
    for (uint i = 0; i < found; ++i)
        *sum += weights[numbers[i]];
    for (uint i = 0; i < found && chosen<count && * sum> 0.0; ++i) {
        before += weights[numbers[i]];
        while (chosen < count && (((double)chosen + offset) * *sum < before * count || i + 1 == found))
            seeds[chosen++] = numbers[i];
    }
    free(numbers);
    return true;
}
