#include "scene/light_tree.h"

#include "geometry/box.h"
#include "light/area.h"
#include "light/delta.h"
#include "light/light_tree.h"
#include "scene/portal_setup.h"

#include <math.h>
#include <stdlib.h>

/* Directions within `angle` of the axis; of none: angle < 0. */
typedef struct Cone {
    Vec3 axis;
    double angle;
} Cone;

/* A light, or a node's lights together. */
typedef struct Bounds {
    Box box;
    Cone normals;
    double emission; /* light leaves this far from the normals */
    double intensity;
    bool two_sided;
    bool infinite; /* no place; intensity: irradiance */
} Bounds;

typedef struct Leaf {
    Bounds bounds;
    Vec3 center;
    uint light;
} Leaf;

/* ---- cones ------------------------------------------------------------------------------------------------------- */

static const Cone NO_CONE = {{0.0f, 0.0f, 1.0f}, -1.0};

/* The axis of a cone around both axes, turned from a by `angle` towards b; a unit. */
static Vec3 axis_turn(Vec3 a, Vec3 b, double angle)
{
    double dot = (double)vec3_dot(a, b), side[3], length = 0.0;
    const double from[3] = {(double)a.x, (double)a.y, (double)a.z}, to[3] = {(double)b.x, (double)b.y, (double)b.z};
    for (int i = 0; i < 3; ++i) {
        side[i] = to[i] - dot * from[i];
        length += side[i] * side[i];
    }
    length = sqrt(length);
    if (!(length > 1e-12))
        return a;
    double c = cos(angle), s = sin(angle) / length;
    return vec3_normalize(vec3((float)(c * from[0] + s * side[0]), (float)(c * from[1] + s * side[1]),
                               (float)(c * from[2] + s * side[2])));
}

/* The smallest cone around both. */
static Cone cone_join(Cone a, Cone b)
{
    if (a.angle < b.angle) {
        Cone larger = b;
        b = a;
        a = larger;
    }
    if (b.angle < 0.0 || a.angle >= M_PI)
        return a;
    double between = acos(fmin(fmax((double)vec3_dot(a.axis, b.axis), -1.0), 1.0));
    if (between + b.angle <= a.angle)
        return a;
    double angle = 0.5 * (a.angle + between + b.angle);
    if (angle >= M_PI || between > M_PI - 1e-3)
        return (Cone){a.axis, M_PI};
    return (Cone){axis_turn(a.axis, b.axis, angle - a.angle), angle};
}

/* ---- bounds ------------------------------------------------------------------------------------------------------ */

static Bounds bounds_empty(void)
{
    return (Bounds){.box = box_empty(), .normals = NO_CONE};
}

static void bounds_join(Bounds *a, const Bounds *b)
{
    box_join(&a->box, &b->box);
    a->normals = cone_join(a->normals, b->normals);
    a->emission = fmax(a->emission, b->emission);
    a->intensity += b->intensity;
    a->two_sided |= b->two_sided;
    a->infinite |= b->infinite;
}

/* The normals of an area light. Those of a bilinear patch are sums of the corners' with positive factors. */
static Cone area_normals(const SceneView *view, uint light)
{
    Primitive primitive = view->primitives[view->lights[light].primitive];
    uint kind = primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    if (kind == PRIMITIVE_SPHERE || kind == PRIMITIVE_CYLINDER)
        return (Cone){NO_CONE.axis, M_PI};
    Cone cone = NO_CONE;
    for (int corner = 0; corner < (kind == PRIMITIVE_BILINEAR ? 4 : 1); ++corner) {
        Vec2 u = vec2((corner & 1) != 0 ? 1.0f : 0.0f, (corner & 2) != 0 ? 1.0f : 0.0f);
        u = kind == PRIMITIVE_BILINEAR ? u : vec2(0.5f, 0.5f);
        cone = cone_join(cone, (Cone){area_light_point(view, light, &primitive, u).ng, 0.0});
    }
    return cone.angle > 0.5 * M_PI ? (Cone){NO_CONE.axis, M_PI} : cone;
}

