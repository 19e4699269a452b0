/* Every kernel with its arguments, for the backends: the CPU backend makes a loop of each, a device looks them up by
 * name. Kernels themselves never include this file. A launch may have more work items than the pass has items: a kernel
 * returns at once if its item is not below item_count. */
#ifndef TWINLIGHT_LAYOUT_KERNEL_LIST_H
#define TWINLIGHT_LAYOUT_KERNEL_LIST_H

#include "layout/diagnostics.h"

/* X(name, number of arguments, the BufferId of each in order) */
#define KERNEL_LIST_PATHS(X)                                                                                           \
    X(pt_start_paths, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,      \
      BUFFER_RAYS, BUFFER_SHADOWS, BUFFER_DIAGNOSTICS)                                                                 \
    X(pt_shade_hits, 8, BUFFER_FRAME, BUFFER_PHOTONS, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,     \
      BUFFER_RAYS, BUFFER_HITS)                                                                                        \
    X(pt_sample_lights, 6, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_SHADOWS)  \
    X(pt_add_lights, 6, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_SHADOWS)     \
    X(pt_extend_paths, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,      \
      BUFFER_DIAGNOSTICS)                                                                                              \
    X(pt_splat_own, 4, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)                                  \
    X(pt_splat_rare, 4, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)                                 \
    X(pt_splat, 4, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)                                      \
    X(aov_shade_hits, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,       \
      BUFFER_HITS)                                                                                                     \
    X(aov_splat, 3, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS)

/* Ray queries and film sums. */
#define KERNEL_LIST_OTHERS(X)                                                                                          \
    X(count_closest, 3, BUFFER_FRAME, BUFFER_RAYS, BUFFER_COUNTS)                                                      \
    X(count_shadow, 3, BUFFER_FRAME, BUFFER_SHADOWS, BUFFER_COUNTS)                                                    \
    X(film_add, 4, BUFFER_FRAME, BUFFER_TABLES, BUFFER_SPLATS, BUFFER_FILM)                                            \
    X(trace_closest, 8, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_BVH, BUFFER_RAYS,          \
      BUFFER_HITS, BUFFER_DIAGNOSTICS)                                                                                 \
    X(trace_shadow, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_BVH, BUFFER_SHADOWS,        \
      BUFFER_DIAGNOSTICS)

#define KERNEL_LIST_BIDIRECTIONAL(X)                                                                                   \
    X(bd_start_light, 11, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,     \
      BUFFER_RAYS, BUFFER_SHADOWS, BUFFER_VERTICES, BUFFER_DENSITIES, BUFFER_DIAGNOSTICS)                              \
    X(bd_start_camera, 8, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,     \
      BUFFER_RAYS, BUFFER_DIAGNOSTICS)                                                                                 \
    X(bd_shade_hits, 11, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_PHOTONS, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS,    \
      BUFFER_PATHS, BUFFER_RAYS, BUFFER_HITS, BUFFER_VERTICES, BUFFER_DENSITIES)                                       \
    X(bd_extend_walks, 10, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,    \
      BUFFER_RAYS, BUFFER_VERTICES, BUFFER_DENSITIES, BUFFER_DIAGNOSTICS)                                              \
    X(bd_connect, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,          \
      BUFFER_SHADOWS, BUFFER_VERTICES, BUFFER_DENSITIES)                                                               \
    X(bd_add_connections, 6, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_PATHS, BUFFER_SHADOWS, BUFFER_SPLATS,                  \
      BUFFER_DIAGNOSTICS)                                                                                              \
    X(bd_splat_direct, 4, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)                               \
    X(bd_splat, 4, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)

