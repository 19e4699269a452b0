/* Cameras that see all directions: pbrt-v4's spherical camera, of both mappings. The plane of film positions is covered
 * by copies of the film: past its border a picture goes on with what is inside at another place, and so do pixel
 * filters. */
#ifndef TWINLIGHT_CAMERA_SPHERICAL_H
#define TWINLIGHT_CAMERA_SPHERICAL_H

#include "camera/camera.h"

/* Where the place `in` of a copy is on the film itself, both in [0, 1)^2, or the other way round. column and row: of
 * the copy; the film is (0, 0). The equal-area map is turned by 180 degrees from copy to copy; past the poles of the
 * other mapping, which repeats from left to right, is the opposite longitude. */
SHARED_FUNCTION Vec2 spherical_copy(uint kind, int column, int row, Vec2 in)
{
    bool odd_row = (row & 1) != 0, odd_column = (column & 1) != 0;
    if (kind == CAMERA_EQUAL_AREA)
        return odd_row != odd_column ? vec2(1.0f - in.x, 1.0f - in.y) : in;
    if (!odd_row)
        return in;
    return vec2(in.x < 0.5f ? in.x + 0.5f : in.x - 0.5f, 1.0f - in.y);
}

/* The camera ray of a film position (pixels), which may be off the film: in world space, with a unit direction. The
 * vertical axis of the map is y in camera space. */
SHARED_FUNCTION_APART Ray spherical_ray(const Camera *camera, Vec2 film, float width, float height)
{
    float x = film.x / width, y = film.y / height, column = float_floor(x), row = float_floor(y);
    Vec2 uv = spherical_copy(camera->kind, (int)column, (int)row, vec2(x - column, y - row));
    Vec3 d = camera->kind == CAMERA_EQUAL_AREA ? octahedral_to_sphere(uv) : equirectangular_to_sphere(uv);
    Ray ray;
    ray.o = affine_point(camera->world_from_camera, vec3_splat(0.0f));
    ray.d = vec3_normalize(affine_vector(camera->world_from_camera, vec3(d.x, d.z, d.y)));
    ray.t_max = FLOAT_MAX;
    return ray;
}

/* camera_pdf of these cameras. The mapping gives the density of a camera-space direction l per solid angle, 1 / (4 pi)
 * or 1 / (2 pi^2 sin) with the sine of the angle from y, for a film of area 1. If q is the camera-space vector of the
 * unit vector d and M the transform to the world, solid angles in the world are |det M| |q|^3 times those of l = q /
 * |q|. */
SHARED_FUNCTION_APART float spherical_pdf(__global const FrameParams *frame, Vec3 d, float distance)
{
    __global const Camera *camera = &frame->camera;
    Affine camera_from_world = camera->camera_from_world;
    Vec3 q = affine_vector(camera_from_world, d);
    float length2 = vec3_length_squared(q), length = float_sqrt(length2);
    float pixels =
        (float)(frame->film.crop_x1 - frame->film.crop_x0) * (float)(frame->film.crop_y1 - frame->film.crop_y0);
    float per_film = (float)frame->film.width * (float)frame->film.height / pixels;
    float mapped = camera->kind == CAMERA_EQUAL_AREA
                       ? INV_4PI
                       : 0.5f * INV_PI * INV_PI * (length / float_sqrt(q.x * q.x + q.z * q.z));
    return per_film * mapped / (camera_volume_scale(camera) * length2 * length * distance * distance);
}

/* The film positions from which the direction of `uv`, on the film of area 1, is seen, within the reach of the crop
 * window's filters; one of them, drawn with u, is returned. *count: how many there are. */
SHARED_FUNCTION_APART Vec2 spherical_film(__global const FrameParams *frame, Vec2 uv, float u, float *count)
{
    float width = (float)frame->film.width, height = (float)frame->film.height;
    float more_x = frame->film.filter.radius_x, more_y = frame->film.filter.radius_y;
    int column_begin = (int)float_floor(((float)frame->film.crop_x0 - more_x) / width);
    int column_end = (int)float_floor(((float)frame->film.crop_x1 + more_x) / width);
    int row_begin = (int)float_floor(((float)frame->film.crop_y0 - more_y) / height);
    int row_end = (int)float_floor(((float)frame->film.crop_y1 + more_y) / height);
    Vec2 chosen = vec2(0.0f, 0.0f);
    *count = 0.0f;
    for (int row = row_begin; row <= row_end; ++row)
        for (int column = column_begin; column <= column_end; ++column) {
            Vec2 place = spherical_copy(frame->camera.kind, column, row, uv);
            Vec2 film = vec2(width * ((float)column + place.x), height * ((float)row + place.y));
            if (!camera_film_covered(frame, film))
                continue;
            *count += 1.0f;
            u *= *count;
            bool take = u < 1.0f; /* with probability 1 / count; what is left of u is uniform */
            u = take ? u : (u - 1.0f) / (*count - 1.0f);
            chosen = take ? film : chosen;
        }
    return chosen;
}

/* camera_connect of these cameras. u: chooses among the film positions from which p is seen. */
SHARED_FUNCTION_APART bool spherical_connect(__global const FrameParams *frame, Vec3 p, float u,
                                             CameraConnection *connection)
{
    Camera camera = frame->camera;
    connection->p = vec3(camera.world_from_camera.m[3], camera.world_from_camera.m[7], camera.world_from_camera.m[11]);
    Vec3 d = vec3_sub(connection->p, p), q = affine_vector(camera.camera_from_world, vec3_negate(d));
    float distance = vec3_length(d), length = vec3_length(q);
    if (!(distance > 0.0f && length > 0.0f))
        return false;
    connection->wi = vec3_scale(d, 1.0f / distance);
    Vec3 mapped = vec3(q.x / length, q.z / length, q.y / length);
    Vec2 uv = camera.kind == CAMERA_EQUAL_AREA ? sphere_to_octahedral(mapped) : sphere_to_equirectangular(mapped);
    connection->film = spherical_film(frame, uv, u, &connection->copies);
    connection->pdf = spherical_pdf(frame, vec3_negate(connection->wi), distance);
    return connection->copies > 0.0f && connection->pdf > 0.0f && float_finite(connection->pdf);
}

#endif
