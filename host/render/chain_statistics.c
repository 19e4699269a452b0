#include "render/chain_statistics.h"

#include "chain/chain_numbers.h"

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* The smaller of two fractions; 0: unknown. */
static double smaller_known(double a, double b)
{
    return a > 0.0 && (a < b || !(b > 0.0)) ? a : b;
}

void chain_statistics_starts(ChainStatistics *statistics, const ChainStarts *starts)
{
    uint64_t chains = 0, distinct = 0;
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
        chains += starts->chains[depth];
        distinct += starts->distinct[depth];
        statistics->starts[depth] += starts->chains[depth];
        statistics->distinct_starts[depth] += starts->distinct[depth];
    }
    statistics->seeds += chains - starts->kept;
    if (chains > 0)
        statistics->least_distinct = smaller_known((double)distinct / (double)chains, statistics->least_distinct);
}

void chain_statistics_pass(ChainStatistics *statistics, const uint *words, uint count, uint steps)
{
    for (uint i = 0; i < count; ++i) {
        uint depth = chain_key_depth(words[(size_t)CHAIN_PASS_KEY * count + i]) % CHAIN_DEPTHS;
        uint longest = run_longest(words[(size_t)CHAIN_PASS_RUN * count + i]);
        statistics->longest_run[depth] = larger(statistics->longest_run[depth], longest);
        for (uint kind = 0; kind < MUTATION_COUNT; ++kind) {
            uint tally = words[(size_t)(CHAIN_PASS_TALLY + kind) * count + i];
            statistics->proposals[kind][depth] += tally & 0xffffu;
            statistics->accepted[kind][depth] += tally >> 16;
        }
    }
    statistics->steps += (uint64_t)count * steps;
}

uint64_t chain_statistics_proposals(const ChainStatistics *statistics, int depth)
{
    uint64_t sum = 0;
    for (int kind = 0; kind < CHAIN_KINDS; ++kind)
        sum += statistics->proposals[kind][depth];
    return sum;
}

void chain_statistics_add(ChainStatistics *sum, const ChainStatistics *other)
{
    sum->pool_samples += other->pool_samples;
    sum->seeds += other->seeds;
    sum->steps += other->steps;
    sum->pool_seconds += other->pool_seconds;
    sum->chain_seconds += other->chain_seconds;
    sum->direct_seconds += other->direct_seconds;
    sum->bidirectional_seconds += other->bidirectional_seconds;
    sum->least_distinct = smaller_known(sum->least_distinct, other->least_distinct);
    for (int i = 0; i < CHAIN_WEIGHTS; ++i)
        sum->weights[i] += other->weights[i];
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth) {
        sum->starts[depth] += other->starts[depth];
        sum->distinct_starts[depth] += other->distinct_starts[depth];
        sum->longest_run[depth] = larger(sum->longest_run[depth], other->longest_run[depth]);
        sum->r_hat[depth] = other->r_hat[depth] > sum->r_hat[depth] ? other->r_hat[depth] : sum->r_hat[depth];
        for (int kind = 0; kind < CHAIN_KINDS; ++kind) {
            sum->proposals[kind][depth] += other->proposals[kind][depth];
            sum->accepted[kind][depth] += other->accepted[kind][depth];
        }
    }
}