#define KERNEL_LIST_IBPT(X)                                                                                            \
    X(ib_start_light, 10, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,      \
      BUFFER_SHADOWS, BUFFER_SPLATS, BUFFER_VERTICES, BUFFER_DIAGNOSTICS)                                              \
    X(ib_shade_hits, 8, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,        \
      BUFFER_HITS, BUFFER_VERTICES)                                                                                    \
    X(ib_connect, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_SHADOWS,        \
      BUFFER_VERTICES)                                                                                                 \
    X(ib_add_connections, 5, BUFFER_FRAME, BUFFER_PATHS, BUFFER_SHADOWS, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)            \
    X(ib_extend_walks, 9, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,      \
      BUFFER_SPLATS, BUFFER_VERTICES, BUFFER_DIAGNOSTICS)

#define KERNEL_LIST_CAUSTICS(X)                                                                                        \
    X(photon_start, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PASS, BUFFER_PATHS,         \
      BUFFER_RAYS)                                                                                                     \
    X(photon_walk, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,          \
      BUFFER_HITS)                                                                                                     \
    X(photon_end, 3, BUFFER_FRAME, BUFFER_PATHS, BUFFER_PASS)                                                          \
    X(pt_start_caustics, 7, BUFFER_FRAME, BUFFER_PHOTONS, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, \
      BUFFER_RAYS)                                                                                                     \
    X(pt_walk_caustics, 8, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,     \
      BUFFER_SHADOWS, BUFFER_HITS)

#define KERNEL_LIST_OPENINGS(X)                                                                                        \
    X(opening_start, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PASS, BUFFER_PATHS,        \
      BUFFER_RAYS)                                                                                                     \
    X(opening_walk, 7, BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS, BUFFER_RAYS,         \
      BUFFER_HITS)                                                                                                     \
    X(opening_end, 3, BUFFER_FRAME, BUFFER_PATHS, BUFFER_PASS)

#define KERNEL_LIST_CHAINS(X)                                                                                          \
    X(pool_end, 3, BUFFER_FRAME, BUFFER_PATHS, BUFFER_PASS)                                                            \
    X(mlt_begin, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PASS,            \
      BUFFER_PATHS, BUFFER_RAYS, BUFFER_SHADOWS)                                                                       \
    X(mlt_propose, 10, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,        \
      BUFFER_RAYS, BUFFER_VERTICES, BUFFER_DENSITIES, BUFFER_DIAGNOSTICS)                                              \
    X(mlt_start_camera, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,    \
      BUFFER_RAYS, BUFFER_VERTICES, BUFFER_DIAGNOSTICS)                                                                \
    X(mlt_walk, 12, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_PHOTONS, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS,         \
      BUFFER_PATHS, BUFFER_RAYS, BUFFER_HITS, BUFFER_VERTICES, BUFFER_DENSITIES, BUFFER_DIAGNOSTICS)                   \
    X(mlt_connect, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,         \
      BUFFER_SHADOWS, BUFFER_VERTICES, BUFFER_DENSITIES)                                                               \
    X(mlt_accept, 10, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,         \
      BUFFER_SHADOWS, BUFFER_VERTICES, BUFFER_SPLATS, BUFFER_DIAGNOSTICS)                                              \
    X(mlt_end, 9, BUFFER_FRAME, BUFFER_GUIDE, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS, BUFFER_PATHS,             \
      BUFFER_SPLATS, BUFFER_PASS, BUFFER_DIAGNOSTICS)

#define KERNEL_LIST(X)                                                                                                 \
    KERNEL_LIST_PATHS(X)                                                                                               \
    KERNEL_LIST_OTHERS(X)                                                                                              \
    KERNEL_LIST_BIDIRECTIONAL(X)                                                                                       \
    KERNEL_LIST_IBPT(X) KERNEL_LIST_CAUSTICS(X) KERNEL_LIST_OPENINGS(X) KERNEL_LIST_CHAINS(X)

/* KERNEL_pt_start_paths, ...: the values of Step.kernel. */
#define KERNEL_ENUMERATE(name, count, ...) KERNEL_##name,
enum { KERNEL_LIST(KERNEL_ENUMERATE) KERNEL_COUNT };
#undef KERNEL_ENUMERATE

#endif
