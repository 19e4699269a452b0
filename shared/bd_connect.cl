/* Connections of bidirectional path tracing: per pair (s, t) bd_connect, (shadow rays traced) bd_add_connections; at the
 * end bd_splat. */
#ifndef TWINLIGHT_BD_CONNECT_CL
#define TWINLIGHT_BD_CONNECT_CL

#include "bd_random.h"
#include "bd_weight.h"
#include "camera.h"
#include "diagnostics.h"
#include "film_splat.h"

/* A connection before it is known whether anything lies between. */
typedef struct Connection {
    Vec3 contribution; /* unweighted */
    Ray shadow;
    uint target; /* pixel; NONE: the path's own */
    StrategyEnds ends;
} Connection;

/* The stored density z_{t-2} gets from z_{t-1}, whose BSDF has the solid-angle density `reverse` towards it. */
SHARED_FUNCTION float connect_back(__global const FrameParams *frame, __global const uint *paths,
                                   __global const uint *vertices, uint stride, uint t, uint side, uint i, Vec3 p,
                                   float reverse)
{
    if (side == SIDE_CAMERA && i == 1u)
        return 0.0f; /* the lens */
    uint base = vertex_base(frame, side, i - 1u);
    uint flags = side == SIDE_LIGHT && i == 1u ? state_load(paths, stride, BD_EMITTER_FLAGS, t) : 0u;
    return reverse * walk_back(p, state_load_vec3(vertices, stride, base + VERTEX_POINT, t),
                               state_load_vec3(vertices, stride, base + VERTEX_NG, t), flags);
}

/* f(wo, wi) |cos wi| at a vertex of the light's side, with the factor of shading normals. */
SHARED_FUNCTION BsdfValue vertex_eval_light(const SceneView *scene, const Vertex *vertex, Vec3 wi)
{
    Vec3 wi_frame = frame_to_local(vertex->frame, wi);
    BsdfValue value = bsdf_eval(scene, &vertex->bsdf, vertex->wo, wi_frame, TRANSPORT_IMPORTANCE);
    if (!vec3_is_zero(value.f_cos))
        value.f_cos = vec3_scale(value.f_cos, adjoint_factor(vertex->ng, frame_to_world(vertex->frame, vertex->wo), wi,
                                                             vertex->wo.z, wi_frame.z));
    return value;
}

/* t = 1: y_{s-1}, s >= 2, seen from a point on the lens. */
SHARED_FUNCTION bool connect_camera(const SceneView *scene, __global const uint *paths, __global const uint *vertices,
                                    uint stride, uint t, uint s, Connection *connection)
{
    __global const FrameParams *frame = scene->frame;
    Vertex y = vertex_load(scene, vertices, stride, vertex_base(frame, SIDE_LIGHT, s - 1u), t);
    if ((y.bsdf.flags & BSDF_SMOOTH) != 0u)
        return false;
    Random4 random = bd_random(frame, paths, t, bd_random_connection(s, 1u));
    CameraConnection camera;
    float weight;
    if (!camera_connect(frame, y.p, vec2(random_float(random.x[0]), random_float(random.x[1])), &camera))
        return false;
    connection->target =
        film_splat_pixel(scene, camera.film, vec2(random_float(random.x[2]), random_float(random.x[3])), &weight);
    if (connection->target == NONE)
        return false;
    BsdfValue f = vertex_eval_light(scene, &y, camera.wi);
    connection->contribution = vec3_scale(vec3_mul(y.beta, f.f_cos), weight * camera.pdf);
    connection->shadow = ray_between(y.p, y.ng, camera.p, vec3_splat(0.0f));
    connection->ends.camera_y1 = camera.pdf * float_abs(vec3_dot(camera.wi, y.ng));
    connection->ends.camera_y2 = connect_back(frame, paths, vertices, stride, t, SIDE_LIGHT, s - 1u, y.p, f.pdf_rev_w);
    return true;
}

