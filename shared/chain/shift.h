/* Shifts: mutations that move a path across the film and reconnect it to the rest of the path, which stays where it is.
 *
 * On a path over several glossy or curved surfaces, a small step of the numbers that sample directions moves the path
 * off the peaks of the lobes: a rotation of the ray at z_1 is magnified at every following vertex. Such proposals are
 * rejected, and a chain at such a path, which is the brighter the rarer it is, stays there and shows as a single bright
 * dot. A shift moves film and lens, and with them z_1. It uses those numbers at z_1 that sample the direction to the
 * same z_2, and those at z_2 that sample the direction to the same z_3. From z_3 on the path is unchanged.
 *
 * The Jacobian of the map from one path's numbers to the other's is the ratio of the area densities with which they
 * sample z_2 and z_3. It enters the acceptance probability (Green, "Reversible jump Markov chain Monte Carlo
 * computation and Bayesian model determination", 1995). Reconnection to another path's vertices comes from
 * gradient-domain rendering: Kettunen et al., "Gradient-domain path tracing", 2015. Mutations that invert the sampling
 * of directions: Otsu et al., "Fusing state spaces for Markov chain Monte Carlo rendering", 2017; Bitterli et al.,
 * "Reversible jump Metropolis light transport using inverse mappings", 2018.
 *
 * A path can be shifted if it has z_2, if z_2 and z_3 are not on curves, and if z_1 and, where z_3 exists, z_2 have
 * lobes that draw all directions near theirs. Other paths take an ordinary step of the camera subpath instead; it is
 * rejected if it leads to a path that can be shifted, since no step leads back from there. */
#ifndef TWINLIGHT_CHAIN_SHIFT_H
#define TWINLIGHT_CHAIN_SHIFT_H

#include "bsdf/bsdf.h"
#include "chain/chain_numbers.h"
#include "path/bd_walk.h"

/* Tolerance for the position of a kept vertex, in ulps. A shift and its reverse must find the same vertices, or chains
 * accumulate at those that only one of them finds. So a kept vertex must be found on its old primitive, not on a
 * neighbour that hides it, and no further from its old position than rounding explains. The ulps are those of
 * coordinates, by which rays start beside their vertex, and of directions, whose numbers are 2^-23 apart: the lower
 * their density, the larger the steps of the direction. docs/TUNING.md */
#define SHIFT_ULPS 32.0f

/* Upper bound of that distance relative to the last segment: beyond, floats do not resolve the lobe. */
#define SHIFT_MOST 1e-3f

SHARED_FUNCTION uint shift_base(uint bank)
{
    return CHAIN_SHIFTS + bank * SHIFT_WORDS;
}

/* The bank of the current path. */
SHARED_FUNCTION uint shift_bank(__global const uint *paths, uint stride, uint item)
{
    return chain_move(paths, stride, item, MOVE_BANKS) >> SIDE_CAMERA & 1u;
}

/* First field of z_i, 2 <= i <= 3, in a bank. */
SHARED_FUNCTION uint shift_point(uint bank, uint i)
{
    return shift_base(bank) + SHIFT_POINTS + SHIFT_POINT_WORDS * (i - 2u);
}

SHARED_FUNCTION float shift_density(__global const uint *vertices, uint stride, uint bank, uint item)
{
    return state_load_float(vertices, stride, shift_base(bank) + SHIFT_DENSITY, item);
}

SHARED_FUNCTION void shift_density_set(__global uint *vertices, uint stride, uint bank, uint item, float density)
{
    state_store_float(vertices, stride, shift_base(bank) + SHIFT_DENSITY, item, density);
}

/* MOVE_SHIFT of a proposal that is to be a shift. */
SHARED_FUNCTION uint shift_kind(__global const uint *paths, __global const uint *vertices, uint stride, uint item)
{
    return shift_density(vertices, stride, shift_bank(paths, stride, item), item) > 0.0f ? SHIFT_STEP | SHIFT_KEEPS
                                                                                         : SHIFT_STEP;
}

/* Replaces the coordinates of the direction at z_i in `numbers` by those that draw the direction to the kept vertex
 * z_{i+1}. False if no coordinates do. */
SHARED_FUNCTION bool shift_guide(const SceneView *scene, __global const uint *restrict paths,
                                 __global const uint *restrict vertices, uint item, uint i, const Vertex *vertex,
                                 Random4 *numbers)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->pass.stride, point = shift_point(shift_bank(paths, stride, item), i + 1u);
    Vec3 to = vec3_sub(state_load_vec3(vertices, stride, point, item), vertex->p);
    float square = vec3_length_squared(to);
    BsdfInverse inverse;
    if (!(square > 0.0f))
        return false;
    Vec3 wi = frame_to_local(vertex->frame, vec3_scale(to, 1.0f / float_sqrt(square)));
    if (!bsdf_invert(scene, &vertex->bsdf, vertex->wo, wi, random_float(numbers->x[0]), &inverse))
        return false;
    Random4 origin = {{0u, 0u, 0u, 0u}};
    if (inverse.base && frame->scene.guide_count > 0u)
        origin = light_guide_numbers(scene, vertex->p, vertex->frame, origin);
    numbers->x[1] = light_guide_bits(inverse.u.x) - origin.x[1];
    numbers->x[2] = light_guide_bits(inverse.u.y) - origin.x[2];
    return true;
}

