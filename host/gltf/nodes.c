/* Nodes, cameras, lights. */
#include "base/log.h"
#include "gltf/document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- cameras and lights ------------------------------------------------------------------------------------------ */

static GltfCamera camera_read(GltfReader *reader, size_t i)
{
    const GltfObject object = gltf_entry(reader, "cameras", i);
    const GltfObject perspective = gltf_object(reader, &object, "perspective");
    const GltfObject orthographic = gltf_object(reader, &object, "orthographic");
    GltfCamera camera = {.orthographic = perspective.json == NULL};
    if (!reader->failed && !perspective.json && !orthographic.json)
        gltf_fail(reader, "%s is neither perspective nor orthographic", object.name);
    if (camera.orthographic) {
        camera.xmag = gltf_number(reader, &orthographic, "xmag", 1.0, 1e-9, 1e9);
        camera.ymag = gltf_number(reader, &orthographic, "ymag", 1.0, 1e-9, 1e9);
    } else {
        camera.yfov = gltf_number(reader, &perspective, "yfov", 0.8, 1e-4, 3.14);
        camera.aspect = gltf_number(reader, &perspective, "aspectRatio", 0.0, 1e-3, 1e3);
    }
    return camera;
}

static const json_t *light_array(GltfReader *reader, size_t *count)
{
    const GltfObject root = {reader->root, ""};
    const GltfObject punctual = gltf_extension(reader, &root, "KHR_lights_punctual");
    return gltf_array(reader, &punctual, "lights", count);
}

static GltfLightKind light_kind(GltfReader *reader, const GltfObject *object)
{
    const char *kind = gltf_text(reader, object, "type", "");
    if (strcmp(kind, "directional") == 0)
        return GLTF_DIRECTIONAL;
    if (strcmp(kind, "spot") == 0)
        return GLTF_SPOT;
    if (strcmp(kind, "point") != 0)
        gltf_fail(reader, "%s.type is \"%.40s\" instead of point, spot or directional", object->name, kind);
    return GLTF_POINT;
}

/* Units: candela of point and spot lights, lux of directional ones. Radiances of the scene are then in nits. */
static GltfLight light_read(GltfReader *reader, const json_t *json, size_t i)
{
    GltfObject object = {json, ""};
    double color[3] = {1.0, 1.0, 1.0};
    snprintf(object.name, sizeof object.name, "KHR_lights_punctual.lights[%zu]", i);
    if (!json_is_object(json))
        gltf_fail(reader, "%s must be an object", object.name);
    GltfLight light = {.kind = light_kind(reader, &object)};
    gltf_numbers(reader, &object, "color", 3, color);
    double intensity = gltf_number(reader, &object, "intensity", 1.0, 0.0, 1e30);
    for (int k = 0; k < 3; ++k)
        light.emission[k] = fmax(color[k], 0.0) * intensity;
    if (gltf_number(reader, &object, "range", 0.0, 0.0, 1e30) > 0.0)
        log_message(LOG_INFO, "%s: the range of %s is ignored: light fades by the square of the distance", reader->path,
                    object.name);
    const GltfObject spot = gltf_object(reader, &object, "spot");
    light.inner = gltf_number(reader, &spot, "innerConeAngle", 0.0, 0.0, M_PI_2);
    light.outer = gltf_number(reader, &spot, "outerConeAngle", M_PI_4, 0.0, M_PI_2 + 1e-6);
    if (light.kind == GLTF_SPOT && !(light.inner < light.outer))
        gltf_fail(reader, "%s.spot.innerConeAngle must be below outerConeAngle", object.name);
    return light;
}

