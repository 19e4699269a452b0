#include "ranks/ranks_backend.h"

#include "backend/shares.h"
#include "base/timing.h"
#include "ranks/communicator.h"
#include "ranks/pass_cache.h"
#include "ranks/slice.h"

#include <stdlib.h>
#include <string.h>

/* The Backend of rank 0; only this file knows the type. */
typedef struct RanksBackend {
    BackendMember local;
    int count; /* of ranks; the arrays have an entry for each */
    double *speeds; /* items per second */
    uint *starts; /* items of the pass, shares_make */
    RankReport *reports; /* the latest */
    const uint *tables;
    PassCache cache;
    Archive broadcast;
    ExchangeStatistics exchange;
} RanksBackend;

static RanksBackend *ranks_of(Backend *backend)
{
    return (RanksBackend *)(void *)backend;
}

static uint items_of(const RanksBackend *ranks, int rank)
{
    return ranks->starts[rank + 1] - ranks->starts[rank];
}

static PassWords words_of(const RanksBackend *ranks, const FrameParams *frame, const StepList *list, int rank)
{
    return (PassWords){.words = list->pass_words,
                       .first = frame->pass.first_item + ranks->starts[rank],
                       .count = items_of(ranks, rank),
                       .fields = list->pass_words ? list->pass_fields : 0,
                       .stride = list->pass_stride};
}

/* ---- a pass ------------------------------------------------------------------------------------------------------ */

static void pass_send(RanksBackend *ranks, const FrameParams *frame, const StepList *list)
{
    for (int rank = 1; rank < ranks->count; ++rank) {
        const RankCommand command = {.kind = COMMAND_PASS,
                                     .first = frame->pass.first_item + ranks->starts[rank],
                                     .count = items_of(ranks, rank)};
        message_send(rank, TAG_COMMAND, &command, sizeof command);
    }
    pass_order_send(&ranks->cache, &ranks->broadcast, list);
    for (int rank = 1; rank < ranks->count; ++rank) {
        const PassWords words = words_of(ranks, frame, list, rank);
        if (pass_words_any(&words))
            pass_words_send(rank, &words);
    }
}

/* Waits for this rank's slice and the reports of the others, and tells them of a stop. Returns whether there was
 * one. */
static bool pass_wait(RanksBackend *ranks, Slice *slice, const atomic_int *stop)
{
    static const char NOTHING = 0;
    bool stopped = false;
    for (int missing = ranks->count - 1, from; missing > 0 || !slice_wait(slice, 0.0);) {
        while (missing > 0 && message_waits(TAG_REPORT, &from)) {
            message_receive(from, TAG_REPORT, &ranks->reports[from], sizeof ranks->reports[from]);
            --missing;
        }
        if (*stop && !stopped) {
            for (int rank = 1; rank < ranks->count; ++rank)
                message_send(rank, TAG_STOP, &NOTHING, sizeof NOTHING);
            stopped = true;
        }
        if (slice_wait(slice, SLICE_LOOK_SECONDS))
            communicator_nap();
    }
    slice_join(slice);
    return stopped;
}

static void pass_collect(RanksBackend *ranks, const FrameParams *frame, const StepList *list)
{
    for (int rank = 1; rank < ranks->count; ++rank) {
        const PassWords words = words_of(ranks, frame, list, rank);
        if (pass_words_any(&words))
            pass_words_receive(rank, &words);
    }
}

/* Adds what the other ranks have splatted to the film. */
static void film_finish(RanksBackend *ranks, FilmWords *film, const SplatSink *sink, bool stopped)
{
    const RankCommand command = {.kind = COMMAND_FINISH, .stopped = stopped};
    for (int rank = 1; rank < ranks->count; ++rank)
        message_send(rank, TAG_COMMAND, &command, sizeof command);
    if (!sink->sums)
        return;
    film_words_reduce(film);
    sink->sums(sink->context, film->words);
    pass_film_clear(&ranks->cache, film);
}

/* Sums up what the ranks report; false with the first error. */
static bool pass_outcome(RanksBackend *ranks, const Slice *slice, uint64_t *delivered, Error *error)
{
    bool good = slice->good;
    if (!good)
        *error = slice->error;
    ranks->reports[0].delivered = slice->delivered;
    ranks->reports[0].seconds = slice->seconds;
    for (int rank = 0; rank < ranks->count; ++rank) {
        const RankReport *report = &ranks->reports[rank];
        *delivered += report->delivered;
        if (report->delivered > 0 && report->delivered == items_of(ranks, rank))
            shares_learn(&ranks->speeds[rank], report->delivered, report->seconds);
        if (rank > 0 && !report->good && good) {
            good = false;
            *error = report->error;
        }
    }
    return good;
}

