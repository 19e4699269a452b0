/* From a point of a surface to the coordinates at which a texture is evaluated, by pbrt-v4's conventions. */
#ifndef TWINLIGHT_GEOMETRY_TEXTURE_MAP_H
#define TWINLIGHT_GEOMETRY_TEXTURE_MAP_H

#include "layout/scene_view.h"
#include "math/elementary.h"

/* Where a texture is evaluated: world-space position, the surface's (u, v) and its geometric normal, on either side;
 * read by directionmix alone, which alpha textures do not contain. */
typedef struct TexturePoint {
    Vec3 p;
    Vec2 uv;
    Vec3 n;
} TexturePoint;

/* pbrt: s = theta / pi, t = phi / (2 pi) around the origin of the texture's space. */
SHARED_FUNCTION Vec2 texture_map_spherical(Vec3 p)
{
    float length = vec3_length(p);
    float z = length > 0.0f ? p.z / length : 1.0f;
    float phi = float_atan2(p.y, p.x);
    phi = phi < 0.0f ? phi + 2.0f * PI : phi;
    return vec2(float_acos(float_clamp(z, -1.0f, 1.0f)) * INV_PI, phi * INV_2PI);
}

SHARED_FUNCTION Vec2 texture_map(__global const TextureOp *op, const TexturePoint *point)
{
    __global const float *map = op->uv_map;
    if (op->mapping == MAPPING_UV)
        return vec2(map[0] * point->uv.x + map[2], map[1] * point->uv.y + map[3]);
    Affine texture_from_world = op->texture_from_world;
    Vec3 p = affine_point(texture_from_world, point->p);
    if (op->mapping == MAPPING_PLANAR)
        return vec2(map[3] + vec3_dot(p, vec3(map[0], map[1], map[2])),
                    map[7] + vec3_dot(p, vec3(map[4], map[5], map[6])));
    if (op->mapping == MAPPING_SPHERICAL)
        return texture_map_spherical(p);
    return vec2((PI + float_atan2(p.y, p.x)) * INV_2PI, p.z);
}

/* The point in the space that was current where the texture was defined. */
SHARED_FUNCTION Vec3 texture_map_3d(__global const TextureOp *op, const TexturePoint *point)
{
    Affine texture_from_world = op->texture_from_world;
    return affine_point(texture_from_world, point->p);
}

#endif