static bool cameras_and_lights_read(Gltf *gltf, GltfReader *reader)
{
    void *cameras = NULL, *lights = NULL;
    gltf->camera_count = gltf_count(reader, "cameras");
    const json_t *array = light_array(reader, &gltf->light_count);
    if (reader->failed || !gltf_allocate(reader, &cameras, gltf->camera_count, sizeof *gltf->cameras))
        return false;
    gltf->cameras = cameras;
    if (!gltf_allocate(reader, &lights, gltf->light_count, sizeof *gltf->lights))
        return false;
    gltf->lights = lights;
    for (size_t i = 0; i < gltf->camera_count && !reader->failed; ++i)
        gltf->cameras[i] = camera_read(reader, i);
    for (size_t i = 0; i < gltf->light_count && !reader->failed; ++i)
        gltf->lights[i] = light_read(reader, json_array_get(array, i), i);
    return !reader->failed;
}

/* ---- nodes ------------------------------------------------------------------------------------------------------- */

/* The rotation of a quaternion x y z w, which need not be normalised. */
static Matrix quaternion_matrix(const double q[4])
{
    Matrix matrix = matrix_identity();
    double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    double s = n > 0.0 ? 2.0 / n : 0.0;
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        matrix.m[4 * i + i] = 1.0 - s * (q[j] * q[j] + q[k] * q[k]);
        matrix.m[4 * i + j] = s * (q[i] * q[j] - q[3] * q[k]);
        matrix.m[4 * i + k] = s * (q[i] * q[k] + q[3] * q[j]);
    }
    return matrix;
}

/* A node's own transform: `matrix`, column by column, or translation, rotation, scale. */
static Matrix local_matrix(GltfReader *reader, const GltfObject *object)
{
    double columns[16], t[3] = {0.0, 0.0, 0.0}, q[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0};
    Matrix matrix;
    if (gltf_numbers(reader, object, "matrix", 16, columns)) {
        for (int i = 0; i < 16; ++i)
            matrix.m[i] = columns[4 * (i % 4) + i / 4];
        if (matrix.m[12] != 0.0 || matrix.m[13] != 0.0 || matrix.m[14] != 0.0 || matrix.m[15] != 1.0)
            gltf_fail(reader, "%s.matrix is not affine", object->name);
        return matrix;
    }
    gltf_numbers(reader, object, "translation", 3, t);
    gltf_numbers(reader, object, "rotation", 4, q);
    gltf_numbers(reader, object, "scale", 3, s);
    const Matrix translation = matrix_translate(t[0], t[1], t[2]), scale = matrix_scale(s[0], s[1], s[2]);
    const Matrix rotation = quaternion_matrix(q), turned = matrix_multiply(&rotation, &scale);
    return matrix_multiply(&translation, &turned);
}

static void node_read(Gltf *gltf, GltfReader *reader, size_t i)
{
    const GltfObject object = gltf_entry(reader, "nodes", i);
    GltfNode *node = &gltf->nodes[i];
    size_t children;
    node->world = local_matrix(reader, &object);
    node->mesh = gltf_index(reader, &object, "mesh", "meshes");
    node->skin = node->mesh >= 0 ? gltf_index(reader, &object, "skin", "skins") : -1;
    node->camera = gltf_index(reader, &object, "camera", "cameras");
    const GltfObject punctual = gltf_extension(reader, &object, "KHR_lights_punctual");
    size_t light = gltf_size(reader, &punctual, "light", gltf->light_count);
    node->light = punctual.json ? (int)light : -1;
    if (!reader->failed && punctual.json && light >= gltf->light_count)
        gltf_fail(reader, "%s.light is %zu, but there are %zu lights", punctual.name, light, gltf->light_count);
    gltf_array(reader, &object, "children", &children);
    for (size_t k = 0; k < children && !reader->failed; ++k) {
        int child = gltf_index_at(reader, &object, "children", k, "nodes");
        if (child >= 0 && gltf->nodes[child].parent >= 0)
            gltf_fail(reader, "nodes[%d] has two parents", child);
        else if (child >= 0)
            gltf->nodes[child].parent = (int)i;
    }
}

