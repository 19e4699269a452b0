#include "mmlt/chain_groups.h"

#include "chain/chain_numbers.h"

#include <math.h>

static uint depth_of(const uint *words, uint count, uint i)
{
    return chain_key_depth(words[(size_t)CHAIN_PASS_KEY * count + i]) % CHAIN_DEPTHS;
}

static void chain_add(SampleMoments moments[CHAIN_QUANTITIES][CHAIN_GROUPS], const uint *words, uint count, uint i,
                      uint group)
{
    uint key = words[(size_t)CHAIN_PASS_KEY * count + i];
    double luminance = (double)bits_float(words[(size_t)CHAIN_PASS_LUMINANCE * count + i]);
    if (!(luminance > 0.0))
        return; /* the chain never started */
    sample_moments_add(&moments[0][group], log(luminance));
    for (uint k = 0; k < 2 && chain_key_s(key) < chain_key_depth(key); ++k)
        sample_moments_add(&moments[1 + k][group],
                           words[(size_t)(CHAIN_PASS_NUMBERS + NUMBER_CAMERA + k) * count + i] / 4294967296.0);
}

void chain_groups_add(ChainGroups *groups, const uint *words, uint count, uint first, uint parts)
{
    uint chains[CHAIN_DEPTHS] = {0}, before[CHAIN_DEPTHS] = {0};
    for (uint i = 0; i < count; ++i)
        ++chains[depth_of(words, count, i)];
    for (uint i = 0; i < count; ++i) {
        uint depth = depth_of(words, count, i), part = (uint)((uint64_t)before[depth]++ * parts / chains[depth]);
        chain_add(groups->moments[depth], words, count, i, first + part);
    }
}

double chain_groups_r_hat(const ChainGroups *groups, int depth)
{
    double worst = 0.0;
    for (int k = 0; k < CHAIN_QUANTITIES; ++k)
        worst = fmax(worst, sample_r_hat(groups->moments[depth][k], CHAIN_GROUPS)); /* fmax leaves NaN out */
    return worst;
}
