/* Shows a rendering to those who watch it: to tev (serve/tev.h), and on a page in a browser
 * (serve/server.h). */
#ifndef TWINLIGHT_SERVE_WATCH_H
#define TWINLIGHT_SERVE_WATCH_H

#include "serve/server.h"
#include "serve/tev.h"

typedef struct WatchOptions {
    OptionAddress tev; /* host "": none */
    OptionAddress serve; /* the same for the page; port 0: the system chooses it */
} WatchOptions;

static inline bool watch_wanted(const WatchOptions *options)
{
    return options->tev.host[0] != '\0' || options->serve.host[0] != '\0';
}

/* What is watched; all of it outlives the Watch. */
typedef struct WatchSubject {
    RenderFacts facts; /* image: the output file */
    int width, height; /* of the crop */
    const PictureSettings *settings;
    const PictureMemory *memory; /* for pictures of these settings and this size; used between passes */
} WatchSubject;

typedef struct Watch {
    bool open;
    WatchSubject subject;
    Snapshot snapshot;
    Tev tev;
    bool sends; /* to tev */
    Server *server; /* NULL: none */
    RenderStatus status; /* at the latest pass */
} Watch;

/* Starts what the options ask for, if anything. Call watch_end even on failure. */
bool watch_begin(Watch *watch, const WatchOptions *options, const WatchSubject *subject, Error *error);

/* RenderCallbacks.publish: publishes the film and its layers, if somebody wants to see them and it is time. */
void watch_publish(Watch *watch, RenderRun *run, const RenderProgress *progress);

/* Publishes the film as it is at the end of the rendering. */
void watch_finish(Watch *watch, const Film *film);

/* Gives viewers a moment to take what was published last, and ends. Safe on zeroed memory. */
void watch_end(Watch *watch);

#endif
