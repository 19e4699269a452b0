#include "scene/camera_setup.h"

#include "base/matrix.h"

#include <math.h>
#include <string.h>

static bool affine_set(const double m[16], Affine *out, Error *error)
{
    *out = matrix_affine(m);
    for (int i = 0; i < 12; ++i) {
        if (!isfinite(out->m[i])) {
            error_set(error, "the camera's transformation is not finite");
            return error_fix(error, "check the transformations before the Camera directive for a zero scale");
        }
    }
    return true;
}

static bool settings_check(const CameraSettings *settings, int width, int height, Error *error)
{
    if (width < 1 || height < 1) {
        error_set(error, "the film size %d x %d is empty", width, height);
        return error_fix(error, "give a width and a height of at least 1 pixel");
    }
    if (settings->kind == CAMERA_PERSPECTIVE && !(settings->fov > 0.0f && settings->fov < 180.0f)) {
        error_set(error, "the camera's field of view of %g degrees is not between 0 and 180", (double)settings->fov);
        return error_fix(error, "set \"float fov\" to an angle such as 45");
    }
    if (!(settings->frame_aspect >= 0.0f && isfinite(settings->frame_aspect))) {
        error_set(error, "the camera's frame aspect ratio %g is not positive", (double)settings->frame_aspect);
        return error_fix(error, "leave \"float frameaspectratio\" out to use the film's width / height");
    }
    if (!(settings->lens_radius >= 0.0f && isfinite(settings->lens_radius))) {
        error_set(error, "the camera's lens radius %g is negative or not finite", (double)settings->lens_radius);
        return error_fix(error, "set \"float lensradius\" to 0 for a pinhole");
    }
    if (settings->lens_radius > 0.0f && !(settings->focal_distance > 0.0f && isfinite(settings->focal_distance))) {
        error_set(error, "the camera's focal distance %g is not positive", (double)settings->focal_distance);
        return error_fix(error, "set \"float focaldistance\" to the distance of the plane in focus");
    }
    return true;
}

/* Computes x_min x_max y_min y_max. As in pbrt, a window may be mirrored, but not empty. */
static bool screen_window(const CameraSettings *settings, double film_aspect, double window[4], Error *error)
{
    double aspect = settings->frame_aspect > 0.0f ? (double)settings->frame_aspect : film_aspect;
    window[1] = aspect > 1.0 ? aspect : 1.0;
    window[3] = aspect > 1.0 ? 1.0 : 1.0 / aspect;
    window[0] = -window[1];
    window[2] = -window[3];
    if (!settings->has_screen_window)
        return true;
    for (int i = 0; i < 4; ++i)
        window[i] = (double)settings->screen_window[i];
    if (isfinite(window[0] + window[1] + window[2] + window[3]) && window[0] != window[1] && window[2] != window[3])
        return true;
    error_set(error, "the camera's screen window [%g %g %g %g] is empty", window[0], window[1], window[2], window[3]);
    return error_fix(error, "give x_min x_max y_min y_max, or leave \"float screenwindow\" out");
}

/* Exponent of the power of two at or below the length in the world of one unit of camera space. */
static int unit_exponent(const double world_from_camera[16])
{
    Matrix matrix;
    memcpy(matrix.m, world_from_camera, sizeof matrix.m);
    double determinant = matrix_determinant(&matrix);
    return isnormal(determinant) ? ilogb(cbrt(fabs(determinant))) : 0;
}

/* A Scale before the camera can make units of camera space tiny or huge, and their squares or volumes leave the range
 * of floats. So camera space is rescaled by 2^exponent, which is exact, to units close to the world's. */
static void unit_change(CameraSettings *settings, int exponent)
{
    for (int i = 0; i < 12; ++i) {
        if (i % 4 < 3)
            settings->world_from_camera[i] = ldexp(settings->world_from_camera[i], -exponent);
        settings->camera_from_world[i] = ldexp(settings->camera_from_world[i], exponent);
    }
    settings->lens_radius = ldexpf(settings->lens_radius, exponent);
    settings->focal_distance = ldexpf(settings->focal_distance, exponent);
}

/* Limit of lens radii in world units, the same as for coordinates. */
#define LENGTH_MAX 1e12f

static bool lens_check(const CameraSettings *settings, Error *error)
{
    if (settings->lens_radius <= 0.0f || (settings->lens_radius < LENGTH_MAX && settings->focal_distance > 0.0f &&
                                          settings->focal_distance < 1e6f * LENGTH_MAX))
        return true;
    error_set(error, "the camera's lens has a radius of %g and is in focus at %g, in units of the world",
              (double)settings->lens_radius, (double)settings->focal_distance);
    return error_fix(error, "set \"float lensradius\" to 0 for a pinhole, or look for a Scale before the Camera "
                            "directive: camera space is scaled by it");
}

bool camera_setup(const CameraSettings *given, int width, int height, Camera *out, Error *error)
{
    double window[4];
    CameraSettings settings = *given;
    int exponent = unit_exponent(given->world_from_camera);
    if (!settings_check(given, width, height, error) ||
        !screen_window(given, (double)width / (double)height, window, error))
        return false;
    unit_change(&settings, exponent);
    if (!lens_check(&settings, error))
        return false;
    double scale = ldexp(1.0, exponent);
    if (settings.kind == CAMERA_PERSPECTIVE)
        scale = tan((double)settings.fov * (M_PI / 360.0));
    *out = (Camera){.kind = settings.kind,
                    .lens_radius = settings.lens_radius,
                    .focal_distance = settings.focal_distance,
                    .medium = settings.medium};
    for (int i = 0; i < 4; ++i)
        out->screen[i] = (float)(scale * window[i]);
    return affine_set(settings.world_from_camera, &out->world_from_camera, error) &&
           affine_set(settings.camera_from_world, &out->camera_from_world, error);
}

void camera_matrices(const CameraSettings *settings, const Camera *camera, Vec3 origin, float world_to_camera[16],
                     float world_to_ndc[16])
{
    Matrix view, to_window = matrix_identity(),
                 move = matrix_translate(-(double)origin.x, -(double)origin.y, -(double)origin.z);
    memcpy(view.m, settings->camera_from_world, sizeof view.m);
    Matrix world = matrix_multiply(&view, &move);
    for (int i = 0; i < 16; ++i) {
        world_to_camera[i] = (float)world.m[i];
        world_to_ndc[i] = 0.0f;
    }
    if (camera->kind >= CAMERA_EQUAL_AREA)
        return;
    /* an orthographic window is in rescaled units, 2^exponent times the settings'; a perspective one has tangents */
    double unit = camera->kind == CAMERA_PERSPECTIVE ? 1.0 : ldexp(1.0, -unit_exponent(settings->world_from_camera));
    const double left = unit * (double)camera->screen[0], right = unit * (double)camera->screen[1],
                 low = unit * (double)camera->screen[2], high = unit * (double)camera->screen[3];
    int across = camera->kind == CAMERA_PERSPECTIVE ? 2 : 3; /* column of the divisor: z, or 1 */
    to_window.m[0] = 1.0 / (right - left);
    to_window.m[5] = 1.0 / (low - high);
    to_window.m[across] = -left / (right - left);
    to_window.m[4 + across] = -high / (low - high);
    if (camera->kind == CAMERA_PERSPECTIVE) {
        to_window.m[10] = to_window.m[15] = 0.0;
        to_window.m[11] = to_window.m[14] = 1.0; /* z becomes 1 / z */
    }
    Matrix picture = matrix_multiply(&to_window, &world);
    for (int i = 0; i < 16; ++i)
        world_to_ndc[i] = (float)picture.m[i];
}
