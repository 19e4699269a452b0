/* Shifts: steps across the film that keep the rest of the path where it is.
 *
 * With a step of the numbers that draw directions, a path that has met the lobes of several glossy or curved surfaces
 * at their peaks loses them: what turns the ray at z_1 turns it more and more at every vertex behind, so that such a
 * chain, which carries the more the rarer it is, stays where it is, a single dot. A shift moves film and lens, by which
 * z_1 moves, and takes those numbers at z_1 that draw the direction to z_2, and those at z_2 that draw the one to z_3,
 * where both stay. From z_3 on everything is as it was.
 *
 * The map from one path's numbers to the other's changes volumes: those that draw z_2 by the density of z_2 per area,
 * and so with z_3. The ratio of the densities of both paths goes into the rule of acceptance (Green, "Reversible jump
 * Markov chain Monte Carlo computation and Bayesian model determination", 1995). Such maps that connect again with the
 * vertices of another path are known from gradients: Kettunen et al., "Gradient-domain path tracing", 2015. A path can
 * be shifted where z_2 exists and z_1, and where z_3 exists z_2, have lobes that draw any direction near theirs. A path
 * that cannot makes a usual step of the camera subpath instead, but none to a path that can, which never comes back. */
#ifndef TWINLIGHT_CHAIN_SHIFT_H
#define TWINLIGHT_CHAIN_SHIFT_H

#include "bsdf/bsdf.h"
#include "chain/chain_numbers.h"
#include "path/bd_walk.h"

/* Both ways of a shift have to find the same vertices, or chains gather at those that only one way leads to. So a
 * vertex that stays has to be of the primitive that it was of, not of a neighbour that hides it, and no further from
 * where it was than rounding can leave it. That is so many times what floats resolve of coordinates, by which rays
 * begin beside it, and of directions, whose numbers are 2^-23 apart: the less densely they draw it, the further apart
 * they are. In a glossy hall, a door ajar and beside beaten metal 99.5 of 100 vertices that are found are off by less
 * than a quarter of this. */
#define SHIFT_ULPS 32.0f

/* And no more than so much of the last segment: beyond, floats do not resolve the lobe. */
#define SHIFT_MOST 1e-3f

SHARED_FUNCTION uint shift_base(uint bank)
{
    return CHAIN_SHIFTS + bank * SHIFT_WORDS;
}

/* The bank of the current path. */
SHARED_FUNCTION uint shift_bank(__global const uint *paths, uint stride, uint t)
{
    return chain_move(paths, stride, t, MOVE_BANKS) >> SIDE_CAMERA & 1u;
}

/* Field of z_i, 2 <= i <= 3, in a bank. */
SHARED_FUNCTION uint shift_point(uint bank, uint i)
{
    return shift_base(bank) + SHIFT_POINTS + SHIFT_POINT_WORDS * (i - 2u);
}

SHARED_FUNCTION float shift_density(__global const uint *vertices, uint stride, uint bank, uint t)
{
    return state_load_float(vertices, stride, shift_base(bank) + SHIFT_DENSITY, t);
}

SHARED_FUNCTION void shift_density_set(__global uint *vertices, uint stride, uint bank, uint t, float density)
{
    state_store_float(vertices, stride, shift_base(bank) + SHIFT_DENSITY, t, density);
}

/* MOVE_SHIFT of a proposal that is to be a shift. */
SHARED_FUNCTION uint shift_kind(__global const uint *paths, __global const uint *vertices, uint stride, uint t)
{
    return shift_density(vertices, stride, shift_bank(paths, stride, t), t) > 0.0f ? SHIFT_STEP | SHIFT_KEEPS
                                                                                   : SHIFT_STEP;
}

/* numbers: the coordinates of z_i, of a path of d segments. They become those that draw the direction to where the next
 * vertex is. */
SHARED_FUNCTION bool shift_guide(const SceneView *scene, __global uint *restrict paths,
                                 __global const uint *restrict vertices, uint t, uint d, uint i, const Vertex *vertex,
                                 Random4 *numbers)
{
    __global const FrameParams *frame = scene->frame;
    uint stride = frame->stride, point = shift_point(shift_bank(paths, stride, t), i + 1u);
    Vec3 to = vec3_sub(state_load_vec3(vertices, stride, point, t), vertex->p);
    float square = vec3_length_squared(to);
    BsdfInverse inverse;
    if (!(square > 0.0f))
        return false;
    Vec3 wi = frame_to_local(vertex->frame, vec3_scale(to, 1.0f / float_sqrt(square)));
    if (!bsdf_invert(scene, &vertex->bsdf, vertex->wo, wi, random_float(numbers->x[0]), &inverse))
        return false;
    Random4 origin = {{0u, 0u, 0u, 0u}};
    if (inverse.base && frame->guide_count > 0u)
        origin = light_guide_numbers(scene, vertex->p, vertex->frame, origin);
    numbers->x[1] = light_guide_bits(inverse.u.x) - origin.x[1];
    numbers->x[2] = light_guide_bits(inverse.u.y) - origin.x[2];
    for (uint k = 0u; k < 2u; ++k)
        state_store(paths, stride, shift_number(frame, d, i, k), t, numbers->x[1u + k]);
    return true;
}

