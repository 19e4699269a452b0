#include "mmlt/generation.h"

#include "math/rng.h"

Generation generation_at(RenderRun *run, const MmltScheme *scheme, uint index)
{
    return (Generation){.run = run,
                        .index = index,
                        .replica = (int)(index % (uint)scheme->replicas),
                        .other = (int)((index + 1) % (uint)scheme->replicas)};
}

double generation_random(const RenderRun *run, uint index, uint use)
{
    Random4 random =
        random_four(index, use, NONE, PATH_STREAM_POOL, run->frame.pass.seed_low, run->frame.pass.seed_high);
    return ((double)random.x[0] + 0.5) / 4294967296.0;
}
