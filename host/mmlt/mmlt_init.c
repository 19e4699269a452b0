/* How a rendering by mmlt begins and ends: its options, films, estimators and combinations. */
#include "mmlt/mmlt.h"

#include "chain/chain.h"
#include "mmlt/tuning.h"
#include "render/layers.h"
#include "render/shard.h"

static void options_complete(ChainOptions *options, const MmltScheme *scheme, uint max_depth)
{
    options->chains_only = options->chains_only || !scheme->combines || max_depth < CHAIN_DEPTH_MIN;
    options->chains = options->chains ? options->chains : scheme->chains;
    options->pool = options->pool ? options->pool : scheme->pool_per_chain * options->chains;
    options->steps = options->steps ? options->steps : STEPS_DEFAULT;
    options->mutations = options->mutations ? options->mutations : 7u;
    if (!(options->large_step > 0.0))
        options->large_step = scheme->large_step;
}

/* Sets what passes of chains and pools share. */
static void frame_complete(const Mmlt *mmlt, FrameParams *frame)
{
    frame->path.min_depth = CHAIN_DEPTH_MIN;
    frame->path.mis_exponent = 1;
    frame->chains.mutations = mmlt->options.mutations | (mmlt->options.ungrouped ? 0u : MUTATION_GROUPED);
    frame->chains.large_step = mmlt->scheme->large_step > 0.0 ? (float)mmlt->options.large_step : 0.0f;
    frame->chains.shifts = mmlt->options.shiftless ? 0.0f : mmlt->scheme->shifts;
    frame->chains.keep = 1;
}

bool mmlt_chains_needed(const Mmlt *mmlt)
{
    return mmlt->run->frame.path.max_depth >= CHAIN_DEPTH_MIN;
}

/* Makes the film, like that of the image; unless chains are alone, with what estimators leave to each other. */
static bool generation_film_init(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    const RenderLayers *layers = run->options->layers;
    uint last = run->frame.path.max_depth;
    bool by_depth = layers && (layers->wanted & LAYER_BIT(LAYER_BY_DEPTH)) != 0;
    return (!by_depth || film_depths_reserve(run->film, last, error)) &&
           film_init_like(&mmlt->film, run->film, error) &&
           (mmlt->options.chains_only || film_rare_reserve(&mmlt->film, error)) &&
           (!by_depth || film_depths_reserve(&mmlt->film, last, error));
}

static bool estimators_init(Mmlt *mmlt, Error *error)
{
    RenderRun *run = mmlt->run;
    bool alone = mmlt->options.chains_only;
    const Guide *guide = &mmlt->guide.shown;
    Film *film = &mmlt->film;
    bool completes = !alone && !mmlt->options.shown && !render_layers_split(run->options->layers);
    bool shown = mmlt->options.shown == 0 || mmlt->options.shown == 1 + ESTIMATOR_BIDIRECTIONAL;
    if (!paths_estimator_init(&mmlt->paths, run, film, alone, completes, guide, error) ||
        !bidirectional_estimator_init(&mmlt->bidirectional, run, film, !alone && shown && film->depth_kinds == 0, guide,
                                      error))
        return false;
    frame_complete(mmlt, &run->frame);
    pool_estimator_init(&mmlt->pool, run, film, alone, guide);
    chains_estimator_init(&mmlt->chains, film);
    return !mmlt_chains_needed(mmlt) ||
           (pool_estimator_list(&mmlt->pool, run, error) &&
            chains_estimator_list(&mmlt->chains, run, mmlt->options.steps, guide, mmlt->scheme->groups, error));
}

void mmlt_changes_forget(Mmlt *mmlt)
{
    for (int replica = 0; replica < REPLICAS; ++replica)
        paths_change_forget(&mmlt->changes[replica]);
}

bool mmlt_changes_init(Mmlt *mmlt, Error *error)
{
    mmlt_changes_forget(mmlt);
    for (int replica = 0; replica < REPLICAS; ++replica)
        if (mmlt->paths.completes && film_pixels(&mmlt->film) <= PATHS_KEPT_PIXELS &&
            !paths_change_init(&mmlt->changes[replica], mmlt->combined.values, error))
            return false;
    return true;
}

static bool combinations_init(Mmlt *mmlt, Error *error)
{
    for (int replica = 0; replica < REPLICAS; ++replica) {
        if (!combination_init(&mmlt->combinations[replica], &mmlt->film, error))
            return false;
        mmlt->combinations[replica].hidden = mmlt->run->hidden_light;
        mmlt->combinations[replica].paths_trusted = mmlt->paths.frame.photons.everywhere != 0;
        mmlt->combinations[replica].opened = mmlt->run->frame.openings.count > 0;
        mmlt->combinations[replica].shown = mmlt->options.shown;
        mmlt->combinations[replica].one_sequence = mmlt->paths.sequences == 1 && !mmlt->run->options->independent;
    }
    combination_share(&mmlt->combinations[1], &mmlt->combinations[0]);
    return combined_image_init(&mmlt->combined, &mmlt->film, error) && mmlt_changes_init(mmlt, error);
}

bool mmlt_init(Mmlt *mmlt, RenderRun *run, Error *error)
{
    *mmlt = (Mmlt){.run = run, .options = run->options->chains, .scheme = mmlt_scheme(run->options->chains.paper)};
    options_complete(&mmlt->options, mmlt->scheme, run->frame.path.max_depth);
    mmlt_guide_init(&mmlt->guide, run->guide);
    plan_init(&mmlt->plan, &mmlt->options, mmlt->scheme, run->crop_pixels, shard_work(run->options, run->crop_pixels));
    if (run->options->error.goal > 0.0) /* what is rendered until it is reached is not to depend on the clock */
        mmlt->plan.timed = false;
    if (!generation_film_init(mmlt, error) || !estimators_init(mmlt, error) ||
        (!mmlt->options.chains_only && !combinations_init(mmlt, error)))
        return false;
    mmlt->generation = generation_at(run, mmlt->scheme, 0);
    return true;
}

void mmlt_destroy(Mmlt *mmlt)
{
    chains_estimator_destroy(&mmlt->chains);
    pool_estimator_destroy(&mmlt->pool);
    paths_estimator_destroy(&mmlt->paths);
    bidirectional_estimator_destroy(&mmlt->bidirectional);
    for (int replica = 0; replica < REPLICAS; ++replica)
        combination_destroy(&mmlt->combinations[replica]);
    combined_image_destroy(&mmlt->combined);
    mmlt_changes_forget(mmlt);
    film_destroy(&mmlt->film);
    archive_memory_destroy(&mmlt->kept);
}
