/* Image lookups and texture programs: the value of a material's parameter at a point. Conventions of pbrt-v4
 * (textures.cpp, mipmap.cpp), without its prefiltering: every lookup is of the finest level, and checkerboards have
 * hard edges. */
#ifndef TWINLIGHT_GEOMETRY_TEXTURE_H
#define TWINLIGHT_GEOMETRY_TEXTURE_H

#include "geometry/texture_procedural.h"
#include "layout/scene_view.h"

/* Brings a texture coordinate into a range whose texel numbers fit an int, without changing the result of wrapping: [0,
 * 1] for repeat (u - floor(u) rounds to 1 for -1e-9), [-1, 2] for black and clamp. Not finite: 0. */
SHARED_FUNCTION float image_coordinate(uint wrap, float u)
{
    if (!float_finite(u))
        return 0.0f;
    if (wrap == WRAP_REPEAT)
        return u - float_floor(u);
    if (wrap == WRAP_OCTAHEDRAL)
        return float_clamp(u, 0.0f, 1.0f);
    return float_clamp(u, -1.0f, 2.0f);
}

/* Each side of the square continues into itself, turned by 180 degrees about its middle (Clarberg 2008, "Fast
 * Equal-Area Mapping of the (Hemi)Sphere using SIMD"). x and y at most one texel outside. Texel -1 is the image of
 * texel 0; pbrt takes texel 1 there. */
SHARED_FUNCTION void image_wrap_octahedral(int width, int height, int *x, int *y)
{
    if (*x < 0 || *x >= width) {
        *x = *x < 0 ? 0 : width - 1;
        *y = height - 1 - *y;
    }
    if (*y < 0 || *y >= height) {
        *y = *y < 0 ? 0 : height - 1;
        *x = width - 1 - *x;
    }
}

/* Wraps along one axis: a texel number at most one image away becomes one inside; -1 where the border is black. */
SHARED_FUNCTION int image_wrap_axis(uint wrap, int size, int x)
{
    if (x >= 0 && x < size)
        return x;
    if (wrap == WRAP_BLACK)
        return -1;
    if (wrap == WRAP_CLAMP)
        return x < 0 ? 0 : size - 1;
    x += x < 0 ? size : -size;
    return x < 0 ? 0 : x >= size ? size - 1 : x;
}

/* Channel `channel` of texel number `texel` = y * width + x. */
SHARED_FUNCTION float image_channel(const SceneView *scene, const TextureImage *image, uint texel, uint channel)
{
    if (image->format == TEXEL_F32)
        return bits_float(scene->texels[image->first_word + texel * image->channels + channel]);
    uint byte = image->channels == 1u ? texel : 4u * texel + channel;
    uint word = scene->texels[image->first_word + byte / 4u];
    return scene->lookup[image->lut + ((word >> (8u * (byte & 3u))) & 0xffu)];
}

/* The colour of texel (x, y), row 0 on top, 0 <= x < width, 0 <= y < height. */
SHARED_FUNCTION Vec3 image_texel(const SceneView *scene, const TextureImage *image, uint x, uint y)
{
    uint texel = y * image->width + x;
    float first = image_channel(scene, image, texel, 0u);
    if (image->channels == 1u)
        return vec3_splat(first);
    return vec3(first, image_channel(scene, image, texel, 1u), image_channel(scene, image, texel, 2u));
}

#define IMAGE_READ_COLOR 0u
#define IMAGE_READ_ALPHA 1u /* the fourth channel in every component */

/* A texel after wrapping. */
SHARED_FUNCTION Vec3 image_texel_wrapped(const SceneView *scene, const TextureImage *image, int x, int y, uint what)
{
    int width = (int)image->width, height = (int)image->height;
    if (image->wrap == WRAP_OCTAHEDRAL)
        image_wrap_octahedral(width, height, &x, &y);
    x = image_wrap_axis(image->wrap, width, x);
    y = image_wrap_axis(image->wrap, height, y);
    if (x < 0 || y < 0)
        return vec3_splat(0.0f);
    if (what == IMAGE_READ_ALPHA)
        return vec3_splat(image_channel(scene, image, (uint)y * image->width + (uint)x, 3u));
    return image_texel(scene, image, (uint)x, (uint)y);
}

SHARED_FUNCTION Vec3 image_filter(const SceneView *scene, const TextureImage *image, Vec2 uv, uint what)
{
    float s = image_coordinate(image->wrap, uv.x) * (float)image->width;
    float t = (1.0f - image_coordinate(image->wrap, uv.y)) * (float)image->height;
    if (image->filter == FILTER_POINT)
        return image_texel_wrapped(scene, image, (int)float_floor(s), (int)float_floor(t), what);
    s -= 0.5f;
    t -= 0.5f;
    float x = float_floor(s), y = float_floor(t);
    float dx = s - x, dy = t - y;
    Vec3 c00 = image_texel_wrapped(scene, image, (int)x, (int)y, what);
    Vec3 c10 = image_texel_wrapped(scene, image, (int)x + 1, (int)y, what);
    Vec3 c01 = image_texel_wrapped(scene, image, (int)x, (int)y + 1, what);
    Vec3 c11 = image_texel_wrapped(scene, image, (int)x + 1, (int)y + 1, what);
    return vec3_lerp(vec3_lerp(c00, c10, dx), vec3_lerp(c01, c11, dx), dy);
}

