/* The values that travel between the parts of a path: rays, hits, surfaces, scattering and light samples. They live in
 * private memory; what must outlast a kernel is stored field by field (path/path_state.h). */
#ifndef TWINLIGHT_LAYOUT_PATH_TYPES_H
#define TWINLIGHT_LAYOUT_PATH_TYPES_H

#include "math/vec.h"

/* Points o + t d with 0 < t < t_max. d need not be a unit vector. */
typedef struct Ray {
    Vec3 o;
    Vec3 d;
    float t_max;
} Ray;

/* The closest intersection is the smallest (t, instance, primitive), in that order. primitive NONE: a miss. u and v:
 * barycentric weights of vertices b and c for a triangle, (u, v) of a patch or curve, 0 for quadrics. */
typedef struct Hit {
    float t;
    uint primitive;
    uint instance; /* NONE: the world's own geometry */
    float u, v;
} Hit;

/* A point on a surface, in world space. */
typedef struct Surface {
    Vec3 p;
    Vec3
        ng; /* geometric normal, unit, on the side that pbrt calls outside (an area light shines to this side); on a curve
                FIBRE_NORMAL times the unit tangent (geometry/curve.h) */
    Vec3 ns; /* shading normal, unit; in the hemisphere of ng before bump mapping */
    Vec3 dpdu, dpdv; /* shading tangents; only in scenes with FEATURE_TANGENTS */
    Vec2 uv; /* texture coordinates; of quadrics only in scenes with FEATURE_TEXTURE or FEATURE_HAIR */
    float u, v; /* as in Hit: where on the primitive */
    uint shape;
} Surface;

/* Which quantity a path carries: radiance from the light to the camera is scaled by eta^2 at a refraction, importance
 * is not (Veach 1997, section 5.2). A camera path traces radiance. */
#define TRANSPORT_RADIANCE 0u
#define TRANSPORT_IMPORTANCE 1u

/* A material evaluated at a surface: every texture looked up, mix decided, roughness remapped.
 * kind: MATERIAL_DIFFUSE ... MATERIAL_HAIR, whose members are in bsdf/hair.h. */
typedef struct Bsdf {
    uint kind;
    uint media; /* on both sides of the vertex (geometry/medium.h); 0 in scenes without media */
    uint flags; /* BSDF_*; from BSDF_BASE_SHIFT on the alphas of a coated conductor (bsdf/coated_conductor.h) */
    Vec3 color0; /* diffuse, coated diffuse, transmission: reflectance. conductor: eta or reflectance. coated conductor:
                    eta, relative to the coat */
    Vec3 color1; /* conductor: k. diffuse transmission: transmittance. coated diffuse: thickness, round trip
                    (bsdf/coat.h). coated conductor: k, relative to the coat */
    float alpha_x, alpha_y; /* GGX; below ALPHA_DELTA the lobe is a delta */
    float eta; /* inside over outside of the surface */
    uint coat_table; /* first float in `lookup`, NONE without; that of bsdf/coated_conductor.h has more */
} Bsdf;

#define BSDF_REFLECTANCE 0x1u /* conductor given by reflectance at normal incidence */
#define BSDF_SMOOTH 0x2u /* every lobe is a delta, so lights need not be sampled */
#define BSDF_ROUGH 0x4u /* the specular lobe is a microfacet lobe, not a delta */
#define BSDF_FIBRE 0x8u /* of a point on a curve (bsdf/fibre.h) */

#define ALPHA_DELTA 1e-3f

/* What draws a direction from a Bsdf: u_lobe chooses the lobe; u_base draws the direction in a cosine lobe, u in any
 * other; all in [0,1). transport: TRANSPORT_*. */
typedef struct BsdfDraw {
    float u_lobe;
    Vec2 u, u_base;
    uint transport;
} BsdfDraw;

/* A direction drawn from a Bsdf, in the shading frame (z = ns, directions point away from the surface). weight, the
 * factor of the throughput, is f |cos wi| / pdf_w. For a delta lobe, pdf_w is the probability of having chosen the lobe
 * (densities of deltas never enter an MIS ratio). pdf_rev_w: density of drawing wo from wi. */
typedef struct BsdfSample {
    Vec3 wi;
    Vec3 weight;
    float pdf_w;
    float pdf_rev_w;
    uint delta; /* 1: a delta lobe */
    uint transmitted; /* 1: wi is on the other side than wo */
    float eta; /* of a refraction: index on wi's side over index on wo's side; else 1 */
} BsdfSample;

/* f(wo, wi) |cos wi| and the densities of wi given wo and of wo given wi; delta lobes count as zero. */
typedef struct BsdfValue {
    Vec3 f_cos;
    float pdf_w;
    float pdf_rev_w;
} BsdfValue;

/* Light from one light that arrives at a reference point. */
typedef struct LightSample {
    Vec3 wi; /* unit, from the reference point to the light */
    Vec3 p; /* point on the light; unused when `infinite` */
    Vec3 ng; /* its geometric normal; 0: not an area light */
    Vec3 radiance; /* arriving; for lights without extent already divided by the squared distance */
    float pdf_w; /* solid-angle density given the light; 1 for lights without extent */
    float pdf_emit; /* density of light subpaths (light/emit.h): area lights: per area at p; infinite: from wi */
    uint delta; /* 1: lights of LIGHT_LIST_DELTA, invisible area lights: no sampled direction can hit it */
    uint infinite; /* 1: at infinity; trace along wi without end */
} LightSample;

#endif
