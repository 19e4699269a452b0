#include "gltf/translate.h"

#include "base/log.h"
#include "geometry/box.h"

#include <math.h>
#include <stdlib.h>

#define PRINT(translation, ...) fprintf((translation)->out, __VA_ARGS__)

/* Shorter side of the film, pixels, and the ratio of its sides if the camera gives none. */
#define FILM_SIDE 720
#define FILM_ASPECT (16.0 / 9.0)

/* Segments of a path, less one. */
#define MAX_DEPTH 10

#define DEGREES (180.0 / M_PI)

/* Transform that takes the place of the current one, column by column. */
static void transform_print(const Translation *translation, const Matrix *matrix)
{
    PRINT(translation, "Transform [");
    for (int i = 0; i < 16; ++i)
        PRINT(translation, " %.9g", matrix->m[4 * (i % 4) + i / 4] + 0.0); /* no -0 */
    PRINT(translation, " ]\n");
}

/* ---- camera ------------------------------------------------------------------------------------------------------ */

/* A camera in the world: rotated and translated, looking along -z with +x to the right. */
typedef struct PlacedCamera {
    GltfCamera camera;
    Matrix world;
} PlacedCamera;

/* Whether the upper left 3x3 part can be inverted, as floats will see it. */
static bool matrix_flat(const Matrix *matrix)
{
    double determinant = matrix_determinant(matrix);
    return !(fabs(determinant) > 1e-37) || !isfinite(determinant);
}

/* pbrt's camera space from the world: the axes of the node, made orthogonal and of length 1 as the specification asks,
 * with z into the scene. False if the node has no axes. */
static bool camera_from_world(const Matrix *world, Matrix *out)
{
    double x[3], y[3], z[3], eye[3], length;
    for (int i = 0; i < 3; ++i) {
        y[i] = world->m[4 * i + 1];
        z[i] = -world->m[4 * i + 2];
        eye[i] = world->m[4 * i + 3];
    }
    vector_cross(z, y, x);
    vector_cross(x, z, y);
    const double *axes[3] = {x, y, z};
    *out = matrix_identity();
    for (int i = 0; i < 3; ++i) {
        length = sqrt(axes[i][0] * axes[i][0] + axes[i][1] * axes[i][1] + axes[i][2] * axes[i][2]);
        if (!(length > 0.0 && isfinite(length)))
            return false;
        for (int k = 0; k < 3; ++k)
            out->m[4 * i + k] = axes[i][k] / length;
        out->m[4 * i + 3] = -(out->m[4 * i] * eye[0] + out->m[4 * i + 1] * eye[1] + out->m[4 * i + 2] * eye[2]);
    }
    return true;
}

static void film_print(Translation *translation, double aspect)
{
    double width = aspect >= 1.0 ? FILM_SIDE * aspect : FILM_SIDE,
           height = aspect >= 1.0 ? FILM_SIDE : FILM_SIDE / aspect;
    double most = 65535.0;
    PRINT(translation, "Film \"rgb\" \"integer xresolution\" %.0f \"integer yresolution\" %.0f\n", fmin(width, most),
          fmin(height, most));
}

static bool camera_print(Translation *translation, const PlacedCamera *placed)
{
    const GltfCamera *camera = &placed->camera;
    Matrix matrix;
    if (!camera_from_world(&placed->world, &matrix))
        return gltf_fail(translation->reader, "the camera's node is scaled to nothing");
    transform_print(translation, &matrix);
    if (camera->orthographic) {
        PRINT(translation, "Camera \"orthographic\" \"float screenwindow\" [ %.9g %.9g %.9g %.9g ]\n", -camera->xmag,
              camera->xmag, -camera->ymag, camera->ymag);
        film_print(translation, camera->xmag / camera->ymag);
        return true;
    }
    double aspect = camera->aspect > 0.0 ? camera->aspect : FILM_ASPECT;
    double fov = aspect >= 1.0 ? camera->yfov : 2.0 * atan(tan(0.5 * camera->yfov) * aspect);
    PRINT(translation, "Camera \"perspective\" \"float fov\" %.9g\n", fov * DEGREES);
    film_print(translation, aspect);
    return true;
}

/* Adds the bounds of what a node shows. */
static void node_bounds(const Gltf *gltf, const GltfNode *node, Box *box)
{
    const GltfMesh *mesh = &gltf->meshes[node->mesh];
    const Matrix world = gltf_mesh_world(node);
    for (size_t i = 0; i < mesh->primitive_count; ++i) {
        const GltfPrimitive *primitive = &gltf->primitives[mesh->first_primitive + i];
        for (size_t k = 0; k < primitive->part_count; ++k) {
            const PlyMesh *part = &ARRAY_AT(&gltf->parts, GltfPart, primitive->first_part + k).mesh;
            for (size_t v = 0; v < part->vertex_count; ++v) {
                double p[3] = {(double)part->positions[3 * v], (double)part->positions[3 * v + 1],
                               (double)part->positions[3 * v + 2]};
                matrix_point(&world, p, p);
                box_add(box, vec3((float)p[0], (float)p[1], (float)p[2]));
            }
        }
    }
}

