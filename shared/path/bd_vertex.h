/* Vertices of a bidirectional path as they are stored, and densities between vertices. */
#ifndef TWINLIGHT_PATH_BD_VERTEX_H
#define TWINLIGHT_PATH_BD_VERTEX_H

#include "bsdf/bsdf_state.h"
#include "camera/view.h"
#include "geometry/ray.h"
#include "geometry/surface.h"
#include "light/aim.h"
#include "light/light.h"
#include "path/bd_state.h"

/* First field of vertex i of a side: first y_0, y_1 ..., then z_1, z_2 ... */
SHARED_FUNCTION uint vertex_base(__global const FrameParams *frame, uint side, uint i)
{
    return (side == SIDE_LIGHT ? i : frame->path.max_depth + i - 1u) * VERTEX_WORDS;
}

SHARED_FUNCTION uint density_base(__global const FrameParams *frame, uint side, uint i)
{
    return (side == SIDE_LIGHT ? i : frame->path.max_depth + i - 1u) * DENSITY_WORDS;
}

/* A stored vertex as connections need it. */
typedef struct Vertex {
    Vec3 p, ng;
    Vec3 wo; /* in the frame */
    Vec3 beta;
    float back; /* factor from a solid-angle density here to an area density at the vertex before (walk_back) */
    Frame frame;
    Bsdf bsdf;
} Vertex;

/* Stores what the next segment of a walk needs to know of the vertex that it leaves. */
SHARED_FUNCTION void vertex_place_store(__global uint *vertices, uint stride, uint base, uint item,
                                        const Vertex *vertex)
{
    state_store_vec3(vertices, stride, base + VERTEX_POINT, item, vertex->p);
    state_store_vec3(vertices, stride, base + VERTEX_NG, item, vertex->ng);
}

SHARED_FUNCTION void vertex_store(const SceneView *scene, __global uint *vertices, uint stride, uint base, uint item,
                                  const Vertex *vertex)
{
    vertex_place_store(vertices, stride, base, item, vertex);
    frame_store(vertices, stride, base + VERTEX_FRAME_N, item, vertex->frame);
    state_store_vec3(vertices, stride, base + VERTEX_WO, item, vertex->wo);
    state_store_vec3(vertices, stride, base + VERTEX_BETA, item, vertex->beta);
    state_store_float(vertices, stride, base + VERTEX_BACK, item, vertex->back);
    bsdf_store(scene, vertices, stride, base + VERTEX_BSDF_KIND, item, &vertex->bsdf);
}

SHARED_FUNCTION Vertex vertex_load(const SceneView *scene, __global const uint *vertices, uint stride, uint base,
                                   uint item)
{
    Vertex vertex;
    vertex.p = state_load_vec3(vertices, stride, base + VERTEX_POINT, item);
    vertex.ng = state_load_vec3(vertices, stride, base + VERTEX_NG, item);
    vertex.frame = frame_load(vertices, stride, base + VERTEX_FRAME_N, item);
    vertex.wo = state_load_vec3(vertices, stride, base + VERTEX_WO, item);
    vertex.beta = state_load_vec3(vertices, stride, base + VERTEX_BETA, item);
    vertex.back = state_load_float(vertices, stride, base + VERTEX_BACK, item);
    vertex.bsdf = bsdf_load(scene, vertices, stride, base + VERTEX_BSDF_KIND, item);
    return vertex;
}

/* Whether the stored vertex has delta lobes alone, so that nothing can be connected with it. */
SHARED_FUNCTION bool vertex_smooth(__global const uint *vertices, uint stride, uint base, uint item)
{
    return (state_load(vertices, stride, base + VERTEX_BSDF_FLAGS, item) & BSDF_SMOOTH) != 0u;
}

/* |cosine| between the unit direction w and the normal n of a vertex; 1 for a vertex in a medium, whose normal is 0. A
 * curve faces w. */
SHARED_FUNCTION float vertex_cosine(const SceneView *scene, Vec3 w, Vec3 n)
{
    float cosine = normal_is_fibre(scene, n) ? fibre_cosine(w, n) : float_abs(vec3_dot(w, n));
    return SCENE_HAS(scene, FEATURE_SCATTERING) && vec3_is_zero(n) ? 1.0f : cosine;
}

/* |cosine| / distance^2 between the unit direction w and the normal n at the far end: turns a density per solid angle
 * into one per area there; at a vertex in a medium, together with the density of the distance, into one per volume. */
SHARED_FUNCTION float solid_angle_to_area(const SceneView *scene, Vec3 w, Vec3 n, float distance2)
{
    return vertex_cosine(scene, w, n) / distance2;
}

/* Factor that turns a solid-angle density at a vertex into an area density at the one before it, which is d away and
 * has the normal `ng` or, with flags EMITTER_*, is y_0. distance2: square of the length of d. At the position of a
 * delta light no strategy uses that density. */
SHARED_FUNCTION float walk_back(const SceneView *scene, Vec3 d, float distance2, Vec3 ng, uint emitter_flags)
{
    if ((emitter_flags & EMITTER_INFINITE) != 0u)
        return 1.0f;
    if (!(distance2 > 0.0f))
        return 0.0f;
    if ((emitter_flags & EMITTER_DELTA) != 0u)
        return 1.0f / distance2;
    return solid_angle_to_area(scene, vec3_scale(d, 1.0f / float_sqrt(distance2)), ng, distance2);
}

