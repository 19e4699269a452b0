#include "mmlt/chain_population.h"

#include "chain/chain.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Resampling candidates: first the population's `chains` paths, then the pool's; `all` together. */
typedef struct Candidates {
    const float *change; /* ratio of target importances, new over old, per cell; NULL: unchanged */
    double *weights;
    uint *keys;
    uint chains, all;
} Candidates;

void chain_population_init(ChainPopulation *population, uint fields)
{
    *population = (ChainPopulation){.fields = fields};
}

void chain_population_destroy(ChainPopulation *population)
{
    free(population->words);
    *population = (ChainPopulation){0};
}

/* Makes room for the words of `count` chains that are restored. */
static bool words_reserve(Archive *archive, ChainPopulation *population)
{
    size_t bytes = (size_t)population->count * population->fields * sizeof *population->words;
    free(population->words);
    population->words = bytes > 0 ? malloc(bytes) : NULL;
    if (population->words || bytes == 0)
        return true;
    population->count = 0;
    archive_fail(archive, "out of memory: %zu bytes for chains", bytes);
    return false;
}

static uint word_of(const ChainPopulation *population, uint field, uint i)
{
    return population->words[(size_t)field * population->count + i];
}

/* Why chain i cannot go on; NULL if it can. */
static const char *chain_fault(const ChainPopulation *population, uint i, uint depth_most)
{
    uint key = word_of(population, CHAIN_PASS_KEY, i), depth = chain_key_depth(key);
    float luminance = bits_float(word_of(population, CHAIN_PASS_LUMINANCE, i));
    if (depth < CHAIN_DEPTH_MIN || depth > depth_most)
        return "its path is too short or too long";
    if (chain_key_s(key) > depth)
        return "its path has more vertices from the light than it has segments";
    if (!(luminance >= 0.0f && luminance <= FLT_MAX))
        return "the luminance of its path is negative or not finite";
    return word_of(population, CHAIN_PASS_CELL, i) < IMPORTANCE_CELLS ? NULL : "its place on the film does not exist";
}

void chain_population_archive(Archive *archive, ChainPopulation *population, PopulationLimits limits)
{
    archive_same(archive, population->fields, "the words of a chain");
    archive_count(archive, &population->count, 0, population->fields > 0 ? limits.chains : 0, "chains");
    archive_doubles(archive, &population->samples, 1, (NumberRange){0.0, DBL_MAX}, "the samples behind chains");
    archive_doubles(archive, &population->brightness, 1, RANGE_FLOATS_POSITIVE, "the brightness of chains");
    if (archive->failed || (!archive->saves && !words_reserve(archive, population)))
        return;
    archive_bytes(archive, population->words, (size_t)population->count * population->fields * sizeof(uint));
    /* Without brightness there are no chains, and nothing reads the words. */
    if (archive->saves || archive->failed || !population->words || !(population->brightness > 0.0))
        return;
    for (uint i = 0; i < population->count; ++i) {
        const char *fault = chain_fault(population, i, limits.depth);
        if (fault)
            archive_fail(archive, "chain %lu of %lu: %s", (unsigned long)i + 1, (unsigned long)population->count,
                         fault);
    }
}

/* The chains' part of a path's contribution (partition of unity; see the header). most: n / (n + m). */
static double part_of_chains(double luminance, double most, double threshold)
{
    return luminance > 0.0 ? most * luminance / (luminance + threshold) : 0.0;
}

/* Sets weights in units of brightness: they add up to that of the next population. */
static void candidates_weigh(const Candidates *candidates, const ChainPopulation *population, const PoolSamples *pool,
                             double threshold)
{
    uint chains = candidates->chains, samples = pool->count;
    double most = population->samples / (population->samples + samples);
    for (uint i = 0; i < chains; ++i) {
        double change = candidates->change ? (double)candidates->change[word_of(population, CHAIN_PASS_CELL, i)] : 1.0;
        double luminance = change * (double)bits_float(word_of(population, CHAIN_PASS_LUMINANCE, i));
        double part = part_of_chains(luminance, most, threshold);
        candidates->weights[i] = change * population->brightness / chains * part;
        candidates->keys[i] = part > 0.0 ? word_of(population, CHAIN_PASS_KEY, i) : 0;
    }
    /* Subtract the chains' part even if there are no chains because all earlier pools were black: otherwise the mean
     * over generations would be biased high. */
    for (uint i = 0; i < samples; ++i) {
        double luminance = (double)bits_float(pool->words[(size_t)POOL_LUMINANCE * samples + i]);
        double weight = (double)bits_float(pool->words[(size_t)POOL_WEIGHT * samples + i]) / samples;
        double part = part_of_chains(luminance, most, threshold);
        candidates->weights[chains + i] = weight * (1.0 - part);
        candidates->keys[chains + i] = pool->words[(size_t)POOL_KEY * samples + i];
    }
}

