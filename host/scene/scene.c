#include "scene/scene.h"

#include "base/matrix.h"
#include "scene/primitive_area.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define MEMBER_ARRAYS(X)                                                                                               \
    X(positions, Vec3)                                                                                                 \
    X(normals, Vec3)                                                                                                   \
    X(uvs, Vec2)                                                                                                       \
    X(primitives, Primitive)                                                                                           \
    X(shapes, Shape)                                                                                                   \
    X(patches, Patch)                                                                                                  \
    X(quadrics, Quadric)                                                                                               \
    X(curves, Curve)                                                                                                   \
    X(objects, Object)                                                                                                 \
    X(instances, Instance)                                                                                             \
    X(materials, Material)                                                                                             \
    X(texture_ops, TextureOp)                                                                                          \
    X(images, TextureImage)                                                                                            \
    X(lights, Light)                                                                                                   \
    X(light_details, LightDetail)                                                                                      \
    X(light_alias, AliasBucket)                                                                                        \
    X(light_tree, LightTree)                                                                                           \
    X(light_nodes, LightNode)                                                                                          \
    X(light_leaves, uint)                                                                                              \
    X(infinite_lights, uint)                                                                                           \
    X(portals, Portal)                                                                                                 \
    X(aims, Aim)                                                                                                       \
    X(media, Medium)                                                                                                   \
    X(grids, MediumGrid)                                                                                               \
    X(distributions2d, Distribution2D)                                                                                 \
    X(lookup, float)                                                                                                   \
    X(texels, uint)                                                                                                    \
    X(shape_objects, uint)                                                                                             \
    X(geometry_words, uint)                                                                                            \
    X(tables_words, uint)

void scene_init(Scene *scene)
{
    memset(scene, 0, sizeof *scene);
#define X(member, Type) array_init(&scene->member, sizeof(Type));
    MEMBER_ARRAYS(X)
#undef X
    scene->settings = (SceneSettings){
        .width = 1280, .height = 720, .crop = {0, 0, 1280, 720}, .max_depth = 6, .samples = 16, .film_scale = 1.0f};
    scene->filter_settings =
        (FilterSettings){.kind = PIXEL_FILTER_GAUSSIAN, .radius_x = 1.5f, .radius_y = 1.5f, .sigma = 0.5f};
    scene->camera_settings = (CameraSettings){.kind = CAMERA_PERSPECTIVE, .fov = 90.0f, .focal_distance = 1e6f};
    for (int i = 0; i < 4; ++i)
        scene->camera_settings.world_from_camera[5 * i] = scene->camera_settings.camera_from_world[5 * i] = 1.0;
}

void scene_destroy(Scene *scene)
{
#define X(member, Type) array_destroy(&scene->member);
    MEMBER_ARRAYS(X)
#undef X
}

/* Appends n elements; a macro, so that the result has the right type. */
#define SCENE_GROW(scene, member, Type, n, error) ((Type *)array_grow(&(scene)->member, (n), (error)))

/* Indices have 32 bits, PRIMITIVE_SHAPE_MASK has 28. */
static bool count_fits(size_t count, size_t limit, const char *what, Error *error)
{
    if (count < limit)
        return true;
    error_set(error, "the scene has more than %zu %s", limit, what);
    return error_fix(error, "use object instances, or split the scene");
}

static bool object_ensure_world(Scene *scene, Error *error)
{
    return scene->objects.count > 0 || SCENE_GROW(scene, objects, Object, 1, error) != NULL;
}

/* Checked before memory is allocated: geometry that does not fit the packed buffer must not be collected first. */
static bool geometry_fits(const Scene *scene, const MeshData *mesh, size_t primitive_words, Error *error)
{
    size_t vertex_words = 3u + (mesh->normals ? 3u : 0u) + (mesh->uvs ? 2u : 0u), words = scene_geometry_words(scene);
    if (mesh->vertex_count < NONE && mesh->triangle_count < NONE &&
        words + mesh->vertex_count * vertex_words + mesh->triangle_count * primitive_words <= SCENE_WORDS_MAX)
        return true;
    error_set(error, "the scene needs more than 16 GiB of vertices and primitives");
    return error_fix(error, "use object instances, or split the scene");
}

