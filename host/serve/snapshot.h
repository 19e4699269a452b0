/* What readers of a rendering under way see of it: copies of the layers that somebody asks for, which the rendering
 * thread renews between passes. Readers never make that thread wait: while one of them holds the lock, it goes on and
 * publishes later. */
#ifndef TWINLIGHT_SERVE_SNAPSHOT_H
#define TWINLIGHT_SERVE_SNAPSHOT_H

#include "render/picture.h"
#include "serve/status.h"

#include <pthread.h>

/* Fewest seconds between two publications. */
#define SNAPSHOT_SECONDS 1.0

/* Publications, and what readers do with them, take at most this part of the threads' time: the next one waits until
 * the latest has taken no more, but not for more than SNAPSHOT_SECONDS_MOST. */
#define SNAPSHOT_TIME_PART 0.0075
#define SNAPSHOT_SECONDS_MOST 20.0

/* A layer that nobody has asked for this many seconds is no longer published. */
#define SNAPSHOT_WANTED_SECONDS 5.0

/* The name of the picture itself. */
#define SNAPSHOT_PICTURE "picture"

typedef struct SnapshotLayer {
    char name[16]; /* "picture", "direct", "halfA", "depth": the EXR's channels without their last part */
    int channels; /* 1: the three values of a pixel are equal */
    float *rgb; /* 3 per pixel, row by row, the uppermost first; NULL: never published */
    uint64_t version; /* the publication that it is of */
    double wanted; /* in timing_now: published until then */
    bool once; /* also part of the next publication */
} SnapshotLayer;

typedef struct Snapshot {
    pthread_mutex_t lock; /* of all that follows */
    int width, height; /* of the crop; constant */
    SnapshotLayer layers[PICTURE_GROUPS_MAX]; /* the first: the picture */
    size_t layer_count;
    uint64_t version; /* number of publications */
    RenderStatus status; /* at the latest publication */
    double watched; /* in timing_now: until then somebody wants the status */
    double published; /* in timing_now: when the latest publication ended */
    double cost; /* of that one and of reading since, in processor seconds */
    int threads; /* of publications, as many as render */
} Snapshot;

/* What is published. */
typedef struct SnapshotSource {
    const Film *film;
    const PictureSettings *settings;
    const PictureMemory *memory; /* its lanes are used */
    const RenderStatus *status;
} SnapshotSource;

void snapshot_init(Snapshot *snapshot, int width, int height);
void snapshot_destroy(Snapshot *snapshot);

/* The layer of this name, or NULL. The caller holds the lock. */
SnapshotLayer *snapshot_find(Snapshot *snapshot, const char *name);

/* Asks for a layer: it is part of publications for SNAPSHOT_WANTED_SECONDS. Before the first publication the picture
 * alone is known. The caller holds the lock. */
void snapshot_ask(SnapshotLayer *layer);

/* Asks for the status, and with it for publications, for as long. The caller holds the lock. */
void snapshot_watch(Snapshot *snapshot);

/* Counts what the calling thread, a reader, has used since *counted, which becomes timing_thread. The caller holds the
 * lock. */
void snapshot_reader_count(Snapshot *snapshot, double *counted);

/* Takes the lock if a publication is due, somebody wants a layer or the status, and no reader holds the lock. Then
 * publish and call pthread_mutex_unlock. */
bool snapshot_due(Snapshot *snapshot);

/* Renews all layers that are wanted. The caller holds the lock, and the film does not change meanwhile. */
void snapshot_publish(Snapshot *snapshot, const SnapshotSource *source);

/* Copies a layer that is newer than *version, and sets that. rgb[3 * width * height]. */
bool snapshot_copy(Snapshot *snapshot, const char *name, uint64_t *version, float *rgb);

#endif
