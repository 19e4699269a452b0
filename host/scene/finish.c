/* Derives what the kernels read from the arrays filled by an importer: order, bounds, features, tables. */
#include "scene/scene.h"

#include "geometry/box.h"
#include "light/delta.h"
#include "scene/aim_setup.h"
#include "scene/camera_setup.h"
#include "scene/center.h"
#include "scene/coats_setup.h"
#include "scene/features.h"
#include "scene/filter_setup.h"
#include "scene/light_guide_setup.h"
#include "scene/light_setup.h"
#include "scene/media_setup.h"
#include "scene/pack.h"
#include "scene/portal_setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- order of primitives ---------------------------------------------------------------------------------------- */

/* Assigns every object its range of primitives; `ends[s]` is the present end of shape s. */
static void objects_place(Scene *scene, const uint *ends)
{
    Object *objects = scene->objects.data;
    const uint *shape_objects = scene->shape_objects.data;
    for (size_t o = 0; o < scene->objects.count; ++o)
        objects[o].primitive_count = 0;
    for (size_t s = 0; s < scene->shapes.count; ++s)
        objects[shape_objects[s]].primitive_count += ends[s] - ARRAY_AT(&scene->shapes, Shape, s).first_primitive;
    uint next = 0;
    for (size_t o = 0; o < scene->objects.count; ++o) {
        objects[o].first_primitive = next;
        next += objects[o].primitive_count;
    }
}

/* Copies the primitives shape by shape to `sorted`, grouped by object, and updates the indices that refer to them. */
static void primitives_copy(Scene *scene, const uint *ends, uint *cursors, Primitive *sorted)
{
    const Primitive *old = scene->primitives.data;
    const uint *shape_objects = scene->shape_objects.data;
    for (size_t o = 0; o < scene->objects.count; ++o)
        cursors[o] = ARRAY_AT(&scene->objects, Object, o).first_primitive;
    for (size_t s = 0; s < scene->shapes.count; ++s) {
        Shape *shape = &ARRAY_AT(&scene->shapes, Shape, s);
        uint to = cursors[shape_objects[s]], count = ends[s] - shape->first_primitive;
        if (count > 0)
            memcpy(sorted + to, old + shape->first_primitive, count * sizeof *sorted);
        for (uint i = 0; shape->first_light != NONE && i < count; ++i)
            ARRAY_AT(&scene->lights, Light, shape->first_light + i).primitive = to + i;
        shape->first_primitive = to;
        cursors[shape_objects[s]] += count;
    }
}

/* Primitives of an object must be consecutive, but object definitions are interleaved with the world's shapes. Moves
 * whole shapes, keeping their order, and updates the lights. */
static bool primitives_group_by_object(Scene *scene, Error *error)
{
    size_t shape_count = scene->shapes.count, total = scene->primitives.count;
    Primitive *sorted = malloc((total + 1) * sizeof *sorted);
    uint *ends = malloc((shape_count + scene->objects.count + 1) * sizeof *ends);
    if (!sorted || !ends) {
        free(sorted);
        free(ends);
        return error_memory(error, total * sizeof *sorted, "primitives");
    }
    for (size_t s = 0; s < shape_count; ++s)
        ends[s] = s + 1 < shape_count ? ARRAY_AT(&scene->shapes, Shape, s + 1).first_primitive : (uint)total;
    objects_place(scene, ends);
    primitives_copy(scene, ends, ends + shape_count, sorted);
    if (total > 0)
        memcpy(scene->primitives.data, sorted, total * sizeof *sorted);
    free(sorted);
    free(ends);
    return true;
}

/* ---- bounds ----------------------------------------------------------------------------------------------------- */

/* A view with the members that primitive_box and scene/smooth_boxes.h read, on the arrays before packing. */
static SceneView geometry_view(const Scene *scene)
{
    return (SceneView){.positions = scene->positions.data,
                       .primitives = scene->primitives.data,
                       .shapes = scene->shapes.data,
                       .patches = scene->patches.data,
                       .quadrics = scene->quadrics.data,
                       .curves = scene->curves.data};
}