/* A camera that sees the sphere around everything, from the front, a little from the right and above. */
static PlacedCamera camera_frame(const Gltf *gltf)
{
    static const double FROM[3] = {0.4, 0.3, 1.0}, UP[3] = {0.0, 1.0, 0.0};
    PlacedCamera placed = {.camera = {.yfov = 40.0 / DEGREES}, .world = matrix_identity()};
    Box box = box_empty();
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (gltf->nodes[i].used && gltf->nodes[i].mesh >= 0)
            node_bounds(gltf, &gltf->nodes[i], &box);
    if (box_is_empty(&box))
        return placed;
    double middle[3], z[3], x[3], y[3], square = 0.0;
    for (int i = 0; i < 3; ++i) {
        double low = (double)box.low[i], high = (double)box.high[i];
        middle[i] = 0.5 * (low + high);
        square += 0.25 * (high - low) * (high - low);
    }
    double length = sqrt(FROM[0] * FROM[0] + FROM[1] * FROM[1] + FROM[2] * FROM[2]);
    double distance = fmax(sqrt(square), 1e-6) / sin(0.5 * placed.camera.yfov);
    for (int i = 0; i < 3; ++i)
        z[i] = FROM[i] / length;
    vector_cross(UP, z, x);
    vector_cross(z, x, y);
    for (int i = 0; i < 3; ++i) {
        placed.world.m[4 * i] = x[i];
        placed.world.m[4 * i + 1] = y[i];
        placed.world.m[4 * i + 2] = z[i];
        placed.world.m[4 * i + 3] = middle[i] + distance * z[i];
    }
    return placed;
}

/* The first camera of the scene, in the order of nodes. */
static PlacedCamera camera_choose(const Gltf *gltf)
{
    const GltfNode *chosen = NULL;
    int count = 0;
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (gltf->nodes[i].used && gltf->nodes[i].camera >= 0) {
            chosen = chosen ? chosen : &gltf->nodes[i];
            ++count;
        }
    if (!chosen) {
        log_message(LOG_INFO, "%s has no camera: one is added that sees everything", gltf->path);
        return camera_frame(gltf);
    }
    if (count > 1)
        log_message(LOG_INFO, "%s has %d cameras: that of nodes[%td] is used", gltf->path, count, chosen - gltf->nodes);
    return (PlacedCamera){gltf->cameras[chosen->camera], chosen->world};
}

/* ---- lights ------------------------------------------------------------------------------------------------------ */

static void light_print(Translation *translation, const GltfLight *light, const Matrix *world)
{
    static const char *const KINDS[] = {"distant", "point", "spot"};
    PRINT(translation, "AttributeBegin\n");
    transform_print(translation, world);
    PRINT(translation, "LightSource \"%s\" \"rgb %s\" [ %.9g %.9g %.9g ]", KINDS[light->kind],
          light->kind == GLTF_DIRECTIONAL ? "L" : "I", light->emission[0], light->emission[1], light->emission[2]);
    if (light->kind != GLTF_POINT)
        PRINT(translation, " \"point3 to\" [ 0 0 -1 ]");
    if (light->kind == GLTF_SPOT)
        PRINT(translation, " \"float coneangle\" %.9g \"float conedeltaangle\" %.9g", light->outer * DEGREES,
              (light->outer - light->inner) * DEGREES);
    PRINT(translation, "\nAttributeEnd\n");
}

static bool part_emits(const GltfPart *part)
{
    return part->emission[0] > 0.0 || part->emission[1] > 0.0 || part->emission[2] > 0.0;
}

static bool scene_is_dark(const Gltf *gltf)
{
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (gltf->nodes[i].used && gltf->nodes[i].light >= 0)
            return false;
    for (size_t i = 0; i < gltf->parts.count; ++i)
        if (part_emits(&ARRAY_AT(&gltf->parts, GltfPart, i)))
            return false;
    return true;
}

static void lights_print(Translation *translation)
{
    const Gltf *gltf = translation->gltf;
    for (size_t i = 0; i < gltf->node_count; ++i) {
        const GltfNode *node = &gltf->nodes[i];
        if (!node->used || node->light < 0)
            continue;
        if (matrix_flat(&node->world))
            log_message(LOG_WARNING, "%s: the light of nodes[%zu] is scaled to nothing and is left out", gltf->path, i);
        else
            light_print(translation, &gltf->lights[node->light], &node->world);
    }
    if (!scene_is_dark(gltf))
        return;
    log_message(LOG_INFO, "%s has no light: a white sky of radiance 1 is added", gltf->path);
    PRINT(translation, "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n");
}

