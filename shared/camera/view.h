/* The scene's camera, of whatever kind. */
#ifndef TWINLIGHT_CAMERA_VIEW_H
#define TWINLIGHT_CAMERA_VIEW_H

#include "camera/spherical.h"
#include "layout/scene_view.h"

/* camera_ray of the scene's camera. */
SHARED_FUNCTION Ray view_ray(const SceneView *scene, Vec2 film, Vec2 u_lens)
{
    Camera camera = scene->frame->camera;
    float width = (float)scene->frame->film.width, height = (float)scene->frame->film.height;
    if (SCENE_HAS(scene, FEATURE_SPHERICAL_CAMERA))
        return spherical_ray(&camera, film, width, height);
    return camera_ray(&camera, film, width, height, u_lens);
}

/* camera_pdf of the scene's camera. */
SHARED_FUNCTION float view_pdf(const SceneView *scene, Vec3 lens, Vec3 d, float distance)
{
    if (SCENE_HAS(scene, FEATURE_SPHERICAL_CAMERA))
        return spherical_pdf(scene->frame, d, distance);
    return camera_pdf(scene->frame, lens, d, distance);
}

/* camera_connect of the scene's camera. */
SHARED_FUNCTION bool view_connect(const SceneView *scene, Vec3 p, Vec2 u_lens, CameraConnection *connection)
{
    if (SCENE_HAS(scene, FEATURE_SPHERICAL_CAMERA))
        return spherical_connect(scene->frame, p, u_lens.x, connection);
    return camera_connect(scene->frame, p, u_lens, connection);
}

#endif
