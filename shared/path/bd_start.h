/* How both walks of a bidirectional path start. */
#ifndef TWINLIGHT_PATH_BD_START_H
#define TWINLIGHT_PATH_BD_START_H

#include "camera/pixel_filter.h"
#include "camera/splat_offset.h"
#include "layout/item.h"
#include "path/bd_random.h"
#include "path/bd_walk.h"

/* The header of a path that has not started, for the sample `place`: no ray, no shadow ray, nothing gathered. */
SHARED_FUNCTION void bd_header_begin(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                     __global uint *restrict rays, __global uint *restrict shadows, uint item,
                                     ItemPlace place)
{
    uint stride = frame->pass.stride;
    state_store(paths, stride, BD_PIXEL, item, place.pixel);
    state_store(paths, stride, BD_SAMPLE, item, place.sample);
    state_store(paths, stride, BD_SIDE, item, SIDE_LIGHT);
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    state_store_float(paths, stride, BD_CANDIDATE_SUM, item, 0.0f);
    state_store(paths, stride, BD_CANDIDATE, item, 0u);
    state_store_vec3(paths, stride, BD_RADIANCE, item, vec3_splat(0.0f));
    state_store(paths, stride, BD_GATHERED, item, 0u);
    if (frame->partition.split_direct != 0u)
        state_store_vec3(paths, stride, BD_DIRECT, item, vec3_splat(0.0f));
    walk_end(paths, rays, stride, item);
}

/* Draws y_0, stored at `base`, and the first ray of the light walk. choice: x: light_select_point, z: aim; random:
 * which light and point on it, direction. *own: density of y_0, or of its direction for a light at infinity. False if
 * the light emits nothing. */
SHARED_FUNCTION bool walk_start_light(const SceneView *scene, Walk walk, __global uint *restrict vertices, uint base,
                                      Random4 choice, Random4 random, float *own)
{
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item;
    Vec2 u;
    uint light = light_start_point(scene, connection_random_light(choice, random), &u);
    LightEmission emission = {0};
    if (!light_emit_aimed(scene, light, random_float(choice.x[2]), u,
                          vec2(random_float(random.x[2]), random_float(random.x[3])), &emission))
        return false;
    float select = light_start_pdf(scene, light);
    bool infinite = emission.infinite != 0u, invisible = light_is_invisible(scene, light);
    uint flags = (infinite ? EMITTER_INFINITE : 0u) |
                 (emission.delta_position != 0u || emission.delta_direction != 0u || invisible ? EMITTER_DELTA : 0u) |
                 (SCENE_HAS(scene, FEATURE_MEDIUM) && emission.back != 0u && !invisible ? EMITTER_BACK : 0u);
    state_store_vec3(vertices, stride, base + VERTEX_POINT, item, infinite ? emission.w : emission.p);
    state_store_vec3(vertices, stride, base + VERTEX_NG, item, emission.ng);
    state_store(paths, stride, BD_EMITTER, item, light);
    state_store(paths, stride, BD_EMITTER_FLAGS, item, flags);
    *own = select * (infinite ? emission.pdf_w : emission.pdf_p);
    Vec3 beta = vec3_scale(emission.radiance, emission.cosine / (select * emission.pdf_p * emission.pdf_w));
    bool on_surface = !infinite && emission.delta_position == 0u;
    Ray ray = ray_spawn(emission.p, on_surface ? emission.ng : vec3_splat(0.0f), emission.w);
    walk_begin(walk, SIDE_LIGHT, ray, beta, infinite ? emission.pdf_p : emission.pdf_w, infinite ? WALK_PARALLEL : 0u);
    return true;
}

/* The stored ray, which makes segment `depth` of a side, begins in `medium`. */
SHARED_FUNCTION_APART void bd_ray_media(const SceneView *scene, __global const uint *restrict paths,
                                        __global uint *restrict rays, uint item, uint side, uint depth, uint medium)
{
    walk_ray_media(scene, rays, scene->frame->pass.stride, item, medium,
                   bd_random_distance(scene, paths, item, side, depth));
}