/* Marks the roots of the scene: those of scenes[scene], or all nodes without a parent. */
static void roots_mark(Gltf *gltf, GltfReader *reader)
{
    const GltfObject root = {reader->root, ""};
    size_t count;
    int index = gltf_index(reader, &root, "scene", "scenes");
    if (index < 0 && gltf_count(reader, "scenes") == 0) {
        for (size_t i = 0; i < gltf->node_count; ++i)
            gltf->nodes[i].used = gltf->nodes[i].parent < 0;
        return;
    }
    const GltfObject scene = gltf_entry(reader, "scenes", index < 0 ? 0 : (size_t)index);
    gltf_array(reader, &scene, "nodes", &count);
    for (size_t k = 0; k < count && !reader->failed; ++k) {
        int node = gltf_index_at(reader, &scene, "nodes", k, "nodes");
        if (node >= 0 && gltf->nodes[node].parent >= 0)
            gltf_fail(reader, "%s lists nodes[%d], which is a child of nodes[%d]", scene.name, node,
                      gltf->nodes[node].parent);
        else if (node >= 0)
            gltf->nodes[node].used = true;
    }
}

/* Moves one node to world space, after its parent. */
static void node_place(Gltf *gltf, GltfReader *reader, int i)
{
    GltfNode *node = &gltf->nodes[i];
    if (node->parent >= 0) {
        const GltfNode *parent = &gltf->nodes[node->parent];
        node->world = matrix_multiply(&parent->world, &node->world);
        node->used = parent->used;
    }
    if (node->used && !matrix_fits_float(&node->world))
        gltf_fail(reader, "the transform of nodes[%d] overflows", i);
    if (node->used && node->mesh >= 0)
        ++gltf->meshes[node->mesh].uses;
}

/* Nodes in an order in which parents come before children: `order` gets those that are reached from nodes without a
 * parent, found without recursion, since files may nest nodes as deep as they like. Returns their number. */
static size_t nodes_order(const Gltf *gltf, int *order, int *first_child, int *sibling)
{
    size_t count = 0;
    for (size_t i = 0; i < gltf->node_count; ++i)
        first_child[i] = sibling[i] = -1;
    for (size_t i = gltf->node_count; i-- > 0;) {
        int parent = gltf->nodes[i].parent;
        if (parent >= 0) {
            sibling[i] = first_child[parent];
            first_child[parent] = (int)i;
        }
    }
    for (size_t i = 0; i < gltf->node_count; ++i)
        if (gltf->nodes[i].parent < 0)
            order[count++] = (int)i;
    for (size_t k = 0; k < count; ++k)
        for (int child = first_child[order[k]]; child >= 0; child = sibling[child])
            order[count++] = child;
    return count;
}

static bool nodes_place(Gltf *gltf, GltfReader *reader)
{
    void *lists = NULL;
    size_t n = gltf->node_count;
    if (!gltf_allocate(reader, &lists, 3 * n, sizeof(int)))
        return false;
    int *order = lists;
    size_t count = nodes_order(gltf, order, order + n, order + 2 * n);
    if (count < n)
        gltf_fail(reader, "the nodes have a cycle: some are their own ancestors");
    for (size_t k = 0; k < count && !reader->failed; ++k)
        node_place(gltf, reader, order[k]);
    free(lists);
    return !reader->failed;
}

Matrix gltf_mesh_world(const GltfNode *node)
{
    return node->skin >= 0 ? matrix_identity() : node->world;
}

bool gltf_nodes_read(Gltf *gltf, GltfReader *reader)
{
    void *nodes = NULL;
    size_t count = gltf_count(reader, "nodes");
    if (!cameras_and_lights_read(gltf, reader) || !gltf_allocate(reader, &nodes, count, sizeof *gltf->nodes))
        return false;
    gltf->nodes = nodes;
    gltf->node_count = count;
    for (size_t i = 0; i < count; ++i)
        gltf->nodes[i].parent = -1;
    for (size_t i = 0; i < count && !reader->failed; ++i)
        node_read(gltf, reader, i);
    if (!reader->failed)
        roots_mark(gltf, reader);
    return !reader->failed && nodes_place(gltf, reader);
}
