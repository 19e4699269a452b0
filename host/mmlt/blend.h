/* Several estimates of the same picture in one: what the chains of a generation show, what the pool's samples show from
 * which they began, and what path tracing sees. In easy light path tracing is the best of them, in hard light the chains,
 * and which it is changes from place to place.
 *
 * Each tile of the picture takes a share of every stream, in inverse proportion to its variance (Graybill and Deal 1959),
 * which is estimated from the generations before: a share that depends on nothing of the generation it is applied to
 * leaves the mean of that one right, where its chains are new. The blend of all is consistent.
 *
 * A path that carries more than a limit is a bright dot where a pool or path tracing has met it by chance; each shows as much of it as the limit, and the rest is left to the chains, which come by many of its like. What it
 * carries depends on how probable it is that the stream makes it, so both leave different parts. The same variances say how
 * the time is divided. */
#ifndef TWINLIGHT_MMLT_BLEND_H
#define TWINLIGHT_MMLT_BLEND_H

#include "mmlt/blend_learn.h"

/* The work of so many samples of every stream, in samples of path tracing: with typical times of the CPU backend, not
 * those of the machine, so that the image does not depend on it. */
double blend_work(const double samples[BLEND_STREAMS]);

/* For films like `film`. */
bool blend_init(Blend *blend, const Film *film, Error *error);
void blend_destroy(Blend *blend);

/* The streams of one generation: light_sums from light_samples paths each (0: the stream has nothing this time). The
 * film of the paths has direct light in `sums`, that of the chains what pools do not show, and in rare_sums what path tracing
 * does not. Makes the film of the chains the blend of all, with that direct light, in the
 * shares that `teacher` has learnt, then teaches `blend` what they were. Both may be the same where generations know
 * nothing of each other. Once *stop is 1 nothing more is learnt: no generation follows. */
bool blend_generation(Blend *blend, Blend *teacher, Film *const films[BLEND_STREAMS], const atomic_int *stop,
                      Error *error);

/* Relative square error of a tile's pixels from so many samples of every stream, direct light left out. Zeros before enough is
 * known. */
void blend_errors(const Blend *blend, const double samples[BLEND_STREAMS], double *errors);

/* How many samples for every step of a chain. */
typedef struct BlendPlan {
    double paths_per_step, pool_per_step;
} BlendPlan;

/* The plan that makes the relative error of the whole picture smallest in a given time; zeros before enough is known. */
BlendPlan blend_plan(const Blend *blend);

#endif
