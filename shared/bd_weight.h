/* Weights of bidirectional paths from their stored state. */
#ifndef TWINLIGHT_BD_WEIGHT_H
#define TWINLIGHT_BD_WEIGHT_H

#include "bd_walk.h"
#include "strategy.h"

SHARED_FUNCTION DensityView bd_density_view(__global const FrameParams *frame, __global const uint *paths,
                                            __global const uint *densities, uint t)
{
    DensityView view;
    view.words = densities;
    view.stride = frame->stride;
    view.t = t;
    view.camera_first = frame->max_depth;
    view.light_delta = state_load(paths, frame->stride, BD_LIGHT_DELTA, t);
    view.camera_delta = state_load(paths, frame->stride, BD_CAMERA_DELTA, t);
    return view;
}

/* What a contribution of the strategy (s, t) is multiplied by: its weight; 1 when weights are turned off; 0 when only
 * another strategy is wanted. */
SHARED_FUNCTION float bd_weight(__global const FrameParams *frame, uint s, uint t, const DensityView *view,
                                const StrategyEnds *ends)
{
    if (!strategy_taken(frame->strategies, s, s + t - 1u) ||
        (frame->only_s != NONE && (frame->only_s != s || frame->only_t != t)))
        return 0.0f;
    if (frame->unweighted != 0u)
        return 1.0f;
    return strategy_weight(frame->strategies, frame->mis_exponent, s, t, view, ends);
}

/* BD_CONNECT of the stored y_0 for y_1 at p. */
SHARED_FUNCTION float bd_emitter_ratio(const SceneView *scene, __global const uint *paths,
                                       __global const uint *vertices, uint stride, uint t, Vec3 p)
{
    uint light = state_load(paths, stride, BD_EMITTER, t), base = vertex_base(scene->frame, SIDE_LIGHT, 0u);
    if (!SCENE_HAS(scene, FEATURE_SPHERE) || scene->lights[light].kind != LIGHT_AREA ||
        scene->primitives[scene->lights[light].primitive].shape_and_kind >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_SPHERE)
        return 1.0f;
    Surface point = {0}; /* spheres ask for no more than this */
    point.p = state_load_vec3(vertices, stride, base + VERTEX_POINT, t);
    point.ng = state_load_vec3(vertices, stride, base + VERTEX_NG, t);
    Vec3 d = vec3_sub(point.p, p);
    float distance2 = vec3_length_squared(d);
    if (!(distance2 > 0.0f))
        return 1.0f;
    return light_connect_ratio(scene, light, p, vec3_scale(d, 1.0f / float_sqrt(distance2)), distance2, &point);
}

#endif
