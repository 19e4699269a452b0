#include "ranks/pass_cache.h"

#include "layout/scene_view.h"

#include <stdlib.h>
#include <string.h>

/* ---- rank 0 ------------------------------------------------------------------------------------------------------ */

/* Finds the list among those kept, or puts it there. */
static bool steps_keep(PassCache *cache, const StepList *list, Error *error)
{
    size_t bytes = list->count * sizeof *list->steps;
    for (uint i = 0; i < STEP_LISTS_KEPT; ++i) {
        const KeptSteps *kept = &cache->lists[i];
        if (kept->steps && kept->count == list->count && memcmp(kept->steps, list->steps, bytes) == 0) {
            cache->order.steps = i;
            return true;
        }
    }
    KeptSteps *kept = &cache->lists[cache->next];
    Step *copy = malloc(bytes + 1);
    if (!copy)
        return error_memory(error, bytes, "the steps of a pass");
    memcpy(copy, list->steps, bytes);
    free(kept->steps);
    *kept = (KeptSteps){copy, list->count};
    cache->order.steps = cache->next;
    cache->order.steps_new = true;
    cache->next = (cache->next + 1) % STEP_LISTS_KEPT;
    return true;
}

static void photons_describe(PassCache *cache, const PhotonMap *photons)
{
    PassOrder *order = &cache->order;
    order->photons = photons && photons->words;
    if (!order->photons)
        return;
    order->photons_new = photons->number != cache->photons_sent;
    order->photon_number = cache->photons_sent = photons->number;
    order->photon_words = photons->word_count;
    order->photon_params = photons->params;
}

bool pass_order_make(PassCache *cache, const FrameParams *frame, const StepList *list, uint64_t sum_words, bool whole,
                     Error *error)
{
    PassOrder *order = &cache->order;
    memset(order, 0, sizeof *order);
    order->frame = *frame;
    memcpy(order->words_per_item, list->words_per_item, sizeof order->words_per_item);
    order->pass_fields = list->pass_words ? list->pass_fields : 0;
    order->pass_stride = list->pass_stride;
    order->guided = list->guide != NULL;
    order->whole = whole;
    order->step_count = list->count;
    order->sum_words = sum_words;
    photons_describe(cache, list->photons);
    return steps_keep(cache, list, error);
}

void pass_order_send(PassCache *cache, Archive *broadcast, const StepList *list)
{
    PassOrder *order = &cache->order;
    Guide guide;
    ARCHIVE_FIELD(broadcast, *order);
    if (order->steps_new)
        archive_bytes(broadcast, cache->lists[order->steps].steps, list->count * sizeof(Step));
    if (order->guided) {
        guide = *list->guide;
        ARCHIVE_FIELD(broadcast, guide);
    }
    if (order->photons && order->photons_new)
        archive_bytes(broadcast, list->photons->words, list->photons->word_count * sizeof(uint));
}

/* ---- the others -------------------------------------------------------------------------------------------------- */

/* Replaces memory whose contents are not needed. */
static void *memory_renew(void *old, size_t bytes, const char *what, Error *error)
{
    free(old);
    void *memory = malloc(bytes + 1);
    if (!memory)
        error_memory(error, bytes, what);
    return memory;
}

static bool steps_receive(PassCache *cache, Archive *broadcast, Error *error)
{
    const PassOrder *order = &cache->order;
    KeptSteps *kept = &cache->lists[order->steps];
    if (order->steps_new) {
        kept->count = (size_t)order->step_count;
        kept->steps = memory_renew(kept->steps, kept->count * sizeof(Step), "the steps of a pass", error);
        if (!kept->steps)
            return false;
        archive_bytes(broadcast, kept->steps, kept->count * sizeof(Step));
    }
    cache->list.steps = kept->steps;
    cache->list.count = kept->count;
    return true;
}

static bool photons_receive(PassCache *cache, Archive *broadcast, Error *error)
{
    const PassOrder *order = &cache->order;
    PhotonMap *photons = &cache->photons;
    if (!order->photons)
        return true;
    photons->word_count = (size_t)order->photon_words;
    photons->number = order->photon_number;
    photons->params = order->photon_params;
    if (order->photons_new) {
        photons->words = memory_renew(photons->words, photons->word_count * sizeof(uint), "photons", error);
        if (!photons->words)
            return false;
        archive_bytes(broadcast, photons->words, photons->word_count * sizeof(uint));
    }
    cache->list.photons = photons;
    return true;
}

/* Room for the words of all items, of which a rank uses some: pages that are not written to take no memory. */
static bool pass_words_reserve(PassCache *cache, Error *error)
{
    const PassOrder *order = &cache->order;
    size_t words = (size_t)order->pass_fields * order->pass_stride;
    if (words > cache->pass_capacity) {
        cache->pass_words = memory_renew(cache->pass_words, words * sizeof(uint), "the words of a pass", error);
        cache->pass_capacity = cache->pass_words ? words : 0;
        if (!cache->pass_words)
            return false;
    }
    cache->list.pass_words = words > 0 ? cache->pass_words : NULL;
    cache->list.pass_fields = order->pass_fields;
    cache->list.pass_stride = order->pass_stride;
    return true;
}

bool pass_order_receive(PassCache *cache, Archive *broadcast, Error *error)
{
    PassOrder *order = &cache->order;
    ARCHIVE_FIELD(broadcast, *order);
    cache->list = (StepList){.steps = NULL};
    memcpy(cache->list.words_per_item, order->words_per_item, sizeof order->words_per_item);
    if (!steps_receive(cache, broadcast, error))
        return false;
    if (order->guided) {
        ARCHIVE_FIELD(broadcast, cache->guide);
        cache->list.guide = &cache->guide;
    }
    return photons_receive(cache, broadcast, error) && pass_words_reserve(cache, error);
}

/* ---- the film of a pass ------------------------------------------------------------------------------------------ */

bool pass_film_begin(PassCache *cache, FilmWords *film, const uint *tables, Error *error)
{
    const PassOrder *order = &cache->order;
    size_t words = (size_t)order->sum_words;
    if (words > cache->film_capacity) {
        free(cache->film_words);
        cache->film_words = calloc(words, sizeof *cache->film_words);
        cache->film_capacity = cache->film_words ? words : 0;
        if (!cache->film_words)
            return error_memory(error, words * sizeof *cache->film_words, "the film of a pass");
    }
    film_words_begin(film, &order->frame, scene_lookup(&order->frame, tables), cache->film_words, words);
    return true;
}

void pass_film_clear(PassCache *cache, const FilmWords *film)
{
    memset(cache->film_words, 0, film->count * sizeof *cache->film_words);
}

void pass_cache_destroy(PassCache *cache)
{
    for (uint i = 0; i < STEP_LISTS_KEPT; ++i)
        free(cache->lists[i].steps);
    free(cache->photons.words);
    free(cache->pass_words);
    free(cache->film_words);
    *cache = (PassCache){.next = 0};
}
