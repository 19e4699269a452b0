#include "render/run.h"

#include "base/log.h"
#include "base/timing.h"

#include <math.h>

/* A number of seconds that no rendering takes, and that fits all integers. */
#define SECONDS_MOST 1e15

static const atomic_int NEVER = 0;

const atomic_int *render_run_stop(const RenderRun *run)
{
    return run->options->stop ? run->options->stop : &NEVER;
}

const atomic_int *render_run_stop_between(const RenderRun *run)
{
    return run->checkpoint ? &NEVER : render_run_stop(run);
}

double render_run_seconds(const RenderRun *run)
{
    return run->past.seconds + timing_now() - run->start;
}

RenderTotals render_run_totals(const RenderRun *run)
{
    RenderTotals totals = run->past;
    BackendStatistics statistics;
    uint64_t counters[DIAGNOSTIC_COUNT] = {0};
    run->interface->statistics(run->backend, &statistics);
    run->interface->diagnostics(run->backend, counters);
    totals.done = run->done;
    totals.seconds = render_run_seconds(run);
    totals.samples = run->options->samples;
    totals.closest_rays += statistics.closest_rays;
    totals.shadow_rays += statistics.shadow_rays;
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i)
        totals.diagnostics[i] += counters[i];
    return totals;
}

void render_totals_archive(Archive *archive, RenderTotals *totals)
{
    ARCHIVE_FIELD(archive, totals->done);
    archive_doubles(archive, &totals->seconds, 1, (NumberRange){0.0, SECONDS_MOST}, "seconds of rendering");
    ARCHIVE_FIELD(archive, totals->samples);
    archive_count(archive, &totals->photons, 0, PHOTONS_MOST_ALLOWED, "photons");
    ARCHIVE_FIELD(archive, totals->closest_rays);
    ARCHIVE_FIELD(archive, totals->shadow_rays);
    ARCHIVE_FIELD(archive, totals->diagnostics);
}

void render_frame_seed(FrameParams *frame, uint64_t seed)
{
    frame->pass.seed_low = (uint)seed;
    frame->pass.seed_high = (uint)(seed >> 32);
}

bool render_run_gather(RenderRun *run, Error *error)
{
    if (!run->halves)
        return true;
    film_clear(run->film);
    return film_merge(run->film, &run->halves[0], error) && film_merge(run->film, &run->halves[1], error);
}

double render_run_error_fraction(const RenderRun *run)
{
    const ErrorWatch *watch = &run->error;
    double goal = run->options->error.goal, error = watch->estimate + watch->deviation;
    if (watch->work == 0 || !(goal > 0.0) || !(error > 0.0))
        return 0.0;
    return fmin(1.0, (double)run->done / (double)watch->work * (goal / error) * (goal / error));
}

/* A pass that is expected to take this part of the seconds that are left, or more, is taken for the last. */
#define LAST_PASS_PART 0.9

/* The seconds that are left of the budget; negative: not known. */
static double budget_left(const RenderRun *run, const RenderProgress *progress)
{
    double fresh = progress->fraction - progress->fraction_before;
    if (fresh > 0.0)
        return progress->elapsed * (1.0 - progress->fraction) / fresh;
    return run->options->seconds > 0.0 ? fmax(run->options->seconds - progress->elapsed, 0.0) : -1.0;
}

/* A pass under way is finished even if the budget is spent before. */
static void left_set(const RenderRun *run, double now, RenderProgress *progress)
{
    double budget = budget_left(run, progress), pass = run->pass_end > 0.0 ? fmax(run->pass_end - now, 0.0) : -1.0;
    progress->left = fmax(budget, pass);
    progress->finishing =
        progress->fraction >= 1.0 || run->pass_last || (budget >= 0.0 && pass >= LAST_PASS_PART * budget);
}

static RenderProgress progress_now(const RenderRun *run)
{
    BackendStatistics statistics;
    run->interface->statistics(run->backend, &statistics);
    double now = timing_now(), elapsed = now - run->start;
    double by_time = run->options->seconds > 0.0 ? elapsed / run->options->seconds : 0.0;
    double fraction = fmax(run->fraction, render_run_error_fraction(run));
    RenderProgress progress = {.elapsed = elapsed,
                               .fraction = fmin(1.0, fmax(fraction, by_time)),
                               .samples = run->done,
                               .rays = statistics.closest_rays + statistics.shadow_rays,
                               .samples_before = run->past.done,
                               .error = run->error.estimate};
    if (run->done > 0 && fraction > by_time)
        progress.fraction_before = progress.fraction * (double)run->past.done / (double)run->done;
    left_set(run, now, &progress);
    return progress;
}

void render_run_report(RenderRun *run, double fraction)
{
    const RenderCallbacks *callbacks = run->callbacks;
    run->fraction = fraction;
    if (!callbacks || (!callbacks->progress && !callbacks->publish))
        return;
    const RenderProgress progress = progress_now(run);
    if (callbacks->progress)
        callbacks->progress(callbacks->context, &progress);
    if (callbacks->publish)
        callbacks->publish(callbacks->context, run, &progress);
}

void render_run_expect(RenderRun *run, double seconds)
{
    run->pass_end = seconds > 0.0 ? timing_now() + seconds : 0.0;
}

void render_run_tell(const RenderRun *run)
{
    if (!run->callbacks || !run->callbacks->progress)
        return;
    const RenderProgress progress = progress_now(run);
    run->callbacks->progress(run->callbacks->context, &progress);
}

void render_run_save_if_due(RenderRun *run)
{
    Error error = {0};
    if (!run->callbacks || !run->callbacks->save || run->options->save_every <= 0.0 ||
        timing_now() - run->last_save < run->options->save_every)
        return;
    const RenderTotals totals = render_run_totals(run);
    bool saved =
        render_run_gather(run, &error) && run->callbacks->save(run->callbacks->context, run->film, &totals, &error);
    /* One warning per series of failures. */
    if (!saved && !run->save_failed)
        log_message(LOG_WARNING, "%s; rendering continues, and saving will be tried again", error_text(&error));
    if (saved && run->save_failed)
        log_message(LOG_INFO, "saving the image succeeded again");
    run->save_failed = !saved;
    run->last_save = timing_now();
}