/* The medium in which the first ray of a light walk begins. */
SHARED_FUNCTION_APART uint emitter_medium(const SceneView *scene, Walk walk)
{
    if (!SCENE_HAS(scene, FEATURE_MEDIUM))
        return 0u;
    __global const Light *light = scene->lights + state_load(walk.paths, walk.stride, BD_EMITTER, walk.item);
    if (light_kind(light) != LIGHT_AREA)
        return light_detail(scene, light)->medium;
    uint media = scene->shapes[scene->primitives[light->primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    bool back = (state_load(walk.paths, walk.stride, BD_EMITTER_FLAGS, walk.item) & EMITTER_BACK) != 0u;
    return back ? media_inside(media) : media_outside(media);
}

/* The first ray of the camera walk, for a sample of the item's pixel. */
SHARED_FUNCTION void walk_start_camera(const SceneView *scene, Walk walk)
{
    __global uint *paths = walk.paths;
    uint stride = walk.stride, item = walk.item;
    __global const FrameParams *frame = scene->frame;
    Random4 random = bd_random(frame, paths, item, BD_RANDOM_CAMERA);
    float weight;
    Vec2 offset = pixel_filter_sample(scene, vec2(random_float(random.x[0]), random_float(random.x[1])), &weight);
    uint pixel = state_load(paths, stride, BD_PIXEL, item);
    uint row = pixel / frame->film.width, column = pixel % frame->film.width;
    Vec2 film = vec2((float)column + 0.5f + offset.x, (float)row + 0.5f + offset.y);
    Ray ray = view_ray(scene, film, vec2(random_float(random.x[2]), random_float(random.x[3])));
    state_store_float(paths, stride, BD_WEIGHT, item, weight);
    state_store(paths, stride, BD_OFFSET, item, splat_offset(&frame->film, pixel, film));
    walk_begin(walk, SIDE_CAMERA, ray, vec3_splat(1.0f), 1.0f, WALK_DELTA);
}

/* The reach: film positions that the pixel filter of the crop window covers, width x height pixels from (x, y) on. */
typedef struct FilmReach {
    float x, y, width, height;
} FilmReach;

SHARED_FUNCTION FilmReach film_reach(__global const FrameParams *frame)
{
    float more_x = frame->film.filter.radius_x - 0.5f, more_y = frame->film.filter.radius_y - 0.5f;
    FilmReach reach;
    reach.x = (float)frame->film.crop_x0 - more_x;
    reach.y = (float)frame->film.crop_y0 - more_y;
    reach.width = (float)(frame->film.crop_x1 - frame->film.crop_x0) + 2.0f * more_x;
    reach.height = (float)(frame->film.crop_y1 - frame->film.crop_y0) + 2.0f * more_y;
    return reach;
}

/* Area of the reach over that of the crop window: a path from anywhere in the reach counts for that much of a pixel. */
SHARED_FUNCTION float film_reach_factor(__global const FrameParams *frame)
{
    FilmReach reach = film_reach(frame);
    float pixels =
        (float)(frame->film.crop_x1 - frame->film.crop_x0) * (float)(frame->film.crop_y1 - frame->film.crop_y0);
    return reach.width * reach.height / pixels;
}

/* The film position of two random numbers, uniform over the reach. */
SHARED_FUNCTION Vec2 film_position(__global const FrameParams *frame, uint x, uint y)
{
    FilmReach reach = film_reach(frame);
    return vec2(reach.x + reach.width * random_float(x), reach.y + reach.height * random_float(y));
}

/* The random number for which film_position gives `place`, 0 <= place < extent, to within 2^-24 of the extent. rest:
 * supplies the bits that have no influence on the place. */
SHARED_FUNCTION uint film_number(float place, float extent, uint rest)
{
    float cell = float_clamp(place / extent, 0.0f, 0.99999988079071045f) * 8388608.0f;
    return (uint)cell << 9 | (rest & 0x1ffu);
}

/* The first ray of a camera walk from any film position. random: film, lens. Its throughput is meant for splats that
 * are divided by the samples per pixel, like those of light paths. */
SHARED_FUNCTION void walk_start_film(const SceneView *scene, Walk walk, Random4 random)
{
    __global const FrameParams *frame = scene->frame;
    Ray ray = view_ray(scene, film_position(frame, random.x[0], random.x[1]),
                       vec2(random_float(random.x[2]), random_float(random.x[3])));
    walk_begin(walk, SIDE_CAMERA, ray, vec3_splat(film_reach_factor(frame)), 1.0f, WALK_DELTA);
}

#endif
