#include "mmlt/estimator.h"

#include "backend/film_sink.h"
#include "mmlt/tuning.h"

static const double COSTS[ESTIMATOR_COUNT] = {[ESTIMATOR_CHAINS] = COST_CHAINS,
                                              [ESTIMATOR_POOL] = COST_POOL,
                                              [ESTIMATOR_PATHS] = COST_PATHS,
                                              [ESTIMATOR_BIDIRECTIONAL] = COST_BIDIRECTIONAL};

double estimator_cost(EstimatorKind kind)
{
    return COSTS[kind];
}

double estimator_work(EstimatorKind kind, const double samples[ESTIMATOR_COUNT])
{
    return COSTS[kind] * samples[kind];
}

double estimators_work(const double samples[ESTIMATOR_COUNT])
{
    double work = 0.0;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        work += estimator_work((EstimatorKind)s, samples);
    return work;
}

void estimator_film_params(const Estimator *estimator, FilmParams *params)
{
    params->exponent = estimator->film->quantum_exponent;
    params->split_depths = estimator->film->depth_kinds;
    params->reconstruction = estimator->film->reconstruction;
}

bool estimator_pass(Estimator *estimator, RenderRun *run, const FrameParams *frame, bool parts, uint64_t *delivered,
                    Error *error)
{
    SplatSink sink = {.splats = NULL};
    if (!estimator->hidden)
        sink = film_sink(estimator->film);
    sink.whole = !parts;
    *delivered = 0;
    return run->interface->run(run->backend, frame, &estimator->list, &sink, render_run_stop(run), delivered, error);
}
