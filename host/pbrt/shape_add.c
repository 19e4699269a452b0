#include "pbrt/shape_add.h"

#include "pbrt/media_places.h"
#include "pbrt/state.h"
#include "pbrt/values.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool point_transform(const Matrix *matrix, float p[3])
{
    double in[3] = {(double)p[0], (double)p[1], (double)p[2]}, out[3];
    matrix_point(matrix, in, out);
    for (int k = 0; k < 3; ++k) {
        if (!(fabs(out[k]) <= IMPORT_COORDINATE_MAX))
            return false;
        p[k] = (float)out[k];
    }
    return true;
}

static void normal_transform(const Matrix *inverse, bool reverse, float n[3])
{
    double in[3] = {(double)n[0], (double)n[1], (double)n[2]}, out[3];
    matrix_normal(inverse, in, out);
    double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    double scale = length > 0.0 && isfinite(length) ? (reverse ? -1.0 : 1.0) / length : 0.0;
    for (int k = 0; k < 3; ++k)
        n[k] = scale != 0.0 ? (float)(out[k] * scale) : 0.0f;
}

/* Transforms points and normals by ctm. */
static bool mesh_transform(PbrtImport *im, const ShapeContext *context, bool reverse, float *positions, float *normals,
                           size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (!point_transform(&context->ctm, &positions[3 * i])) {
            error_at(im->error, context->place, "vertex %zu is not finite, or beyond %g, after the transform", i,
                     IMPORT_COORDINATE_MAX);
            return error_fix(im->error, "check the vertices and the current transform for huge numbers");
        }
    for (size_t i = 0; normals && i < count; ++i)
        normal_transform(&context->inverse, reverse, &normals[3 * i]);
    return true;
}

/* Converts the power of the area lights from first_light on to radiance. As in pbrt, each primitive has the whole
 * power: radiance = power / (pi area), half of that for a two-sided light. */
static void power_apply(Scene *scene, size_t first_light, const AreaEmission *emission)
{
    float sides = emission->flags & LIGHT_TWO_SIDED ? 2.0f : 1.0f;
    for (size_t i = first_light; emission->by_power && i < scene->lights.count; ++i) {
        Light *light = &ARRAY_AT(&scene->lights, Light, i);
        light->emission = vec3_scale(light->emission, 1.0f / (PI * sides * light->area));
    }
}

static void *arena_copy(PbrtImport *im, const void *data, size_t bytes)
{
    void *copy = arena_alloc(&im->arena, bytes, im->error);
    return copy ? memcpy(copy, data, bytes) : NULL;
}

/* Stores an emissive shape of an object definition for its instances. */
static bool emissive_keep(PbrtImport *im, EmissiveShape shape)
{
    ImportObject *object = &ARRAY_AT(&im->object_definitions, ImportObject, im->open_object);
    MeshData *mesh = &shape.mesh;
    size_t corners = shape.kind == PRIMITIVE_TRIANGLE ? 3 : 4;
    if (mesh->vertex_count > 0) {
        size_t bytes = mesh->vertex_count * sizeof(float);
        if (!(mesh->positions = arena_copy(im, mesh->positions, 3 * bytes)) ||
            (mesh->normals && !(mesh->normals = arena_copy(im, mesh->normals, 3 * bytes))) ||
            (mesh->uvs && !(mesh->uvs = arena_copy(im, mesh->uvs, 2 * bytes))) ||
            !(mesh->indices = arena_copy(im, mesh->indices, corners * mesh->triangle_count * sizeof(uint))))
            return false;
    }
    EmissiveShape *kept = arena_copy(im, &shape, sizeof shape);
    if (!kept)
        return false;
    if (object->last_emissive)
        object->last_emissive->next = kept;
    else
        object->emissive = kept;
    object->last_emissive = kept;
    return true;
}

/* Bounds of the space that shapes are currently added to: the world or an object definition. */
static Box *space_box(PbrtImport *im)
{
    return im->open_object < 0 ? &im->world : &ARRAY_AT(&im->object_definitions, ImportObject, im->open_object).box;
}

/* Adds a mesh whose vertices are already transformed. */
static bool mesh_emit(PbrtImport *im, uint kind, const MeshData *mesh, Shape shape, const AreaEmission *emission)
{
    Box *box = space_box(im);
    for (size_t i = 0; i < mesh->vertex_count; ++i)
        box_add(box, vec3(mesh->positions[3 * i], mesh->positions[3 * i + 1], mesh->positions[3 * i + 2]));
    size_t first_light = im->scene->lights.count;
    const float *radiance = emission ? emission->radiance : NULL;
    uint flags = emission ? emission->flags : 0u;
    bool good = kind == PRIMITIVE_TRIANGLE ? scene_add_mesh(im->scene, mesh, shape, radiance, flags, im->error)
                                           : scene_add_patches(im->scene, mesh, shape, radiance, flags, im->error);
    if (good && emission)
        power_apply(im->scene, first_light, emission);
    return good && media_places_lights(im, first_light);
}

bool shape_add_mesh(PbrtImport *im, const ShapeContext *context, uint kind, float *positions, float *normals,
                    const MeshData *mesh)
{
    MeshData moved = *mesh;
    moved.positions = positions;
    moved.normals = normals;
    if (!mesh_transform(im, context, context->shape.flags & SHAPE_REVERSE, positions, normals, mesh->vertex_count))
        return false;
    if (context->invisible)
        return true;
    if (context->emits && im->open_object >= 0)
        return emissive_keep(im, (EmissiveShape){.kind = kind,
                                                 .mesh = moved,
                                                 .shape = context->shape,
                                                 .emission = context->emission,
                                                 .place = context->place});
    return mesh_emit(im, kind, &moved, context->shape, context->emits ? &context->emission : NULL);
}