static Box object_box(const Scene *scene, const Object *object)
{
    SceneView view = geometry_view(scene);
    Box box = box_empty();
    for (uint i = 0; i < object->primitive_count; ++i) {
        Box primitive = primitive_box(&view, object->first_primitive + i);
        box_join(&box, &primitive);
    }
    return box;
}

/* Bounding box of everything in world space; raises *largest to the largest coordinate in any object's space. */
static bool world_box(const Scene *scene, Box *world, float *largest, Error *error)
{
    Box *objects = malloc(scene->objects.count * sizeof *objects);
    if (!objects)
        return error_memory(error, scene->objects.count * sizeof *objects, "bounds");
    for (size_t o = 0; o < scene->objects.count; ++o) {
        objects[o] = object_box(scene, &ARRAY_AT(&scene->objects, Object, o));
        *largest = fmaxf(*largest, box_largest(&objects[o]));
    }
    *world = objects[0];
    for (size_t i = 0; i < scene->instances.count; ++i) {
        const Instance *instance = &ARRAY_AT(&scene->instances, Instance, i);
        if (box_is_empty(&objects[instance->object]))
            continue;
        Box placed = box_transform(&objects[instance->object], instance->world_from_object);
        box_join(world, &placed);
    }
    free(objects);
    media_box_join(scene, world);
    if (box_is_empty(world)) /* no geometry: an environment alone is a valid scene */
        *world = (Box){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    *largest = fmaxf(*largest, box_largest(world));
    return true;
}

static void world_sphere_set(SceneParams *params, const Box *world)
{
    double square = 0.0, center[3];
    for (int i = 0; i < 3; ++i) {
        double half = 0.5 * ((double)world->high[i] - (double)world->low[i]);
        center[i] = 0.5 * ((double)world->low[i] + (double)world->high[i]);
        square += half * half;
    }
    params->world_center = vec3((float)center[0], (float)center[1], (float)center[2]);
    params->world_radius = (float)(sqrt(square) * 1.0001);
}

static bool scene_bounds(Scene *scene, Error *error)
{
    Box world = box_empty();
    float largest = 0.0f;
    if (!world_box(scene, &world, &largest, error))
        return false;
    const float origin[3] = {scene->origin.x, scene->origin.y, scene->origin.z};
    for (int i = 0; i < 3; ++i) {
        scene->bounds_min[i] = world.low[i] + origin[i];
        scene->bounds_max[i] = world.high[i] + origin[i];
    }
    if (scene->movable && scene_center(scene, &world)) {
        largest = 0.0f;
        if (!world_box(scene, &world, &largest, error))
            return false;
    }
    for (int i = 0; i < 3; ++i)
        largest = fmaxf(largest, fabsf((float)scene->camera_settings.world_from_camera[4 * i + 3]));
    if (!(largest <= 2e12f)) { /* allows for rounding of the importer's limit 1e12 and transforms of instances */
        error_set(error, "the scene reaches to %g, where float32 arithmetic overflows", (double)largest);
        return error_fix(error, "scale the scene down, or remove the stray vertices");
    }
    world_sphere_set(&scene->frame.scene, &world);
    scene->ray_reach = box_largest(&world);
    return true;
}

/* Upper bound of the coordinates of camera ray origins. */
static float camera_reach(const Camera *camera)
{
    Vec3 origin = vec3(camera->lens_radius, camera->lens_radius, 0.0f);
    if (camera->kind == CAMERA_ORTHOGRAPHIC) {
        origin.x += fmaxf(fabsf(camera->screen[0]), fabsf(camera->screen[1]));
        origin.y += fmaxf(fabsf(camera->screen[2]), fabsf(camera->screen[3]));
    }
    return vec3_max_abs(affine_magnitude(camera->world_from_camera, origin));
}

/* The same for rays from a light: those from infinity start on a disk of the bounding sphere's radius, tangent to
 * it, or as far from it as the portal that they pass. */
static float light_reach(const Scene *scene, const Light *light)
{
    const SceneParams *params = &scene->frame.scene;
    float portal = 0.0f;
    uint kind = light_kind(light);
    if (kind == LIGHT_AREA)
        return 0.0f;
    const LightDetail *detail = scene_light_detail(scene, light);
    if (light_has_position(kind))
        return vec3_max_abs(detail->position);
    for (int i = 0; kind == LIGHT_PORTAL && i < 4; ++i) {
        Vec3 corner = portal_corner(&ARRAY_AT(&scene->portals, Portal, detail->portal), i);
        portal = fmaxf(portal, vec3_length(vec3_sub(corner, params->world_center)));
    }
    return vec3_max_abs(params->world_center) + fmaxf(1.5f * params->world_radius, portal + params->world_radius);
}

/* ---- entry points ------------------------------------------------------------------------------------------------ */

bool scene_film_set(Scene *scene, int width, int height, const int crop[4], Error *error)
{
    FilmParams *film = &scene->frame.film;
    if (width < 1 || height < 1 || (int64_t)width * height > INT32_MAX) {
        error_set(error, "the film size %d x %d is not between 1 and 2^31 pixels", width, height);
        return error_fix(error, "choose another --resolution");
    }
    if (crop[0] < 0 || crop[1] < 0 || crop[2] > width || crop[3] > height || crop[0] >= crop[2] || crop[1] >= crop[3]) {
        error_set(error, "the crop %d,%d,%d,%d is empty or outside the film of %d x %d pixels", crop[0], crop[1],
                  crop[2], crop[3], width, height);
        return error_fix(error, "give x0,y0,x1,y1 with 0 <= x0 < x1 <= %d and 0 <= y0 < y1 <= %d", width, height);
    }
    scene->settings.width = width;
    scene->settings.height = height;
    memcpy(scene->settings.crop, crop, 4 * sizeof *crop);
    film->width = (uint)width;
    film->height = (uint)height;
    film->crop_x0 = (uint)crop[0];
    film->crop_y0 = (uint)crop[1];
    film->crop_x1 = (uint)crop[2];
    film->crop_y1 = (uint)crop[3];
    if (!camera_setup(&scene->camera_settings, width, height, &scene->frame.camera, error))
        return false;
    /* the factor covers ray_offset and other rounding */
    float reach = (1.0f + 64.0f * FLOAT_EPSILON) * fmaxf(scene->ray_reach, camera_reach(&scene->frame.camera));
    scene->frame.scene.ray_reach = fminf(reach, RAY_COMPONENT_MAX);
    return true;
}

bool scene_finish(Scene *scene, Error *error)
{
    if (scene->objects.count == 0 && !array_grow(&scene->objects, 1, error))
        return false;
    if (!primitives_group_by_object(scene, error) || !scene_bounds(scene, error))
        return false;
    scene_features_set(scene, scene_features(scene));
    scene->primitive_count = scene->primitives.count;
    if (!coats_setup(scene, error) ||
        !filter_setup(&scene->filter_settings, &scene->lookup, &scene->frame.film.filter, error))
        return false;
    if (!media_lights_setup(scene, error) || !light_setup(scene, error))
        return false;
    for (size_t i = 0; i < scene->lights.count; ++i)
        scene->ray_reach = fmaxf(scene->ray_reach, light_reach(scene, &ARRAY_AT(&scene->lights, Light, i)));
    scene->ray_reach += media_reach(scene);
    light_guide_setup(scene);
    SceneView view = geometry_view(scene);
    if (!aim_setup(scene, &view, error))
        return false;
    scene->frame.scene.light_count = (uint)scene->lights.count;
    scene->frame.scene.infinite_light_count = (uint)scene->infinite_lights.count;
    scene->frame.pass.pixel_stride = 1;
    scene->frame.path.max_depth = (uint)scene->settings.max_depth;
    return scene_pack(scene, error) &&
           scene_film_set(scene, scene->settings.width, scene->settings.height, scene->settings.crop, error);
}
