/* What media do to a path between two of its vertices. The path's throughput is multiplied by the transmittance and, in
 * scenes that scatter, divided by the density of the distance that was drawn; at a vertex in a medium it is multiplied
 * by the scattering coefficient. That density belongs to the density of the vertex: it is a probability for a vertex on
 * a surface, and a density per length for one in a medium. */
#ifndef TWINLIGHT_PATH_PASSAGE_H
#define TWINLIGHT_PATH_PASSAGE_H

#include "bsdf/phase.h"
#include "geometry/media_walk.h"

typedef struct Passage {
    Vec3 weight; /* factor of the throughput */
    float pdf; /* of the distance, in the direction of the ray */
    OpticalDepth depth;
    uint medium; /* at the far end */
} Passage;

/* The same without media. */
SHARED_FUNCTION Passage passage_free(void)
{
    Passage passage = {0};
    passage.weight = vec3_splat(1.0f);
    passage.pdf = 1.0f;
    return passage;
}

/* How the ray of a path has reached its hit. scattered: that is in a medium, at p, which is read only then. */
SHARED_FUNCTION_APART Passage passage_load(const SceneView *scene, __global const uint *hits, uint stride, uint item,
                                           bool scattered, Vec3 p)
{
    Passage passage = passage_free();
    if (!SCENE_HAS(scene, FEATURE_MEDIUM))
        return passage;
    passage.depth = optical_depth_load(hits, stride, HIT_DEPTH, item);
    passage.medium = state_load(hits, stride, HIT_MEDIUM, item);
    passage.weight = transmittance(passage.depth.all);
    if (!SCENE_HAS(scene, FEATURE_SCATTERING))
        return passage;
    if (scattered)
        passage.weight = vec3_mul(passage.weight, medium_scattering(scene, passage.medium, p));
    passage.pdf =
        scattered ? scattering_density(scene, &passage.depth, passage.medium, p) : passing_probability(&passage.depth);
    passage.weight = vec3_scale(passage.weight, passage.pdf > 0.0f ? 1.0f / passage.pdf : 0.0f);
    return passage;
}

/* What a shadow ray has gone through: no distance was drawn. */
SHARED_FUNCTION_APART Passage passage_shadow(const SceneView *scene, __global const uint *shadows, uint stride,
                                             uint item)
{
    Passage passage = passage_free();
    if (!SCENE_HAS(scene, FEATURE_MEDIUM))
        return passage;
    passage.depth = optical_depth_load(shadows, stride, SHADOW_DEPTH, item);
    passage.weight = transmittance(passage.depth.all);
    if (SCENE_HAS(scene, FEATURE_SCATTERING))
        passage.pdf = passing_probability(&passage.depth);
    return passage;
}

/* Density of the distance with which a vertex at either end of the passage is reached from the other. p, ng and medium:
 * of the vertex that is reached; a vertex in a medium has ng 0. */
SHARED_FUNCTION_APART float passage_density(const SceneView *scene, Passage passage, Vec3 p, Vec3 ng, uint medium)
{
    if (!SCENE_HAS(scene, FEATURE_SCATTERING))
        return 1.0f;
    return vec3_is_zero(ng) ? scattering_density(scene, &passage.depth, medium, p)
                            : passing_probability(&passage.depth);
}

/* The Bsdf of a vertex in a medium. */
SHARED_FUNCTION_APART Bsdf medium_bsdf(const SceneView *scene, uint medium)
{
    Bsdf bsdf = phase_bsdf(scene->media[medium].g);
    bsdf.media = media_bits(medium, medium);
    return bsdf;
}

/* Where the ray whose last part is `ray` was scattered. */
SHARED_FUNCTION Vec3 scatter_position(const Ray *ray, Hit hit)
{
    return vec3_mad(ray->o, hit.t, ray->d);
}

#endif
