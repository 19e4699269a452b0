/* --dump-bad: writes chains that met a non-finite contribution, one JSON object per line. */
#include "mmlt/mmlt.h"

#include "chain/chain.h"

/* Writes what is needed to reproduce a chain: it is a function of the seed, its starting state and its number
 * (chain/chain.h). It started either from a sample of the pool or, if carried over from the previous generation, from
 * the coordinates in "numbers". */
static void bad_chain_write(const Mmlt *mmlt, FILE *out, uint count, uint i, uint step)
{
    const uint *words = mmlt->chains.pass_words;
    uint key = words[(size_t)CHAIN_PASS_KEY * count + i], item = words[(size_t)CHAIN_PASS_ITEM * count + i];
    fprintf(out, "{\"seed\": %llu, \"generation\": %u, \"pool_sample\": %u, \"pool_pixel\": %u, ",
            (unsigned long long)mmlt->run->options->seed, mmlt->generation, mmlt->pool_sample, mmlt->pool_pixel);
    if (item != NONE) {
        fprintf(out, "\"pool_item\": %u, ", item);
    } else {
        for (uint field = CHAIN_PASS_NUMBERS; field < mmlt->chains.pass_fields; ++field)
            fprintf(out, "%s%u", field > CHAIN_PASS_NUMBERS ? ", " : "\"numbers\": [",
                    mmlt->begun[(size_t)field * count + i]);
        fprintf(out, "], ");
    }
    fprintf(out, "\"chain\": %u, \"step\": %u, \"depth\": %u, \"s\": %u}\n", i, step, chain_key_depth(key),
            chain_key_s(key));
}

void mmlt_bad_chains_write(const Mmlt *mmlt, uint count)
{
    for (uint i = 0; mmlt->run->options->bad_chains && i < count; ++i) {
        uint step = mmlt->chains.pass_words[(size_t)CHAIN_PASS_BAD * count + i];
        if (step != NONE)
            bad_chain_write(mmlt, mmlt->run->options->bad_chains, count, i, step);
    }
}
