/* A ray that leaves a light, and the disc that rays from infinity come through. */
#ifndef TWINLIGHT_LIGHT_EMISSION_H
#define TWINLIGHT_LIGHT_EMISSION_H

#include "geometry/ray.h"
#include "layout/scene_view.h"
#include "math/warp.h"

/* A ray that leaves a light from p along w. Its throughput is radiance * cosine / (select_pdf * pdf_p * pdf_w). */
typedef struct LightEmission {
    Vec3 p;
    Vec3 ng; /* area: geometric normal on the side that w leaves. Zero for other lights */
    Vec3 w; /* unit */
    Vec3 radiance; /* area, infinite: radiance. at a point: intensity. distant: irradiance on a plane facing it */
    float pdf_p; /* area: per area of the light. infinite, distant: per area perpendicular to w. at a point: 1 */
    float pdf_w; /* per solid angle; distant: 1 */
    float cosine; /* area: |ng.w|; else 1 */
    uint delta_position; /* 1: a light at a point */
    uint delta_direction; /* 1: distant */
    uint infinite; /* 1: infinite, distant: p is not on the light */
    uint back; /* 1: w leaves the side of a two-sided area light that its shape's normal does not point to */
} LightEmission;

/* Radius of the disc: that of the scene's bounding sphere, plus what rounding of the centre and of points on the disc
 * may take away in a small scene far from (0,0,0). 0 if there is nothing to light. */
SHARED_FUNCTION float light_emit_disc_radius(const SceneView *scene)
{
    float radius = scene->frame->scene.world_radius;
    float size = vec3_max_abs(scene->frame->scene.world_center) + radius;
    return radius > 0.0f ? radius + 4.0f * FLOAT_EPSILON * size : 0.0f;
}

/* Density of points on the disc, 1 / (pi R^2); 0 if there is nothing to light. */
SHARED_FUNCTION float light_emit_pdf_disc(const SceneView *scene)
{
    float radius = light_emit_disc_radius(scene);
    return radius > 0.0f ? INV_PI / (radius * radius) : 0.0f;
}

/* Sets p and `infinite` for a ray from infinity that passes the point `passed` along w: it begins where it touches the
 * plane of light_emit_from_disc. */
SHARED_FUNCTION void light_emit_from_far(const SceneView *scene, Vec3 passed, LightEmission *emission)
{
    Vec3 from_center = vec3_sub(passed, scene->frame->scene.world_center);
    emission->p = vec3_mad(passed, -(light_emit_disc_radius(scene) + vec3_dot(from_center, emission->w)), emission->w);
    emission->infinite = 1u;
}

/* Sets p, pdf_p and `infinite` for light from infinity, given w. p is uniform on a disc perpendicular to w that touches
 * the bounding sphere on the side that w comes from. */
SHARED_FUNCTION bool light_emit_from_disc(const SceneView *scene, Vec2 u, LightEmission *emission)
{
    float radius = light_emit_disc_radius(scene);
    Vec2 disc = warp_disk_concentric(u);
    Vec3 offset = frame_to_world(frame_from_normal(emission->w), vec3(disc.x, disc.y, -1.0f));
    emission->p = vec3_mad(scene->frame->scene.world_center, radius, offset);
    emission->pdf_p = light_emit_pdf_disc(scene);
    emission->infinite = 1u;
    return emission->pdf_p > 0.0f && float_finite(emission->pdf_p);
}

#endif
