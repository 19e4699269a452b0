/* Connections of bidirectional paths: their contributions, and the densities that only a connection determines. */
#ifndef TWINLIGHT_PATH_BD_CONNECT_H
#define TWINLIGHT_PATH_BD_CONNECT_H

#include "camera/film_splat.h"
#include "camera/splat_offset.h"
#include "camera/view.h"
#include "layout/diagnostics.h"
#include "path/bd_random.h"
#include "path/bd_walk.h"
#include "path/strategy.h"

/* A connection whose visibility is not known yet. */
typedef struct Connection {
    Vec3 contribution; /* unweighted */
    Ray shadow;
    uint medium; /* in which the shadow ray begins */
    Vec2 film; /* t = 1: film position of y */
    uint target; /* t = 1: pixel of the splat */
    uint target_offset; /* in the filter of that pixel (camera/splat_offset.h) */
    float target_weight; /* of the pixel filter */
    float copies; /* t = 1: CameraConnection.copies, a factor of the contribution; else 1 */
    StrategyEnds ends;
} Connection;

/* f(wo, wi) |cos wi| at a vertex of the light's side, with the factor of shading normals. */
SHARED_FUNCTION BsdfValue vertex_eval_light(const SceneView *scene, const Vertex *vertex, Vec3 wi)
{
    Vec3 wi_frame = frame_to_local(vertex->frame, wi);
    BsdfValue value = bsdf_eval(scene, &vertex->bsdf, vertex->wo, wi_frame, TRANSPORT_IMPORTANCE);
    if (!vec3_is_zero(value.f_cos) && !bsdf_is_phase(scene, &vertex->bsdf))
        value.f_cos =
            vec3_scale(value.f_cos, adjoint_factor(scene, vertex->ng, frame_to_world(vertex->frame, vertex->wo), wi,
                                                   vertex->wo.z, wi_frame.z));
    return value;
}

/* t = 1: connects y = y_{s-1}, s >= 2, to a point on the lens. random: lens. */
SHARED_FUNCTION_CALLED bool connect_camera(const SceneView *scene, const Vertex *y, Random4 random,
                                           Connection *connection)
{
    CameraConnection camera;
    if ((y->bsdf.flags & BSDF_SMOOTH) != 0u ||
        !view_connect(scene, y->p, vec2(random_float(random.x[0]), random_float(random.x[1])), &camera))
        return false;
    connection->film = camera.film;
    connection->copies = camera.copies;
    BsdfValue f = vertex_eval_light(scene, y, camera.wi);
    connection->contribution = vec3_scale(vec3_mul(y->beta, f.f_cos), camera.pdf * camera.copies);
    connection->shadow = connecting_ray(scene, y->p, y->ng, camera.p, vec3_splat(0.0f));
    connection->medium = medium_leaving(scene, y->bsdf.media, y->ng, camera.wi);
    connection->ends.camera_y1 = camera.pdf * vertex_cosine(scene, camera.wi, y->ng);
    connection->ends.camera_y2 = f.pdf_rev_w * y->back;
    return true;
}

/* s = 1: connects z = z_{t-1}, t >= 2, to a point drawn on a light. random: of light_choose_point. */
SHARED_FUNCTION_CALLED bool connect_light(const SceneView *scene, const Vertex *z, Random4 random,
                                          Connection *connection)
{
    if ((z->bsdf.flags & BSDF_SMOOTH) != 0u)
        return false;
    Vec2 u;
    float choice;
    uint light = light_choose_point(scene, z->p, z->ng, random, &u, &choice);
    LightSample sample = {0};
    if (!light_sample(scene, light, z->p, u, &sample))
        return false;
    BsdfValue f = bsdf_eval(scene, &z->bsdf, z->wo, frame_to_local(z->frame, sample.wi), TRANSPORT_RADIANCE);
    float select = light_start_pdf(scene, light);
    connection->contribution =
        vec3_scale(vec3_mul(vec3_mul(z->beta, f.f_cos), sample.radiance), 1.0f / (choice * sample.pdf_w));
    connection->shadow = light_shadow_ray(scene, z->p, z->ng, &sample);
    connection->medium = medium_leaving(scene, z->bsdf.media, z->ng, sample.wi);
    StrategyEnds *ends = &connection->ends;
    float at_z = vertex_cosine(scene, sample.wi, z->ng);
    ends->light_z2 = f.pdf_rev_w * z->back;
    ends->hittable = sample.delta == 0u;
    ends->connect = choice / select;
    if (sample.infinite != 0u) {
        ends->own_y0 = select * sample.pdf_emit;
        ends->camera_y1 = f.pdf_w;
        ends->light_z1 = light_aimed_pdf_disc(scene, light, z->p, vec3_negate(sample.wi)) * at_z;
        if (light_has_portal(scene, light))
            ends->connect *= sample.pdf_emit > 0.0f ? sample.pdf_w / sample.pdf_emit : 0.0f;
        return true;
    }
    float distance2 = vec3_length_squared(vec3_sub(sample.p, z->p));
    ends->light_z1 = light_aimed_pdf_w(scene, light, sample.p, sample.ng, vec3_negate(sample.wi)) * (at_z / distance2);
    if (light_kind(scene->lights + light) != LIGHT_AREA) {
        ends->own_y0 = select;
        ends->camera_y1 = 0.0f; /* cannot be hit */
        return true;
    }
    float to_area = solid_angle_to_area(scene, sample.wi, sample.ng, distance2);
    ends->own_y0 = select * sample.pdf_emit;
    ends->camera_y1 = f.pdf_w * to_area;
    ends->connect *= sample.pdf_emit > 0.0f ? sample.pdf_w * to_area / sample.pdf_emit : 0.0f;
    return true;
}

