/* Textures computed from coordinates alone: noise, dots, mixes by direction, bilinear interpolation. Their formulas are
 * pbrt-v4's (textures.h, textures.cpp); noise has all its octaves, whatever the size of a pixel. */
#ifndef TWINLIGHT_GEOMETRY_TEXTURE_PROCEDURAL_H
#define TWINLIGHT_GEOMETRY_TEXTURE_PROCEDURAL_H

#include "geometry/texture_map.h"
#include "math/noise.h"

SHARED_FUNCTION float texture_windy(Vec3 p)
{
    float strength = noise_fbm(vec3_scale(p, 0.1f), 0.5f, 3u);
    return float_abs(strength) * noise_fbm(p, 0.5f, 6u);
}

/* Colours of marble: segment i < 6 is a cubic Bezier curve with the control points i ... i + 3. Three have a colour of
 * their own; the others are the first. */
SHARED_FUNCTION Vec3 texture_marble_color(uint i)
{
    if (i == 3u)
        return vec3_splat(0.5f);
    if (i == 4u)
        return vec3(0.6f, 0.59f, 0.58f);
    return i == 7u ? vec3(0.2f, 0.2f, 0.33f) : vec3(0.58f, 0.58f, 0.6f);
}

SHARED_FUNCTION Vec3 texture_marble(__global const TextureOp *op, Vec3 p)
{
    p = vec3_scale(p, op->scale);
    float wave = p.y + op->uv_map[1] * noise_fbm(p, op->uv_map[0], op->index);
    float t = 6.0f * (0.5f + 0.5f * (float_finite(wave) ? float_sin(wave) : 0.0f));
    float segment = float_min(float_floor(t), 5.0f);
    uint first = (uint)segment;
    t -= segment;
    float s = 1.0f - t;
    Vec3 rgb = vec3_scale(texture_marble_color(first), s * s * s);
    rgb = vec3_mad(rgb, 3.0f * s * s * t, texture_marble_color(first + 1u));
    rgb = vec3_mad(rgb, 3.0f * s * t * t, texture_marble_color(first + 2u));
    rgb = vec3_mad(rgb, t * t * t, texture_marble_color(first + 3u));
    return vec3_scale(rgb, 1.5f);
}

#define DOT_RADIUS 0.35f

/* Whether (s, t) is in the dot of its cell: half of the unit cells around integers have one, moved by noise. */
SHARED_FUNCTION bool texture_in_dot(Vec2 st)
{
    float s = float_floor(st.x + 0.5f), t = float_floor(st.y + 0.5f);
    if (!(noise(vec3(s + 0.5f, t + 0.5f, 0.5f)) > 0.0f))
        return false;
    float shift = 0.5f - DOT_RADIUS;
    float x = st.x - (s + shift * noise(vec3(s + 1.5f, t + 2.8f, 0.5f)));
    float y = st.y - (t + shift * noise(vec3(s + 4.5f, t + 9.8f, 0.5f)));
    return x * x + y * y < DOT_RADIUS * DOT_RADIUS;
}

/* v00 v10 v01 v11 at the corners (0,0), (1,0), (0,1), (1,1) of (s, t); linear in each beyond them. */
SHARED_FUNCTION Vec3 texture_bilerp(Vec2 st, const Vec3 *corner)
{
    Vec3 sum = vec3_scale(corner[0], (1.0f - st.x) * (1.0f - st.y));
    sum = vec3_mad(sum, st.x * (1.0f - st.y), corner[1]);
    sum = vec3_mad(sum, (1.0f - st.x) * st.y, corner[2]);
    return vec3_mad(sum, st.x * st.y, corner[3]);
}

/* A noise op: what it pushes. */
SHARED_FUNCTION Vec3 texture_noise_op(__global const TextureOp *op, const TexturePoint *point)
{
    Vec3 p = texture_map_3d(op, point);
    if (op->code == TEXTURE_MARBLE)
        return texture_marble(op, p);
    if (op->code == TEXTURE_WINDY)
        return vec3_splat(texture_windy(p));
    return vec3_splat(op->code == TEXTURE_FBM ? noise_fbm(p, op->uv_map[0], op->index)
                                              : noise_turbulence(p, op->uv_map[0], op->index));
}

/* Runs one op of a program on the stack of `top` values; returns how many it has afterwards. */
SHARED_FUNCTION_APART uint texture_procedural(__global const TextureOp *op, const TexturePoint *point, Vec3 *stack,
                                              uint top)
{
    if (op->code == TEXTURE_DOTS) {
        --top;
        if (!texture_in_dot(texture_map(op, point)))
            stack[top - 1u] = stack[top];
    } else if (op->code == TEXTURE_DIRECTION_MIX) {
        --top;
        float amount = float_abs(vec3_dot(point->n, op->value));
        stack[top - 1u] = vec3_lerp(stack[top], stack[top - 1u], amount);
    } else if (op->code == TEXTURE_BILERP) {
        top -= 3u;
        stack[top - 1u] = texture_bilerp(texture_map(op, point), stack + top - 1u);
    } else {
        stack[top++] = texture_noise_op(op, point);
    }
    return top;
}

#endif
