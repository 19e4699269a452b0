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
    progress->writing_seconds = 0.0;
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

/* text = ", 12.3 s left", or "" if so little is left that it is not worth saying. `size` >= 32. */
static void left_text(double left, char *text, size_t size)
{
    char time[24] = "?";
    text[0] = '\0';
    if (left >= 0.0)
        progress_time(left, time, sizeof time);
    if (!(left >= 0.0 && left < 0.05))
        snprintf(text, size, ", %s left", time);
}

void progress_line(const RenderProgress *now, int columns, char *text, size_t size)
{
    char elapsed[24], left[40], samples[24], rays[24], found[32] = "", figures[192];
    progress_time(now->elapsed, elapsed, sizeof elapsed);
    left_text(now->left, left, sizeof left);
    double per_second = now->elapsed > 0.0 ? 1.0 / now->elapsed : 0.0;
    progress_rate((double)(now->samples - now->samples_before) * per_second, samples, sizeof samples);
    progress_rate((double)now->rays * per_second, rays, sizeof rays);
    if (now->error > 0.0)
        snprintf(found, sizeof found, "error %.3g %%, ", 100.0 * now->error);
    /* at most 99 %: the rendering is not done while this line is shown */
    snprintf(figures, sizeof figures, "%3.0f %%  %s: %s%s%s  %ssamples/s  %srays/s",
             fmin(99.0, floor(100.0 * now->fraction)), now->finishing ? "finishing a pass" : "rendering", found,
             elapsed, left, samples, rays);

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
    RenderProgress all = *now;
    if (progress->quiet)
        return;
    all.left += all.left >= 0.0 ? progress->writing_seconds : 0.0;
    if (progress->terminal) {
        int columns = terminal_columns(progress->stream);
        progress_line(&all, columns, text, sizeof text);
        fprintf(progress->stream, "\r%.*s\033[K", columns - 1, text);
        fflush(progress->stream);
        progress->line_open = true;
    } else if (now->elapsed - progress->last_shown >= PROGRESS_PLAIN_SECONDS) {
        progress_line(&all, 0, text, sizeof text);
        fprintf(progress->stream, "%s\n", text);
        progress->last_shown = now->elapsed;
    }
}

void progress_writing(Progress *progress, const char *path, double part)
{
    char left[40] = "";
    double now = timing_now();
    if (!(part > 0.0)) {
        progress->writing_since = now;
        progress->writing_told = false;
    }
    if (progress->quiet || now - progress->writing_since < PROGRESS_WRITING_SECONDS)
        return;
    if (part > 0.0)
        left_text((now - progress->writing_since) * (1.0 - part) / part, left, sizeof left);
    if (progress->terminal) {
        int columns = terminal_columns(progress->stream);
        fprintf(progress->stream, "\rwriting %.*s: %3.0f %%%s\033[K", columns - 16 - (int)strlen(left), path,
                floor(100.0 * part), left);
        fflush(progress->stream);
        progress->line_open = true;
    } else if (!progress->writing_told) {
        fprintf(progress->stream, "writing %s%s\n", path, left);
    }
    progress->writing_told = true;
}

void progress_end(Progress *progress)
{
    if (progress->line_open)
        fputs("\r\033[K", progress->stream);
    progress->line_open = false;
}
