/* Sends the picture to the viewer tev as it converges, from a thread of its own. A viewer that is missing, slow,
 * hanging or gone costs the rendering nothing: while one snapshot is being sent, others are dropped. */
#ifndef TWINLIGHT_SERVE_TEV_H
#define TWINLIGHT_SERVE_TEV_H

#include "base/option_values.h"
#include "serve/snapshot.h"

#include <netdb.h>
#include <stdatomic.h>

/* Most seconds that tev_end waits for the last snapshot to be sent. */
#define TEV_END_SECONDS 1.5

typedef struct Tev {
    Snapshot *snapshot;
    const char *image; /* name in the viewer */
    char address[280]; /* for messages */
    struct addrinfo *addresses; /* of the viewer */
    pthread_t thread;
    bool running;
    _Atomic double end; /* in timing_now: nothing is sent after it; infinite before tev_end */
    /* Of the thread. */
    int socket; /* -1: not connected */
    uint64_t version; /* of the latest snapshot sent over this connection */
    double next_try, last_send; /* in timing_now */
    double counted; /* snapshot_reader_count */
    bool told; /* that there is no viewer */
    float *rgb;
    unsigned char *packet;
    int packet_rows;
} Tev;

/* Looks the host up, which must succeed, and starts the thread; the viewer need not be there yet. `image` and
 * `snapshot` must outlive it. Call tev_end even on failure. */
bool tev_begin(Tev *tev, const OptionAddress *address, const char *image, Snapshot *snapshot, Error *error);

/* Sends what was published last, if that takes at most TEV_END_SECONDS, and ends the thread. */
void tev_end(Tev *tev);

#endif
