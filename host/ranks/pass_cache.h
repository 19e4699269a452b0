/* Sends the description of a pass to all ranks, without what they have: rank 0 knows what it has sent, the others keep
 * it. */
#ifndef TWINLIGHT_RANKS_PASS_CACHE_H
#define TWINLIGHT_RANKS_PASS_CACHE_H

#include "base/archive.h"
#include "film/film_words.h"
#include "ranks/messages.h"

/* Lists of steps that are kept: an integrator has up to three, photons and layers one each. */
#define STEP_LISTS_KEPT 8

typedef struct KeptSteps {
    Step *steps;
    size_t count;
} KeptSteps;

/* Empty when zeroed. */
typedef struct PassCache {
    PassOrder order; /* the latest */
    KeptSteps lists[STEP_LISTS_KEPT];
    uint next; /* the one to be replaced */
    unsigned photons_sent; /* number of the latest map; on rank 0 */
    /* What follows is of the other ranks. */
    Guide guide;
    PhotonMap photons;
    uint *pass_words;
    size_t pass_capacity;
    StepList list; /* of the latest order; refers to this cache */
    /* Of all ranks. */
    ulong *film_words; /* zero between passes */
    size_t film_capacity;
} PassCache;

/* On rank 0: fills in cache->order. sum_words: as there. */
bool pass_order_make(PassCache *cache, const FrameParams *frame, const StepList *list, uint64_t sum_words, bool whole,
                     Error *error);

/* On rank 0: sends it, with what the ranks do not have. `list`: as for pass_order_make. */
void pass_order_send(PassCache *cache, Archive *broadcast, const StepList *list);

/* On another rank: receives it; cache->list is the list to be run. */
bool pass_order_receive(PassCache *cache, Archive *broadcast, Error *error);

/* Words for the film of the latest order, all zero. */
bool pass_film_begin(PassCache *cache, FilmWords *film, const uint *tables, Error *error);

/* Makes them zero again. */
void pass_film_clear(PassCache *cache, const FilmWords *film);

void pass_cache_destroy(PassCache *cache);

#endif
