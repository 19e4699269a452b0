/* Access to structure-of-arrays state: field f of an item is at f * stride + item, so that neighbouring items touch
 * neighbouring words. Every buffer is an array of 32-bit words. */
#ifndef TWINLIGHT_LAYOUT_STATE_H
#define TWINLIGHT_LAYOUT_STATE_H

#include "layout/path_types.h"

/* A backend whose buffers all have the same stride may define STATE_STRIDE beforehand: then the address of a field is a
 * constant plus the item. */
#ifdef STATE_STRIDE
#define STATE_PLACE(stride, field, item) ((void)(stride), (size_t)(field)*STATE_STRIDE + (item))
#else
#define STATE_PLACE(stride, field, item) ((size_t)(field) * (stride) + (item))
#endif

SHARED_FUNCTION uint state_load(__global const uint *buffer, uint stride, uint field, uint item)
{
    return buffer[STATE_PLACE(stride, field, item)];
}

SHARED_FUNCTION void state_store(__global uint *buffer, uint stride, uint field, uint item, uint value)
{
    buffer[STATE_PLACE(stride, field, item)] = value;
}

SHARED_FUNCTION float state_load_float(__global const uint *buffer, uint stride, uint field, uint item)
{
    return word_float(buffer + STATE_PLACE(stride, field, item));
}

SHARED_FUNCTION void state_store_float(__global uint *buffer, uint stride, uint field, uint item, float value)
{
    word_set_float(buffer + STATE_PLACE(stride, field, item), value);
}

/* A Vec3 takes three fields from `field` on. */
SHARED_FUNCTION Vec3 state_load_vec3(__global const uint *buffer, uint stride, uint field, uint item)
{
    return vec3(state_load_float(buffer, stride, field, item), state_load_float(buffer, stride, field + 1, item),
                state_load_float(buffer, stride, field + 2, item));
}

SHARED_FUNCTION void state_store_vec3(__global uint *buffer, uint stride, uint field, uint item, Vec3 value)
{
    state_store_float(buffer, stride, field, item, value.x);
    state_store_float(buffer, stride, field + 1, item, value.y);
    state_store_float(buffer, stride, field + 2, item, value.z);
}

/* Fields of BUFFER_RAYS and of the first part of BUFFER_SHADOWS. A ray with t_max <= 0 is not traced. */
#define RAY_ORIGIN 0u
#define RAY_DIRECTION 3u
#define RAY_T_MAX 6u
#define RAY_WORDS 7u
/* In scenes with media (geometry/media_walk.h): of BUFFER_RAYS */
#define RAY_MEDIUM 7u /* where it begins */
#define RAY_CHANNEL 8u /* colour channel in which ... */
#define RAY_TARGET 9u /* ... it is scattered at this optical depth */
#define RAY_MEDIA_WORDS 10u

/* BUFFER_SHADOWS: after the ray, 1 if it is occluded. */
#define SHADOW_OCCLUDED 7u
#define SHADOW_WORDS 8u
/* In scenes with media */
#define SHADOW_MEDIUM 8u /* where it begins */
#define SHADOW_DEPTH 9u /* what it has gone through: OpticalDepth, 6 */
#define SHADOW_MEDIA_WORDS 15u

/* BUFFER_HITS */
#define HIT_T 0u
#define HIT_PRIMITIVE 1u
#define HIT_INSTANCE 2u
#define HIT_U 3u
#define HIT_V 4u
#define HIT_WORDS 5u
/* In scenes with media: what the ray has gone through */
#define HIT_ORIGIN 5u /* where the last part of the ray begins, to which `t` refers, 3 */
#define HIT_MEDIUM 8u /* of the last part */
#define HIT_DISTANCE 9u /* from the ray's origin; infinite for a miss */
#define HIT_DEPTH 10u /* OpticalDepth, 6 */
#define HIT_EMISSION 16u /* emitted on the way towards the origin, 3 */
#define HIT_MEDIA_WORDS 19u

/* `primitive` of a ray that has been scattered in a medium. */
#define HIT_SCATTERED 0xfffffffeu