/* Notes how densely a vertex draws the world direction d. */
SHARED_FUNCTION void shift_drawn(const SceneView *scene, __global uint *restrict paths, uint t, const Vertex *vertex,
                                 Random4 numbers, Vec3 d)
{
    BsdfInverse inverse;
    bool found = bsdf_invert(scene, &vertex->bsdf, vertex->wo, frame_to_local(vertex->frame, d),
                             random_float(numbers.x[0]), &inverse);
    state_store_float(paths, scene->frame->stride, BD_SHIFT_DENSITY, t, found ? inverse.pdf_w : 0.0f);
}

/* Whether the walk that draws directions so densely has met the vertex at `point` again. */
SHARED_FUNCTION bool shift_found(__global const uint *vertices, uint stride, uint t, uint point, float pdf_w,
                                 const WalkHit *walk_hit)
{
    if (walk_hit->primitive != state_load(vertices, stride, point + SHIFT_PRIMITIVE, t) ||
        walk_hit->instance != state_load(vertices, stride, point + SHIFT_INSTANCE, t))
        return false;
    Vec3 p = walk_hit->surface.p, away = vec3_sub(p, state_load_vec3(vertices, stride, point, t));
    float size = float_max(vec3_max_abs(p), vec3_max_abs(walk_hit->ray.o));
    float distance = float_sqrt(walk_hit->distance2);
    float across = SHIFT_ULPS * FLOAT_EPSILON * (size + distance * (1.0f + 1.0f / pdf_w));
    float along = across / float_abs(vec3_dot(walk_hit->ray.d, walk_hit->surface.ng)),
          most = float_min(along, SHIFT_MOST * distance);
    return vec3_length_squared(away) <= most * most;
}

/* The camera's walk has met `walk_hit` as z_depth, depth > 1, which a shift keeps: notes what it is and its density.
 * False: it is not what it has to be. */
SHARED_FUNCTION bool shift_hit(__global const FrameParams *frame, __global const uint *restrict paths,
                               __global uint *restrict vertices, uint t, uint depth, const WalkHit *walk_hit)
{
    uint stride = frame->stride, bank = chain_bank(paths, stride, t, SIDE_CAMERA), point = shift_point(bank, depth);
    float before = depth == 2u ? 1.0f : shift_density(vertices, stride, bank, t), density = 0.0f;
    float pdf_w = state_load_float(paths, stride, BD_SHIFT_DENSITY, t);
    if (!walk_hit->missed) {
        density = before * pdf_w * solid_angle_to_area(walk_hit->ray.d, walk_hit->surface.ng, walk_hit->distance2);
        state_store_vec3(vertices, stride, point, t, walk_hit->surface.p);
        state_store(vertices, stride, point + SHIFT_INSTANCE, t, walk_hit->instance);
        state_store(vertices, stride, point + SHIFT_PRIMITIVE, t, walk_hit->primitive);
    }
    density = density > 0.0f && float_finite(density) ? density : 0.0f;
    shift_density_set(vertices, stride, bank, t, density);
    if ((chain_move(paths, stride, t, MOVE_SHIFT) & SHIFT_KEEPS) == 0u)
        return true;
    return density > 0.0f &&
           shift_found(vertices, stride, t, shift_point(shift_bank(paths, stride, t), depth), pdf_w, walk_hit);
}

/* What the ratio of f is to be multiplied with; 0: refuse the proposal. */
SHARED_FUNCTION float shift_ratio(__global const uint *restrict paths, __global const uint *restrict vertices,
                                  uint stride, uint t)
{
    uint shift = chain_move(paths, stride, t, MOVE_SHIFT);
    if (shift == 0u)
        return 1.0f;
    float proposed = shift_density(vertices, stride, chain_bank(paths, stride, t, SIDE_CAMERA), t);
    if ((shift & SHIFT_KEEPS) == 0u)
        return proposed > 0.0f ? 0.0f : 1.0f;
    return proposed / shift_density(vertices, stride, shift_bank(paths, stride, t), t);
}

#endif