/* The largest part of a surface's area that is seen from one direction, with its cosine: of a sphere, that of its disc;
 * of a cylinder, that of its silhouette, also where it is flattened to almost two sides. */
static double area_shown(uint kind)
{
    return kind == PRIMITIVE_SPHERE ? 0.25 : kind == PRIMITIVE_CYLINDER ? 0.5 : 1.0;
}

/* power: its flux. intensity: the largest in any direction, so that intensity / distance^2 is what arrives there. */
static Bounds area_bounds(const SceneView *view, uint light, double power)
{
    const Light *source = &view->lights[light];
    uint kind = view->primitives[source->primitive].shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    bool two_sided = (source->flags & LIGHT_TWO_SIDED) != 0;
    double facing = area_shown(kind);
    return (Bounds){.box = primitive_box(view, source->primitive),
                    .normals = area_normals(view, light),
                    .emission = 0.5 * M_PI,
                    .intensity = power * facing / (M_PI * (two_sided ? 2.0 : 1.0)),
                    .two_sided = two_sided};
}

/* The largest luminance of a point light's intensity in any direction. */
static double intensity_most(const SceneView *view, const Light *light)
{
    if (!light_has_intensity_image(light->kind))
        return (double)rgb_luminance(light->emission);
    double most = 0.0;
    TextureImage image = view->images[light->image];
    for (uint y = 0; y < image.height; ++y)
        for (uint x = 0; x < image.width; ++x)
            most = fmax(most, (double)rgb_luminance(vec3_mul(light->emission, image_texel(view, &image, x, y))));
    return most;
}

static Bounds position_bounds(const SceneView *view, const Light *light)
{
    Bounds bounds = {.box = box_empty(),
                     .normals = {NO_CONE.axis, M_PI},
                     .emission = 0.5 * M_PI,
                     .intensity = intensity_most(view, light)};
    box_add(&bounds.box, light->position);
    if (light->kind == LIGHT_SPOT || light->kind == LIGHT_PROJECTION) {
        bounds.normals = (Cone){light->direction, acos((double)light->cos_falloff)};
        bounds.emission = acos((double)light->cos_total) - bounds.normals.angle;
    }
    return bounds;
}

/* As of an area light that emits the same flux. */
static Bounds portal_bounds(const Portal *portal, double power)
{
    Bounds bounds = {.box = box_empty(),
                     .normals = {vec3_negate(portal->axes.n), 0.0},
                     .emission = 0.5 * M_PI,
                     .intensity = power / M_PI};
    for (int i = 0; i < 4; ++i)
        box_add(&bounds.box, portal_corner(portal, i));
    return bounds;
}

static Bounds light_bounds(const SceneView *view, uint light, double power, double disk)
{
    const Light *source = &view->lights[light];
    if (source->kind == LIGHT_AREA)
        return area_bounds(view, light, power);
    if (light_has_position(source->kind))
        return position_bounds(view, source);
    if (source->kind == LIGHT_PORTAL)
        return portal_bounds(&view->portals[source->portal], power);
    double directions = source->kind >= LIGHT_INFINITE ? 0.25 : 1.0; /* 4 pi sr, of which pi counts at a surface */
    return (Bounds){.box = box_empty(), .normals = NO_CONE, .intensity = power * directions / disk, .infinite = true};
}

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
static double bounds_cost(const Bounds *bounds)
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

/* The cone of many normals: around the mean of their axes. */
typedef struct ConeSum {
    double axis[3], widest, cosine;
} ConeSum;

