#include "render/error_watch.h"

#include "render/halves_error.h"
#include "render/layers.h"

#include <math.h>

void error_watch_archive(Archive *archive, ErrorWatch *watch)
{
    ARCHIVE_FIELD(archive, *watch);
    /* NaN is the estimate for pixels that overflow, and is below no goal. */
    if (watch->estimate < 0.0 || watch->deviation < 0.0)
        archive_fail(archive, "the estimated error is negative");
}

/* The work after which the next look is due. */
static double due_from(const RenderRun *run)
{
    uint64_t latest = run->error.work;
    return latest > 0 ? ERROR_LOOK_GROWTH * (double)latest : (double)ERROR_LOOK_FIRST * (double)run->crop_pixels;
}

bool error_watch_due(const RenderRun *run)
{
    return run->options->error.goal > 0.0 && (double)run->done >= due_from(run);
}

bool error_watch_look(RenderRun *run, Error *error)
{
    HalvesError found;
    if (!halves_error(run->options->layers->halves, &run->options->error, &found, error))
        return false;
    run->error = (ErrorWatch){.estimate = found.value, .deviation = found.deviation, .work = run->done};
    return true;
}

bool error_watch_reached(const RenderRun *run)
{
    const ErrorWatch *watch = &run->error;
    return watch->work > 0 && watch->estimate + watch->deviation <= run->options->error.goal;
}

double error_watch_target(const RenderRun *run)
{
    const ErrorWatch *watch = &run->error;
    double error = (watch->estimate + watch->deviation) / run->options->error.goal;
    if (watch->work == 0 || !(run->options->error.goal > 0.0) || !isfinite(error))
        return (double)INFINITY;
    return fmax((double)watch->work * error * error, due_from(run));
}

uint64_t error_watch_next(uint64_t samples)
{
    uint64_t next = 2 * (uint64_t)ceil(0.5 * ERROR_LOOK_GROWTH * (double)samples);
    return next < ERROR_LOOK_FIRST ? ERROR_LOOK_FIRST : next > samples ? next : samples + 2;
}
