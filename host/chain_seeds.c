#include "chain_seeds.h"

#include "pool.h"

#include <stdlib.h>
#include <string.h>

/* Depths and numbers of vertices are below 64 (bd_state.h). */
#define KEY_SIDE 64u
#define KEY_COUNT (KEY_SIDE * KEY_SIDE)

static uint key_rank(uint key)
{
    return (chain_key_depth(key) % KEY_SIDE) * KEY_SIDE + chain_key_s(key) % KEY_SIDE;
}

static float weight_of(const uint *pool, uint pool_count, uint i)
{
    return bits_float(pool[(size_t)POOL_WEIGHT * pool_count + i]);
}

/* order[0 ... returned - 1]: samples of weight, by key (a counting sort, so that those of a key keep their order). */
static uint samples_order(const uint *pool, uint pool_count, bool sorted, uint *order)
{
    const uint *keys = pool + (size_t)POOL_KEY * pool_count;
    uint starts[KEY_COUNT + 1] = {0}, found = 0;
    for (uint i = 0; i < pool_count; ++i)
        if (keys[i] != 0)
            ++starts[(sorted ? key_rank(keys[i]) : 0) + 1];
    for (uint k = 0; k < KEY_COUNT; ++k)
        starts[k + 1] += starts[k];
    for (uint i = 0; i < pool_count; ++i)
        if (keys[i] != 0) {
            order[starts[sorted ? key_rank(keys[i]) : 0]++] = i;
            ++found;
        }
    return found;
}

bool chain_seeds_choose(const uint *pool, uint pool_count, bool sorted, double offset, uint count, uint *seeds,
                        uint *keys, double *brightness, Error *error)
{
    uint *order = malloc(pool_count * sizeof *order);
    if (!order)
        return error_memory(error, pool_count * sizeof *order, "the order of seeds");
    uint found = samples_order(pool, pool_count, sorted, order), chosen = 0;
    double sum = 0.0, before = 0.0;
    for (uint i = 0; i < found; ++i)
        sum += (double)weight_of(pool, pool_count, order[i]);
    *brightness = sum / pool_count;
    for (uint i = 0; i < found && chosen < count; ++i) {
        before += (double)weight_of(pool, pool_count, order[i]);
        while (chosen < count && (((double)chosen + offset) * sum < before * count || i + 1 == found)) {
            seeds[chosen] = order[i];
            keys[chosen++] = pool[(size_t)POOL_KEY * pool_count + order[i]];
        }
    }
    free(order);
    return true;
}
