#include "serve/watch.h"

static SnapshotSource source_of(const Watch *watch, const Film *film)
{
    return (SnapshotSource){film, watch->subject.settings, watch->subject.memory, &watch->status};
}

bool watch_begin(Watch *watch, const WatchOptions *options, const WatchSubject *subject, Error *error)
{
    bool serves = options->serve.host[0] != '\0';
    *watch = (Watch){.subject = *subject, .sends = options->tev.host[0] != '\0'};
    if (!watch_wanted(options))
        return true;
    watch->open = true;
    snapshot_init(&watch->snapshot, subject->width, subject->height);
    if (watch->sends && !tev_begin(&watch->tev, &options->tev, subject->facts.image, &watch->snapshot, error))
        return false;
    watch->server = serves ? server_begin(&options->serve, &watch->snapshot, &watch->subject.facts, error) : NULL;
    return !serves || watch->server;
}

void watch_publish(Watch *watch, RenderRun *run, const RenderProgress *progress)
{
    if (!watch->open)
        return;
    status_make(&watch->status, run, progress);
    if (!snapshot_due(&watch->snapshot))
        return;
    Error error = {0};
    const SnapshotSource source = source_of(watch, run->film);
    if (render_run_gather(run, &error)) /* a failure ends the rendering soon, and is reported then */
        snapshot_publish(&watch->snapshot, &source);
    pthread_mutex_unlock(&watch->snapshot.lock);
}

void watch_finish(Watch *watch, const Film *film)
{
    if (!watch->open)
        return;
    watch->status.ended = true;
    const SnapshotSource source = source_of(watch, film);
    pthread_mutex_lock(&watch->snapshot.lock);
    snapshot_ask(snapshot_find(&watch->snapshot, SNAPSHOT_PICTURE)); /* also of a viewer that connects only now */
    snapshot_publish(&watch->snapshot, &source);
    pthread_mutex_unlock(&watch->snapshot.lock);
}

void watch_end(Watch *watch)
{
    if (!watch->open)
        return;
    server_end(watch->server);
    if (watch->sends)
        tev_end(&watch->tev);
    snapshot_destroy(&watch->snapshot);
    *watch = (Watch){0};
}
