/* Cameras: from a film position to a ray and back. Conventions of pbrt-v4: camera space is left-handed and looks along
 * +z with y up; film positions are in pixels from the upper left corner, y down. */
#ifndef TWINLIGHT_CAMERA_H
#define TWINLIGHT_CAMERA_H

#include "path_types.h"
#include "scene_types.h"
#include "warp.h"

/* The point of the screen window (plane z = 1, or camera units when orthographic) that a film position shows. */
SHARED_FUNCTION Vec2 camera_screen(const Camera *camera, Vec2 film, float width, float height)
{
    float x = film.x / width;
    float y = film.y / height;
    return vec2((1.0f - x) * camera->screen[0] + x * camera->screen[1],
                (1.0f - y) * camera->screen[3] + y * camera->screen[2]);
}

/* The inverse of camera_screen. */
SHARED_FUNCTION Vec2 camera_film(const Camera *camera, Vec2 screen, float width, float height)
{
    return vec2(width * ((screen.x - camera->screen[0]) / (camera->screen[1] - camera->screen[0])),
                height * ((screen.y - camera->screen[3]) / (camera->screen[2] - camera->screen[3])));
}

/* A point on the lens, in camera space at z = 0, uniform over its disk; the origin for a pinhole. */
SHARED_FUNCTION Vec2 camera_lens(const Camera *camera, Vec2 u_lens)
{
    Vec2 lens = vec2(0.0f, 0.0f);
    if (camera->lens_radius > 0.0f) {
        lens = warp_disk_concentric(u_lens);
        lens.x *= camera->lens_radius;
        lens.y *= camera->lens_radius;
    }
    return lens;
}

/* The ray, in world space with a unit direction and no end, that the film position `film` (pixels, 0 <= x <= width,
 * 0 <= y <= height of the whole film) sees through the lens point of `u_lens`.
 *
 * Thin lens: rays of one film position meet in one point of the plane z = focal_distance. An orthographic camera's
 * lens is centred on each ray (telecentric). */
SHARED_FUNCTION Ray camera_ray(const Camera *camera, Vec2 film, float width, float height, Vec2 u_lens)
{
    Vec2 screen = camera_screen(camera, film, width, height);
    Vec2 lens = camera_lens(camera, u_lens);
    /* The lens moves the origin by l and the point at z = focal_distance not at all, so d changes by -l / f. */
    float slope_x = 0.0f, slope_y = 0.0f;
    if (camera->lens_radius > 0.0f) {
        slope_x = lens.x / camera->focal_distance;
        slope_y = lens.y / camera->focal_distance;
    }
    Vec3 o, d;
    if (camera->kind == CAMERA_PERSPECTIVE) {
        o = vec3(lens.x, lens.y, 0.0f);
        d = vec3(screen.x - slope_x, screen.y - slope_y, 1.0f);
    } else {
        o = vec3(screen.x + lens.x, screen.y + lens.y, 0.0f);
        d = vec3(-slope_x, -slope_y, 1.0f);
    }
    Ray ray;
    ray.o = affine_point(camera->world_from_camera, o);
    ray.d = vec3_normalize(affine_vector(camera->world_from_camera, d));
    ray.t_max = FLOAT_MAX;
    return ray;
}

/* The film position that sees the world point `p` through the lens point of `u_lens`: the inverse of camera_ray.
 * False when p is not in front of the camera or not on the film. */
SHARED_FUNCTION bool camera_project(const Camera *camera, Vec3 p, float width, float height, Vec2 u_lens, Vec2 *film)
{
    Vec3 q = affine_point(camera->camera_from_world, p);
    if (!(q.z > 0.0f))
        return false;
    if (camera->lens_radius > 0.0f) {
        Vec2 lens = camera_lens(camera, u_lens);
        float defocus = 1.0f - q.z / camera->focal_distance;
        q.x -= lens.x * defocus;
        q.y -= lens.y * defocus;
    }
    Vec2 screen = vec2(q.x, q.y);
    if (camera->kind == CAMERA_PERSPECTIVE)
        screen = vec2(q.x / q.z, q.y / q.z);
    *film = camera_film(camera, screen, width, height);
    return film->x >= 0.0f && film->x < width && film->y >= 0.0f && film->y < height;
}

#endif