/* ---- shapes ------------------------------------------------------------------------------------------------------ */

static void part_print(Translation *translation, const GltfPrimitive *primitive, size_t part)
{
    const GltfMaterial *material = &translation->gltf->materials[primitive->material];
    const GltfPart *from = &ARRAY_AT(&translation->gltf->parts, GltfPart, part);
    PRINT(translation, "AttributeBegin\nNamedMaterial ");
    gltf_material_name(translation, primitive->material, "");
    if (part_emits(from))
        PRINT(translation, "\nAreaLightSource \"diffuse\" \"rgb L\" [ %.9g %.9g %.9g ]%s", from->emission[0],
              from->emission[1], from->emission[2], material->double_sided ? " \"bool twosided\" true" : "");
    PRINT(translation, "\nShape \"plymesh\" \"string filename\" \"%s-meshes/%zu.ply\"", translation->prefix, part);
    gltf_material_alpha(translation, primitive->material);
    PRINT(translation, "\nAttributeEnd\n");
}

/* Prints the parts of a mesh that emit, or those that do not. Returns how many there are; with `count_only` prints
 * none. */
static size_t mesh_print(Translation *translation, const GltfMesh *mesh, bool emitting, bool count_only)
{
    const Gltf *gltf = translation->gltf;
    size_t count = 0;
    for (size_t i = 0; i < mesh->primitive_count; ++i) {
        const GltfPrimitive *primitive = &gltf->primitives[mesh->first_primitive + i];
        for (size_t k = 0; k < primitive->part_count; ++k) {
            size_t part = primitive->first_part + k;
            if (gltf_material_invisible(&gltf->materials[primitive->material]) ||
                part_emits(&ARRAY_AT(&gltf->parts, GltfPart, part)) != emitting)
                continue;
            ++count;
            if (!count_only)
                part_print(translation, primitive, part);
        }
    }
    return count;
}

/* Objects: meshes that several nodes show. What emits is repeated instead, since pbrt ignores the light of
 * instances. */
static bool mesh_is_object(Translation *translation, const GltfMesh *mesh)
{
    return mesh->uses > 1 && mesh_print(translation, mesh, false, true) > 0;
}

static void objects_print(Translation *translation)
{
    const Gltf *gltf = translation->gltf;
    for (size_t i = 0; i < gltf->mesh_count; ++i) {
        if (!mesh_is_object(translation, &gltf->meshes[i]))
            continue;
        PRINT(translation, "ObjectBegin \"%zu\"\n", i);
        mesh_print(translation, &gltf->meshes[i], false, false);
        PRINT(translation, "ObjectEnd\n");
    }
}

static void node_print(Translation *translation, size_t i)
{
    const Gltf *gltf = translation->gltf;
    const GltfNode *node = &gltf->nodes[i];
    const GltfMesh *mesh = &gltf->meshes[node->mesh];
    const Matrix world = gltf_mesh_world(node);
    size_t dark = mesh_print(translation, mesh, false, true), emitting = mesh_print(translation, mesh, true, true);
    if (dark + emitting == 0)
        return;
    if (matrix_flat(&world)) {
        log_message(LOG_WARNING, "%s: the mesh of nodes[%zu] is scaled to nothing and is left out", gltf->path, i);
        return;
    }
    PRINT(translation, "AttributeBegin\n");
    transform_print(translation, &world);
    if (mesh_is_object(translation, mesh))
        PRINT(translation, "ObjectInstance \"%d\"\n", node->mesh);
    else
        mesh_print(translation, mesh, false, false);
    mesh_print(translation, mesh, true, false);
    PRINT(translation, "AttributeEnd\n");
}

bool gltf_translate(Translation *translation)
{
    const Gltf *gltf = translation->gltf;
    PRINT(translation, "# Written by twinlight convert from a glTF 2.0 file.\n");
    PRINT(translation, "Integrator \"volpath\" \"integer maxdepth\" %d\n", MAX_DEPTH);
    const PlacedCamera camera = camera_choose(gltf);
    if (!camera_print(translation, &camera))
        return false;
    PRINT(translation, "\nWorldBegin\n");
    lights_print(translation);
    if (!gltf_translate_materials(translation))
        return false;
    objects_print(translation);
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (gltf->nodes[i].used && gltf->nodes[i].mesh >= 0)
            node_print(translation, i);
    return !translation->reader->failed;
}
