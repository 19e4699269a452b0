#include "rays_embree_scene.h"

#include "geometry/media_walk.h"
#include "layout/state.h"

#ifdef TWINLIGHT_DOUBLE

static Hit outer_walk(const RaysEmbree *rays, const Ray *ray, bool any)
{
    (void)rays;
    (void)any;
    return hit_none(ray->t_max); /* no ray is an outer one */
}

#else

static Hit outer_walk(const RaysEmbree *rays, const Ray *ray, bool any)
{
    return bvh_walk(&rays->view, rays->outer.words, *ray, any);
}

#endif

static inline void walk_begin(RayWalk *walk, const RaysEmbree *rays, const Ray *ray)
{
    rtcInitIntersectContext(&walk->context);
    walk->rays = rays;
    walk->ray = ray;
#ifndef TWINLIGHT_DOUBLE
    walk->has_boxes = false;
#endif
    walk->instance = NONE;
    walk->best = hit_none(ray->t_max);
}

/* Whether the ray starts beyond the reach of Embree's margins. The choice affects no bit: both traversals find the hits
 * of the shared primitive test. */
static inline bool ray_is_outer(const RaysEmbree *rays, const Ray *ray)
{
    return rays->outer.words && vec3_max_abs(ray->o) > rays->reach;
}

/* Inlined into the loop over the rays of a chunk. */
__attribute__((always_inline)) static inline Hit ray_closest(const RaysEmbree *rays, const Ray *ray)
{
    RayWalk walk;
    if (ray_is_outer(rays, ray))
        return outer_walk(rays, ray, false);
    walk_begin(&walk, rays, ray);
    if (rays->object_count == 0 || !rays->objects[0].scene || !ray_traceable(ray->o, ray->d))
        return walk.best;
    struct RTCRayHit rayhit = {.ray = embree_ray(&walk, ray->o, ray->d)};
    rtcIntersect1(rays->objects[0].scene, &walk.context, &rayhit);
    return walk.best;
}

Hit rays_embree_closest(const RaysEmbree *rays, const Ray *ray)
{
    return ray_closest(rays, ray);
}

bool rays_embree_occluded(const RaysEmbree *rays, const Ray *ray)
{
    RayWalk walk;
    if (ray_is_outer(rays, ray))
        return outer_walk(rays, ray, true).primitive != NONE;
    if (rays->object_count == 0 || !rays->objects[0].scene || !ray_traceable(ray->o, ray->d))
        return false;
    walk_begin(&walk, rays, ray);
    struct RTCRay asked = embree_ray(&walk, ray->o, ray->d);
    rtcOccluded1(rays->objects[0].scene, &walk.context, &asked);
    return asked.tfar < 0.0f;
}

/* rays_embree_closest through media (geometry/media_walk.h). Not inlined: other scenes do not pay for it. */
__attribute__((noinline)) static Hit media_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words,
                                                   uint *diagnostics, uint stride, uint item, Ray ray)
{
    MediaWalk walk = media_walk_load(&rays->view, ray_words, stride, item);
    Hit hit;
    do
        hit = rays_embree_closest(rays, &ray);
    while (media_walk_on(&rays->view, &ray, &hit, &walk));
    media_walk_end(hit_words, diagnostics, stride, item, ray, &walk, &hit);
    return hit;
}

__attribute__((noinline)) static void media_shadow(const RaysEmbree *rays, uint *shadow_words, uint *diagnostics,
                                                   uint stride, uint item, Ray ray)
{
    MediaWalk walk = media_walk_begin(state_load(shadow_words, stride, SHADOW_MEDIUM, item));
    Hit hit;
    do
        hit = rays_embree_closest(rays, &ray);
    while (media_walk_on(&rays->view, &ray, &hit, &walk));
    shadow_walk_end(shadow_words, diagnostics, stride, item, &walk, &hit);
}

uint rays_embree_trace_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words, uint *diagnostics,
                               const uint *items, uint count, uint stride)
{
    bool media = SCENE_HAS(&rays->view, FEATURE_MEDIUM);
    uint traced = 0;
    for (uint i = 0; i < count; ++i) {
        uint item = items ? items[i] : i;
        Ray ray = ray_load(ray_words, stride, item);
        if (!(ray.t_max > 0.0f))
            continue;
        hit_store(hit_words, stride, item,
                  media ? media_closest(rays, ray_words, hit_words, diagnostics, stride, item, ray)
                        : ray_closest(rays, &ray));
        ++traced;
    }
    return traced;
}

uint rays_embree_trace_shadow(const RaysEmbree *rays, uint *shadow_words, uint *diagnostics, uint count, uint stride)
{
    bool media = SCENE_HAS(&rays->view, FEATURE_MEDIUM);
    uint traced = 0;
    for (uint item = 0; item < count; ++item) {
        Ray ray = ray_load(shadow_words, stride, item);
        if (!(ray.t_max > 0.0f))
            continue;
        if (media)
            media_shadow(rays, shadow_words, diagnostics, stride, item, ray);
        else
            state_store(shadow_words, stride, SHADOW_OCCLUDED, item, rays_embree_occluded(rays, &ray) ? 1u : 0u);
        ++traced;
    }
    return traced;
}
