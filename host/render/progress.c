#include "render/progress.h"

#include "base/log.h"
#include "base/timing.h"

#include <math.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define BAR_MIN 8
#define BAR_MAX 40

void progress_init(Progress *progress, FILE *stream, bool quiet)
{
    progress->stream = stream;
    progress->quiet = quiet;
    progress->terminal = stream_is_terminal(stream);
    progress->last_shown = 0.0;
    progress->line_open = false;
}

void progress_time(double seconds, char *text, size_t size)
{
    if (seconds < 59.95) {
        snprintf(text, size, "%.1f s", seconds);
        return;
    }
    unsigned long whole = (unsigned long)(seconds + 0.5);
    if (whole < 3600)
        snprintf(text, size, "%lu:%02lu", whole / 60, whole % 60);
    else
        snprintf(text, size, "%lu:%02lu:%02lu", whole / 3600, whole / 60 % 60, whole % 60);
}

void progress_rate(double rate, char *text, size_t size)
{
    static const char *const PREFIXES[] = {"", "k", "M", "G", "T"};
    int prefix = 0;
    while (rate >= 999.5 && prefix < 4) {
        rate /= 1000.0;
        ++prefix;
    }
    int decimals = rate < 9.995 ? 2 : rate < 99.95 ? 1 : 0;
    snprintf(text, size, "%.*f %s", decimals, rate, PREFIXES[prefix]);
}

void progress_line(const RenderProgress *now, int columns, char *text, size_t size)
{
    char elapsed[24], remaining[32] = "?", samples[24], rays[24], found[32] = "", figures[192];
    progress_time(now->elapsed, elapsed, sizeof elapsed);
    double fresh = now->fraction - now->fraction_before;
    double left = fresh > 0.0 ? now->elapsed * (1.0 - now->fraction) / fresh : 0.0;
    bool finishing = now->fraction >= 1.0 || (fresh > 0.0 && left < 0.05);
    if (fresh > 0.0)
        progress_time(left, remaining, sizeof remaining);
    double per_second = now->elapsed > 0.0 ? 1.0 / now->elapsed : 0.0;
    progress_rate((double)(now->samples - now->samples_before) * per_second, samples, sizeof samples);
    progress_rate((double)now->rays * per_second, rays, sizeof rays);
    if (now->error > 0.0)
        snprintf(found, sizeof found, "error %.3g %%, ", 100.0 * now->error);
    /* at most 99 %: the rendering is not done while this line is shown */
    snprintf(figures, sizeof figures, "%3.0f %%  %s%s, %s%s  %ssamples/s  %srays/s",
             fmin(99.0, floor(100.0 * now->fraction)), found, elapsed, finishing ? "finishing" : remaining,
             finishing ? "" : " left", samples, rays);

    int width = columns - (int)strlen(figures) - 4; /* brackets, a blank, and a free last column */
    width = width > BAR_MAX ? BAR_MAX : width;
    if (width < BAR_MIN) {
        snprintf(text, size, "%s", figures);
        return;
    }
    char bar[BAR_MAX + 1];
    int full = (int)(now->fraction * width + 0.5);
    memset(bar, '.', (size_t)width);
    memset(bar, '#', (size_t)(full < width ? full : width));
    bar[width] = '\0';
    snprintf(text, size, "[%s] %s", bar, figures);
}

static int terminal_columns(FILE *stream)
{
    struct winsize window;
    if (ioctl(fileno(stream), TIOCGWINSZ, &window) != 0 || window.ws_col == 0)
        return 80;
    return window.ws_col;
}

void progress_update(Progress *progress, const RenderProgress *now)
{
    char text[320];
    if (progress->quiet)
        return;
    if (progress->terminal) {
        int columns = terminal_columns(progress->stream);
        progress_line(now, columns, text, sizeof text);
        fprintf(progress->stream, "\r%.*s\033[K", columns - 1, text);
        fflush(progress->stream);
        progress->line_open = true;
    } else if (now->elapsed - progress->last_shown >= PROGRESS_PLAIN_SECONDS) {
        progress_line(now, 0, text, sizeof text);
        fprintf(progress->stream, "%s\n", text);
        progress->last_shown = now->elapsed;
    }
}

void progress_writing(Progress *progress, const char *path, double part)
{
    double now = timing_now();
    if (!(part > 0.0)) {
        progress->writing_since = now;
        progress->writing_told = false;
    }
    if (progress->quiet || now - progress->writing_since < PROGRESS_WRITING_SECONDS)
        return;
    if (progress->terminal) {
        int columns = terminal_columns(progress->stream);
        fprintf(progress->stream, "\rwriting %.*s: %3.0f %%\033[K", columns - 16, path, floor(100.0 * part));
        fflush(progress->stream);
        progress->line_open = true;
    } else if (!progress->writing_told) {
        fprintf(progress->stream, "writing %s\n", path);
    }
    progress->writing_told = true;
}

void progress_end(Progress *progress)
{
    if (progress->line_open)
        fputs("\r\033[K", progress->stream);
    progress->line_open = false;
}
