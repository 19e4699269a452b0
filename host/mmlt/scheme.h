/* The two ways to run chains: in generations, and as published (--mlt=scheme=paper; Frolov 2018). */
#ifndef TWINLIGHT_MMLT_SCHEME_H
#define TWINLIGHT_MMLT_SCHEME_H

#include <stdbool.h>

/* Even and odd generations are two replicas, independent but for what each has learned of the scene: a generation's
 * weights, plan and clamping threshold come from the other replica. So no replica weights its own errors, which its
 * chains carry from one generation to the next, and the two images can be compared. Through the other replica its own
 * past does affect its weights: the picture is consistent but not unbiased. */
#define REPLICAS 2

/* The first generations, two of each replica, have path tracing whatever the plan, so that variances become known. */
#define PATHS_FORCED (2u * REPLICAS)

typedef struct MmltScheme {
    int replicas; /* renderings with independent errors that take turns */
    bool renews; /* every generation draws a pool and starts chains from it; else only the first does */
    bool grows; /* generations start small and double */
    bool combines; /* pool and path tracing are shown beside the chains, unless --mlt=combine=off */
    unsigned chains; /* at a time, without --mlt=chains */
    unsigned pool_per_chain; /* samples of a pool, without --mlt=pool; 0: by the plan */
    double large_step; /* probability, without --mlt=large-step; 0: there are none */
    float shifts; /* fraction of the camera subpath's mutations, unless --mlt=shift=off */
    unsigned groups; /* of a population's chains, whose means are compared (chain_groups.h) */
} MmltScheme;

const MmltScheme *mmlt_scheme(bool published);

#endif
