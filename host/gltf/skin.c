#include "gltf/skin.h"

#include "base/log.h"
#include "gltf/accessors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Sums of weights may be this far from 1 without a warning: those in bytes are rounded. */
#define WEIGHT_ROUNDING 0.02

/* Sets of a primitive, at most: each has a copy of its values, so that a small file could take all memory. */
#define SETS_MAX 16u

/* A set of four joints and their weights for each vertex. */
typedef struct JointSet {
    float *joints, *weights;
} JointSet;

typedef struct Skin {
    GltfReader *reader;
    const char *name; /* of the primitive */
    Matrix *joints; /* from the mesh's space to the world */
    size_t joint_count;
    JointSet *sets;
    size_t set_count;
    size_t vertex_count, unweighted, unnormalized; /* vertices */
} Skin;

static GltfObject skin_object(const Gltf *gltf, GltfReader *reader, const GltfMesh *mesh)
{
    return gltf_entry(reader, "skins", (size_t)gltf->nodes[mesh->pose].skin);
}

size_t gltf_skin_joints(const Gltf *gltf, GltfReader *reader, const GltfMesh *mesh)
{
    size_t count = 0;
    if (mesh->pose < 0 || gltf->nodes[mesh->pose].skin < 0)
        return 0;
    const GltfObject object = skin_object(gltf, reader, mesh);
    gltf_array(reader, &object, "joints", &count);
    return count;
}

/* ---- joints ------------------------------------------------------------------------------------------------------ */

/* The inverse bind matrices, of which there may be none: identities. False after a failure. */
static bool inverse_binds_read(const Gltf *gltf, Skin *skin, const GltfObject *object, float **out)
{
    GltfReader *reader = skin->reader;
    int accessor = gltf_index(reader, object, "inverseBindMatrices", "accessors");
    size_t count = 0;
    *out = NULL;
    if (accessor < 0)
        return !reader->failed;
    *out = gltf_accessor_floats(gltf, reader, accessor, "MAT4", GLTF_COMPONENT(GLTF_FLOAT), &count);
    if (!reader->failed && count < skin->joint_count)
        gltf_fail(reader, "%s has %zu joints, but only %zu inverseBindMatrices", object->name, skin->joint_count,
                  count);
    return !reader->failed;
}

/* The transform of joint i: first to the joint's space, by 16 numbers column by column (NULL: identity), then by its
 * node to the world. */
static Matrix joint_matrix(const Gltf *gltf, int node, const float *inverse_bind)
{
    Matrix bind = matrix_identity();
    for (int i = 0; inverse_bind && i < 12; ++i)
        bind.m[i] = (double)inverse_bind[4 * (i % 4) + i / 4];
    return matrix_multiply(&gltf->nodes[node].world, &bind);
}

static bool joints_read(const Gltf *gltf, Skin *skin, const GltfMesh *mesh)
{
    GltfReader *reader = skin->reader;
    const GltfObject object = skin_object(gltf, reader, mesh);
    void *joints = NULL;
    float *binds = NULL;
    skin->joint_count = gltf_skin_joints(gltf, reader, mesh);
    if (!reader->failed && skin->joint_count == 0)
        gltf_fail(reader, "%s has no joints", object.name);
    if (reader->failed || !gltf_allocate(reader, &joints, skin->joint_count, sizeof *skin->joints))
        return false;
    skin->joints = joints;
    if (inverse_binds_read(gltf, skin, &object, &binds))
        for (size_t i = 0; i < skin->joint_count && !reader->failed; ++i) {
            int node = gltf_index_at(reader, &object, "joints", i, "nodes");
            if (node >= 0)
                skin->joints[i] = joint_matrix(gltf, node, binds ? binds + 16 * i : NULL);
        }
    free(binds);
    return !reader->failed;
}

/* ---- joints and weights of vertices ------------------------------------------------------------------------------ */

