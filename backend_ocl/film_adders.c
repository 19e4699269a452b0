#include "film_adders.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Items that a thread takes at a time: enough to make the lock rarely contended. */
#define ADD_ITEMS 4096u

typedef enum SlotState {
    SLOT_FREE,
    SLOT_LAUNCHED, /* on the device; no thread waits for it yet */
    SLOT_AWAITED, /* a thread waits for its results */
    SLOT_COPIED /* ready to be added to the film by any thread */
} SlotState;

typedef struct Slot {
    SlotState state;
    Batch *batch;
    uint next, added; /* items assigned to threads, items added */
} Slot;

typedef struct Adder {
    FilmAdders *adders;
    pthread_t thread;
    uint lane;
} Adder;

struct FilmAdders {
    pthread_mutex_t mutex;
    pthread_cond_t work; /* signals the threads */
    pthread_cond_t freed; /* signals adders_wait */
    Slot slots[BATCH_SLOTS];
    const SplatSink *sink; /* NULL: no splats to add */
    AddersTotal total;
    Timeline *timeline;
    bool quit;
    int count;
    Adder *threads;
};

/* ---- one thread -------------------------------------------------------------------------------------------------- */

static void slot_free(FilmAdders *adders, Slot *slot)
{
    slot->state = SLOT_FREE;
    slot->batch = NULL;
    pthread_cond_broadcast(&adders->freed);
}

/* Adds up the statistics of a finished batch. Called with the lock held. */
static void batch_account(FilmAdders *adders, const Batch *batch, uint64_t ray_nanoseconds)
{
    const BatchResults *results = batch->memory->results;
    adders->total.closest_rays += results->counts[COUNT_CLOSEST];
    adders->total.shadow_rays += results->counts[COUNT_SHADOW];
    adders->total.ray_nanoseconds += ray_nanoseconds;
    for (int i = 0; i < DIAGNOSTIC_COUNT; ++i)
        adders->total.diagnostics[i] += results->diagnostics[i];
}

/* Waits for a batch without the lock. Called and returns with the lock held. */
static void slot_await(FilmAdders *adders, Slot *slot)
{
    slot->state = SLOT_AWAITED;
    pthread_mutex_unlock(&adders->mutex);
    cl_int status = batch_wait(slot->batch);
    uint64_t nanoseconds = batch_finish(slot->batch, adders->timeline);
    pthread_mutex_lock(&adders->mutex);
    if (status != CL_SUCCESS) {
        if (adders->total.status == CL_SUCCESS)
            adders->total.status = status;
        slot_free(adders, slot);
        return;
    }
    batch_account(adders, slot->batch, nanoseconds);
    if (!adders->sink) {
        adders->total.items += slot->batch->frame.pass.item_count;
        slot_free(adders, slot);
        return;
    }
    slot->next = slot->added = 0;
    slot->state = SLOT_COPIED;
    pthread_cond_broadcast(&adders->work);
}

/* Adds some items without the lock. Called and returns with the lock held. */
static void slot_add(FilmAdders *adders, Slot *slot, uint lane)
{
    Batch *batch = slot->batch;
    uint first = slot->next, left = batch->frame.pass.item_count - first, count = left < ADD_ITEMS ? left : ADD_ITEMS;
    slot->next += count;
    pthread_mutex_unlock(&adders->mutex);
    uint64_t begin = timeline_now();
    for (uint section = 0; section < batch->splat_sections; ++section)
        adders->sink->splats(adders->sink->context,
                             batch->memory->host + (size_t)section * SPLAT_WORDS * batch->frame.pass.stride + first,
                             count, batch->frame.pass.stride);
    timeline_add(adders->timeline, (BackendSpan){.name = "add to film",
                                                 .track = SPAN_FILM,
                                                 .lane = lane,
                                                 .batch = batch->number,
                                                 .begin = begin,
                                                 .end = timeline_now()});
    pthread_mutex_lock(&adders->mutex);
    slot->added += count;
    if (slot->added == batch->frame.pass.item_count) {
        adders->total.items += slot->added;
        slot_free(adders, slot);
    }
}