/* Appends `shape` to the current object, with its vertices. */
static bool shape_add(Scene *scene, const MeshData *mesh, Shape *shape, uint *index, Error *error)
{
    if (!object_ensure_world(scene, error) || !count_fits(scene->shapes.count, PRIMITIVE_SHAPE_MASK, "shapes", error))
        return false;
    shape->first_primitive = (uint)scene->primitives.count;
    shape->first_vertex = (uint)scene->positions.count;
    shape->first_normal = (uint)scene->normals.count;
    shape->first_uv = (uint)scene->uvs.count;
    shape->first_light = NONE;
    if (mesh->vertex_count > 0) {
        Vec3 *positions = SCENE_GROW(scene, positions, Vec3, mesh->vertex_count, error);
        if (!positions)
            return false;
        memcpy(positions, mesh->positions, mesh->vertex_count * sizeof *positions);
    }
    if (mesh->normals) {
        Vec3 *normals = SCENE_GROW(scene, normals, Vec3, mesh->vertex_count, error);
        if (!normals)
            return false;
        memcpy(normals, mesh->normals, mesh->vertex_count * sizeof *normals);
        shape->flags |= SHAPE_HAS_NORMALS;
    }
    if (mesh->uvs) {
        Vec2 *uvs = SCENE_GROW(scene, uvs, Vec2, mesh->vertex_count, error);
        if (!uvs)
            return false;
        memcpy(uvs, mesh->uvs, mesh->vertex_count * sizeof *uvs);
        shape->flags |= SHAPE_HAS_UV;
    }
    *index = (uint)scene->shapes.count;
    Shape *stored = SCENE_GROW(scene, shapes, Shape, 1, error);
    uint *object = stored ? SCENE_GROW(scene, shape_objects, uint, 1, error) : NULL;
    if (!object)
        return false;
    *stored = *shape;
    *object = scene->current_object;
    return true;
}

static uint shape_and_kind(uint shape_index, uint kind, const Shape *shape)
{
    return shape_index | (kind << PRIMITIVE_KIND_SHIFT) | (shape->alpha != NONE ? PRIMITIVE_ALPHA_BIT : 0u);
}

/* Makes every primitive from the shape's first to the last of the scene an area light. Degenerate primitives have been
 * dropped before, and lights are in the order of primitives, so the indices of both differ by a constant. */
static bool shape_emit(Scene *scene, uint shape_index, const float *emission, uint light_flags, Error *error)
{
    Shape *shape = &ARRAY_AT(&scene->shapes, Shape, shape_index);
    size_t count = scene->primitives.count - shape->first_primitive;
    if (!emission || count == 0)
        return true;
    assert(scene->current_object == 0);
    if (!count_fits(scene->lights.count + count, LIGHTS_MAX, "lights", error))
        return false;
    shape->first_light = (uint)scene->lights.count;
    Light *lights = SCENE_GROW(scene, lights, Light, count, error);
    if (!lights)
        return false;
    for (size_t i = 0; i < count; ++i) {
        lights[i].flags = LIGHT_AREA | light_flags;
        lights[i].primitive = shape->first_primitive + (uint)i;
        lights[i].emission = vec3(emission[0], emission[1], emission[2]);
        lights[i].area = (float)scene_primitive_area(scene, lights[i].primitive);
    }
    return true;
}

bool scene_add_mesh(Scene *scene, const MeshData *mesh, Shape shape, const float *emission, uint light_flags,
                    Error *error)
{
    uint index;
    if (!geometry_fits(scene, mesh, sizeof(Primitive) / 4, error) || !shape_add(scene, mesh, &shape, &index, error))
        return false;
    Primitive *out = SCENE_GROW(scene, primitives, Primitive, mesh->triangle_count, error);
    if (!out && mesh->triangle_count > 0)
        return false;
    const Vec3 *positions = scene->positions.data;
    size_t kept = 0;
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        Primitive p = {.a = shape.first_vertex + mesh->indices[3 * i],
                       .b = shape.first_vertex + mesh->indices[3 * i + 1],
                       .c = shape.first_vertex + mesh->indices[3 * i + 2],
                       .shape_and_kind = shape_and_kind(index, PRIMITIVE_TRIANGLE, &shape)};
        if (!triangle_degenerate(positions[p.a], positions[p.b], positions[p.c]))
            out[kept++] = p;
    }
    size_t dropped = mesh->triangle_count - kept;
    scene->primitives.count -= dropped;
    scene->counts.degenerate_triangles += dropped;
    if (emission)
        scene->counts.zero_area_lights += dropped;
    return shape_emit(scene, index, emission, light_flags, error);
}

