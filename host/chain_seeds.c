#include "chain_seeds.h"

#include "pool.h"

#include <stdlib.h>

/* Depths and numbers of vertices are below 64 (bd_state.h). */
#define KEY_SIDE 64u
#define KEY_COUNT (KEY_SIDE * KEY_SIDE)

static uint key_rank(uint key)
{
    return (chain_key_depth(key) % KEY_SIDE) * KEY_SIDE + chain_key_s(key) % KEY_SIDE;
}

/* order[0 ... returned - 1]: paths there are, by key (a counting sort, so that those of a key keep their order). */
static uint candidates_order(const uint *keys, uint candidates, bool sorted, uint *order)
{
    uint starts[KEY_COUNT + 1] = {0}, found = 0;
    for (uint i = 0; i < candidates; ++i)
        if (keys[i] != 0)
            ++starts[(sorted ? key_rank(keys[i]) : 0) + 1];
    for (uint k = 0; k < KEY_COUNT; ++k)
        starts[k + 1] += starts[k];
    for (uint i = 0; i < candidates; ++i)
        if (keys[i] != 0) {
            order[starts[sorted ? key_rank(keys[i]) : 0]++] = i;
            ++found;
        }
    return found;
}

bool chain_seeds_choose(const double *weights, const uint *keys, uint candidates, bool sorted, double offset,
                        uint count, uint *seeds, double *sum, Error *error)
{
    uint *order = malloc(candidates * sizeof *order);
    if (!order)
        return error_memory(error, candidates * sizeof *order, "the order of seeds");
    uint found = candidates_order(keys, candidates, sorted, order), chosen = 0;
    double before = 0.0;
    *sum = 0.0;
    for (uint i = 0; i < found; ++i)
        *sum += weights[order[i]];
    for (uint i = 0; i < found && chosen<count && * sum> 0.0; ++i) {
        before += weights[order[i]];
        while (chosen < count && (((double)chosen + offset) * *sum < before * count || i + 1 == found))
            seeds[chosen++] = order[i];
    }
    free(order);
    return true;
}