static void slices_bound(const Leaf *leaves, size_t count, const Division *division, Bounds slices[SLICES])
{
    ConeSum sums[SLICES];
    Vec3 axes[SLICES];
    for (int i = 0; i < SLICES; ++i) {
        slices[i] = bounds_empty();
        sums[i] = (ConeSum){{0.0, 0.0, 0.0}, -1.0, 1.0};
        axes[i] = NO_CONE.axis;
    }
    for (size_t i = 0; i < count; ++i) {
        int slice = slice_of(division, &leaves[i]);
        const Bounds *bounds = &leaves[i].bounds;
        box_join(&slices[slice].box, &bounds->box);
        slices[slice].emission = fmax(slices[slice].emission, bounds->emission);
        slices[slice].intensity += bounds->intensity;
        sums[slice].axis[0] += (double)bounds->normals.axis.x;
        sums[slice].axis[1] += (double)bounds->normals.axis.y;
        sums[slice].axis[2] += (double)bounds->normals.axis.z;
        sums[slice].widest = fmax(sums[slice].widest, bounds->normals.angle);
    }
    for (int i = 0; i < division->slices; ++i)
        axes[i] =
            vec3_direction(vec3((float)sums[i].axis[0], (float)sums[i].axis[1], (float)sums[i].axis[2]), NO_CONE.axis);
    for (size_t i = 0; i < count; ++i) {
        int slice = slice_of(division, &leaves[i]);
        sums[slice].cosine = fmin(sums[slice].cosine, (double)vec3_dot(axes[slice], leaves[i].bounds.normals.axis));
    }
    for (int i = 0; i < division->slices; ++i)
        if (sums[i].widest >= 0.0)
            slices[i].normals = (Cone){axes[i], fmin(acos(fmax(sums[i].cosine, -1.0)) + sums[i].widest, M_PI)};
}

