#include "mmlt/bad_chains.h"

#include "chain/chain.h"

bool bad_chains_begin(BadChains *bad, const char *path, Error *error)
{
    if (!path)
        return true;
    if (!output_file_begin(&bad->file, path, error))
        return false;
    bad->stream = output_file_stream(&bad->file, error);
    return bad->stream != NULL;
}

bool bad_chains_end(BadChains *bad, Error *error)
{
    FILE *stream = bad->stream;
    bad->stream = NULL;
    return !stream || output_file_stream_commit(&bad->file, stream, error);
}

void bad_chains_cancel(BadChains *bad)
{
    if (!bad->stream)
        return;
    fclose(bad->stream);
    bad->stream = NULL;
    output_file_cancel(&bad->file);
}

/* Writes what is needed to reproduce a chain: it is a function of the seed, its starting state and its number
 * (chain/chain.h). It started either from a sample of the pool or, if carried over from the previous generation, from
 * the coordinates in "numbers". */
static void bad_chain_write(FILE *out, const BadChainsPass *pass, uint i, uint step)
{
    uint count = pass->count, key = pass->words[(size_t)CHAIN_PASS_KEY * count + i],
         item = pass->words[(size_t)CHAIN_PASS_ITEM * count + i];
    fprintf(out, "{\"seed\": %llu, \"generation\": %u, \"pool_sample\": %u, \"pool_pixel\": %u, ", pass->seed,
            pass->generation, pass->pool_sample, pass->pool_pixel);
    if (item != NONE) {
        fprintf(out, "\"pool_item\": %u, ", item);
    } else {
        for (uint field = CHAIN_PASS_NUMBERS; field < pass->fields; ++field)
            fprintf(out, "%s%u", field > CHAIN_PASS_NUMBERS ? ", " : "\"numbers\": [",
                    pass->begun[(size_t)field * count + i]);
        fprintf(out, "], ");
    }
    fprintf(out, "\"chain\": %u, \"step\": %u, \"depth\": %u, \"s\": %u}\n", i, step, chain_key_depth(key),
            chain_key_s(key));
}

void bad_chains_write(FILE *out, const BadChainsPass *pass)
{
    for (uint i = 0; i < pass->count; ++i) {
        uint step = pass->words[(size_t)CHAIN_PASS_BAD * pass->count + i];
        if (step != NONE)
            bad_chain_write(out, pass, i, step);
    }
}
