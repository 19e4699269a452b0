/* Floats near c are c 2^-23 apart, so edges, distances and ray origins lose precision in proportion to c over the size
 * of the scene. Subtracting two floats within a factor of two of each other is exact (P. H. Sterbenz, "Floating-Point
 * Computation", 1974): moving such a scene to the origin loses nothing, and later differences are no longer rounded.
 * Coordinates computed by transforms in double precision need not be rounded at the distant position at all: the
 * importer knows the world's position once it has read the scene, and reads it again (pbrt/import.c). */
#include "scene/center.h"

#include "base/matrix.h"
#include "light/delta.h"

#include <math.h>

/* Least distance of a world from the origin, in half extents, for it to be moved. Every coordinate is then within a
 * factor of two of the centre. */
#define FAR_EXTENTS 8.0f

Vec3 scene_center_offset(const Box *world)
{
    float center[3], half = 0.0f;
    for (int i = 0; i < 3; ++i) {
        center[i] = 0.5f * world->low[i] + 0.5f * world->high[i];
        half = fmaxf(half, 0.5f * (world->high[i] - world->low[i]));
    }
    for (int i = 0; i < 3; ++i)
        if (!(fabsf(center[i]) > FAR_EXTENTS * half))
            center[i] = 0.0f;
    return vec3(center[0], center[1], center[2]);
}

static Vec3 affine_translation(const Affine *a)
{
    return vec3(a->m[3], a->m[7], a->m[11]);
}

/* Adjusts a transform that takes world points p, so that it maps the moved point p - offset like p before. */
static void argument_move(Affine *a, Vec3 offset)
{
    for (int i = 0; i < 12; i += 4)
        a->m[i + 3] = (float)((double)a->m[i + 3] + (double)a->m[i] * (double)offset.x +
                              (double)a->m[i + 1] * (double)offset.y + (double)a->m[i + 2] * (double)offset.z);
}

/* Moves the transform from object to world and recomputes its inverse, because the translation has been rounded. */
static void placement_move(Affine *world_from_object, Affine *object_from_world, Vec3 offset)
{
    Matrix m = matrix_identity(), inverse;
    Vec3 t = vec3_sub(affine_translation(world_from_object), offset);
    world_from_object->m[3] = t.x;
    world_from_object->m[7] = t.y;
    world_from_object->m[11] = t.z;
    for (int i = 0; i < 12; ++i)
        m.m[i] = (double)world_from_object->m[i];
    if (matrix_inverse(&m, &inverse) && matrix_fits_float(&inverse))
        *object_from_world = matrix_affine(inverse.m);
    else
        argument_move(object_from_world, offset);
}

/* Vertices are in the order of shapes. Object 0 is the world; others are placed by instances. */
static void vertices_move(Scene *scene, Vec3 offset)
{
    Vec3 *positions = scene->positions.data;
    for (size_t s = 0; s < scene->shapes.count; ++s) {
        size_t first = ARRAY_AT(&scene->shapes, Shape, s).first_vertex;
        size_t end =
            s + 1 < scene->shapes.count ? ARRAY_AT(&scene->shapes, Shape, s + 1).first_vertex : scene->positions.count;
        if (ARRAY_AT(&scene->shape_objects, uint, s) != 0)
            continue;
        for (size_t i = first; i < end; ++i)
            positions[i] = vec3_sub(positions[i], offset);
    }
}

static void quadrics_move(Scene *scene, Vec3 offset)
{
    const Object *world = &ARRAY_AT(&scene->objects, Object, 0);
    for (uint i = 0; i < world->primitive_count; ++i) {
        const Primitive *p = &ARRAY_AT(&scene->primitives, Primitive, world->first_primitive + i);
        if (!PRIMITIVE_IS_QUADRIC(p->shape_and_kind >> PRIMITIVE_KIND_SHIFT))
            continue;
        Quadric *quadric = &ARRAY_AT(&scene->quadrics, Quadric, p->a);
        placement_move(&quadric->world_from_object, &quadric->object_from_world, offset);
        quadric->center = affine_translation(&quadric->world_from_object);
    }
}

static void curves_move(Scene *scene, Vec3 offset)
{
    const Object *world = &ARRAY_AT(&scene->objects, Object, 0);
    for (uint i = 0; i < world->primitive_count; ++i) {
        const Primitive *p = &ARRAY_AT(&scene->primitives, Primitive, world->first_primitive + i);
        if (p->shape_and_kind >> PRIMITIVE_KIND_SHIFT != PRIMITIVE_CURVE || CURVE_INDEX(p->b) != 0)
            continue;
        Curve *curve = &ARRAY_AT(&scene->curves, Curve, p->a);
        for (int k = 0; k < 4; ++k)
            curve->p[k] = vec3_sub(curve->p[k], offset);
    }
}

void camera_move(CameraSettings *camera, Vec3 offset)
{
    const double c[3] = {(double)offset.x, (double)offset.y, (double)offset.z};
    for (int i = 0; i < 3; ++i) {
        camera->world_from_camera[4 * i + 3] -= c[i];
        for (int k = 0; k < 3; ++k)
            camera->camera_from_world[4 * i + 3] += camera->camera_from_world[4 * i + k] * c[k];
    }
}

bool scene_center(Scene *scene, const Box *world)
{
    Vec3 offset = scene_center_offset(world);
    if (offset.x == 0.0f && offset.y == 0.0f && offset.z == 0.0f)
        return false;
    vertices_move(scene, offset);
    quadrics_move(scene, offset);
    curves_move(scene, offset);
    for (size_t i = 0; i < scene->instances.count; ++i) {
        Instance *instance = &ARRAY_AT(&scene->instances, Instance, i);
        placement_move(&instance->world_from_object, &instance->object_from_world, offset);
    }
    for (size_t i = 0; i < scene->lights.count; ++i) {
        const Light *light = &ARRAY_AT(&scene->lights, Light, i);
        if (!light_has_position(light_kind(light)))
            continue;
        LightDetail *detail = scene_light_detail(scene, light);
        detail->position = vec3_sub(detail->position, offset);
    }
    for (size_t i = 0; i < scene->portals.count; ++i) {
        Portal *portal = &ARRAY_AT(&scene->portals, Portal, i);
        portal->corner = vec3_sub(portal->corner, offset);
    }
    for (size_t i = 0; i < scene->texture_ops.count; ++i)
        argument_move(&ARRAY_AT(&scene->texture_ops, TextureOp, i).texture_from_world, offset);
    for (size_t i = 0; i < scene->grids.count; ++i)
        argument_move(&ARRAY_AT(&scene->grids, MediumGrid, i).grid_from_world, offset);
    camera_move(&scene->camera_settings, offset);
    return true;
}