bool scene_add_patches(Scene *scene, const MeshData *mesh, Shape shape, const float *emission, uint light_flags,
                       Error *error)
{
    uint index;
    if (!geometry_fits(scene, mesh, (sizeof(Primitive) + sizeof(Patch)) / 4, error) ||
        !shape_add(scene, mesh, &shape, &index, error))
        return false;
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        Patch patch;
        for (int k = 0; k < 4; ++k)
            patch.v[k] = shape.first_vertex + mesh->indices[4 * i + (size_t)k];
        const Vec3 *p = scene->positions.data;
        if (triangle_degenerate(p[patch.v[0]], p[patch.v[1]], p[patch.v[2]]) &&
            triangle_degenerate(p[patch.v[3]], p[patch.v[1]], p[patch.v[2]])) {
            ++scene->counts.degenerate_triangles;
            scene->counts.zero_area_lights += emission ? 1 : 0;
            continue;
        }
        uint patch_index = (uint)scene->patches.count;
        Patch *stored = SCENE_GROW(scene, patches, Patch, 1, error);
        Primitive *primitive = stored ? SCENE_GROW(scene, primitives, Primitive, 1, error) : NULL;
        if (!primitive)
            return false;
        *stored = patch;
        primitive->a = patch_index;
        primitive->shape_and_kind = shape_and_kind(index, PRIMITIVE_BILINEAR, &shape);
    }
    return shape_emit(scene, index, emission, light_flags, error);
}

bool scene_add_quadric(Scene *scene, const QuadricData *data, Shape shape, const float *emission, uint light_flags,
                       Error *error)
{
    uint index, kind = data->kind;
    MeshData no_vertices = {0};
    Quadric quadric = data->quadric;
    quadric.world_from_object = matrix_affine(data->world_from_object);
    quadric.object_from_world = matrix_affine(data->object_from_world);
    double scale = matrix_similarity_scale(data->world_from_object);
    bool full = kind == PRIMITIVE_SPHERE && quadric.z_min <= -quadric.radius && quadric.z_max >= quadric.radius &&
                quadric.phi_max >= 6.2831850f;
    /* The cone in which a sphere is sampled from outside has only the near side; of an invisible light both may
     * shine. */
    bool both_shine = (light_flags & LIGHT_INVISIBLE) != 0 &&
                      ((light_flags & LIGHT_TWO_SIDED) != 0 || (shape.flags & SHAPE_FLIP_NORMAL) != 0);
    quadric.whole = full && scale > 0.0 && !both_shine;
    quadric.center =
        vec3(quadric.world_from_object.m[3], quadric.world_from_object.m[7], quadric.world_from_object.m[11]);
    quadric.world_radius = (float)(scale * (double)quadric.radius);
    if (!geometry_fits(scene, &no_vertices, 0, error) || !shape_add(scene, &no_vertices, &shape, &index, error))
        return false;
    uint quadric_index = (uint)scene->quadrics.count;
    Quadric *stored = SCENE_GROW(scene, quadrics, Quadric, 1, error);
    Primitive *primitive = stored ? SCENE_GROW(scene, primitives, Primitive, 1, error) : NULL;
    if (!primitive)
        return false;
    *stored = quadric;
    primitive->a = quadric_index;
    primitive->shape_and_kind = shape_and_kind(index, kind, &shape);
    /* a few steps suffice to tell whether there is any area; scenes with a million spheres that are no lights load
     * faster */
    if (!((float)quadric_area(stored, kind, emission ? QUADRIC_STEPS : 4) > 0.0f)) {
        --scene->primitives.count;
        scene->counts.zero_area_lights += emission ? 1 : 0;
        ++scene->counts.degenerate_triangles;
        return true;
    }
    return shape_emit(scene, index, emission, light_flags, error);
}

/* Whether a curve can be hit: it has a width somewhere, and is not a point. */
static bool curve_extends(const Curve *curve)
{
    bool point = true;
    for (int i = 1; i < 4; ++i)
        point = point && vec3_is_zero(vec3_sub(curve->p[i], curve->p[0]));
    return !point && (curve->width[0] > 0.0f || curve->width[1] > 0.0f);
}

bool scene_add_curves(Scene *scene, const CurveData *data, Shape shape, Error *error)
{
    uint index, pieces = 1u << data->levels;
    size_t words = (sizeof(Curve) + pieces * sizeof(Primitive)) / 4;
    MeshData extent = {.triangle_count = data->count};
    if (!geometry_fits(scene, &extent, words, error) || !shape_add(scene, &extent, &shape, &index, error))
        return false;
    for (size_t i = 0; i < data->count; ++i) {
        if (!curve_extends(&data->curves[i])) {
            ++scene->counts.degenerate_triangles;
            continue;
        }
        uint curve = (uint)scene->curves.count;
        Curve *stored = SCENE_GROW(scene, curves, Curve, 1, error);
        Primitive *primitives = stored ? SCENE_GROW(scene, primitives, Primitive, pieces, error) : NULL;
        if (!primitives)
            return false;
        *stored = data->curves[i];
        for (uint piece = 0; piece < pieces; ++piece)
            primitives[piece] = (Primitive){.a = curve,
                                            .b = CURVE_PIECE(data->levels, piece),
                                            .c = data->type,
                                            .shape_and_kind = shape_and_kind(index, PRIMITIVE_CURVE, &shape)};
    }
    return true;
}