/* Attribute NAME_SET, four numbers per vertex; NULL if it is not there, or after a failure. */
static float *attribute_read(const Gltf *gltf, Skin *skin, const GltfObject *attributes, const char *name, size_t set,
                             unsigned components)
{
    GltfReader *reader = skin->reader;
    char key[40];
    size_t count = 0;
    snprintf(key, sizeof key, "%s_%zu", name, set);
    int accessor = gltf_index(reader, attributes, key, "accessors");
    if (accessor < 0)
        return NULL;
    float *values = gltf_accessor_floats(gltf, reader, accessor, "VEC4", components, &count);
    if (!reader->failed && count != skin->vertex_count)
        gltf_fail(reader, "%s.%s has %zu elements for %zu vertices", attributes->name, key, count, skin->vertex_count);
    return values;
}

/* Reads set `number`. False if there is none, or after a failure. */
static bool set_read(const Gltf *gltf, Skin *skin, const GltfObject *attributes, size_t number)
{
    const unsigned integers = GLTF_COMPONENT(GLTF_UNSIGNED_BYTE) | GLTF_COMPONENT(GLTF_UNSIGNED_SHORT);
    JointSet set = {.joints = attribute_read(gltf, skin, attributes, "JOINTS", number, integers)};
    set.weights = attribute_read(gltf, skin, attributes, "WEIGHTS", number, integers | GLTF_COMPONENT(GLTF_FLOAT));
    if (!skin->reader->failed && !set.joints != !set.weights)
        gltf_fail(skin->reader, "%s has %s_%zu without %s_%zu", attributes->name, set.joints ? "JOINTS" : "WEIGHTS",
                  number, set.joints ? "WEIGHTS" : "JOINTS", number);
    if (!skin->reader->failed && set.joints && number == SETS_MAX)
        gltf_fail(skin->reader, "%s has more than %u sets of joints", attributes->name, SETS_MAX);
    JointSet *sets = set.joints && set.weights ? realloc(skin->sets, (number + 1) * sizeof set) : NULL;
    if (!sets && set.joints && set.weights && !skin->reader->failed)
        skin->reader->failed = !error_memory(skin->reader->error, sizeof set, "a skin");
    if (!sets) {
        free(set.joints);
        free(set.weights);
        return false;
    }
    skin->sets = sets;
    skin->sets[number] = set;
    skin->set_count = number + 1;
    return !skin->reader->failed;
}

/* Joint k of a vertex, and its weight. False after a failure. */
static bool influence_check(const Skin *skin, size_t vertex, size_t joint, double weight)
{
    if (!(weight >= 0.0 && isfinite(weight))) {
        gltf_fail(skin->reader, "%s has a skin weight of %g at vertex %zu: weights are finite and not negative",
                  skin->name, weight, vertex);
        return error_fix(skin->reader->error, "repair the skin in the program that made it");
    }
    if (weight > 0.0 && joint >= skin->joint_count) {
        gltf_fail(skin->reader, "%s has joint %zu at vertex %zu, but its skin has %zu joints", skin->name, joint,
                  vertex, skin->joint_count);
        return error_fix(skin->reader->error, "repair the skin in the program that made it");
    }
    return true;
}

/* Adds `weight` times the affine part of b to a. */
static void matrix_add(Matrix *a, const Matrix *b, double weight)
{
    for (int i = 0; i < 12; ++i)
        a->m[i] += weight * b->m[i];
}

/* The mean of the transforms of a vertex's joints; of one without weights, that of its first. False after a failure. */
static bool vertex_matrix(Skin *skin, size_t vertex, Matrix *out)
{
    double sum = 0.0;
    *out = matrix_scale(0.0, 0.0, 0.0);
    for (size_t i = 0; i < 4 * skin->set_count; ++i) {
        const JointSet *set = &skin->sets[i / 4];
        double weight = (double)set->weights[4 * vertex + i % 4];
        size_t joint = (size_t)set->joints[4 * vertex + i % 4];
        if (!influence_check(skin, vertex, joint, weight))
            return false;
        if (weight > 0.0)
            matrix_add(out, &skin->joints[joint], weight);
        sum += weight;
    }
    if (sum > 0.0) {
        skin->unnormalized += fabs(sum - 1.0) > WEIGHT_ROUNDING;
        for (int i = 0; i < 12; ++i)
            out->m[i] /= sum;
        return true;
    }
    size_t first = (size_t)skin->sets[0].joints[4 * vertex];
    ++skin->unweighted;
    if (!influence_check(skin, vertex, first, 1.0))
        return false;
    *out = skin->joints[first];
    return true;
}

