/* Light guides: the numbers that sample a direction from a cosine lobe are relative to the direction to a light: (0, 0)
 * samples that direction, and a step away from (0, 0) is a step away from the light.
 *
 * A light behind glass cannot be connected to any vertex; walks hit it by chance, in a small part of all directions. If
 * the numbers were relative to the surface's own axes, those that hit the light would differ from point to point, and a
 * chain that had found the light would lose it with the first step across the film; relative to the light they are the
 * same everywhere. The offset is an addition of integers modulo 2^32, hence a permutation, and preserves all
 * probabilities (Cranley and Patterson, "Randomization of number theoretic methods for multiple integration", 1976,
 * shift points in this way to randomise them). */
#ifndef TWINLIGHT_LIGHT_LIGHT_GUIDE_H
#define TWINLIGHT_LIGHT_LIGHT_GUIDE_H

#include "layout/scene_view.h"
#include "math/rng.h"
#include "math/warp.h"

/* The vector from p to the light guide that would contribute most at p if it were unoccluded. Not normalised; zero at
 * the guide itself and where there is none. */
SHARED_FUNCTION Vec3 light_guide_from(uint count, __global const Guide *guide, Vec3 p)
{
    Vec3 best = vec3_splat(0.0f);
    float most = 0.0f;
    for (uint i = 0u; i < count; ++i) {
        Vec3 d = vec3_sub(guide->lights[i], vec3_scale(p, guide->lights_near[i]));
        float sent = guide->lights_power[i] / vec3_length_squared(d);
        if (!(sent > most)) /* rejects NaN */
            continue;
        most = sent;
        best = d;
    }
    return best;
}

/* x in [0, 1] as a fraction of 2^32. */
SHARED_FUNCTION uint light_guide_bits(float x)
{
    return (uint)(float_min(x, 0.99999994f) * 4294967296.0f);
}

/* Offsets random.x[1] and x[2], which draw a direction at p by warp_cosine_hemisphere in the frame `shading`, so that
 * they are relative to the light guide. A light below the surface is replaced by its mirror image, so that the offset
 * is continuous where the light crosses the horizon. */
SHARED_FUNCTION Random4 light_guide_numbers(const SceneView *scene, Vec3 p, Frame shading, Random4 random)
{
    Vec3 d = light_guide_from(scene->frame->scene.guide_count, scene->guide, p);
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