/* Factor by which shading normals make a BSDF differ from its adjoint; paths from the light carry it (Veach 1997,
 * section 5.3.2). Not for vertices in a medium; 1 on a curve, whose BSDF is adjoint as it is (bsdf/fibre.h). wo and wi:
 * in world space; cosine_o and cosine_i: their cosines with the shading normal. */
SHARED_FUNCTION float adjoint_factor(const SceneView *scene, Vec3 ng, Vec3 wo, Vec3 wi, float cosine_o, float cosine_i)
{
    if (normal_is_fibre(scene, ng))
        return 1.0f;
    float numerator = float_abs(cosine_o) * float_abs(vec3_dot(wi, ng));
    float denominator = float_abs(vec3_dot(wo, ng)) * float_abs(cosine_i);
    return denominator > 0.0f ? numerator / denominator : 0.0f;
}

/* Densities of a delta lobe's directions. They are probabilities, and only the ratio of the two directions means
 * anything. Reflection and refraction preserve n^2 times the projected solid angle, so relative to that measure the
 * same delta appears in both directions and cancels; the conversion to solid angle remains. */
SHARED_FUNCTION void delta_densities(const BsdfSample *sample, Vec3 wo, float *forward, float *reverse)
{
    *forward = sample->pdf_w * (float_abs(sample->wi.z) * (sample->eta * sample->eta));
    *reverse = sample->pdf_rev_w * float_abs(wo.z);
}

/* Density with which the point (p, ng) on the light, given the light, is drawn for `from` (s = 1), over that of
 * emitting from it. They differ for spheres, which are sampled in the cone that `from` sees. w: unit, from `from` to
 * p. */
SHARED_FUNCTION float light_connect_ratio(const SceneView *scene, uint light, Vec3 from, Vec3 w, float distance2,
                                          const Surface *point)
{
    if (light_kind(scene->lights + light) != LIGHT_AREA)
        return 1.0f;
    float emitted = light_emit_pdf_p(scene, light, point);
    float drawn = area_light_pdf_w(scene, light, from, w, point) * solid_angle_to_area(scene, w, point->ng, distance2);
    return emitted > 0.0f ? drawn / emitted : 0.0f;
}

/* Density with which the direction d (unit) to a light at infinity, given the light, is drawn at `from` (s = 1), over
 * that of light subpaths that come from there. They differ for lights with a portal, of which `from` sees a window. */
SHARED_FUNCTION float environment_connect_ratio(const SceneView *scene, uint light, Vec3 from, Vec3 d)
{
    if (!light_has_portal(scene, light))
        return 1.0f;
    float emitted = environment_pdf_w(scene, light, d);
    return emitted > 0.0f ? environment_sample_pdf_w(scene, light, from, d) / emitted : 0.0f;
}

/* Whether the light of a light subpath reaches its first vertex p along the ray: if it has a portal, through that. */
SHARED_FUNCTION bool emitter_reaches(const SceneView *scene, __global const uint *paths, uint item, const Ray *ray,
                                     Vec3 p)
{
    uint light = state_load(paths, scene->frame->pass.stride, BD_EMITTER, item);
    return !light_has_portal(scene, light) || environment_reaches(scene, light, p, vec3_negate(ray->d));
}

/* BD_CONNECT of y_0, stored at `base`, for y_1. */
SHARED_FUNCTION float emitter_connect_ratio(const SceneView *scene, __global const uint *paths,
                                            __global const uint *vertices, uint item, uint base, const Vertex *y)
{
    uint stride = scene->frame->pass.stride, light = state_load(paths, stride, BD_EMITTER, item);
    float choice = light_choice_ratio(scene, light, y->p, y->ng);
    if (light_has_portal(scene, light)) {
        Vec3 travel = state_load_vec3(vertices, stride, base + VERTEX_POINT, item);
        return choice * environment_connect_ratio(scene, light, y->p, vec3_negate(travel));
    }
    if (!SCENE_HAS(scene, FEATURE_SPHERE) || light_kind(scene->lights + light) != LIGHT_AREA ||
        scene->primitives[scene->lights[light].primitive].shape_and_kind >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_SPHERE)
        return choice;
    Surface point = {0}; /* spheres read no more than this */
    point.p = state_load_vec3(vertices, stride, base + VERTEX_POINT, item);
    point.ng = state_load_vec3(vertices, stride, base + VERTEX_NG, item);
    Vec3 d = vec3_sub(point.p, y->p);
    float distance2 = vec3_length_squared(d);
    if (!(distance2 > 0.0f))
        return choice;
    Vec3 w = vec3_scale(d, 1.0f / float_sqrt(distance2));
    return choice * light_connect_ratio(scene, light, y->p, w, distance2, &point);
}

/* Area density with which the walk has made the point that it has just hit, where the geometric normal is ng. first: by
 * the camera's first ray. */
SHARED_FUNCTION float walk_density(const SceneView *scene, const Ray *ray, Vec3 ng, float distance2, bool first,
                                   uint flags, float pdf)
{
    if (first)
        return view_pdf(scene, ray->o, ray->d, float_sqrt(distance2)) * vertex_cosine(scene, ray->d, ng);
    if ((flags & WALK_PARALLEL) != 0u)
        return pdf * vertex_cosine(scene, ray->d, ng);
    return pdf * solid_angle_to_area(scene, ray->d, ng, distance2);
}

#endif
