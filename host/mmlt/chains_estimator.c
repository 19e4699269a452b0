#include "mmlt/chains_estimator.h"

#include "backend/step_recorder.h"
#include "chain/chain.h"
#include "mmlt/bad_chains.h"
#include "mmlt/chain_list.h"

#include <stdlib.h>
#include <string.h>

void chains_estimator_init(ChainsEstimator *chains, Film *film)
{
    *chains = (ChainsEstimator){.own = {.film = film}};
}

void chains_estimator_destroy(ChainsEstimator *chains)
{
    step_list_destroy(&chains->own.list);
    for (int replica = 0; replica < REPLICAS; ++replica)
        chain_population_destroy(&chains->populations[replica]);
    free(chains->begun);
}

bool chains_estimator_list(ChainsEstimator *chains, const RenderRun *run, uint steps, const Guide *guide, uint groups,
                           Error *error)
{
    if (!chain_list(&run->frame, steps, &chains->own.list, error))
        return false;
    chains->steps = steps;
    chains->depth_most = run->frame.path.max_depth;
    chains->groups_each = groups;
    chains->own.list.guide = guide;
    chains->own.list.photons = &run->photons;
    for (int replica = 0; replica < REPLICAS; ++replica)
        chain_population_init(&chains->populations[replica], chains->own.list.pass_fields);
    return true;
}

void chains_estimator_archive(Archive *archive, ChainsEstimator *chains, uint most)
{
    const PopulationLimits limits = {.chains = most, .depth = chains->depth_most};
    for (int replica = 0; replica < REPLICAS; ++replica)
        chain_population_archive(archive, &chains->populations[replica], limits);
    ARCHIVE_FIELD(archive, chains->groups);
}

void chains_estimator_clear(ChainsEstimator *chains)
{
    for (int replica = 0; replica < REPLICAS; ++replica) {
        uint fields = chains->populations[replica].fields;
        chain_population_destroy(&chains->populations[replica]);
        chain_population_init(&chains->populations[replica], fields);
    }
    memset(&chains->groups, 0, sizeof chains->groups);
}

void chains_estimator_continue(ChainsEstimator *chains, const Generation *generation)
{
    const ChainPopulation *population = &chains->populations[generation->replica];
    chains->own.list.pass_words = population->words;
    chains->own.list.pass_stride = population->count;
}

bool chains_estimator_alive(const ChainsEstimator *chains, const Generation *generation)
{
    return chains->populations[generation->replica].brightness > 0.0;
}

bool chains_estimator_start(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool,
                            const float *change, ChainOrder order, uint count, Error *error)
{
    ChainPopulation *population = &chains->populations[generation->replica];
    ChainStarts starts;
    /* A pool sample of this contribution weight starts one chain on average. */
    double threshold = pool_estimator_brightness(pool, generation) * pool->count / count;
    const PoolSamples samples = {.words = pool->words, .count = pool->count};
    const SystematicResampling resampling = {
        .count = count,
        .offset = generation_random(generation->run, generation->index, GENERATION_RESAMPLING),
        .order = order};
    if (!chain_population_renew(population, &samples, change, threshold, &resampling, &starts, error))
        return false;
    chains_estimator_continue(chains, generation);
    chain_statistics_starts(&generation->run->chains, &starts);
    return true;
}

/* ---- a pass ------------------------------------------------------------------------------------------------------ */

FrameParams chains_estimator_frame(const ChainsEstimator *chains, const Generation *generation,
                                   const PoolEstimator *pool)
{
    FrameParams frame = generation->run->frame;
    pool_estimator_share(pool, generation, &frame);
    frame.chains.brightness = (float)chains->populations[generation->replica].brightness;
    frame.path.roulette_depth = NONE;
    estimator_film_params(&chains->own, &frame.film);
    return frame;
}

/* Keeps the chains' words for --dump-bad, before the pass overwrites them with their final states. */
static bool begun_keep(ChainsEstimator *chains, uint count, Error *error)
{
    size_t bytes = (size_t)count * chains->own.list.pass_fields * sizeof *chains->begun;
    free(chains->begun);
    chains->begun = malloc(bytes);
    if (!chains->begun)
        return error_memory(error, bytes, "where chains began");
    memcpy(chains->begun, chains->own.list.pass_words, bytes);
    return true;
}

bool chains_estimator_run(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool, uint count,
                          bool continues, bool *whole, Error *error)
{
    RenderRun *run = generation->run;
    uint64_t delivered;
    if (!chains_estimator_alive(chains, generation))
        return true;
    FrameParams frame = chains_estimator_frame(chains, generation, pool);
    frame.pass.item_count = count;
    if (run->options->bad_chains && !begun_keep(chains, count, error))
        return false;
    bool done = estimator_pass(&chains->own, run, &frame, false, &delivered, error);
    *whole = delivered == count;
    for (uint i = 0; continues && i < count; ++i) /* from their coordinates */
        chains->own.list.pass_words[(size_t)CHAIN_PASS_ITEM * count + i] = NONE;
    return done;
}

/* ---- what is counted --------------------------------------------------------------------------------------------- */

void chains_estimator_count(ChainsEstimator *chains, const Generation *generation, const PoolEstimator *pool,
                            uint count)
{
    const uint *words = chains->own.list.pass_words;
    chain_statistics_pass(&generation->run->chains, words, count, chains->steps);
    chain_groups_add(&chains->groups, words, count, (uint)generation->replica, chains->groups_each);
    const BadChainsPass pass = {.words = words,
                                .begun = chains->begun,
                                .count = count,
                                .fields = chains->own.list.pass_fields,
                                .seed = generation->run->options->seed,
                                .generation = generation->index,
                                .pool_sample = pool->sample,
                                .pool_pixel = pool->pixel};
    if (generation->run->options->bad_chains)
        bad_chains_write(generation->run->options->bad_chains, &pass);
}
