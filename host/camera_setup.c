#include "camera_setup.h"

#include "matrix.h"

#include <math.h>

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

/* x_min x_max y_min y_max. A window may be mirrored, as in pbrt, but not empty. */
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

bool camera_setup(const CameraSettings *settings, int width, int height, Camera *out, Error *error)
{
    double window[4];
    if (!settings_check(settings, width, height, error) ||
        !screen_window(settings, (double)width / (double)height, window, error))
        return false;
    double scale = 1.0;
    if (settings->kind == CAMERA_PERSPECTIVE)
        scale = tan((double)settings->fov * (M_PI / 360.0));
    *out = (Camera){
        .kind = settings->kind, .lens_radius = settings->lens_radius, .focal_distance = settings->focal_distance};
    for (int i = 0; i < 4; ++i)
        out->screen[i] = (float)(scale * window[i]);
    return affine_set(settings->world_from_camera, &out->world_from_camera, error) &&
           affine_set(settings->camera_from_world, &out->camera_from_world, error);
}