bool scene_object_begin(Scene *scene, uint *object, Error *error)
{
    assert(scene->current_object == 0);
    if (!object_ensure_world(scene, error))
        return false;
    *object = (uint)scene->objects.count;
    if (!SCENE_GROW(scene, objects, Object, 1, error))
        return false;
    scene->current_object = *object;
    return true;
}

bool scene_object_end(Scene *scene, Error *error)
{
    (void)error;
    assert(scene->current_object != 0);
    scene->current_object = 0;
    return true;
}

bool scene_add_instance(Scene *scene, uint object, const double world_from_object[16],
                        const double object_from_world[16], Error *error)
{
    if (!count_fits(scene->instances.count, SCENE_WORDS_MAX / (sizeof(Instance) / 4), "instances", error))
        return false;
    Instance *instance = SCENE_GROW(scene, instances, Instance, 1, error);
    if (!instance)
        return false;
    instance->world_from_object = matrix_affine(world_from_object);
    instance->object_from_world = matrix_affine(object_from_world);
    instance->object = object;
    return true;
}

bool scene_add_material(Scene *scene, const Material *material, uint *index, Error *error)
{
    if (!count_fits(scene->materials.count, SCENE_WORDS_MAX / (sizeof(Material) / 4), "materials", error))
        return false;
    *index = (uint)scene->materials.count;
    Material *stored = SCENE_GROW(scene, materials, Material, 1, error);
    if (!stored)
        return false;
    *stored = *material;
    return true;
}

bool scene_add_medium(Scene *scene, const Medium *medium, uint *number, Error *error)
{
    size_t added = scene->media.count == 0 ? 2 : 1; /* with empty space */
    if (scene->media.count >= MEDIA_MAX) {
        error_set(error, "the scene has more than %u media", MEDIA_MAX - 1);
        return error_fix(error, "use one medium for several shapes");
    }
    Medium *stored = SCENE_GROW(scene, media, Medium, added, error);
    if (!stored)
        return false;
    stored[0] = (Medium){.g = 0.0f};
    stored[added - 1] = *medium;
    *number = (uint)scene->media.count - 1;
    return true;
}

bool scene_add_light(Scene *scene, const LightData *light, Error *error)
{
    if (!count_fits(scene->lights.count, LIGHTS_MAX, "lights", error))
        return false;
    Light *stored = SCENE_GROW(scene, lights, Light, 1, error);
    LightDetail *detail = stored ? SCENE_GROW(scene, light_details, LightDetail, 1, error) : NULL;
    if (!detail)
        return false;
    *stored = (Light){.flags = light->kind | light->flags,
                      .primitive = (uint)scene->light_details.count - 1,
                      .emission = light->emission};
    *detail = light->detail;
    return true;
}

LightDetail *scene_light_detail(const Scene *scene, const Light *light)
{
    return &ARRAY_AT(&scene->light_details, LightDetail, light->primitive);
}

bool scene_add_portal(Scene *scene, const Portal *portal, uint *index, Error *error)
{
    Portal *stored = SCENE_GROW(scene, portals, Portal, 1, error);
    if (!stored)
        return false;
    *stored = *portal;
    *index = (uint)scene->portals.count - 1;
    return true;
}

double scene_primitive_area(const Scene *scene, uint primitive)
{
    const Primitive *p = &ARRAY_AT(&scene->primitives, Primitive, primitive);
    const Vec3 *positions = scene->positions.data;
    switch (p->shape_and_kind >> PRIMITIVE_KIND_SHIFT) {
    case PRIMITIVE_TRIANGLE:
        return triangle_area(positions[p->a], positions[p->b], positions[p->c]);
    case PRIMITIVE_BILINEAR:
        return patch_area(positions, &ARRAY_AT(&scene->patches, Patch, p->a));
    default:
        return quadric_area(&ARRAY_AT(&scene->quadrics, Quadric, p->a), p->shape_and_kind >> PRIMITIVE_KIND_SHIFT,
                            QUADRIC_STEPS);
    }
}
