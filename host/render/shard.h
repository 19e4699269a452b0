/* Shards: a picture that several machines render, each a share of its samples (twinlight-merge(1)).
 *
 * The sample of a pixel is a function of its number. So a shard of independent samples is a range of numbers, and all
 * shards together are the same samples as one rendering. Chains have no such numbers: a shard of MMLT is a rendering of
 * its own with a share of the work and a seed of its own. */
#ifndef TWINLIGHT_RENDER_SHARD_H
#define TWINLIGHT_RENDER_SHARD_H

#include "base/error.h"
#include "render/job.h"

/* Most shards of a picture: each has 2^15 numbers of samples even without a limit of samples. */
#define SHARDS_MOST 65536u

/* Whether the options are those of a shard, and not of a whole picture. */
bool shard_given(const RenderOptions *options);

/* Units of work first ... first + count - 1. */
typedef struct ShardRange {
    uint64_t first, count;
} ShardRange;

/* The shard's share of `total` units; shares of all shards make up the total without gap or overlap. All of them if no
 * shard is given. */
ShardRange shard_share(Shard shard, uint64_t total);

/* Samples of every pixel, for integrators whose samples are independent: a share of options->samples or, without a
 * limit, a block of numbers below PILOT_SAMPLE that no other shard uses. */
ShardRange shard_samples(const RenderOptions *options);

/* What a shard of an integrator without such samples does of options->samples of `pixels`, in samples; 0: no limit. */
uint64_t shard_work(const RenderOptions *options, uint64_t pixels);

/* The seed of the shard's chains: no two shards have the same, and none has the picture's. That itself if no shard is
 * given. */
uint64_t shard_seed(const RenderOptions *options);

/* Fails if shards of these options would have nothing to do. whole: of integrators whose shards have whole samples of
 * every pixel, of which there are `pixels`. */
bool shard_check(const RenderOptions *options, bool whole, uint64_t pixels, Error *error);

#endif