/* Splats that go anywhere but to a film are needed here one by one: a pass of theirs is not divided. */
static bool is_divided(const SplatSink *sink)
{
    return !sink->splats || sink->sums;
}

static bool ranks_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                      const atomic_int *stop, uint64_t *items_done, Error *error)
{
    RanksBackend *ranks = ranks_of(backend);
    if (!is_divided(sink))
        return ranks->local.interface->run(ranks->local.backend, frame, list, sink, stop, items_done, error);
    double begin = timing_now();
    uint64_t bytes = communicator_bytes(), delivered = 0;
    FilmWords film = {.count = 0};
    Slice slice = {.backend = ranks->local, .frame = *frame, .list = list, .sink = sink, .stop = stop};
    shares_make(ranks->speeds, (size_t)ranks->count, frame->pass.item_count, ranks->starts);
    slice.frame.pass.item_count = items_of(ranks, 0);
    if (!pass_order_make(&ranks->cache, frame, list, sink->sums ? sink->sum_words : 0, sink->whole, error) ||
        (sink->sums && !pass_film_begin(&ranks->cache, &film, ranks->tables, error)))
        return false;
    slice_start(&slice);
    pass_send(ranks, frame, list);
    double sent = timing_now();
    bool stopped = pass_wait(ranks, &slice, stop);
    double computed = timing_now();
    pass_collect(ranks, frame, list);
    film_finish(ranks, &film, sink, stopped);
    bool good = pass_outcome(ranks, &slice, &delivered, error);
    ranks->exchange.latest_seconds = sent - begin + (timing_now() - computed);
    ranks->exchange.seconds += ranks->exchange.latest_seconds;
    ranks->exchange.bytes += communicator_bytes() - bytes;
    ++ranks->exchange.passes;
    if (items_done)
        *items_done = delivered;
    return good;
}

/* ---- diagnostics and statistics ---------------------------------------------------------------------------------- */

static void ranks_diagnostics(Backend *backend, uint64_t *counters)
{
    const RanksBackend *ranks = ranks_of(backend);
    ranks->local.interface->diagnostics(ranks->local.backend, counters);
    for (int rank = 1; rank < ranks->count; ++rank)
        for (int k = 0; k < DIAGNOSTIC_COUNT; ++k)
            counters[k] += ranks->reports[rank].diagnostics[k];
}

static void ranks_statistics(Backend *backend, BackendStatistics *statistics)
{
    const RanksBackend *ranks = ranks_of(backend);
    ranks->local.interface->statistics(ranks->local.backend, statistics);
    int threads = statistics->threads;
    for (int rank = 1; rank < ranks->count; ++rank)
        backend_statistics_add(statistics, &ranks->reports[rank].statistics);
    statistics->exchange = ranks->exchange;
    statistics->exchange.threads = statistics->threads;
    statistics->threads = threads;
}

static void ranks_close(Backend *backend)
{
    RanksBackend *ranks = ranks_of(backend);
    if (!ranks)
        return;
    ranks->local.interface->close(ranks->local.backend);
    pass_cache_destroy(&ranks->cache);
    free(ranks->speeds);
    free(ranks->starts);
    free(ranks->reports);
    free(ranks);
}

const BackendInterface *ranks_backend_interface(void)
{
    static const BackendInterface interface = {.name = "ranks",
                                               .close = ranks_close,
                                               .run = ranks_run,
                                               .diagnostics = ranks_diagnostics,
                                               .statistics = ranks_statistics};
    return &interface;
}

/* Allocates what has an entry for each rank. */
static bool arrays_make(RanksBackend *ranks, size_t count, Error *error)
{
    ranks->speeds = calloc(count, sizeof *ranks->speeds);
    ranks->starts = calloc(count + 1, sizeof *ranks->starts);
    ranks->reports = calloc(count, sizeof *ranks->reports);
    return (ranks->speeds && ranks->starts && ranks->reports) ||
           error_memory(error, count * sizeof *ranks->reports, "the ranks");
}

Backend *ranks_backend_create(BackendMember local, const RankReport *reports, const uint *tables, Error *error)
{
    size_t count = (size_t)communicator_count();
    RanksBackend *ranks = calloc(1, sizeof *ranks);
    if (!ranks) {
        error_memory(error, sizeof *ranks, "the ranks");
        local.interface->close(local.backend);
        return NULL;
    }
    ranks->local = local;
    ranks->count = (int)count;
    ranks->tables = tables;
    ranks->broadcast = communicator_broadcast();
    ranks->exchange.ranks = (uint)count;
    if (!arrays_make(ranks, count, error)) {
        ranks_close((Backend *)(void *)ranks);
        return NULL;
    }
    memcpy(ranks->reports, reports, count * sizeof *reports);
    return (Backend *)(void *)ranks;
}
