/* Choosing a light for a point: a binary tree over the lights with bounds of their places, directions and intensities
 * (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). The walk down the
 * tree takes the child of a node with a probability in proportion to an estimate of the irradiance that it causes.
 * host/scene/light_tree.c builds the tree.
 *
 * A node holds its children's bounds in a few bits, spheres in units of its own sphere, so a walk decodes them on its
 * way; host/scene/light_node.c makes them with the functions below, so that no rounding loses a light. */
#ifndef TWINLIGHT_LIGHT_LIGHT_TREE_H
#define TWINLIGHT_LIGHT_LIGHT_TREE_H

#include "geometry/curve.h"
#include "layout/scene_view.h"

/* The probability of the lamps, if there are distant or infinite lights, too: a share of the estimated irradiance
 * within these bounds. Visibility is not known: much of what arrives from far away may be hidden, or all of a lamp's
 * light. */
#define LAMPS_LEAST 0.5f
#define LAMPS_MOST 0.875f

/* ---- a node's packed members ------------------------------------------------------------------------------------- */

/* A unit vector in two times 8 bits, to within 0.02: its projection to the octahedron |x| + |y| + |z| = 1, whose lower
 * half is folded outwards into the plane z = 0. The axes are exact. */
SHARED_FUNCTION uint direction_pack(Vec3 d)
{
    float scale = 1.0f / (float_abs(d.x) + float_abs(d.y) + float_abs(d.z));
    float x = d.x * scale, y = d.y * scale;
    if (d.z < 0.0f) {
        float folded = (1.0f - float_abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - float_abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = folded;
    }
    return (uint)((x + 1.0f) * 127.0f + 0.5f) | (uint)((y + 1.0f) * 127.0f + 0.5f) << 8;
}

/* Of the lowest 16 bits. */
SHARED_FUNCTION Vec3 direction_unpack(uint packed)
{
    const float unit = 1.0f / 127.0f;
    float x = (float)(packed & 0xffu) * unit - 1.0f, y = (float)(packed >> 8 & 0xffu) * unit - 1.0f;
    float z = 1.0f - float_abs(x) - float_abs(y);
    if (z < 0.0f) {
        float folded = (1.0f - float_abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - float_abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = folded;
    }
    return vec3_normalize(vec3(x, y, z));
}

/* An angle between 0 and pi by its cosine and sine. */
typedef struct Angle {
    float cosine, sine;
} Angle;

SHARED_FUNCTION Angle angle_of_cosine(float cosine)
{
    Angle a;
    a.cosine = cosine;
    a.sine = float_sqrt(float_max(1.0f - cosine * cosine, 0.0f));
    return a;
}

/* The angle of a cone of normals (LightNode.z_size). */
SHARED_FUNCTION Angle cone_angle(uint cone)
{
    float x = (float)cone * (1.0f / 255.0f);
    Angle a;
    a.cosine = 1.0f - 2.0f * x * x;
    a.sine = 2.0f * x * float_sqrt(float_max(1.0f - x * x, 0.0f));
    return a;
}

/* A sphere around lights. */
typedef struct LightSphere {
    Vec3 center;
    float radius;
} LightSphere;

/* A child's sphere by that of its node, and by LightNode.xy and z_size. A size of 4095 is a factor of 1, 0 is little
 * more than 2^-16. */
SHARED_FUNCTION LightSphere light_child_sphere(LightSphere node, uint xy, uint z_size)
{
    float unit = node.radius * (1.0f / 2047.0f);
    uint size = z_size >> 12 & 0xfffu;
    Vec3 steps =
        vec3((float)(xy & 0xfffu) - 2047.0f, (float)(xy >> 12 & 0xfffu) - 2047.0f, (float)(z_size & 0xfffu) - 2047.0f);
    LightSphere child;
    child.center = vec3_add(node.center, vec3_scale(steps, unit));
    child.radius = node.radius * bits_float((111u << 23) + ((size + 1u) << 15));
    return child;
}

/* The right child's intensity over the left one's. */
SHARED_FUNCTION float light_node_ratio(uint xy_left, uint xy_right)
{
    return bits_float(((xy_left >> 24) << 8 | xy_right >> 24) << 15);
}

/* What a walk knows about lights: a sphere around them, and their normals. */
typedef struct LightCluster {
    LightSphere sphere;
    uint cone; /* as in LightNode.z_size */
    uint axis; /* as in direction_pack */
} LightCluster;

SHARED_FUNCTION LightCluster light_child(LightSphere node, uint xy, uint z_size, uint axis)
{
    LightCluster child;
    child.sphere = light_child_sphere(node, xy, z_size);
    child.cone = z_size >> 24;
    child.axis = axis;
    return child;
}

/* ---- importance -------------------------------------------------------------------------------------------------- */

/* a - b, but at least 0. */
SHARED_FUNCTION Angle angle_less(Angle a, Angle b)
{
    Angle less;
    bool none = a.cosine > b.cosine;
    less.cosine = none ? 1.0f : a.cosine * b.cosine + a.sine * b.sine;
    less.sine = none ? 0.0f : a.sine * b.cosine - a.cosine * b.sine;
    return less;
}

/* What the radius of a node's sphere adds to the squared distance: as for lights that are spread over it. */
#define RADIUS_SQUARED_PART 0.125f

/* A cosine at a node's lights from that at the middle of its sphere and the largest in the sphere. */
SHARED_FUNCTION float cosine_between(float middle, float most)
{
    return float_max(0.6f * float_max(middle, 0.0f) + 0.4f * most, 0.0f);
}

/* The point that a light is chosen for. n: the surface's unit normal, or 0 at a point in a medium and on a curve; no
 * cosine of n counts for less than `least`, which is 1 there and else 0. */
typedef struct LightReceiver {
    Vec3 p, n;
    float least;
} LightReceiver;

SHARED_FUNCTION LightReceiver light_receiver(const SceneView *scene, Vec3 p, Vec3 ng)
{
    LightReceiver at;
    at.p = p;
    at.n = normal_is_fibre(scene, ng) ? vec3_splat(0.0f) : ng;
    at.least = SCENE_HAS(scene, FEATURE_SCATTERING | FEATURE_CURVE) && vec3_is_zero(at.n) ? 1.0f : 0.0f;
    return at;
}

/* The part of light_importance for directions: w from the receiver to the middle of the sphere, of which it sees half
 * the angle `around`. */
SHARED_FUNCTION float light_cone_importance(const LightCluster *lights, uint flags, Vec3 w, Angle around)
{
    if (lights->cone == LIGHT_CONE_ALL)
        return 1.0f;
    float facing = -vec3_dot(direction_unpack(lights->axis), w);
    if ((flags & LIGHT_NODE_TWO_SIDED) != 0u)
        facing = float_abs(facing);
    Angle leaving = angle_less(angle_of_cosine(facing), cone_angle(lights->cone));
    float most = angle_less(leaving, around).cosine;
    if ((flags & LIGHT_NODE_BEAMS) != 0u)
        return most < 1.0f ? 0.0f : 1.0f;
    return most > 0.0f ? cosine_between(leaving.cosine, most) : 0.0f;
}

/* An estimate of the irradiance at a point by lights of intensity 1 together. 0 only if they send nothing there: with
 * the largest cosines that any point of the sphere allows alone, as by Conty Estevez and Kulla, the variance over many
 * lights was three times as large (docs/TUNING.md). flags: LIGHT_NODE_. */
SHARED_FUNCTION float light_importance(const LightCluster *lights, uint flags, LightReceiver at)
{
    LightSphere sphere = lights->sphere;
    Vec3 d = vec3_sub(sphere.center, at.p);
    float distance2 = vec3_length_squared(d), radius2 = sphere.radius * sphere.radius;
    float irradiance = 1.0f / float_max(distance2 + RADIUS_SQUARED_PART * radius2, 1e-30f);
    if (!(distance2 > radius2))
        return irradiance;
    float scale = 1.0f / float_sqrt(distance2);
    Vec3 w = vec3_scale(d, scale);
    Angle around; /* half the angle that the sphere subtends */
    around.sine = sphere.radius * scale;
    around.cosine = float_sqrt(float_max(1.0f - around.sine * around.sine, 0.0f));
    float arriving = float_max(float_abs(vec3_dot(at.n, w)), at.least);
    irradiance *= cosine_between(arriving, angle_less(angle_of_cosine(arriving), around).cosine);
    return irradiance * light_cone_importance(lights, flags, w, around);
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

/* A place on the way down the tree: `count` leaves from the leaf `first` on, of which `node` is the root if there are
 * two or more, and the sphere around them. */
typedef struct LightWalk {
    uint node, first, count;
    LightSphere sphere;
} LightWalk;

/* Of all lights that are not at infinity. */
SHARED_FUNCTION LightCluster light_tree_lamps(const SceneView *scene)
{
    __global const LightTree *tree = scene->light_tree;
    LightCluster lamps;
    lamps.sphere.center = tree->center;
    lamps.sphere.radius = tree->radius;
    lamps.cone = tree->cone;
    lamps.axis = tree->axis;
    return lamps;
}

SHARED_FUNCTION LightWalk light_walk_begin(const SceneView *scene)
{
    LightWalk walk;
    walk.node = 0u;
    walk.first = 0u;
    walk.count = scene->light_tree->leaves;
    walk.sphere = light_tree_lamps(scene).sphere;
    return walk;
}

/* The two children of a node and the probability of the left one. */
typedef struct LightFork {
    uint lower; /* leaves of the left child */
    LightCluster left, right;
    float share;
} LightFork;

/* The share of lamps beside distant and infinite lights. */
SHARED_FUNCTION float light_lamps_share(const SceneView *scene, LightReceiver at)
{
    __global const LightTree *tree = scene->light_tree;
    LightCluster all = light_tree_lamps(scene);
    float lamps = tree->lamps * light_importance(&all, tree->flags, at);
    float share = lamps / (lamps + tree->far);
    return share >= 0.0f ? float_clamp(share, LAMPS_LEAST, LAMPS_MOST) : 0.5f;
}

/* The probability of the left child. ratio: light_node_ratio. */
SHARED_FUNCTION float light_fork_share(const SceneView *scene, uint flags, float ratio, const LightFork *fork,
                                       LightReceiver at)
{
    if ((flags & LIGHT_NODE_FAR) != 0u)
        return light_lamps_share(scene, at);
    if ((flags & LIGHT_NODE_EVEN) != 0u)
        return 1.0f / (1.0f + ratio);
    float to_left = light_importance(&fork->left, flags, at);
    float to_right = ratio * light_importance(&fork->right, flags, at);
    float share = to_left / (to_left + to_right);
    return share >= 0.0f ? share : 0.5f; /* nothing from both, or infinite */
}

SHARED_FUNCTION LightFork light_walk_fork(const SceneView *scene, const LightWalk *walk, LightReceiver at)
{
    LightNode node = scene->light_nodes[walk->node];
    LightFork fork;
    fork.lower = node.left & LIGHTS_MAX;
    fork.left = light_child(walk->sphere, node.xy[0], node.z_size[0], node.axes & 0xffffu);
    fork.right = light_child(walk->sphere, node.xy[1], node.z_size[1], node.axes >> 16);
    fork.share = light_fork_share(scene, node.left, light_node_ratio(node.xy[0], node.xy[1]), &fork, at);
    return fork;
}

/* Goes to a child; returns the probability of that. */
SHARED_FUNCTION float light_walk_descend(LightWalk *walk, const LightFork *fork, bool to_left)
{
    walk->node += to_left ? 1u : fork->lower; /* the left child's nodes are one fewer than its leaves */
    walk->first += to_left ? 0u : fork->lower;
    walk->count = to_left ? fork->lower : walk->count - fork->lower;
    walk->sphere = to_left ? fork->left.sphere : fork->right.sphere;
    return to_left ? fork->share : 1.0f - fork->share;
}

/* Whether a number, uniform below 2^64, is in the lower part `share` of its range. Stretches its part to the whole. */
SHARED_FUNCTION bool number_below(ulong *number, float share)
{
    uint limit = share < 1.0f ? (uint)(share * 4294967296.0f) : 0u;
    if (share >= 1.0f || limit == 0u)
        return share >= 1.0f;
    ulong bound = (ulong)limit << 32, rest = *number, size = limit;
    bool below = rest < bound;
    if (!below) {
        rest -= bound;
        size = ((ulong)1 << 32) - limit;
    }
    *number = (rest / size) << 32 | ((rest % size) << 32) / size;
    return below;
}

/* Chooses a light for p with a number, uniform below 2^64, of which what is left is uniform given the light. *pdf: the
 * probability of the light. */
SHARED_FUNCTION_APART uint light_tree_choose(const SceneView *scene, Vec3 p, Vec3 n, ulong *number, float *pdf)
{
    LightReceiver at = light_receiver(scene, p, n);
    LightWalk walk = light_walk_begin(scene);
    *pdf = 1.0f;
    while (walk.count > 1u) {
        LightFork fork = light_walk_fork(scene, &walk, at);
        *pdf *= light_walk_descend(&walk, &fork, number_below(number, fork.share));
    }
    return scene->light_leaves[walk.first];
}

/* The probability with which light_tree_choose chooses the light; 0 for those without power. */
SHARED_FUNCTION_APART float light_tree_pdf(const SceneView *scene, uint light, Vec3 p, Vec3 n)
{
    uint leaf = light_leaf(scene->lights + light);
    if (leaf == LIGHTS_MAX)
        return 0.0f;
    LightReceiver at = light_receiver(scene, p, n);
    LightWalk walk = light_walk_begin(scene);
    float pdf = 1.0f;
    while (walk.count > 1u) {
        LightFork fork = light_walk_fork(scene, &walk, at);
        pdf *= light_walk_descend(&walk, &fork, leaf - walk.first < fork.lower);
    }
    return pdf;
}

#endif
