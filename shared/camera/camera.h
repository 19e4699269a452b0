/* Perspective and orthographic cameras: from a film position to a ray and back. Conventions of pbrt-v4: camera space is
 * left-handed and looks along +z with y up; film positions are in pixels from the upper left corner, y down. */
#ifndef TWINLIGHT_CAMERA_CAMERA_H
#define TWINLIGHT_CAMERA_CAMERA_H

#include "layout/path_types.h"
#include "layout/frame_params.h"
#include "math/warp.h"

/* From film position (pixels) to screen window (on the plane z = 1, or in camera units if orthographic). */
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

/* The camera ray of the film position `film` (pixels, 0 <= x <= width, 0 <= y <= height of the whole film) through the
 * lens point of `u_lens`: in world space, with a unit direction and t_max = FLOAT_MAX.
 *
 * Thin lens: the rays of a film position meet in one point of the plane z = focal_distance. An orthographic camera's
 * lens is centred on each ray (telecentric). */
SHARED_FUNCTION Ray camera_ray(const Camera *camera, Vec2 film, float width, float height, Vec2 u_lens)
{
    Vec2 screen = camera_screen(camera, film, width, height);
    Vec2 lens = camera_lens(camera, u_lens);
    /* The lens shifts the origin by l but not the point in focus, at z = f, so the direction changes by -l / f. */
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

/* Density per unit area of the screen of a film position uniform over the pixels of the crop window. */
SHARED_FUNCTION float camera_screen_pdf(__global const FrameParams *frame)
{
    __global const Camera *camera = &frame->camera;
    float x = (camera->screen[1] - camera->screen[0]) / (float)frame->film.width;
    float y = (camera->screen[3] - camera->screen[2]) / (float)frame->film.height;
    float pixels =
        (float)(frame->film.crop_x1 - frame->film.crop_x0) * (float)(frame->film.crop_y1 - frame->film.crop_y0);
    return 1.0f / float_abs(pixels * x * y);
}

/* Factor by which the camera's transform scales volumes. */
SHARED_FUNCTION float camera_volume_scale(__global const Camera *camera)
{
    Affine m = camera->world_from_camera;
    Vec3 x = vec3(m.m[0], m.m[4], m.m[8]), y = vec3(m.m[1], m.m[5], m.m[9]), z = vec3(m.m[2], m.m[6], m.m[10]);
    return float_abs(vec3_dot(x, vec3_cross(y, z)));
}

/* Density, per unit area perpendicular to d, with which camera_ray makes the point at `distance` (world units) along
 * the unit direction d from its origin, for a given lens point and a film position uniform over the pixels of the crop
 * window. Also valid outside the window, where the pixel filter still reaches. 0 for points behind the camera.
 *
 * Let z be the camera-space component of d along the axis. For a fixed lens point, the screen's area element dS
 * corresponds to z^2 distance^2 dS (perspective) or dS (orthographic) of the plane through the point parallel to the
 * screen, in camera space. Times the depth dz of a step along the ray that is a volume, which the transform M scales by
 * |det M|; in the world the same volume is the area sought times dz / z. If the transform preserves lengths, z is the
 * cosine at the lens and the result is 1 / (A cos^3 distance^2), the importance of a pinhole (Veach 1997, section 8.2;
 * Pharr, Jakob and Humphreys, section 16.1.1). It is also the factor of a connection from a light path to the lens:
 * sums of filtered splats, divided by the samples per pixel, are pixel values. */
SHARED_FUNCTION float camera_pdf(__global const FrameParams *frame, Vec3 lens, Vec3 d, float distance)
{
    (void)lens;
    __global const Camera *camera = &frame->camera;
    float z = camera->camera_from_world.m[8] * d.x + camera->camera_from_world.m[9] * d.y +
              camera->camera_from_world.m[10] * d.z;
    if (!(z > 0.0f))
        return 0.0f;
    float pdf = camera_screen_pdf(frame) / (camera_volume_scale(camera) * z);
    if (camera->kind == CAMERA_PERSPECTIVE)
        pdf /= (z * distance) * (z * distance);
    return pdf;
}

/* A connection from a point to the lens. */
typedef struct CameraConnection {
    Vec2 film; /* its film position: pixels of the whole film, continuous */
    Vec3 p; /* on the lens */
    Vec3 wi; /* unit, from the point to the lens */
    float pdf; /* camera_pdf */
    float copies; /* number of film positions from which the point is seen, of which `film` is one, drawn at random */
} CameraConnection;

/* Whether the film position is within the pixel filter's reach of the crop window. (A filter narrower than a pixel
 * leaves gaps between pixels; film_splat_pixel finds those.) */
SHARED_FUNCTION bool camera_film_covered(__global const FrameParams *frame, Vec2 film)
{
    float x = frame->film.filter.radius_x - 0.5f, y = frame->film.filter.radius_y - 0.5f;
    return film.x >= (float)frame->film.crop_x0 - x && film.x < (float)frame->film.crop_x1 + x &&
           film.y >= (float)frame->film.crop_y0 - y && film.y < (float)frame->film.crop_y1 + y;
}

/* Connects the world point p to the lens point of u_lens: the inverse of camera_ray. False if p is behind the camera or
 * its film position is out of the filter's reach of the crop window. Everything is computed relative to the camera's
 * position, so that a camera far from (0,0,0) loses no more than the rounding of that position. */
SHARED_FUNCTION bool camera_connect(__global const FrameParams *frame, Vec3 p, Vec2 u_lens,
                                    CameraConnection *connection)
{
    Camera camera = frame->camera;
    Vec2 lens = camera_lens(&camera, u_lens);
    Vec3 center = vec3(camera.world_from_camera.m[3], camera.world_from_camera.m[7], camera.world_from_camera.m[11]);
    Vec3 q = affine_vector(camera.camera_from_world, vec3_sub(p, center));
    if (!(q.z > 0.0f))
        return false;
    /* The point of the screen as in camera_ray, through the point in focus. */
    Vec2 slope = vec2(0.0f, 0.0f);
    if (camera.lens_radius > 0.0f)
        slope = vec2(lens.x / camera.focal_distance, lens.y / camera.focal_distance);
    Vec2 screen = vec2((q.x - lens.x) + q.z * slope.x, (q.y - lens.y) + q.z * slope.y);
    Vec2 o = vec2(screen.x + lens.x, screen.y + lens.y);
    if (camera.kind == CAMERA_PERSPECTIVE) {
        screen = vec2(screen.x / q.z, screen.y / q.z);
        o = lens;
    }
    connection->copies = 1.0f;
    connection->film = camera_film(&camera, screen, (float)frame->film.width, (float)frame->film.height);
    connection->p = affine_point(camera.world_from_camera, vec3(o.x, o.y, 0.0f));
    Vec3 d = vec3_sub(connection->p, p);
    float distance = vec3_length(d);
    connection->wi = vec3_scale(d, 1.0f / distance);
    connection->pdf = camera_pdf(frame, connection->p, vec3_negate(connection->wi), distance);
    return camera_film_covered(frame, connection->film) && connection->pdf > 0.0f && float_finite(connection->pdf);
}

#endif