bool shape_add_curves(PbrtImport *im, const ShapeContext *context, CurveData *data, Curve *curves)
{
    float scale = (float)cbrt(fabs(matrix_determinant(&context->ctm)));
    Box *box = space_box(im);
    for (size_t i = 0; i < data->count; ++i) {
        Curve *curve = &curves[i];
        curve->width[0] *= scale;
        curve->width[1] *= scale;
        if (!mesh_transform(im, context, false, &curve->p[0].x, NULL, 4))
            return false;
        for (int k = 0; k < 4; ++k)
            box_add(box, curve->p[k]);
    }
    data->curves = curves;
    return scene_add_curves(im->scene, data, context->shape, im->error);
}

/* Whether the corners of the quadric's bounding box are in range; an error if not. */
static bool quadric_fits(PbrtImport *im, const Quadric *quadric, const Matrix *matrix)
{
    double height = fmax(fabs((double)quadric->z_min), fabs((double)quadric->z_max));
    double radius = fmax((double)quadric->radius, height);
    for (int i = 0; i < 3; ++i) {
        const double *row = &matrix->m[4 * i];
        if (!(fabs(row[3]) + radius * (fabs(row[0]) + fabs(row[1]) + fabs(row[2])) <= IMPORT_COORDINATE_MAX)) {
            error_at(im->error, im->place, "the shape reaches beyond %g after the transform", IMPORT_COORDINATE_MAX);
            return error_fix(im->error, "check the shape and the current transform for huge numbers");
        }
    }
    return true;
}

static bool quadric_emit(PbrtImport *im, uint kind, const Quadric *quadric, const Matrix *matrix, const Matrix *inverse,
                         Shape shape, const AreaEmission *emission)
{
    size_t first_light = im->scene->lights.count;
    const QuadricData data = {kind, *quadric, matrix->m, inverse->m};
    if (!quadric_fits(im, quadric, matrix) ||
        !scene_add_quadric(im->scene, &data, shape, emission ? emission->radiance : NULL,
                           emission ? emission->flags : 0u, im->error))
        return false;
    Box box = quadric_box(&ARRAY_AT(&im->scene->quadrics, Quadric, im->scene->quadrics.count - 1), kind);
    box_join(space_box(im), &box);
    if (emission)
        power_apply(im->scene, first_light, emission);
    return media_places_lights(im, first_light);
}

bool shape_add_quadric(PbrtImport *im, const ShapeContext *context, uint kind, const Quadric *quadric)
{
    if (context->invisible)
        return true;
    if (context->emits && im->open_object >= 0)
        return emissive_keep(im, (EmissiveShape){.kind = kind,
                                                 .quadric = *quadric,
                                                 .matrix = context->ctm,
                                                 .shape = context->shape,
                                                 .emission = context->emission,
                                                 .place = context->place});
    return quadric_emit(im, kind, quadric, &context->ctm, &context->inverse, context->shape,
                        context->emits ? &context->emission : NULL);
}

static bool emissive_mesh_add(PbrtImport *im, const EmissiveShape *shape, const ShapeContext *context, Shape flags)
{
    /* Copies, because the transform overwrites them, and the next instance needs the definition again. */
    size_t floats = 3 * shape->mesh.vertex_count;
    Array copies;
    array_init(&copies, sizeof(float));
    float *positions = array_grow(&copies, floats * (shape->mesh.normals ? 2 : 1), im->error);
    if (!positions)
        return false;
    float *normals = shape->mesh.normals ? positions + floats : NULL;
    memcpy(positions, shape->mesh.positions, floats * sizeof(float));
    if (normals)
        memcpy(normals, shape->mesh.normals, floats * sizeof(float));
    bool good = mesh_transform(im, context, false, positions, normals, shape->mesh.vertex_count);
    if (good) {
        MeshData mesh = shape->mesh;
        mesh.positions = positions;
        mesh.normals = normals;
        good = mesh_emit(im, shape->kind, &mesh, flags, &shape->emission);
    }
    array_destroy(&copies);
    return good;
}

bool emissive_shape_add(PbrtImport *im, const EmissiveShape *shape, const Matrix *ctm)
{
    ShapeContext context = {.ctm = *ctm, .place = im->place};
    Shape flags = shape->shape;
    if (im->scene->lights.count + shape->mesh.triangle_count >= IMPORT_LIGHTS_MAX) {
        error_at(im->error, im->place, "the instances of emissive objects have more than %u area lights",
                 IMPORT_LIGHTS_MAX);
        return error_fix(im->error, "take the light source out of the object");
    }
    im->copied_vertices += shape->mesh.vertex_count;
    if (im->copied_vertices > IMPORT_COPIES_MAX) {
        error_at(im->error, im->place, "the instances of emissive objects copy more than %u vertices",
                 IMPORT_COPIES_MAX);
        return error_fix(im->error, "give the light source its own mesh, with few vertices");
    }
    bool quadric = PRIMITIVE_IS_QUADRIC(shape->kind);
    /* An instance is the image of its object (geometry/surface.h). A mesh's geometric normal is a cross product in
     * world space, which a reflection flips; a quadric's normal is transformed. */
    if (!quadric && matrix_swaps_handedness(ctm))
        flags.flags ^= SHAPE_FLIP_NORMAL;
    if (quadric)
        context.ctm = matrix_multiply(ctm, &shape->matrix);
    if (!import_inverse(im, im->place, &context.ctm, &context.inverse))
        return false;
    return quadric
               ? quadric_emit(im, shape->kind, &shape->quadric, &context.ctm, &context.inverse, flags, &shape->emission)
               : emissive_mesh_add(im, shape, &context, flags);
}