/* s = 1: a point on a light drawn for z_{t-1}, t >= 2. */
SHARED_FUNCTION bool connect_light(const SceneView *scene, __global const uint *paths, __global const uint *vertices,
                                   uint stride, uint item, uint t, Connection *connection)
{
    __global const FrameParams *frame = scene->frame;
    Vertex z = vertex_load(scene, vertices, stride, vertex_base(frame, SIDE_CAMERA, t - 1u), item);
    if ((z.bsdf.flags & BSDF_SMOOTH) != 0u)
        return false;
    Random4 random = bd_random(frame, paths, item, bd_random_connection(1u, t));
    uint light = light_select(scene, random.x[0], random.x[1]);
    LightSample sample = {0};
    if (!light_sample(scene, light, z.p, vec2(random_float(random.x[2]), random_float(random.x[3])), &sample))
        return false;
    BsdfValue f = bsdf_eval(scene, &z.bsdf, z.wo, frame_to_local(z.frame, sample.wi), TRANSPORT_RADIANCE);
    float select = scene->lights[light].select_pdf;
    connection->contribution =
        vec3_scale(vec3_mul(vec3_mul(z.beta, f.f_cos), sample.radiance), 1.0f / (select * sample.pdf_w));
    connection->shadow = light_shadow_ray(z.p, z.ng, &sample);
    StrategyEnds *ends = &connection->ends;
    float at_z = float_abs(vec3_dot(sample.wi, z.ng));
    ends->light_z2 = connect_back(frame, paths, vertices, stride, item, SIDE_CAMERA, t - 1u, z.p, f.pdf_rev_w);
    ends->hittable = sample.delta == 0u;
    ends->connect = 1.0f;
    if (sample.infinite != 0u) {
        ends->own_y0 = select * sample.pdf_w;
        ends->camera_y1 = f.pdf_w;
        ends->light_z1 = light_emit_pdf_disc(scene) * at_z;
        return true;
    }
    float distance2 = vec3_length_squared(vec3_sub(sample.p, z.p));
    ends->light_z1 = light_emit_pdf_w(scene, light, sample.ng, vec3_negate(sample.wi)) * (at_z / distance2);
    if (sample.delta != 0u) {
        ends->own_y0 = select;
        ends->camera_y1 = 0.0f; /* never met */
        return true;
    }
    float to_area = solid_angle_to_area(sample.wi, sample.ng, distance2);
    ends->own_y0 = select * sample.pdf_emit;
    ends->camera_y1 = f.pdf_w * to_area;
    ends->connect = sample.pdf_emit > 0.0f ? sample.pdf_w * to_area / sample.pdf_emit : 0.0f;
    return true;
}

/* s >= 2, t >= 2: two surfaces. */
SHARED_FUNCTION bool connect_surfaces(const SceneView *scene, __global const uint *paths, __global const uint *vertices,
                                      uint stride, uint item, uint s, uint t, Connection *connection)
{
    __global const FrameParams *frame = scene->frame;
    Vertex y = vertex_load(scene, vertices, stride, vertex_base(frame, SIDE_LIGHT, s - 1u), item);
    Vertex z = vertex_load(scene, vertices, stride, vertex_base(frame, SIDE_CAMERA, t - 1u), item);
    Vec3 d = vec3_sub(y.p, z.p);
    float distance2 = vec3_length_squared(d);
    if (((y.bsdf.flags | z.bsdf.flags) & BSDF_SMOOTH) != 0u || !(distance2 > 0.0f))
        return false;
    Vec3 w = vec3_scale(d, 1.0f / float_sqrt(distance2)), back = vec3_negate(w);
    BsdfValue fz = bsdf_eval(scene, &z.bsdf, z.wo, frame_to_local(z.frame, w), TRANSPORT_RADIANCE);
    if (vec3_is_zero(fz.f_cos))
        return false;
    BsdfValue fy = vertex_eval_light(scene, &y, back);
    connection->contribution =
        vec3_scale(vec3_mul(vec3_mul(z.beta, fz.f_cos), vec3_mul(y.beta, fy.f_cos)), 1.0f / distance2);
    connection->shadow = ray_between(z.p, z.ng, y.p, y.ng);
    StrategyEnds *ends = &connection->ends;
    ends->light_z1 = fy.pdf_w * solid_angle_to_area(w, z.ng, distance2);
    ends->light_z2 = connect_back(frame, paths, vertices, stride, item, SIDE_CAMERA, t - 1u, z.p, fz.pdf_rev_w);
    ends->camera_y1 = fz.pdf_w * solid_angle_to_area(w, y.ng, distance2);
    ends->camera_y2 = connect_back(frame, paths, vertices, stride, item, SIDE_LIGHT, s - 1u, y.p, fy.pdf_rev_w);
    return true;
}

