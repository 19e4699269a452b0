/* Where chains look for light. The numbers that draw a direction from a cosine lobe count from the direction to a
 * light: 0, 0 draws that one, and a step away from them is one away from it.
 *
 * A light that no vertex can be connected with, for it is behind glass, is met by chance, in a small part of all
 * directions. With numbers that count from the surface's own axes these would be others at every point, so that a chain
 * which has met the light loses it with the first step across the film; counted from the light they are the same
 * wherever it stands. The shift is of integers modulo 2^32, hence a permutation, and keeps all probabilities as they
 * are (Cranley and Patterson, "Randomization of number theoretic methods for multiple integration", 1976, shift points
 * so, to randomise them). */
#ifndef TWINLIGHT_LIGHT_LIGHT_GUIDE_H
#define TWINLIGHT_LIGHT_LIGHT_GUIDE_H

#include "layout/scene_view.h"
#include "math/rng.h"
#include "math/warp.h"

/* Towards the light guide that sends most to p, were nothing between: not a unit vector, zero at the light guide itself
 * and without any. */
SHARED_FUNCTION Vec3 light_guide_from(uint count, __global const Guide *guide, Vec3 p)
{
    Vec3 best = vec3_splat(0.0f);
    float most = 0.0f;
    for (uint i = 0u; i < count; ++i) {
        Vec3 d = vec3_sub(guide->lights[i], vec3_scale(p, guide->lights_near[i]));
        float sent = guide->lights_power[i] / vec3_length_squared(d);
        if (!(sent > most)) /* not what is not a number */
            continue;
        most = sent;
        best = d;
    }
    return best;
}

/* A number from 0 to 1 as a part of 2^32. */
SHARED_FUNCTION uint light_guide_bits(float x)
{
    return (uint)(float_min(x, 0.99999994f) * 4294967296.0f);
}

/* random.x[1] and x[2], which draw a direction at p by warp_cosine_hemisphere in the frame `shading`, counted from the
 * light guide. A light behind the surface counts as the one that it mirrors, so that nothing jumps where it rises. */
SHARED_FUNCTION Random4 light_guide_numbers(const SceneView *scene, Vec3 p, Frame shading, Random4 random)
{
    Vec3 d = light_guide_from(scene->frame->guide_count, scene->guide, p);
    float square = vec3_length_squared(d);
    if (!(square > 0.0f))
        return random;
    Vec3 w = frame_to_local(shading, vec3_scale(d, 1.0f / float_sqrt(square)));
    Vec2 guide = warp_disk_inverse(vec2(w.x, w.y));
    random.x[1] += light_guide_bits(guide.x);
    random.x[2] += light_guide_bits(guide.y);
    return random;
}

#endif
