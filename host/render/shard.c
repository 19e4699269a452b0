#include "render/shard.h"

#include "base/hash.h"
#include "render/film_pilot.h"

bool shard_given(const RenderOptions *options)
{
    return options->shard.count > 0;
}

/* The first unit of shard `number`, counted from 0: floor(total * number / count), without overflow. */
static uint64_t share_begin(uint64_t total, uint64_t number, uint64_t count)
{
    return total / count * number + total % count * number / count;
}

ShardRange shard_share(Shard shard, uint64_t total)
{
    if (shard.count == 0)
        return (ShardRange){0, total};
    uint64_t first = share_begin(total, shard.number - 1, shard.count);
    return (ShardRange){first, share_begin(total, shard.number, shard.count) - first};
}

/* The largest power of two of which `count` fit below the pilot's samples. */
static uint64_t block_of(unsigned count)
{
    uint64_t block = 1;
    while (2 * block * count <= PILOT_SAMPLE)
        block *= 2;
    return block;
}

ShardRange shard_samples(const RenderOptions *options)
{
    ShardRange range = {0, PILOT_SAMPLE - options->first_sample};
    if (options->samples > 0) {
        range = shard_share(options->shard, options->samples);
    } else if (shard_given(options)) {
        range.count = block_of(options->shard.count);
        range.first = (options->shard.number - 1) * range.count;
    }
    range.first += options->first_sample;
    return range;
}

uint64_t shard_work(const RenderOptions *options, uint64_t pixels)
{
    return shard_share(options->shard, options->samples * pixels).count;
}

uint64_t shard_seed(const RenderOptions *options)
{
    const uint32_t words[] = {(uint32_t)options->seed, (uint32_t)(options->seed >> 32), options->shard.number};
    return shard_given(options) ? hash_words(HASH_START, words, sizeof words / sizeof words[0]) : options->seed;
}

bool shard_check(const RenderOptions *options, bool whole, uint64_t pixels, Error *error)
{
    const Shard shard = options->shard;
    uint64_t units = options->samples * (whole ? 1 : pixels);
    if (units == 0 || units >= shard.count)
        return true;
    error_set(error, "--shard=%u/%u: a picture of %llu samples%s has no whole sample for each of %u shards",
              shard.number, shard.count, (unsigned long long)units, whole ? " per pixel" : "", shard.count);
    return error_fix(error, "use at most %llu shards, or more --samples, which are those of the whole picture",
                     (unsigned long long)units);
}