/* Chooses where the sum of both parts' costs is least. False if all is in one slice. */
static bool division_choose(const Bounds slices[SLICES], Division *division)
{
    double above[SLICES + 1] = {0.0}, least = HUGE_VAL;
    Bounds part = bounds_empty();
    for (int i = division->slices; i-- > 1;) {
        bounds_join(&part, &slices[i]);
        above[i] = bounds_cost(&part);
    }
    part = bounds_empty();
    division->at = 0;
    for (int i = 1; i < division->slices; ++i) {
        bounds_join(&part, &slices[i - 1]);
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
    Bounds slices[SLICES];
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

/* The cosine in 15 bits, not larger than that of the angle and of the error of direction_pack beyond it. */
static uint cosine_pack(double angle)
{
    double cosine = angle + 1e-3 < M_PI ? cos(fmax(angle, 0.0) + 1e-3) : -1.0;
    return (uint)floor((cosine + 1.0) * 16383.5);
}

static LightNode node_make(const Bounds *bounds, uint link)
{
    LightNode node = {.radius = -1.0f, .intensity = (float)bounds->intensity, .link = link};
    if (bounds->infinite)
        return node;
    double square = 0.0;
    node.center = box_center(&bounds->box);
    const double center[3] = {(double)node.center.x, (double)node.center.y, (double)node.center.z};
    for (int i = 0; i < 3; ++i)
        square += pow(fmax((double)bounds->box.high[i] - center[i], center[i] - (double)bounds->box.low[i]), 2.0);
    node.radius = (float)(sqrt(square) * (1.0 + 1e-6));
    node.axis = direction_pack(bounds->normals.axis);
    node.cones = cosine_pack(bounds->normals.angle) << LIGHT_NODE_NORMALS |
                 cosine_pack(bounds->emission) << LIGHT_NODE_EMISSION | (bounds->two_sided ? LIGHT_NODE_TWO_SIDED : 0u);
    return node;
}

/* Whether nothing but the intensity distinguishes two nodes, as the two triangles of a square. */
static bool nodes_alike(const LightNode *a, const LightNode *b)
{
    float most = 0.01f * a->radius;
    return a->radius > 0.0f && b->radius > 0.0f && fabsf(a->radius - b->radius) <= most &&
           vec3_length(vec3_sub(a->center, b->center)) <= most && a->cones == b->cones &&
           vec3_dot(direction_unpack(a->axis), direction_unpack(b->axis)) > 0.9999f;
}

/* What nodes_make is at work on. */
typedef struct Builder {
    LightNode *nodes;
    Light *lights;
    uint node_count, leaf_count;
    bool differ; /* some node's children are not alike */
} Builder;

/* Makes the nodes of the leaves, 2 count - 1, in the order of a walk that takes left children first. lamps: how many
 * leaves at the start are not at infinity; only the root may have both. */
static Bounds nodes_make(Builder *builder, Leaf *leaves, size_t count, size_t lamps, int depth)
{
    uint own = builder->node_count++;
    if (count == 1) {
        builder->lights[leaves->light].leaf = builder->leaf_count++;
        builder->nodes[own] = node_make(&leaves->bounds, leaves->light | LIGHT_NODE_LEAF);
        return leaves->bounds;
    }
    size_t left = lamps > 0 && lamps < count ? lamps : leaves_divide(leaves, count, depth);
    Bounds bounds = nodes_make(builder, leaves, left, left, depth + 1);
    uint right = builder->node_count;
    Bounds other = nodes_make(builder, leaves + left, count - left, count - left, depth + 1);
    bounds_join(&bounds, &other);
    bool even = nodes_alike(&builder->nodes[own + 1], &builder->nodes[right]);
    builder->differ |= !even;
    builder->nodes[own] = node_make(&bounds, right | (even ? LIGHT_NODE_EVEN : 0u));
    return bounds;
}

/* ---- entry point ------------------------------------------------------------------------------------------------- */

/* Fills `leaves` with the lights that have power, those at infinity last; how many are not. */
static size_t leaves_fill(const SceneView *view, const double *powers, double disk, size_t light_count, Leaf *leaves,
                          size_t *count)
{
    size_t lamps = 0;
    *count = 0;
    for (int far = 0; far < 2; ++far) {
        for (size_t i = 0; i < light_count; ++i) {
            bool infinite = light_is_far(view->lights[i].kind);
            if (!(powers[i] > 0.0) || infinite != (far == 1))
                continue;
            Leaf *leaf = &leaves[(*count)++];
            leaf->bounds = light_bounds(view, (uint)i, powers[i], disk);
            leaf->center = infinite ? vec3_splat(0.0f) : box_center(&leaf->bounds.box);
            leaf->light = (uint)i;
        }
        lamps = far == 0 ? *count : lamps;
    }
    return lamps;
}

bool light_tree_build(Scene *scene, const double *powers, double disk, Error *error)
{
    size_t count, light_count = scene->lights.count, most = 2 * light_count - 1;
    SceneView view = {.features = ~(FEATURE_ALPHA | FEATURE_TEXTURE),
                      .positions = scene->positions.data,
                      .normals = scene->normals.data,
                      .primitives = scene->primitives.data,
                      .shapes = scene->shapes.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .lights = scene->lights.data,
                      .images = scene->images.data,
                      .lookup = scene->lookup.data,
                      .texels = scene->texels.data,
                      .portals = scene->portals.data};
    scene->light_nodes.count = 0;
    Leaf *leaves = malloc(light_count * sizeof *leaves);
    LightNode *nodes = array_grow(&scene->light_nodes, most, error);
    if (!leaves || !nodes) {
        free(leaves);
        return leaves ? false : error_memory(error, light_count * sizeof *leaves, "lights");
    }
    for (size_t i = 0; i < light_count; ++i)
        ARRAY_AT(&scene->lights, Light, i).leaf = NONE;
    size_t lamps = leaves_fill(&view, powers, disk, light_count, leaves, &count);
    Builder builder = {.nodes = nodes, .lights = scene->lights.data};
    nodes_make(&builder, leaves, count, lamps, 0);
    scene->light_nodes.count = builder.node_count;
    scene_features_set(scene, scene->features | (builder.differ ? FEATURE_LIGHT_TREE : 0u));
    free(leaves);
    return true;
}