/* s >= 2, t >= 2: connects two vertices. */
SHARED_FUNCTION_CALLED bool connect_vertices(const SceneView *scene, const Vertex *y, const Vertex *z,
                                             Connection *connection)
{
    Vec3 d = vec3_sub(y->p, z->p);
    float distance2 = vec3_length_squared(d);
    if (((y->bsdf.flags | z->bsdf.flags) & BSDF_SMOOTH) != 0u || !(distance2 > 0.0f))
        return false;
    Vec3 w = vec3_scale(d, 1.0f / float_sqrt(distance2));
    BsdfValue fz = bsdf_eval(scene, &z->bsdf, z->wo, frame_to_local(z->frame, w), TRANSPORT_RADIANCE);
    if (vec3_is_zero(fz.f_cos))
        return false;
    BsdfValue fy = vertex_eval_light(scene, y, vec3_negate(w));
    connection->contribution =
        vec3_scale(vec3_mul(vec3_mul(z->beta, fz.f_cos), vec3_mul(y->beta, fy.f_cos)), 1.0f / distance2);
    connection->shadow = connecting_ray(scene, z->p, z->ng, y->p, y->ng);
    connection->medium = medium_leaving(scene, z->bsdf.media, z->ng, w);
    StrategyEnds *ends = &connection->ends;
    ends->light_z1 = fy.pdf_w * solid_angle_to_area(scene, w, z->ng, distance2);
    ends->light_z2 = fz.pdf_rev_w * z->back;
    ends->camera_y1 = fz.pdf_w * solid_angle_to_area(scene, w, y->ng, distance2);
    ends->camera_y2 = fy.pdf_rev_w * y->back;
    return true;
}

/* Connects y_{s-1} and z_{t-1}, s + t >= 3: to the lens, to a light, or two vertices between. An end that the strategy
 * lacks is not read. random: the numbers of the respective case. */
SHARED_FUNCTION bool connect_ends(const SceneView *scene, uint s, uint t, const Vertex *y, const Vertex *z,
                                  Random4 random, Connection *connection)
{
    connection->target = NONE;
    connection->target_offset = 0u;
    connection->ends.connect = 1.0f;
    connection->copies = 1.0f;
    if (t == 1u)
        return connect_camera(scene, y, random, connection);
    if (s == 1u)
        return connect_light(scene, z, random, connection);
    return connect_vertices(scene, y, z, connection);
}

/* In scenes with media, a connection is made twice: before its shadow ray is traced, for the ray, and afterwards, when
 * what the ray has gone through is known, for contribution and weight. Whether this is the second time. */
SHARED_FUNCTION bool connection_traced(const SceneView *scene, __global const uint *restrict shadows, uint item)
{
    return SCENE_HAS(scene, FEATURE_MEDIUM) &&
           state_load_float(shadows, scene->frame->pass.stride, RAY_T_MAX, item) > 0.0f;
}

/* The first time: stores the ray alone. */
SHARED_FUNCTION void connection_ray_store(const SceneView *scene, __global uint *restrict shadows, uint item,
                                          const Connection *connection)
{
    uint stride = scene->frame->pass.stride;
    ray_store(shadows, stride, item, connection->shadow);
    shadow_medium_store(scene, shadows, stride, item, connection->medium);
}

/* The second time: applies what the shadow ray has gone through to the contribution and to the densities of the two
 * ends. y and z: NULL at an end that the strategy lacks (s = 1, t = 1). False, and the ray is removed, if nothing is
 * left. */
