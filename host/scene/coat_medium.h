/* What stands for a scattering medium inside a coat over a conductor, for which bsdf/coated_conductor.h has no lobe. */
#ifndef TWINLIGHT_SCENE_COAT_MEDIUM_H
#define TWINLIGHT_SCENE_COAT_MEDIUM_H

#include "math/vec.h"

/* The layers: a smooth interface of index `eta` over the outside, a medium of extinction 1 per unit of length as
 * pbrt-v4 has it, and a smooth conductor. */
typedef struct CoatLayers {
    float eta; /* > 0 */
    float thickness; /* >= 0 */
    float g; /* mean cosine of scattering, in (-1, 1) */
    Vec3 albedo; /* of scattering, in [0, 1] */
    Vec3 metal_eta, metal_k; /* relative to the coat */
} CoatLayers;

/* A mix of two materials with the same interface that reflects as much light as the layers do. */
typedef struct CoatMix {
    float amount; /* of a coat without absorption over a diffuse base; the rest is a coat over the conductor */
    Vec3 reflectance; /* of the diffuse base */
    float thickness; /* of the absorbing medium over the conductor */
} CoatMix;

/* The fraction of diffuse light from outside that leaves the layers after scattering in the medium, by random walks. */
Vec3 coat_medium_scattered(const CoatLayers *layers);

/* The mix for these layers: its diffuse part reflects coat_medium_scattered, and the thickness is reduced so that light
 * that is not scattered keeps its share. amount = 0 if nothing is scattered. The result is the same on every
 * machine. */
CoatMix coat_medium_mix(const CoatLayers *layers);

#endif