/* ---- the pose ---------------------------------------------------------------------------------------------------- */

/* Moves a vertex. Its normal goes by the cofactors, which exist for flat transforms, too. Whether it is mirrored. */
static bool vertex_move(const Matrix *matrix, float *position, float *normal)
{
    double p[3] = {(double)position[0], (double)position[1], (double)position[2]};
    bool mirrored = matrix_swaps_handedness(matrix);
    matrix_point(matrix, p, p);
    for (int i = 0; i < 3; ++i)
        position[i] = (float)p[i];
    if (!normal)
        return mirrored;
    double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]}, sign = mirrored ? -1.0 : 1.0;
    Matrix cofactors = matrix_identity();
    for (int i = 0; i < 3; ++i)
        vector_cross(matrix->m + 4 * ((i + 1) % 3), matrix->m + 4 * ((i + 2) % 3), cofactors.m + 4 * i);
    matrix_vector(&cofactors, n, n);
    if (vector_normalize(n))
        for (int i = 0; i < 3; ++i)
            normal[i] = (float)(sign * n[i]);
    return mirrored;
}

/* Moves all vertices, by `rigid` if there are no joints. */
static bool vertices_move(Skin *skin, const Matrix *rigid, PlyMesh *mesh)
{
    bool *mirrored = calloc(mesh->vertex_count + 1, sizeof *mirrored);
    if (!mirrored) {
        skin->reader->failed = !error_memory(skin->reader->error, mesh->vertex_count, "a skin");
        return false;
    }
    for (size_t i = 0; i < mesh->vertex_count && !skin->reader->failed; ++i) {
        Matrix matrix = *rigid;
        if (skin->set_count == 0 || vertex_matrix(skin, i, &matrix))
            mirrored[i] = vertex_move(&matrix, mesh->positions + 3 * i, mesh->normals ? mesh->normals + 3 * i : NULL);
    }
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        uint *corners = mesh->triangles + 3 * i, second = corners[1];
        if (mirrored[corners[0]]) {
            corners[1] = corners[2];
            corners[2] = second;
        }
    }
    free(mirrored);
    return !skin->reader->failed;
}

static void skin_report(const Skin *skin)
{
    if (skin->unnormalized > 0)
        log_message(LOG_WARNING, "%s: the skin weights of %s do not add up to 1 at %zu vertices, and are scaled",
                    skin->reader->path, skin->name, skin->unnormalized);
    if (skin->unweighted > 0)
        log_message(LOG_WARNING, "%s: %zu vertices of %s have no skin weights and follow their first joint",
                    skin->reader->path, skin->unweighted, skin->name);
}

static void skin_destroy(Skin *skin)
{
    for (size_t i = 0; i < skin->set_count; ++i) {
        free(skin->sets[i].joints);
        free(skin->sets[i].weights);
    }
    free(skin->sets);
    free(skin->joints);
}

bool gltf_skin_apply(const Gltf *gltf, GltfReader *reader, const GltfPrimitive *primitive, PlyMesh *mesh)
{
    const GltfMesh *owner = &gltf->meshes[primitive->mesh];
    if (owner->pose < 0 || gltf->nodes[owner->pose].skin < 0)
        return true;
    const GltfObject object = gltf_primitive_object(reader, owner->number, primitive->number);
    const GltfObject attributes = gltf_object(reader, &object, "attributes");
    Skin skin = {.reader = reader, .name = object.name, .vertex_count = mesh->vertex_count};
    bool good = joints_read(gltf, &skin, owner);
    while (good && set_read(gltf, &skin, &attributes, skin.set_count))
        ;
    good = !reader->failed && vertices_move(&skin, &gltf->nodes[owner->pose].world, mesh);
    if (good)
        skin_report(&skin);
    skin_destroy(&skin);
    return good;
}