/* Makes what shift_guide has found the coordinates of the direction at z_i, in a path of d segments. */
SHARED_FUNCTION void shift_numbers_store(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                         uint d, uint i, Random4 numbers)
{
    for (uint k = 0u; k < 2u; ++k)
        state_store(paths, frame->pass.stride, shift_number(frame, d, i, k), item, numbers.x[1u + k]);
}

/* Stores the density with which a vertex draws the world direction d. */
SHARED_FUNCTION void shift_drawn(const SceneView *scene, __global uint *restrict paths, uint item, const Vertex *vertex,
                                 Random4 numbers, Vec3 d)
{
    BsdfInverse inverse;
    bool found = bsdf_invert(scene, &vertex->bsdf, vertex->wo, frame_to_local(vertex->frame, d),
                             random_float(numbers.x[0]), &inverse);
    state_store_float(paths, scene->frame->pass.stride, BD_SHIFT_DENSITY, item, found ? inverse.pdf_w : 0.0f);
}

/* Whether the walk has hit the kept vertex at field `point` again. pdf_w: density of the direction that led there. */
SHARED_FUNCTION bool shift_found(__global const uint *vertices, uint stride, uint item, uint point, float pdf_w,
                                 const WalkHit *walk_hit)
{
    if (walk_hit->primitive != state_load(vertices, stride, point + SHIFT_PRIMITIVE, item) ||
        walk_hit->instance != state_load(vertices, stride, point + SHIFT_INSTANCE, item))
        return false;
    Vec3 p = walk_hit->surface.p, away = vec3_sub(p, state_load_vec3(vertices, stride, point, item));
    float size = float_max(vec3_max_abs(p), vec3_max_abs(walk_hit->ray.o));
    float distance = float_sqrt(walk_hit->distance2);
    float across = SHIFT_ULPS * FLOAT_EPSILON * (size + distance * (1.0f + 1.0f / pdf_w));
    float along = across / float_abs(vec3_dot(walk_hit->ray.d, walk_hit->surface.ng)),
          most = float_min(along, SHIFT_MOST * distance);
    return vec3_length_squared(away) <= most * most;
}

/* The camera walk has hit z_depth, depth > 1, which a shift keeps: stores it and its density. False if it is not the
 * vertex that it should be. */
SHARED_FUNCTION bool shift_hit(const SceneView *scene, __global const uint *restrict paths,
                               __global uint *restrict vertices, uint item, uint depth, const WalkHit *walk_hit)
{
    uint stride = scene->frame->pass.stride, bank = chain_bank(paths, stride, item, SIDE_CAMERA),
         point = shift_point(bank, depth);
    float before = depth == 2u ? 1.0f : shift_density(vertices, stride, bank, item), density = 0.0f;
    float pdf_w = state_load_float(paths, stride, BD_SHIFT_DENSITY, item);
    if (!walk_hit->missed && !walk_hit->scattered && !normal_is_fibre(scene, walk_hit->surface.ng)) {
        density =
            before * pdf_w * solid_angle_to_area(scene, walk_hit->ray.d, walk_hit->surface.ng, walk_hit->distance2);
        state_store_vec3(vertices, stride, point, item, walk_hit->surface.p);
        state_store(vertices, stride, point + SHIFT_INSTANCE, item, walk_hit->instance);
        state_store(vertices, stride, point + SHIFT_PRIMITIVE, item, walk_hit->primitive);
    }
    density = density > 0.0f && float_finite(density) ? density : 0.0f;
    shift_density_set(vertices, stride, bank, item, density);
    if ((chain_move(paths, stride, item, MOVE_SHIFT) & SHIFT_KEEPS) == 0u)
        return true;
    return density > 0.0f &&
           shift_found(vertices, stride, item, shift_point(shift_bank(paths, stride, item), depth), pdf_w, walk_hit);
}

/* Factor of the acceptance ratio; 0: reject the proposal. */
SHARED_FUNCTION float shift_ratio(__global const uint *restrict paths, __global const uint *restrict vertices,
                                  uint stride, uint item)
{
    uint shift = chain_move(paths, stride, item, MOVE_SHIFT);
    if (shift == 0u)
        return 1.0f;
    float proposed = shift_density(vertices, stride, chain_bank(paths, stride, item, SIDE_CAMERA), item);
    if ((shift & SHIFT_KEEPS) == 0u)
        return proposed > 0.0f ? 0.0f : 1.0f;
    return proposed / shift_density(vertices, stride, shift_bank(paths, stride, item), item);
}

#endif
