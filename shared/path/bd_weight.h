/* MIS weights of bidirectional paths from their stored state. */
#ifndef TWINLIGHT_PATH_BD_WEIGHT_H
#define TWINLIGHT_PATH_BD_WEIGHT_H

#include "path/bd_walk.h"
#include "path/strategy.h"

SHARED_FUNCTION DensityView bd_density_view(__global const FrameParams *frame, __global const uint *paths,
                                            __global const uint *densities, uint item)
{
    DensityView view;
    view.light = densities;
    view.camera = densities + (size_t)frame->path.max_depth * DENSITY_WORDS * frame->pass.stride;
    view.stride = frame->pass.stride;
    view.item = item;
    view.compact = false;
    view.light_end = 0u;
    view.camera_end = 0u;
    view.light_delta = state_load(paths, frame->pass.stride, BD_LIGHT_DELTA, item);
    view.camera_delta = state_load(paths, frame->pass.stride, BD_CAMERA_DELTA, item);
    return view;
}

/* Whether the strategy (s, t) contributes: deep enough, in the set, and not excluded by only_s and only_t. */
SHARED_FUNCTION bool strategy_wanted(__global const FrameParams *frame, uint s, uint t)
{
    return s + t > frame->path.min_depth && strategy_taken(frame->path.strategies, s, s + t - 1u) &&
           (frame->path.only_s == NONE || (frame->path.only_s == s && frame->path.only_t == t));
}

/* Factors of a contribution by the strategy (s, t): its MIS weight; 1 if weights are turned off; 0 if the strategy does
 * not contribute. */
SHARED_FUNCTION StrategyWeights bd_weights(__global const FrameParams *frame, uint s, uint t, const DensityView *view,
                                           const StrategyEnds *ends)
{
    StrategyWeights weights = {0.0f, 0.0f};
    if (!strategy_wanted(frame, s, t))
        return weights;
    if (frame->path.unweighted == 0u)
        return strategy_weights(frame->path.strategies, frame->path.mis_exponent, s, t, view, ends);
    weights.own = 1.0f;
    return weights;
}

SHARED_FUNCTION float bd_weight(__global const FrameParams *frame, uint s, uint t, const DensityView *view,
                                const StrategyEnds *ends)
{
    return bd_weights(frame, s, t, view, ends).own;
}

/* s = 0: adds what media emit along the ray under way of the camera's walk, which ends segment `depth`. No other
 * strategy makes such a path, and of mmlt's estimators path tracing alone shows it. */
SHARED_FUNCTION_APART void walk_add_medium_emission(const SceneView *scene, __global uint *restrict paths,
                                                    __global const uint *restrict hits, uint item, uint depth)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride;
    if (frame->pool.enabled != 0u || frame->partition.split_direct != 0u || !strategy_wanted(frame, 0u, depth + 1u))
        return;
    if (frame->film.split_depths != 0u)
        state_store(paths, stride, BD_GATHERED, item, depth);
    bd_add_radiance(
        frame, paths, item, depth,
        vec3_mul(state_load_vec3(paths, stride, BD_BETA, item), state_load_vec3(hits, stride, HIT_EMISSION, item)));
}

/* s = 0 at infinity: the sum over all lights there, when the camera walk has missed after `depth` segments. */
SHARED_FUNCTION Vec3 walk_environment(const SceneView *scene, DensityView view, const WalkHit *miss, uint depth)
{
    Vec3 sum = vec3_splat(0.0f);
    for (uint i = 0; i < scene->frame->scene.infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 radiance = environment_met(scene, scene->infinite_lights[i], miss, &ends);
        if (!vec3_is_zero(radiance))
            sum = vec3_mad(sum, bd_weight(scene->frame, 0u, depth + 1u, &view, &ends), radiance);
    }
    return sum;
}

#endif