/* Finds work for a thread: splats to add first, then the oldest batch to wait for; NULL if there is none. */
static Slot *slot_find(FilmAdders *adders)
{
    for (int i = 0; i < BATCH_SLOTS; ++i)
        if (adders->slots[i].state == SLOT_COPIED &&
            adders->slots[i].next < adders->slots[i].batch->frame.pass.item_count)
            return &adders->slots[i];
    Slot *oldest = NULL;
    for (int i = 0; i < BATCH_SLOTS; ++i)
        if (adders->slots[i].state == SLOT_LAUNCHED &&
            (!oldest || adders->slots[i].batch->number < oldest->batch->number))
            oldest = &adders->slots[i];
    return oldest;
}

static void *adder_main(void *argument)
{
    Adder *adder = argument;
    FilmAdders *adders = adder->adders;
    pthread_mutex_lock(&adders->mutex);
    for (;;) {
        Slot *slot = slot_find(adders);
        if (slot && slot->state == SLOT_COPIED)
            slot_add(adders, slot, adder->lane);
        else if (slot)
            slot_await(adders, slot);
        else if (adders->quit)
            break;
        else
            pthread_cond_wait(&adders->work, &adders->mutex);
    }
    pthread_mutex_unlock(&adders->mutex);
    return NULL;
}

/* ---- interface --------------------------------------------------------------------------------------------------- */

FilmAdders *adders_create(int threads, Timeline *timeline, Error *error)
{
    FilmAdders *adders = calloc(1, sizeof *adders);
    Adder *list = calloc((size_t)threads, sizeof *list);
    if (!adders || !list) {
        free(adders);
        free(list);
        error_memory(error, (size_t)threads * sizeof *list, "threads");
        return NULL;
    }
    pthread_mutex_init(&adders->mutex, NULL);
    pthread_cond_init(&adders->work, NULL);
    pthread_cond_init(&adders->freed, NULL);
    adders->timeline = timeline;
    adders->threads = list;
    for (int i = 0; i < threads; ++i) {
        list[i] = (Adder){.adders = adders, .lane = (uint)i};
        if (pthread_create(&list[i].thread, NULL, adder_main, &list[i]) != 0) {
            error_set(error, "cannot start thread %d of %d", i + 1, threads);
            error_fix(error, "use fewer, with --threads");
            adders_destroy(adders);
            return NULL;
        }
        ++adders->count;
    }
    return adders;
}

void adders_destroy(FilmAdders *adders)
{
    if (!adders)
        return;
    pthread_mutex_lock(&adders->mutex);
    adders->quit = true;
    pthread_cond_broadcast(&adders->work);
    pthread_mutex_unlock(&adders->mutex);
    for (int i = 0; i < adders->count; ++i)
        pthread_join(adders->threads[i].thread, NULL);
    pthread_cond_destroy(&adders->work);
    pthread_cond_destroy(&adders->freed);
    pthread_mutex_destroy(&adders->mutex);
    free(adders->threads);
    free(adders);
}

void adders_begin(FilmAdders *adders, const SplatSink *sink)
{
    pthread_mutex_lock(&adders->mutex);
    adders->sink = sink;
    adders->total.items = 0;
    pthread_mutex_unlock(&adders->mutex);
}

void adders_wait(FilmAdders *adders, int slot)
{
    pthread_mutex_lock(&adders->mutex);
    while (adders->slots[slot].state != SLOT_FREE)
        pthread_cond_wait(&adders->freed, &adders->mutex);
    pthread_mutex_unlock(&adders->mutex);
}

void adders_push(FilmAdders *adders, int slot, Batch *batch)
{
    pthread_mutex_lock(&adders->mutex);
    adders->slots[slot] = (Slot){.state = SLOT_LAUNCHED, .batch = batch};
    pthread_cond_signal(&adders->work);
    pthread_mutex_unlock(&adders->mutex);
}

void adders_total(FilmAdders *adders, AddersTotal *total)
{
    pthread_mutex_lock(&adders->mutex);
    *total = adders->total;
    pthread_mutex_unlock(&adders->mutex);
}
