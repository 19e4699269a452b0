#include "render/report.h"

#include "base/log.h"
#include "layout/diagnostics.h"

/* Fraction of all samples that may be too faint for the film without a warning. */
#define VANISHED_PART 0.01

/* Warns of `count` events, absolute and per 100 samples. what: "contributions ...", "rays ..." and what became of
 * them. */
static void count_report(const RenderResult *result, uint64_t count, const char *what)
{
    double part = (double)count / (double)(result->samples > 0 ? result->samples : 1);
    log_message(LOG_WARNING, "%llu (%.2g per 100 samples) %s", (unsigned long long)count, 100.0 * part, what);
}

/* Warns of pixels and contributions outside the film's range. */
static void film_report(const RenderResult *result, const Film *film, float scale)
{
    size_t full = film_full_pixels(film), pixels = film_pixels(film), empty = film_empty_pixels(film);
    size_t infinite = film_infinite_pixels(film, scale);
    if (empty > 0)
        log_message(LOG_WARNING, "%zu of %zu pixels have no sample and are black: render for longer", empty, pixels);
    if (infinite > 0)
        log_message(LOG_WARNING,
                    "%zu of %zu pixels (%.3g %%) exceed the range of a float and are infinite in the image: make the "
                    "lights dimmer, or lower the Film's iso",
                    infinite, pixels, 100.0 * (double)infinite / (double)pixels);
    if (film->saturated > 0)
        count_report(result, film->saturated, "contributions were too bright for the film and were clamped");
    if (full > 0)
        log_message(LOG_WARNING, "%zu of %zu pixels (%.3g %%) have reached the film's largest sum and are too dark",
                    full, pixels, 100.0 * (double)full / (double)pixels);
    if ((double)film->vanished > VANISHED_PART * (double)result->samples)
        count_report(result, film->vanished, "contributions were too faint for the film and count as black");
}

void render_report(const RenderResult *result, const Film *film, float scale)
{
    static const char *const SENTENCES[DIAGNOSTIC_COUNT] = {
        [DIAGNOSTIC_NOT_FINITE] = "contributions were not finite inside the kernels and count as black",
        [DIAGNOSTIC_ZERO_DIRECTION] = "rays had no direction and were not traced",
        [DIAGNOSTIC_RAY_RANGE] = "rays left the range of floats, and their paths were ended",
        [DIAGNOSTIC_LOST_CHAIN] = "chains could not rebuild their first path and were dropped",
        [DIAGNOSTIC_REPLAY] = "chains rebuilt their path with another contribution than it had",
    };
    for (int i = 0; i < result->diagnostic_count; ++i)
        if (result->diagnostics[i] > 0)
            count_report(result, result->diagnostics[i], SENTENCES[i]);
    film_report(result, film, scale);
    if (film->not_finite > 0)
        count_report(result, film->not_finite, "contributions were not finite and count as black");
}