SHARED_FUNCTION bool connection_pass(const SceneView *scene, __global uint *restrict shadows, uint item,
                                     const Vertex *y, const Vertex *z, Connection *connection)
{
    uint stride = scene->frame->pass.stride;
    Passage passage = passage_shadow(scene, shadows, stride, item);
    StrategyEnds *ends = &connection->ends;
    connection->contribution = vec3_mul(connection->contribution, passage.weight);
    if (z)
        ends->light_z1 *= passage_density(scene, passage, z->p, z->ng, media_inside(z->bsdf.media));
    ends->camera_y1 *= y ? passage_density(scene, passage, y->p, y->ng, media_inside(y->bsdf.media)) : passage.pdf;
    if (!vec3_is_zero(connection->contribution) && state_load(shadows, stride, SHADOW_OCCLUDED, item) == 0u)
        return true;
    state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    return false;
}

/* t = 1: draws the pixel of the splat; false if there is none. random: lens, pixel. */
SHARED_FUNCTION bool connection_target(const SceneView *scene, Random4 random, Connection *connection)
{
    connection->target =
        film_splat_pixel(scene, connection->film, vec2(random_float(random.x[2]), random_float(random.x[3])),
                         &connection->target_weight);
    connection->target_offset = splat_offset(&scene->frame->film, connection->target, connection->film);
    return connection->target != NONE;
}

/* Whether there is a contribution, and a shadow ray that can be traced. */
SHARED_FUNCTION bool connection_traceable(const Connection *connection)
{
    return !vec3_is_zero(connection->contribution) && connection->shadow.t_max > 0.0f &&
           ray_traceable(connection->shadow.o, connection->shadow.d);
}

/* What the weight needs to know of the stored y_0 (s >= 2). */
SHARED_FUNCTION void connection_light_end(__global const uint *restrict paths, uint stride, uint item,
                                          StrategyEnds *ends)
{
    ends->hittable = (state_load(paths, stride, BD_EMITTER_FLAGS, item) & EMITTER_DELTA) == 0u;
    ends->connect = state_load_float(paths, stride, BD_CONNECT, item);
}

SHARED_FUNCTION void connection_store(__global uint *restrict paths, __global uint *restrict shadows, uint stride,
                                      uint item, const Connection *connection, float weight)
{
    state_store_vec3(paths, stride, BD_CONTRIBUTION, item, vec3_scale(connection->contribution, weight));
    state_store(paths, stride, BD_TARGET, item, connection->target);
    state_store(paths, stride, BD_TARGET_OFFSET, item, connection->target_offset);
    state_store_float(paths, stride, BD_TARGET_WEIGHT, item, connection->target_weight);
    ray_store(shadows, stride, item, connection->shadow);
}

SHARED_FUNCTION void splat_store(__global uint *restrict splats, __global uint *restrict diagnostics, uint stride,
                                 uint item, uint name, uint offset, Vec3 color)
{
    if (!vec3_finite(color)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_NOT_FINITE);
        color = vec3_splat(0.0f);
    }
    state_store(splats, stride, SPLAT_PIXEL, item, name);
    state_store_vec3(splats, stride, SPLAT_COLOR, item, color);
    state_store(splats, stride, SPLAT_OFFSET, item, offset);
}

/* Whether a shadow ray was cast and hit nothing; clears it, so that it is not traced again. */
SHARED_FUNCTION bool shadow_take(__global uint *restrict shadows, uint stride, uint item)
{
    bool cast = state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f;
    if (cast)
        state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    return cast && state_load(shadows, stride, SHADOW_OCCLUDED, item) == 0u;
}

/* Adds a connection whose shadow ray has been traced: a path of `gathered` segments for the path's pixel, or, if
 * that is 0, from the lens (t = 1), splatted. */
SHARED_FUNCTION void connection_add(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                    __global uint *restrict splats, __global uint *restrict diagnostics, uint item,
                                    uint gathered, bool visible)
{
    uint stride = frame->pass.stride;
    Vec3 contribution = state_load_vec3(paths, stride, BD_CONTRIBUTION, item);
    uint target = state_load(paths, stride, BD_TARGET, item);
    if (gathered == 0u && visible && target != NONE)
        splat_store(splats, diagnostics, stride, item, SPLAT_LIGHT | target,
                    state_load(paths, stride, BD_TARGET_OFFSET, item),
                    vec3_scale(contribution, state_load_float(paths, stride, BD_TARGET_WEIGHT, item)));
    else if (gathered == 0u)
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    else if (visible)
        bd_add_radiance(frame, paths, item, gathered, contribution);
}

#endif
