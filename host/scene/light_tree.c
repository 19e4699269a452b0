#include "scene/light_tree.h"

#include "geometry/surface.h"
#include "light/delta.h"
#include "scene/light_bounds.h"
#include "scene/light_node.h"

#include <math.h>
#include <stdlib.h>

typedef struct Leaf {
    LightBounds bounds;
    Vec3 center;
    uint light;
} Leaf;

/* ---- division ---------------------------------------------------------------------------------------------------- */

#define SLICES 12

/* Below this depth, nodes are halved: no more levels follow than the number of lights has bits. */
#define DEPTH_MOST 40

static float component(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* What a node costs: its intensity, times the square of its extent, times the measure of its directions (Conty Estevez
 * and Kulla 2018, equation 1, with the area of its sphere). */
static double bounds_cost(const LightBounds *bounds)
{
    double square = 0.0, normals = fmax(bounds->normals.angle, 0.0), s = sin(normals), c = cos(normals);
    if (!(bounds->intensity > 0.0))
        return 0.0;
    for (int i = 0; i < 3; ++i)
        square += pow((double)bounds->box.high[i] - (double)bounds->box.low[i], 2.0);
    double reach = fmin(normals + bounds->emission, M_PI);
    double directions =
        2.0 * M_PI * (1.0 - c) + 0.5 * M_PI * (2.0 * reach * s - cos(normals - 2.0 * reach) - 2.0 * normals * s + c);
    return bounds->intensity * square * directions;
}

typedef struct Division {
    int axis;
    float low, width;
    int slices;
    int at; /* slices below this one go to the left */
} Division;

static int slice_of(const Division *division, const Leaf *leaf)
{
    float place = (component(leaf->center, division->axis) - division->low) / division->width;
    int slice = (int)(place * (float)division->slices);
    return slice < 0 ? 0 : slice >= division->slices ? division->slices - 1 : slice;
}

/* Along the axis in which the lights' centres reach farthest; false if they are in one place. */
static bool division_begin(const Leaf *leaves, size_t count, Division *division)
{
    Box box = box_empty();
    for (size_t i = 0; i < count; ++i)
        box_add(&box, leaves[i].center);
    division->width = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        if (box.high[axis] - box.low[axis] > division->width) {
            division->axis = axis;
            division->low = box.low[axis];
            division->width = box.high[axis] - box.low[axis];
        }
    division->slices = count < SLICES ? (int)count : SLICES;
    return division->width > 0.0f;
}

static const Vec3 NO_AXIS = {0.0f, 0.0f, 1.0f};

/* The cone of many normals: around the mean of their axes. */
typedef struct ConeSum {
    double axis[3], widest, cosine;
} ConeSum;

static void slices_bound(const Leaf *leaves, size_t count, const Division *division, LightBounds slices[SLICES])
{
    ConeSum sums[SLICES];
    Vec3 axes[SLICES];
    for (int i = 0; i < SLICES; ++i) {
        slices[i] = light_bounds_empty();
        sums[i] = (ConeSum){{0.0, 0.0, 0.0}, -1.0, 1.0};
        axes[i] = NO_AXIS;
    }
    for (size_t i = 0; i < count; ++i) {
        int slice = slice_of(division, &leaves[i]);
        const LightBounds *bounds = &leaves[i].bounds;
        box_join(&slices[slice].box, &bounds->box);
        slices[slice].emission = fmax(slices[slice].emission, bounds->emission);
        slices[slice].intensity += bounds->intensity;
        sums[slice].axis[0] += (double)bounds->normals.axis.x;
        sums[slice].axis[1] += (double)bounds->normals.axis.y;
        sums[slice].axis[2] += (double)bounds->normals.axis.z;
        sums[slice].widest = fmax(sums[slice].widest, bounds->normals.angle);
    }
    for (int i = 0; i < division->slices; ++i)
        axes[i] = vec3_direction(vec3((float)sums[i].axis[0], (float)sums[i].axis[1], (float)sums[i].axis[2]), NO_AXIS);
    for (size_t i = 0; i < count; ++i) {
        int slice = slice_of(division, &leaves[i]);
        sums[slice].cosine = fmin(sums[slice].cosine, (double)vec3_dot(axes[slice], leaves[i].bounds.normals.axis));
    }
    for (int i = 0; i < division->slices; ++i)
        if (sums[i].widest >= 0.0)
            slices[i].normals = (Cone){axes[i], fmin(acos(fmax(sums[i].cosine, -1.0)) + sums[i].widest, M_PI)};
}

/* Chooses where the sum of both parts' costs is least. False if all is in one slice. */
static bool division_choose(const LightBounds slices[SLICES], Division *division)
{
    double above[SLICES + 1] = {0.0}, least = HUGE_VAL;
    LightBounds part = light_bounds_empty();
    for (int i = division->slices; i-- > 1;) {
        light_bounds_join(&part, &slices[i]);
        above[i] = bounds_cost(&part);
    }
    part = light_bounds_empty();
    division->at = 0;
    for (int i = 1; i < division->slices; ++i) {
        light_bounds_join(&part, &slices[i - 1]);
        double cost = bounds_cost(&part) + above[i];
        if (part.normals.angle < 0.0 || !(cost < least))
            continue;
        least = cost;
        division->at = i;
    }
    return division->at > 0;
}

/* Orders the leaves so that those of the left child come first; how many. */
static size_t leaves_divide(Leaf *leaves, size_t count, int depth)
{
    Division division = {.axis = 0};
    LightBounds slices[SLICES];
    size_t left = 0;
    if (count > 2 && depth < DEPTH_MOST && !leaves->bounds.infinite && division_begin(leaves, count, &division)) {
        slices_bound(leaves, count, &division, slices);
        if (division_choose(slices, &division))
            for (size_t i = 0; i < count; ++i)
                if (slice_of(&division, &leaves[i]) < division.at) {
                    Leaf leaf = leaves[i];
                    leaves[i] = leaves[left];
                    leaves[left++] = leaf;
                }
    }
    return left > 0 && left < count ? left : count / 2;
}

/* ---- nodes ------------------------------------------------------------------------------------------------------- */

/* A node of two or more leaves, in the order of LightNode. */
typedef struct Branch {
    LightBounds bounds;
    uint lower; /* leaves of the left child */
} Branch;

/* What the tree is made of. */
typedef struct Builder {
    Leaf *leaves;
    Branch *branches;
    LightNode *nodes;
    size_t lamps; /* leaves that are not at infinity; those come first, and only the root may have both */
    bool differ; /* some node's children are not alike */
} Builder;

/* Divides `count` leaves from `first` on, and makes the branches from `node` on. */
static LightBounds branches_make(Builder *builder, size_t node, size_t first, size_t count, int depth)
{
    if (count == 1)
        return builder->leaves[first].bounds;
    size_t lamps = first < builder->lamps ? builder->lamps - first : 0;
    size_t left = lamps > 0 && lamps < count ? lamps : leaves_divide(builder->leaves + first, count, depth);
    LightBounds bounds = branches_make(builder, node + 1, first, left, depth + 1);
    LightBounds other = branches_make(builder, node + left, first + left, count - left, depth + 1);
    builder->differ |= !light_bounds_alike(&bounds, &other);
    light_bounds_join(&bounds, &other);
    builder->branches[node] = (Branch){bounds, (uint)left};
    return bounds;
}

static const LightBounds *subtree_bounds(const Builder *builder, size_t node, size_t first, size_t count)
{
    return count == 1 ? &builder->leaves[first].bounds : &builder->branches[node].bounds;
}

/* Packs the nodes of such leaves within a sphere. */
static void nodes_pack(Builder *builder, size_t node, size_t first, size_t count, LightSphere sphere)
{
    if (count == 1)
        return;
    size_t left = builder->branches[node].lower;
    LightNode packed = light_node_pack_far((uint)left);
    if (!(first < builder->lamps && builder->lamps < first + count))
        packed = light_node_pack(subtree_bounds(builder, node + 1, first, left),
                                 subtree_bounds(builder, node + left, first + left, count - left), (uint)left, sphere);
    builder->nodes[node] = packed;
    nodes_pack(builder, node + 1, first, left, light_child_sphere(sphere, packed.xy[0], packed.z_size[0]));
    nodes_pack(builder, node + left, first + left, count - left,
               light_child_sphere(sphere, packed.xy[1], packed.z_size[1]));
}

/* ---- entry point ------------------------------------------------------------------------------------------------- */

/* Fills `leaves` with the lights that have power, those at infinity last; how many are not. */
static size_t leaves_fill(const SceneView *view, const double *powers, size_t light_count, Leaf *leaves, size_t *count)
{
    size_t lamps = 0;
    *count = 0;
    for (int far = 0; far < 2; ++far) {
        for (size_t i = 0; i < light_count; ++i) {
            bool infinite = light_is_far(light_kind(&view->lights[i]));
            if (!(powers[i] > 0.0) || infinite != (far == 1))
                continue;
            Leaf *leaf = &leaves[(*count)++];
            leaf->bounds = light_bounds(view, (uint)i, powers[i]);
            leaf->center = infinite ? vec3_splat(0.0f) : box_center(&leaf->bounds.box);
            leaf->light = (uint)i;
        }
        lamps = far == 0 ? *count : lamps;
    }
    return lamps;
}

/* Makes the tree of `count` leaves. */
static LightTree tree_make(Builder *builder, size_t count)
{
    LightBounds none = light_bounds_empty(), all = branches_make(builder, 0, 0, count, 0);
    size_t lamps = builder->lamps, far = count - lamps;
    const LightBounds *near = lamps == count ? &all : lamps > 0 ? subtree_bounds(builder, 1, 0, lamps) : &none;
    const LightBounds *beyond = far == count ? &all : far > 0 ? subtree_bounds(builder, lamps, lamps, far) : &none;
    LightTree tree = light_tree_pack(near, beyond, (uint)count);
    nodes_pack(builder, 0, 0, count, (LightSphere){tree.center, tree.radius});
    return tree;
}

static void leaf_set(Scene *scene, uint light, uint leaf)
{
    uint *flags = &ARRAY_AT(&scene->lights, Light, light).flags;
    *flags = (*flags & ((1u << LIGHT_LEAF_SHIFT) - 1u)) | leaf << LIGHT_LEAF_SHIFT;
}

/* Makes the scene's tree. leaves, branches: space for all lights. */
static bool scene_tree_make(Scene *scene, const SceneView *view, const double *powers, Leaf *leaves, Branch *branches,
                            Error *error)
{
    size_t count, lamps = leaves_fill(view, powers, scene->lights.count, leaves, &count);
    scene->light_tree.count = scene->light_nodes.count = scene->light_leaves.count = 0;
    uint *lights = array_grow(&scene->light_leaves, count, error);
    LightTree *tree = array_grow(&scene->light_tree, 1, error);
    if (!lights || !tree || (count > 1 && !array_grow(&scene->light_nodes, count - 1, error)))
        return false;
    Builder builder = {.leaves = leaves, .branches = branches, .nodes = scene->light_nodes.data, .lamps = lamps};
    *tree = tree_make(&builder, count);
    for (size_t i = 0; i < scene->lights.count; ++i)
        leaf_set(scene, (uint)i, LIGHTS_MAX);
    for (size_t i = 0; i < count; ++i) {
        lights[i] = leaves[i].light;
        leaf_set(scene, leaves[i].light, (uint)i);
    }
    scene_features_set(scene, scene->features | (builder.differ ? FEATURE_LIGHT_TREE : 0u));
    return true;
}

bool light_tree_build(Scene *scene, const double *powers, Error *error)
{
    size_t light_count = scene->lights.count;
    SceneView view = {.features = ~(FEATURE_ALPHA | FEATURE_TEXTURE),
                      .positions = scene->positions.data,
                      .normals = scene->normals.data,
                      .primitives = scene->primitives.data,
                      .shapes = scene->shapes.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .lights = scene->lights.data,
                      .light_details = scene->light_details.data,
                      .images = scene->images.data,
                      .lookup = scene->lookup.data,
                      .texels = scene->texels.data,
                      .portals = scene->portals.data};
    Leaf *leaves = malloc(light_count * sizeof *leaves);
    Branch *branches = malloc(light_count * sizeof *branches);
    bool ok = leaves && branches;
    if (!ok)
        error_memory(error, light_count * (sizeof *leaves + sizeof *branches), "lights");
    ok = ok && scene_tree_make(scene, &view, powers, leaves, branches, error);
    free(leaves);
    free(branches);
    return ok;
}