/* BUFFER_SPLATS: layers and pixel index y * width + x (NONE: no splat), linear RGB, and where in that pixel's filter it
 * is (camera/splat_offset.h; read only by a film that spreads splats). A splat is in one of three
 * layers: a sample of its pixel; light from a path that could have reached any pixel; or, from chains, the excess of a
 * path over what the pool shows (path/partition.h). Chains take no samples of pixels, so the excess uses the sums of
 * samples. A splat may be in a fourth layer as well: what path tracing does not show of the path. */
#define SPLAT_SAMPLE 0u
#define SPLAT_LIGHT 0x80000000u
#define SPLAT_EXCESS SPLAT_SAMPLE
#define SPLAT_RARE 0x40000000u
#define SPLAT_LAYERS (SPLAT_LIGHT | SPLAT_RARE)

/* With frame->film.split_depths the bits between layers and pixel hold the path's depth, from SPLAT_DEPTH_MIN to
 * SPLAT_DEPTH_MAX. */
#define SPLAT_DEPTH_SHIFT 25u
#define SPLAT_DEPTH_MIN 3u
#define DIRECT_DEPTH (SPLAT_DEPTH_MIN - 1u) /* light of paths up to this depth is direct light */
#define SPLAT_DEPTH_MAX 31u

SHARED_FUNCTION uint splat_depth(uint split_depths, uint segments)
{
    return split_depths != 0u ? segments << SPLAT_DEPTH_SHIFT : 0u;
}

/* Passes of several variables have the number of the image in the upper bits, where others have layers and depths; all
 * splats are samples. */
#define SPLAT_FILM_SHIFT 29u
#define SPLAT_FILMS 8u

#define SPLAT_PIXEL 0u
#define SPLAT_COLOR 1u
#define SPLAT_OFFSET 4u
#define SPLAT_WORDS 5u

/* BUFFER_COUNTS: live rays counted by kernels/count.cl. */
#define COUNT_CLOSEST 0u
#define COUNT_SHADOW 1u
#define COUNT_WORDS 2u

/* Rays that one item of a counting launch looks at: few enough to keep the device busy, many enough for its atomic
 * additions to be rare. Such a launch has (item_count + COUNT_RAYS - 1) / COUNT_RAYS items. */
#define COUNT_RAYS 64u

SHARED_FUNCTION void ray_store(__global uint *rays, uint stride, uint item, Ray ray)
{
    state_store_vec3(rays, stride, RAY_ORIGIN, item, ray.o);
    state_store_vec3(rays, stride, RAY_DIRECTION, item, ray.d);
    state_store_float(rays, stride, RAY_T_MAX, item, ray.t_max);
}

SHARED_FUNCTION Ray ray_load(__global const uint *rays, uint stride, uint item)
{
    Ray ray;
    ray.o = state_load_vec3(rays, stride, RAY_ORIGIN, item);
    ray.d = state_load_vec3(rays, stride, RAY_DIRECTION, item);
    ray.t_max = state_load_float(rays, stride, RAY_T_MAX, item);
    return ray;
}

SHARED_FUNCTION void hit_store(__global uint *hits, uint stride, uint item, Hit hit)
{
    state_store_float(hits, stride, HIT_T, item, hit.t);
    state_store(hits, stride, HIT_PRIMITIVE, item, hit.primitive);
    state_store(hits, stride, HIT_INSTANCE, item, hit.instance);
    state_store_float(hits, stride, HIT_U, item, hit.u);
    state_store_float(hits, stride, HIT_V, item, hit.v);
}

SHARED_FUNCTION Hit hit_load(__global const uint *hits, uint stride, uint item)
{
    Hit hit;
    hit.t = state_load_float(hits, stride, HIT_T, item);
    hit.primitive = state_load(hits, stride, HIT_PRIMITIVE, item);
    hit.instance = state_load(hits, stride, HIT_INSTANCE, item);
    hit.u = state_load_float(hits, stride, HIT_U, item);
    hit.v = state_load_float(hits, stride, HIT_V, item);
    return hit;
}

#endif
