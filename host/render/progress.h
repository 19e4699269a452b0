/* Progress of a rendering: on a terminal a line that is redrawn in place, otherwise plain lines from time to time. */
#ifndef TWINLIGHT_RENDER_PROGRESS_H
#define TWINLIGHT_RENDER_PROGRESS_H

#include "render/render.h"

#include <stdio.h>

typedef struct Progress {
    FILE *stream;
    bool quiet;
    bool terminal;
    double last_shown; /* elapsed seconds at the latest plain line */
    bool line_open; /* the terminal shows a line without its newline */
    double writing_seconds; /* that the image is expected to take to be written; to be set by the caller */
    double writing_since; /* start time of the current file */
    bool writing_told; /* writing has been announced */
} Progress;

/* Without a terminal: fewest seconds between two lines. */
#define PROGRESS_PLAIN_SECONDS 10.0

/* stream: standard error. quiet: show nothing. */
void progress_init(Progress *progress, FILE *stream, bool quiet);

/* Shows `now`, with the time for writing the image in what is left: at once on a terminal, otherwise if
 * PROGRESS_PLAIN_SECONDS have passed since the last line. */
void progress_update(Progress *progress, const RenderProgress *now);

/* Reports that the fraction `part` (0 ... 1) of a file has been written; the first call for a file must have 0. Shown,
 * with the time that is left, only after PROGRESS_WRITING_SECONDS. */
#define PROGRESS_WRITING_SECONDS 1.0
void progress_writing(Progress *progress, const char *path, double part);

/* Clears the line on the terminal. */
void progress_end(Progress *progress);

/* text = "12.3 s", "4:05", "2:03:10". `size` >= 16. */
void progress_time(double seconds, char *text, size_t size);

/* text = "12.3 M": three digits and a prefix k, M, G or T. `size` >= 16. */
void progress_rate(double rate, char *text, size_t size);

/* Formats the line for `now`, which says "rendering" or "finishing a pass": with a bar for a terminal of `columns`,
 * without one if columns is 0 or too few. */
void progress_line(const RenderProgress *now, int columns, char *text, size_t size);

#endif
