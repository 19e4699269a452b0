/* Participating media: which one is on which side of a surface, and what a ray loses between two points. */
#ifndef TWINLIGHT_GEOMETRY_MEDIUM_H
#define TWINLIGHT_GEOMETRY_MEDIUM_H

#include "geometry/medium_grid.h"
#include "math/elementary.h"

/* ---- the media at a point ---------------------------------------------------------------------------------------- */

/* The numbers of the media inside and outside of a surface in one word: the upper bits of Shape.flags and, of a vertex,
 * Bsdf.media. A vertex in a medium has that medium on both sides. */
#define MEDIA_INSIDE_SHIFT 8
#define MEDIA_OUTSIDE_SHIFT 20
#define MEDIA_NUMBER_MASK (MEDIA_MAX - 1u)
#define MEDIA_BITS 0xffffff00u

SHARED_FUNCTION uint media_bits(uint inside, uint outside)
{
    return inside << MEDIA_INSIDE_SHIFT | outside << MEDIA_OUTSIDE_SHIFT;
}

SHARED_FUNCTION uint media_inside(uint bits)
{
    return bits >> MEDIA_INSIDE_SHIFT & MEDIA_NUMBER_MASK;
}

SHARED_FUNCTION uint media_outside(uint bits)
{
    return bits >> MEDIA_OUTSIDE_SHIFT & MEDIA_NUMBER_MASK;
}

/* Whether the surface separates two media. */
SHARED_FUNCTION bool media_differ(uint bits)
{
    return media_inside(bits) != media_outside(bits);
}

/* The media beside a surface of `shape` that a ray in `medium` has hit, as bits: the shape's own or, if it separates
 * none, those of the ray. 0 in scenes without media. */
SHARED_FUNCTION uint media_at(const SceneView *scene, uint shape, uint medium)
{
    if (!SCENE_HAS(scene, FEATURE_MEDIUM))
        return 0u;
    uint bits = scene->shapes[shape].flags & MEDIA_BITS;
    return media_differ(bits) ? bits : media_bits(medium, medium);
}

/* The medium that a ray enters which leaves a vertex along w. ng: geometric normal; as in pbrt-v4, inside is where it
 * does not point to. */
SHARED_FUNCTION uint medium_towards(uint bits, Vec3 ng, Vec3 w)
{
    return vec3_dot(w, ng) > 0.0f ? media_outside(bits) : media_inside(bits);
}

/* The same in any scene; 0 without media. */
SHARED_FUNCTION uint medium_leaving(const SceneView *scene, uint bits, Vec3 ng, Vec3 w)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM) ? medium_towards(bits, ng, w) : 0u;
}

/* ---- extinction -------------------------------------------------------------------------------------------------- */

/* Optical depths of a part of a ray: `all` of all media, `scattering` of those that scatter light, in which alone a ray
 * may be scattered. */
typedef struct OpticalDepth {
    Vec3 all, scattering;
} OpticalDepth;

/* coefficient * distance, where either may be infinite or 0; 0 times infinity is 0. */
SHARED_FUNCTION float attenuation(float coefficient, float distance)
{
    return coefficient > 0.0f ? coefficient * distance : 0.0f;
}

SHARED_FUNCTION Vec3 attenuations(Vec3 coefficients, Vec3 distances)
{
    return vec3(attenuation(coefficients.x, distances.x), attenuation(coefficients.y, distances.y),
                attenuation(coefficients.z, distances.z));
}

/* Whether the medium is homogeneous or a grid's. */
SHARED_FUNCTION bool medium_has_grid(const SceneView *scene, uint medium)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM_GRID) && scene->media[medium].grid != 0u;
}

/* Extinction and scattering coefficients at the point p of a medium. */
SHARED_FUNCTION Vec3 medium_extinction(const SceneView *scene, uint medium, Vec3 p)
{
    Vec3 extinction = scene->media[medium].extinction;
    if (medium_has_grid(scene, medium))
        extinction = vec3_mul(extinction, grid_factors(scene, scene->media[medium].grid - 1u, p, false));
    return extinction;
}

SHARED_FUNCTION Vec3 medium_scattering(const SceneView *scene, uint medium, Vec3 p)
{
    Vec3 scattering = scene->media[medium].scattering;
    if (medium_has_grid(scene, medium))
        scattering = vec3_mul(scattering, grid_factors(scene, scene->media[medium].grid - 1u, p, true));
    return scattering;
}

/* Whether light can be scattered in the medium. */
SHARED_FUNCTION bool medium_scatters(__global const Medium *medium)
{
    return !vec3_is_zero(medium->scattering);
}

/* Adds what a part of a ray in a medium contributes. lengths: of each colour, its length in a homogeneous medium, of
 * others the integral of the grid's factor. */
SHARED_FUNCTION void optical_depth_add(const SceneView *scene, OpticalDepth *depth, uint medium, Vec3 lengths)
{
    Vec3 more = attenuations(scene->media[medium].extinction, lengths);
    depth->all = vec3_add(depth->all, more);
    if (SCENE_HAS(scene, FEATURE_SCATTERING) && medium_scatters(scene->media + medium))
        depth->scattering = vec3_add(depth->scattering, more);
}

/* exp(-depth) of each component. */
SHARED_FUNCTION Vec3 transmittance(Vec3 depth)
{
    return vec3(float_exp(-depth.x), float_exp(-depth.y), float_exp(-depth.z));
}

/* ---- distances --------------------------------------------------------------------------------------------------- */

/* A ray's distance is drawn with one number: a colour channel, and the optical depth of that channel at which the ray
 * is scattered. (Chiang, Kutz and Burley, "Practical and controllable subsurface scattering for production path
 * tracing", 2016, section 2.) So a distance has the mean density of the three channels. */

/* The probability of reaching the end of a ray unscattered. */
SHARED_FUNCTION float passing_probability(const OpticalDepth *depth)
{
    return vec3_mean(transmittance(depth->scattering));
}

/* The density, per length, of being scattered at its end, the point p of `medium`. */
SHARED_FUNCTION float scattering_density(const SceneView *scene, const OpticalDepth *depth, uint medium, Vec3 p)
{
    return vec3_mean(vec3_mul(medium_extinction(scene, medium, p), transmittance(depth->scattering)));
}

#endif