/* Colour of image `index` at (u, v), bilinear or nearest as the image says; grey is repeated in all channels. v = 1 is
 * the top of row 0. Any uv is allowed; non-finite coordinates count as 0. */
SHARED_FUNCTION Vec3 image_lookup(const SceneView *scene, uint index, Vec2 uv)
{
    TextureImage image = scene->images[index];
    return image_filter(scene, &image, uv, IMAGE_READ_COLOR);
}

/* The image as a number, as pbrt's float textures: grey, the mean of RGB, the alpha of RGBA. */
SHARED_FUNCTION float image_lookup_float(const SceneView *scene, uint index, Vec2 uv)
{
    TextureImage image = scene->images[index];
    if (image.channels == 3u)
        return vec3_mean(image_filter(scene, &image, uv, IMAGE_READ_COLOR));
    return image_filter(scene, &image, uv, image.channels == 4u ? IMAGE_READ_ALPHA : IMAGE_READ_COLOR).x;
}

/* 1 when floor(x) is odd, else 0; exact for every float, 0 for NaN and infinities. */
SHARED_FUNCTION uint texture_cell_odd(float x)
{
    float cell = float_floor(x);
    return cell - 2.0f * float_floor(0.5f * cell) == 1.0f ? 1u : 0u;
}

SHARED_FUNCTION uint texture_checkerboard_odd(__global const TextureOp *op, const TexturePoint *point)
{
    if (op->mapping == MAPPING_3D) {
        Vec3 p = texture_map_3d(op, point);
        return texture_cell_odd(p.x) ^ texture_cell_odd(p.y) ^ texture_cell_odd(p.z);
    }
    Vec2 st = texture_map(op, point);
    return texture_cell_odd(st.x) ^ texture_cell_odd(st.y);
}

/* An image op: scaled, inverted, not below 0. */
SHARED_FUNCTION Vec3 texture_image_op(const SceneView *scene, __global const TextureOp *op, const TexturePoint *point,
                                      uint as_float)
{
    Vec2 st = texture_map(op, point);
    Vec3 c = as_float ? vec3_splat(image_lookup_float(scene, op->index, st)) : image_lookup(scene, op->index, st);
    c = vec3_scale(c, op->scale);
    if (!op->invert)
        return as_float ? c : vec3(float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f));
    return vec3(float_max(1.0f - c.x, 0.0f), float_max(1.0f - c.y, 0.0f), float_max(1.0f - c.z, 0.0f));
}

/* Runs the program that starts at texture_ops[program]. The host has checked it (texture_program_depth). */
SHARED_FUNCTION Vec3 texture_run(const SceneView *scene, uint program, const TexturePoint *point, uint as_float)
{
    Vec3 stack[TEXTURE_STACK];
    stack[0] = vec3_splat(0.0f); /* every program leaves a value, which compilers do not know */
    uint top = 0u; /* values on the stack */
    for (__global const TextureOp *op = scene->texture_ops + program; op->code != TEXTURE_END; ++op) {
        if (op->code == TEXTURE_CONSTANT) {
            stack[top++] = op->value;
        } else if (op->code == TEXTURE_IMAGE || op->code == TEXTURE_IMAGE_FLOAT) {
            stack[top++] = texture_image_op(scene, op, point, as_float | (op->code == TEXTURE_IMAGE_FLOAT ? 1u : 0u));
        } else if (op->code == TEXTURE_SCALE) {
            --top;
            stack[top - 1u] = vec3_mul(stack[top - 1u], stack[top]);
        } else if (op->code == TEXTURE_CHECKERBOARD) {
            --top;
            if (texture_checkerboard_odd(op, point))
                stack[top - 1u] = stack[top];
        } else if (SCENE_HAS(scene, FEATURE_PROCEDURAL) && op->code >= TEXTURE_FBM) {
            top = texture_procedural(op, point, stack, top);
        } else {
            top -= 2u; /* TEXTURE_MIX */
            stack[top - 1u] = vec3_lerp(stack[top], stack[top + 1u], vec3_mean(stack[top - 1u]));
        }
    }
    return stack[0];
}

/* A spectrum texture's colour. */
SHARED_FUNCTION Vec3 texture_eval(const SceneView *scene, uint program, const TexturePoint *point)
{
    return texture_run(scene, program, point, 0u);
}

/* A float texture's number: every image in it is read as a number. */
SHARED_FUNCTION float texture_eval_float(const SceneView *scene, uint program, const TexturePoint *point)
{
    return texture_run(scene, program, point, 1u).x;
}

SHARED_FUNCTION Vec3 color_param_eval(const SceneView *scene, ColorParam param, const TexturePoint *point)
{
    if (!SCENE_HAS(scene, FEATURE_TEXTURE) || param.program == NONE)
        return param.value;
    return texture_eval(scene, param.program, point);
}

SHARED_FUNCTION float float_param_eval(const SceneView *scene, FloatParam param, const TexturePoint *point)
{
    if (!SCENE_HAS(scene, FEATURE_TEXTURE) || param.program == NONE)
        return param.value;
    return texture_eval_float(scene, param.program, point);
}

#endif
