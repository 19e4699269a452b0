/* Rays on the CPU: Embree walks its hierarchy, the shared primitive test decides. Where a few primitives or the camera
 * lie so far out that boxes which suit every ray would be larger than what is in them, Embree's suit those that start
 * among the others, and the rest take the walk of devices (geometry/bvh_traverse.h). */
#ifndef TWINLIGHT_RAYS_EMBREE_H
#define TWINLIGHT_RAYS_EMBREE_H

#include "backend/backend.h"
#include "layout/path_types.h"

typedef struct RaysEmbree RaysEmbree;

/* Builds the hierarchies with `threads` threads. NULL on failure. The scene's words are borrowed. */
RaysEmbree *rays_embree_create(const BackendScene *scene, int threads, Error *error);
void rays_embree_destroy(RaysEmbree *rays);

/* The closest hit, primitive NONE for a miss; ray.t_max > 0. Any number of threads may ask at once. */
Hit rays_embree_closest(const RaysEmbree *rays, const Ray *ray);

/* Whether anything lies within the ray. */
bool rays_embree_occluded(const RaysEmbree *rays, const Ray *ray);

/* The same over state buffers (layout/state.h) at `stride`: of `count` items, those that `items` lists or, where it is
 * NULL, the first. Rays with t_max <= 0 are not traced; what is returned is the number of the others. */
uint rays_embree_trace_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words, const uint *items,
                               uint count, uint stride);
uint rays_embree_trace_shadow(const RaysEmbree *rays, uint *shadow_words, uint count, uint stride);

/* Bytes of the hierarchies. */
size_t rays_embree_bytes(const RaysEmbree *rays);

#endif
