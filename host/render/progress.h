/* How far a rendering is, on standard error: one line that is drawn over itself on a terminal, else plain lines now
 * and then. */
#ifndef TWINLIGHT_RENDER_PROGRESS_H
#define TWINLIGHT_RENDER_PROGRESS_H

#include "render/render.h"

#include <stdio.h>

typedef struct Progress {
    FILE *stream;
    bool quiet;
    bool terminal;
    double last_shown; /* elapsed seconds when something was last written */
    bool line_open; /* a line without its end is on the terminal */
    double writing_since; /* when the file that is being written was begun */
    bool writing_told; /* a plain line has said so */
} Progress;

/* Without a terminal, at most one line in this many seconds. */
#define PROGRESS_PLAIN_SECONDS 10.0

void progress_init(Progress *progress, FILE *stream, bool quiet);
void progress_update(Progress *progress, const RenderProgress *now);

/* A file is being written, so much of it (0 ... 1) is. Says so when it takes longer than PROGRESS_WRITING_SECONDS. */
#define PROGRESS_WRITING_SECONDS 1.0
void progress_writing(Progress *progress, const char *path, double part);

/* Removes the line from the terminal. */
void progress_end(Progress *progress);

/* text = "12.3 s", "4:05", "2:03:10". `size` >= 16. */
void progress_time(double seconds, char *text, size_t size);

/* text = "12.3 M", three digits and a prefix of k, M, G. `size` >= 16. */
void progress_rate(double rate, char *text, size_t size);

/* The line of `now` for a terminal of `columns` (a bar fills what is left), or without a bar when columns is 0. */
void progress_line(const RenderProgress *now, int columns, char *text, size_t size);

#endif
