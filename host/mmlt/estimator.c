#include "mmlt/estimator.h"

#include "backend/step_recorder.h"
#include "mmlt/tuning.h"

static const double COSTS[ESTIMATOR_COUNT] = {
    [ESTIMATOR_CHAINS] = COST_CHAINS, [ESTIMATOR_POOL] = COST_POOL, [ESTIMATOR_PATHS] = COST_PATHS};

double estimator_cost(EstimatorKind kind)
{
    return COSTS[kind];
}

double estimators_work(const double samples[ESTIMATOR_COUNT])
{
    double work = 0.0;
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        work += COSTS[s] * samples[s];
    return work;
}

bool estimator_init(Estimator *estimator, const RenderRun *run, bool rare, bool depths, Error *error)
{
    *estimator = (Estimator){0};
    return film_init_like(&estimator->film, run->film, error) &&
           (!rare || film_rare_reserve(&estimator->film, error)) &&
           (!depths || run->film->depth_kinds == 0 ||
            film_depths_reserve(&estimator->film, run->frame.path.max_depth, error));
}

void estimator_destroy(Estimator *estimator)
{
    step_list_destroy(&estimator->list);
    film_destroy(&estimator->film);
}

void estimator_film_params(const Estimator *estimator, FilmParams *params)
{
    params->exponent = estimator->film.quantum_exponent;
    params->split_depths = estimator->film.depth_kinds;
}

bool estimator_pass(Estimator *estimator, RenderRun *run, const FrameParams *frame, bool parts, uint64_t *delivered,
                    Error *error)
{
    SplatSink sink = render_run_sink(&estimator->film);
    sink.whole = !parts;
    *delivered = 0;
    return run->interface->run(run->backend, frame, &estimator->list, &sink, render_run_stop(run), delivered, error);
}
