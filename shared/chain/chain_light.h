/* The light that a chain's camera walk hits (s = 0), and the film position of a proposal. */
#ifndef TWINLIGHT_CHAIN_CHAIN_LIGHT_H
#define TWINLIGHT_CHAIN_CHAIN_LIGHT_H

#include "chain/mutation.h"
#include "path/bd_weight.h"

/* Stores the proposal's film position and, in its key, the part that path tracing shows. color: its contribution, if
 * what a light's alpha texture lets through is a factor of it (light_hit_alpha). */
SHARED_FUNCTION void chain_place(const SceneView *scene, __global uint *restrict paths, uint item, Vec2 film,
                                 Vec3 color, float path_tracing)
{
    uint stride = scene->frame->pass.stride, key = state_load(paths, stride, CHAIN_PROPOSED_KEY, item);
    state_store_float(paths, stride, CHAIN_PROPOSED_FILM, item, film.x);
    state_store_float(paths, stride, CHAIN_PROPOSED_FILM + 1u, item, film.y);
    state_store(paths, stride, CHAIN_PROPOSED_KEY, item, chain_key_shown(scene, key, film, color, path_tracing));
}

/* s = 0 at infinity, as walk_environment, times beta. Path tracing clamps the contribution of each light by itself, so
 * the part that it shows depends on which light the path has hit. Of several lights one stands for all, drawn with u in
 * proportion to the luminance of its weighted contribution. It is scaled to the luminance of all, so that the chain
 * targets their sum; its expected colour is theirs. *path_tracing: StrategyWeights.path_tracing, scaled alike, so that
 * color / *path_tracing is what path tracing would contribute from the light drawn. */
SHARED_FUNCTION Vec3 chain_environment(const SceneView *scene, Vec3 beta, DensityView view, const WalkHit *miss,
                                       uint depth, float u, float *path_tracing)
{
    Vec3 one = vec3_splat(0.0f);
    float all = 0.0f, luminance = 1.0f, scale = 1.0f;
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 color = vec3_mul(beta, environment_met(scene, scene->infinite_lights[i], miss, &ends));
        if (vec3_is_zero(color))
            continue;
        StrategyWeights weights = bd_weights(scene->frame, 0u, depth + 1u, &view, &ends);
        color = vec3_scale(color, weights.own);
        float own = rgb_luminance(color), before = all, place;
        if (own == 0.0f)
            continue;
        all += own;
        place = u * all;
        bool take = place < own;
        u = take ? place / own : (place - own) / before;
        if (take) {
            one = color;
            luminance = own;
            *path_tracing = weights.path_tracing;
        }
    }
    if (all > 0.0f)
        scale = all / luminance;
    *path_tracing *= scale;
    return vec3_scale(one, scale);
}

/* s = 0: the camera walk of d segments has ended; it contributes only if it hit a light or left the scene towards
 * one. */
SHARED_FUNCTION void chain_hit_light(const SceneView *scene, __global uint *restrict paths,
                                     __global const uint *restrict densities, uint item, uint d,
                                     const WalkHit *walk_hit)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, bank = chain_bank(paths, stride, item, SIDE_CAMERA);
    state_store(paths, stride, chain_subpath(SIDE_CAMERA, bank) + CHAIN_SUBPATH_DELTA, item,
                state_load(paths, stride, BD_CAMERA_DELTA, item));
    DensityView view = chain_density_view(frame, paths, densities, item, 0u, d + 1u);
    Vec3 color = vec3_splat(0.0f), beta = walk_hit->beta;
    float path_tracing = 0.0f, alpha = 1.0f;
    if (walk_hit->missed && SCENE_HAS(scene, FEATURE_INFINITE_LIGHT)) {
        float u = random_float(chain_select(frame, paths, item).x[0]);
        color = chain_environment(scene, beta, view, walk_hit, d, u, &path_tracing);
    } else if (!walk_hit->missed && walk_hit->light != NONE) {
        StrategyEnds ends = {0};
        color = vec3_mul(beta, emission_met(scene, walk_hit, &ends));
        if (!vec3_is_zero(color)) {
            StrategyWeights weights = bd_weights(frame, 0u, d + 1u, &view, &ends);
            color = vec3_scale(color, weights.own);
            path_tracing = weights.path_tracing;
            alpha = light_hit_alpha(scene, walk_hit->light, &walk_hit->surface);
        }
    }
    color = vec3_scale(color, receiver_rest(scene, paths, BD_RECEIVER, item,
                                            state_load(paths, stride, BD_CAMERA_DELTA, item), d - 1u));
    if (vec3_is_zero(color))
        return;
    Random4 film = chain_camera(frame, paths, item);
    state_store_vec3(paths, stride, BD_CONTRIBUTION, item, color);
    chain_place(scene, paths, item, film_position(frame, film.x[0], film.x[1]), vec3_scale(color, alpha), path_tracing);
}

#endif
