#include "mmlt/mmlt_archive.h"

#include "render/pilot_file.h"

/* More than any rendering has. */
#define GENERATIONS_MOST 0x7fffffffu

/* Saves or restores what the next generation depends on. Numbers that later ones are divided by or read memory by must
 * lie where they can; others, such as seconds, positions in orders of pixels and statistics, may be any. */
static void mmlt_archive(Archive *archive, Mmlt *mmlt)
{
    const int *crop = mmlt->film.crop, size[2] = {crop[2] - crop[0], crop[3] - crop[1]};
    uint index = mmlt->generation.index;
    archive_count(archive, &index, 1, GENERATIONS_MOST, "generations");
    plan_archive(archive, &mmlt->plan);
    paths_estimator_archive(archive, &mmlt->paths);
    pool_estimator_archive(archive, &mmlt->pool);
    chains_estimator_archive(archive, &mmlt->chains, mmlt->options.chains);
    mmlt_guide_archive(archive, &mmlt->guide, size);
    for (int replica = 0; replica < REPLICAS && !mmlt->options.chains_only; ++replica)
        combination_archive(archive, &mmlt->combinations[replica]);
    for (int replica = 0; replica < REPLICAS && !mmlt->options.chains_only; ++replica)
        paths_change_archive(archive, &mmlt->changes[replica], mmlt->combined.values);
    if (!mmlt->paths.completes)
        mmlt_changes_forget(mmlt);
    plan_archive_bidirectional(archive, &mmlt->plan);
    bidirectional_estimator_archive(archive, &mmlt->bidirectional);
    ARCHIVE_FIELD(archive, mmlt->run->chains);
    ARCHIVE_FIELD(archive, mmlt->seconds);
    if (!archive->saves)
        mmlt->generation = generation_at(mmlt->run, mmlt->scheme, index);
}

/* Chains that never restart run on, all of them. */
static void chains_continue(Archive *archive, Mmlt *mmlt)
{
    chains_estimator_continue(&mmlt->chains, &mmlt->generation);
    if (chains_estimator_alive(&mmlt->chains, &mmlt->generation) &&
        mmlt->chains.own.list.pass_stride != mmlt->plan.chains)
        archive_fail(archive, "chains that run on are missing");
}

/* Saves the copy, restores the state itself. */
static void state_archive(void *context, Archive *archive)
{
    Mmlt *mmlt = context;
    if (archive->saves) {
        archive_bytes(archive, mmlt->kept.bytes, mmlt->kept.size);
        return;
    }
    mmlt_archive(archive, mmlt);
    if (!mmlt->scheme->renews)
        chains_continue(archive, mmlt);
}

CheckpointState mmlt_state(Mmlt *mmlt)
{
    return (CheckpointState){mmlt->kept.size > 0 || mmlt->run->resumed ? state_archive : NULL, mmlt};
}

/* Of what was restored, keeps the combinations, the guide and the rates. */
static void pilot_archive(void *context, Archive *archive)
{
    Mmlt *mmlt = context;
    const Plan plan = mmlt->plan;
    const PathsEstimator paths = mmlt->paths;
    const BidirectionalEstimator bidirectional = mmlt->bidirectional;
    const PoolEstimator pool = mmlt->pool;
    const ChainStatistics chains = mmlt->run->chains;
    const Generation generation = mmlt->generation;
    mmlt_archive(archive, mmlt);
    StepRates rates = mmlt->plan.rates;
    mmlt->plan = plan;
    if (!archive->failed) /* otherwise they may be any numbers */
        plan_rates_set(&mmlt->plan, rates);
    mmlt->paths = paths;
    mmlt->bidirectional = bidirectional;
    mmlt->pool = pool;
    chains_estimator_clear(&mmlt->chains);
    mmlt->run->chains = chains;
    mmlt->generation = generation;
    mmlt->seconds = 0.0;
}

bool mmlt_pilot_adopt(Mmlt *mmlt, Error *error)
{
    return !mmlt->run->pilot || (pilot_file_restore(mmlt->run, (CheckpointState){pilot_archive, mmlt}, error) &&
                                 mmlt_changes_init(mmlt, error));
}

bool mmlt_keep(Mmlt *mmlt, Error *error)
{
    if (!mmlt->run->checkpoint)
        return true;
    mmlt->kept.size = 0;
    Archive archive = archive_to_memory(&mmlt->kept);
    mmlt_archive(&archive, mmlt);
    if (archive.failed)
        *error = archive.error;
    return !archive.failed;
}
