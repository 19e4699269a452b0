/* Ray queries on the CPU: Embree traverses its hierarchy, the shared primitive test decides. If a few primitives or the
 * camera lie so far out that boxes with a margin for every ray would be larger than their contents, the margin of
 * Embree's boxes is that for rays that start among the other primitives, and all other rays take the traversal of
 * devices (geometry/bvh_traverse.h). */
#ifndef TWINLIGHT_RAYS_EMBREE_H
#define TWINLIGHT_RAYS_EMBREE_H

#include "backend/backend.h"
#include "layout/path_types.h"

typedef struct RaysEmbree RaysEmbree;

/* Builds the hierarchies with `threads` threads. NULL on failure; *error says why. The scene's words are borrowed. */
RaysEmbree *rays_embree_create(const BackendScene *scene, int threads, Error *error);
void rays_embree_destroy(RaysEmbree *rays);

/* The closest hit; its primitive is NONE for a miss. ray->t_max > 0. Thread-safe. */
Hit rays_embree_closest(const RaysEmbree *rays, const Ray *ray);

/* Whether the ray hits anything. Thread-safe. */
bool rays_embree_occluded(const RaysEmbree *rays, const Ray *ray);

/* The same for state buffers (layout/state.h) with stride `stride`: for `count` items, listed in `items`, or the first
 * ones if that is NULL or missing. Rays with t_max <= 0 are not traced. In scenes with media rays go on behind
 * interfaces (geometry/media_walk.h), and only there `diagnostics`, BUFFER_DIAGNOSTICS, is not ignored. Returns the
 * number of rays traced. */
uint rays_embree_trace_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words, uint *diagnostics,
                               const uint *items, uint count, uint stride);
uint rays_embree_trace_shadow(const RaysEmbree *rays, uint *shadow_words, uint *diagnostics, uint count, uint stride);

/* Size of the hierarchies and of the clusters and lists of primitives below them. */
size_t rays_embree_bytes(const RaysEmbree *rays);

#endif
