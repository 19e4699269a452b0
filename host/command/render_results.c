#include "command/render_job.h"

#include "backend/trace_output.h"
#include "base/log.h"
#include "base/timing.h"
#include "render/stats.h"

/* What --error has estimated. */
static void goal_report(const RenderJob *job)
{
    const ErrorWatch *watch = &job->result.error;
    const double percent = 100.0;
    if (watch->work == 0)
        log_message(LOG_WARNING, "the rendering ended before its error could be estimated; --error had no effect");
    else
        log_message(job->result.error_reached ? LOG_INFO : LOG_WARNING, "estimated error %.3g %% +- %.2g %%%s%.3g %%",
                    percent * watch->estimate, percent * watch->deviation,
                    job->result.error_reached ? ": below --error=" : ", not yet below --error=",
                    percent * job->command->error.goal);
}

/* What ranks have exchanged. */
static void exchange_report(const RenderResult *result)
{
    const ExchangeStatistics *exchange = &result->backend.exchange;
    if (exchange->ranks > 0 && exchange->passes > 0)
        log_message(LOG_INFO, "%u ranks exchanged %.3g MB per pass in %.3g s of %.3g s (%llu passes)", exchange->ranks,
                    1e-6 * (double)exchange->bytes / (double)exchange->passes, exchange->seconds, result->seconds,
                    (unsigned long long)exchange->passes);
}

void job_summary(const RenderJob *job)
{
    const RenderResult *result = &job->result;
    char seconds[24], samples[24], rays[24];
    double per_second = result->seconds > 0.0 ? 1.0 / result->seconds : 0.0;
    progress_time(result->seconds, seconds, sizeof seconds);
    progress_rate((double)result->samples * per_second, samples, sizeof samples);
    progress_rate((double)(result->backend.closest_rays + result->backend.shadow_rays) * per_second, rays, sizeof rays);
    log_message(LOG_INFO, "%s%.6g samples per pixel in %s (%ssamples/s, %srays/s)", result->stopped ? "stopped: " : "",
                result->samples_per_pixel, seconds, samples, rays);
    exchange_report(result);
    if (job->command->error.goal > 0.0)
        goal_report(job);
    if (job->left)
        log_message(LOG_WARNING, "%s is left unchanged: no sample is finished yet", job_target(job));
    else if (job->part.path[0])
        log_message(LOG_INFO, "wrote %s: shard %u of %u, for twinlight merge", job->part.path,
                    job->part.head.shard.number, job->part.head.shard.count);
    else
        log_message(LOG_INFO, "wrote %s%s%s", job->output.exr, job->output.png[0] ? " and " : "", job->output.png);
}

bool job_stats(const RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const RenderStats stats = {
        .scene_file = command->scene,
        .scene = &job->scene,
        .film = &job->film,
        .integrator = command->integrator,
        .backend = command->backends.name,
        .seed = command->seed,
        .part = job->part.path,
        .exr = job->output.exr,
        .png = job->output.png,
        .result = &job->result,
        .error = &command->error,
        .load = job->load,
        .build = job->build,
        .render = job->rendering,
        .write = job->write,
        .total = timing_now() - job->start,
    };
    return stats_write(command->stats, &stats, error);
}

bool job_trace(const RenderJob *job, Error *error)
{
    BackendMember members[BACKEND_GROUP_MAX];
    TraceSource sources[BACKEND_GROUP_MAX];
    size_t count = 0, found = backend_group_members(job->backend, members);
    for (size_t i = 0; i < found; ++i) {
        if (!members[i].interface->spans)
            continue;
        TraceSource *source = &sources[count++];
        source->count = members[i].interface->spans(members[i].backend, &source->spans, &source->dropped);
        members[i].interface->statistics(members[i].backend, &source->statistics);
        if (source->dropped > 0)
            log_message(LOG_WARNING, "the trace holds the first %zu spans only; %llu more were not recorded",
                        source->count, (unsigned long long)source->dropped);
    }
    return trace_write(job->command->trace, sources, count, error);
}
