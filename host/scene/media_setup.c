#include "scene/media_setup.h"

#include "geometry/media_walk.h"
#include "light/delta.h"
#include "scene/grid_build.h"

#include <math.h>
#include <string.h>

/* Mean free paths of media_reach. */
#define REACH_PATHS 40.0f

static const Medium *medium_of(const Scene *scene, uint number)
{
    return &ARRAY_AT(&scene->media, Medium, number);
}

/* Which media some shape, light or the camera is in. */
static void media_used(const Scene *scene, bool used[MEDIA_MAX])
{
    memset(used, 0, MEDIA_MAX * sizeof *used);
    used[scene->camera_settings.medium] = true;
    for (size_t i = 0; i < scene->shapes.count; ++i) {
        uint flags = ARRAY_AT(&scene->shapes, Shape, i).flags;
        used[media_inside(flags)] = used[media_outside(flags)] = true;
    }
    for (size_t i = 0; i < scene->light_details.count; ++i)
        used[ARRAY_AT(&scene->light_details, LightDetail, i).medium] = true;
}

static ulong medium_features(const Medium *medium)
{
    return FEATURE_MEDIUM | (medium_scatters(medium) ? FEATURE_SCATTERING : 0u) |
           (vec3_is_zero(medium->emission) ? 0u : FEATURE_MEDIUM_EMISSION) |
           (medium->grid != 0u ? FEATURE_MEDIUM_GRID : 0u);
}

ulong media_features(const Scene *scene)
{
    bool used[MEDIA_MAX];
    ulong features = 0u;
    media_used(scene, used);
    for (uint i = 1; i < scene->media.count; ++i)
        features |= used[i] ? medium_features(medium_of(scene, i)) : 0u;
    return features;
}

void media_box_join(const Scene *scene, Box *world)
{
    bool used[MEDIA_MAX];
    media_used(scene, used);
    for (uint i = 1; i < scene->media.count; ++i) {
        const Medium *medium = medium_of(scene, i);
        if (!used[i] || medium->grid == 0u)
            continue;
        Box box = grid_box(&ARRAY_AT(&scene->grids, MediumGrid, medium->grid - 1u));
        box_join(world, &box);
    }
}

/* ---- the medium around the scene --------------------------------------------------------------------------------- */

/* Any direction: surfaces that separate media should be closed, so that all lead to the same medium. */
static const Vec3 OUTWARDS = {0.36f, 0.48f, 0.8f};

/* The first surface that separates media among the primitives of an object. */
static void separation_find(const SceneView *view, const Object *object, uint instance, const RayQuery *query, Hit *hit)
{
    for (uint i = object->first_primitive; i < object->first_primitive + object->primitive_count; ++i) {
        uint shape = view->primitives[i].shape_and_kind & PRIMITIVE_SHAPE_MASK;
        if (media_differ(view->shapes[shape].flags))
            primitive_intersect(view, i, instance, query, hit);
    }
}

static Hit separation_next(const Scene *scene, const SceneView *view, const Ray *ray)
{
    Hit hit = hit_none(ray->t_max);
    RayQuery query = ray_query(*ray);
    separation_find(view, view->objects, NONE, &query, &hit);
    for (size_t i = 0; i < scene->instances.count; ++i) {
        const Instance *instance = &view->instances[i];
        RayQuery inner = ray_query_transform(instance->object_from_world, &query);
        separation_find(view, view->objects + instance->object, (uint)i, &inner, &hit);
    }
    return hit;
}

/* The medium that a ray from the camera is in when it has left the scene. */
static uint medium_around(const Scene *scene)
{
    const double *camera = scene->camera_settings.world_from_camera;
    uint medium = scene->camera_settings.medium;
    ulong features = scene->features & ~(FEATURE_ALPHA | FEATURE_TEXTURE | FEATURE_TANGENTS);
    SceneView view = {.features = features,
                      .positions = scene->positions.data,
                      .normals = scene->normals.data,
                      .uvs = scene->uvs.data,
                      .primitives = scene->primitives.data,
                      .shapes = scene->shapes.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .curves = scene->curves.data,
                      .objects = scene->objects.data,
                      .instances = scene->instances.data};
    Ray ray = {vec3((float)camera[3], (float)camera[7], (float)camera[11]), OUTWARDS, FLOAT_MAX};
    for (uint crossings = 0; crossings < CROSSINGS_MAX; ++crossings) {
        Hit hit = separation_next(scene, &view, &ray);
        if (hit.primitive == NONE)
            break;
        Surface surface = surface_from_hit(&view, &ray, hit);
        medium = medium_towards(view.shapes[surface.shape].flags, surface.ng, ray.d);
        ray = ray_spawn(surface.p, surface.ng, ray.d);
    }
    return medium;
}

void media_lights_setup(Scene *scene)
{
    if (!(scene->features & FEATURE_MEDIUM))
        return;
    uint around = medium_around(scene);
    const Medium *medium = medium_of(scene, around);
    Vec3 extinction = medium->grid == 0u ? medium->extinction : vec3_splat(0.0f); /* grids end */
    for (size_t i = 0; i < scene->lights.count; ++i) {
        Light *light = &ARRAY_AT(&scene->lights, Light, i);
        if (!light_is_far(light_kind(light)))
            continue;
        scene_light_detail(scene, light)->medium = around;
        light->emission.x = extinction.x > 0.0f ? 0.0f : light->emission.x;
        light->emission.y = extinction.y > 0.0f ? 0.0f : light->emission.y;
        light->emission.z = extinction.z > 0.0f ? 0.0f : light->emission.z;
    }
}

float media_reach(const Scene *scene)
{
    if (!(scene->features & FEATURE_SCATTERING))
        return 0.0f;
    const Medium *medium = medium_of(scene, medium_around(scene));
    const float extinction[3] = {medium->extinction.x, medium->extinction.y, medium->extinction.z};
    float reach = 0.0f;
    bool endless = medium_scatters(medium) && medium->grid == 0u;
    for (int c = 0; endless && c < 3; ++c)
        if (extinction[c] > 0.0f)
            reach = fmaxf(reach, REACH_PATHS / extinction[c]);
    return reach;
}