/* From: both walks. To: the connection (BD_S, BD_T), weighted, and its shadow ray. */
__kernel void bd_connect(__global const FrameParams *restrict frame, __global const uint *restrict geometry,
                         __global const uint *restrict tables, __global const uint *restrict texels,
                         __global uint *restrict paths, __global uint *restrict shadows,
                         __global const uint *restrict vertices, __global const uint *restrict densities)
{
    uint item = (uint)get_global_id(0), stride = frame->stride;
    if (item >= frame->item_count)
        return;
    uint s = state_load(paths, stride, BD_S, item), t = state_load(paths, stride, BD_T, item);
    uint lengths = state_load(paths, stride, BD_LENGTHS, item);
    if ((s > 1u && s > (lengths & 0xffffu)) || t > (lengths >> 16) + 1u ||
        !strategy_taken(frame->strategies, s, s + t - 1u) ||
        (frame->only_s != NONE && (frame->only_s != s || frame->only_t != t)))
        return;
    SceneView scene = scene_view(frame, geometry, tables, texels);
    Connection connection = {0};
    connection.target = NONE;
    connection.ends.connect = 1.0f;
    bool possible;
    if (t == 1u)
        possible = connect_camera(&scene, paths, vertices, stride, item, s, &connection);
    else if (s == 1u)
        possible = connect_light(&scene, paths, vertices, stride, item, t, &connection);
    else
        possible = connect_surfaces(&scene, paths, vertices, stride, item, s, t, &connection);
    if (!possible || vec3_is_zero(connection.contribution) || !(connection.shadow.t_max > 0.0f) ||
        !ray_traceable(connection.shadow.o, connection.shadow.d))
        return;
    if (s >= 2u) {
        uint flags = state_load(paths, stride, BD_EMITTER_FLAGS, item);
        connection.ends.hittable = (flags & EMITTER_DELTA) == 0u;
        connection.ends.connect = state_load_float(paths, stride, BD_CONNECT, item);
    }
    DensityView view = bd_density_view(frame, paths, densities, item);
    float weight = bd_weight(frame, s, t, &view, &connection.ends);
    state_store_vec3(paths, stride, BD_CONTRIBUTION, item, vec3_scale(connection.contribution, weight));
    state_store(paths, stride, BD_TARGET, item, connection.target);
    ray_store(shadows, stride, item, connection.shadow);
}

/* The pairs in the order of the list of steps (integrator_bdpt.c): t = 1: s = 2 ... D; then t = 2 ... D: s = 1 ...
 * D + 1 - t. */
SHARED_FUNCTION void connection_advance(__global uint *restrict paths, uint stride, uint item, uint max_depth)
{
    uint s = state_load(paths, stride, BD_S, item) + 1u, t = state_load(paths, stride, BD_T, item);
    if (s + t > max_depth + 1u) {
        s = 1u;
        ++t;
    }
    state_store(paths, stride, BD_S, item, s);
    state_store(paths, stride, BD_T, item, t);
}

SHARED_FUNCTION void splat_store(__global uint *restrict splats, __global uint *restrict diagnostics, uint stride,
                                 uint item, uint pixel, Vec3 color)
{
    if (!vec3_finite(color)) {
        diagnostic_count(diagnostics, DIAGNOSTIC_NOT_FINITE);
        color = vec3_splat(0.0f);
    }
    state_store(splats, stride, SPLAT_PIXEL, item, pixel);
    state_store_vec3(splats, stride, SPLAT_COLOR, item, color);
}

/* From: traced shadow rays. To: visible connections gathered, or (t = 1) put out for the film; the next pair. */
__kernel void bd_add_connections(__global const FrameParams *restrict frame, __global uint *restrict paths,
                                 __global uint *restrict shadows, __global uint *restrict splats,
                                 __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->stride;
    if (item >= frame->item_count)
        return;
    bool camera = state_load(paths, stride, BD_T, item) == 1u, visible = false;
    if (state_load_float(shadows, stride, RAY_T_MAX, item) > 0.0f) {
        visible = state_load(shadows, stride, SHADOW_OCCLUDED, item) == 0u;
        state_store_float(shadows, stride, RAY_T_MAX, item, 0.0f);
    }
    Vec3 contribution = state_load_vec3(paths, stride, BD_CONTRIBUTION, item);
    if (camera && visible)
        splat_store(splats, diagnostics, stride, item, SPLAT_FROM_LIGHT | state_load(paths, stride, BD_TARGET, item),
                    contribution);
    else if (camera)
        state_store(splats, stride, SPLAT_PIXEL, item, NONE);
    else if (visible)
        state_store_vec3(paths, stride, BD_RADIANCE, item,
                         vec3_add(state_load_vec3(paths, stride, BD_RADIANCE, item), contribution));
    connection_advance(paths, stride, item, frame->max_depth);
}

/* From: what was gathered for the pixel. To: its splat. */
__kernel void bd_splat(__global const FrameParams *restrict frame, __global const uint *restrict paths,
                       __global uint *restrict splats, __global uint *restrict diagnostics)
{
    uint item = (uint)get_global_id(0), stride = frame->stride;
    if (item >= frame->item_count)
        return;
    Vec3 radiance =
        vec3_scale(state_load_vec3(paths, stride, BD_RADIANCE, item), state_load_float(paths, stride, BD_WEIGHT, item));
    splat_store(splats, diagnostics, stride, item, state_load(paths, stride, BD_PIXEL, item), radiance);
}

#endif