/* Gathers the chosen chains' words: coordinates for one that continues, the number of the pool sample for a new one. */
static void words_gather(const ChainPopulation *population, const Candidates *candidates, const uint *seeds, uint count,
                         uint *words)
{
    for (uint i = 0; i < count; ++i) {
        bool old = seeds[i] < candidates->chains;
        words[(size_t)CHAIN_PASS_KEY * count + i] = candidates->keys[seeds[i]];
        words[(size_t)CHAIN_PASS_ITEM * count + i] = old ? NONE : seeds[i] - candidates->chains;
        if (old) {
            if (!candidates->change) /* otherwise changed; the pass recomputes it */
                words[(size_t)CHAIN_PASS_LUMINANCE * count + i] = word_of(population, CHAIN_PASS_LUMINANCE, seeds[i]);
            words[(size_t)CHAIN_PASS_RUN * count + i] = word_of(population, CHAIN_PASS_RUN, seeds[i]);
        }
    }
    for (uint field = CHAIN_PASS_NUMBERS; candidates->chains > 0 && field < population->fields; ++field)
        for (uint i = 0; i < count; ++i)
            if (seeds[i] < candidates->chains)
                words[(size_t)field * count + i] = word_of(population, field, seeds[i]);
}

/* Duplicates of a candidate are adjacent in `seeds`. */
static void starts_count(const Candidates *candidates, const uint *seeds, uint count, ChainStarts *starts)
{
    for (uint i = 0; i < count; ++i) {
        uint depth = chain_key_depth(candidates->keys[seeds[i]]) % CHAIN_DEPTHS;
        ++starts->chains[depth];
        starts->distinct[depth] += i == 0 || seeds[i] != seeds[i - 1];
        starts->kept += seeds[i] < candidates->chains;
    }
}

static bool population_choose(ChainPopulation *population, const Candidates *candidates, const PoolSamples *pool,
                              double threshold, const SystematicResampling *resampling, ChainStarts *starts,
                              Error *error)
{
    const uint count = resampling->count;
    uint *words = calloc((size_t)count * population->fields, sizeof *words), *seeds = malloc(count * sizeof *seeds);
    double brightness = 0.0;
    bool done = words && seeds;
    if (done) {
        candidates_weigh(candidates, population, pool, threshold);
        const SeedCandidates all = {.weights = candidates->weights, .keys = candidates->keys, .count = candidates->all};
        done = chain_seeds_choose(&all, resampling, seeds, &brightness, error);
    } else {
        error_memory(error, (size_t)count * population->fields * sizeof *words, "chains");
    }
    if (done && brightness > 0.0) {
        words_gather(population, candidates, seeds, count, words);
        if (starts)
            starts_count(candidates, seeds, count, starts);
    }
    free(seeds);
    if (!done) {
        free(words);
        return false;
    }
    free(population->words);
    population->words = words;
    population->count = count;
    population->brightness = brightness;
    population->samples += candidates->all - candidates->chains;
    return true;
}

bool chain_population_renew(ChainPopulation *population, const PoolSamples *pool, const float *change, double threshold,
                            const SystematicResampling *resampling, ChainStarts *starts, Error *error)
{
    Candidates candidates = {.change = change, .chains = population->brightness > 0.0 ? population->count : 0};
    candidates.all = candidates.chains + pool->count;
    candidates.weights = malloc(candidates.all * sizeof *candidates.weights);
    candidates.keys = malloc(candidates.all * sizeof *candidates.keys);
    bool done = candidates.weights && candidates.keys;
    if (!done)
        error_memory(error, candidates.all * (sizeof *candidates.weights + sizeof *candidates.keys), "a pool's paths");
    if (starts)
        *starts = (ChainStarts){0};
    done = done && population_choose(population, &candidates, pool, threshold, resampling, starts, error);
    free(candidates.weights);
    free(candidates.keys);
    return done;
}
