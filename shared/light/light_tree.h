/* Choosing a light for a point: a binary tree over the lights with bounds of their places, directions and intensities
 * (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). The walk down the
 * tree takes the child of a node with a probability in proportion to an estimate of the irradiance that it causes.
 * host/scene/light_tree.c builds the tree. */
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

/* A unit vector in two times 16 bits, to within 1e-4: its projection to the octahedron |x| + |y| + |z| = 1, whose lower
 * half is folded outwards into the plane z = 0. */
SHARED_FUNCTION uint direction_pack(Vec3 d)
{
    float scale = 1.0f / (float_abs(d.x) + float_abs(d.y) + float_abs(d.z));
    float x = d.x * scale, y = d.y * scale;
    if (d.z < 0.0f) {
        float folded = (1.0f - float_abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - float_abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = folded;
    }
    return (uint)((x + 1.0f) * 32767.0f + 0.5f) | (uint)((y + 1.0f) * 32767.0f + 0.5f) << 16;
}

SHARED_FUNCTION Vec3 direction_unpack(uint packed)
{
    const float unit = 1.0f / 32767.0f;
    float x = (float)(packed & 0xffffu) * unit - 1.0f, y = (float)(packed >> 16) * unit - 1.0f;
    float z = 1.0f - float_abs(x) - float_abs(y);
    if (z < 0.0f) {
        float folded = (1.0f - float_abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - float_abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
        x = folded;
    }
    return vec3_normalize(vec3(x, y, z));
}

/* The cosine in 15 bits, from `shift` on in a LightNode's cones; rounded down, so that the angle is not smaller. */
SHARED_FUNCTION float light_node_cosine(uint cones, uint shift)
{
    return (float)(cones >> shift & 0x7fffu) * (1.0f / 16383.5f) - 1.0f;
}

/* ---- importance -------------------------------------------------------------------------------------------------- */

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

/* An estimate of the irradiance that the lights of a node cause at p, where the surface has the unit normal n; at a
 * point in a medium n is 0, and `least`, below which no cosine of n counts, is 1 instead of 0. 0 only if
 * they send nothing to p: with the largest cosines that any point of the sphere allows alone, as by Conty Estevez and
 * Kulla, the variance over many lights was three times as large (docs/TUNING.md). */
SHARED_FUNCTION float light_node_importance(__global const LightNode *node, Vec3 p, Vec3 n, float least)
{
    float radius = node->radius, intensity = node->intensity;
    if (radius < 0.0f)
        return intensity;
    Vec3 d = vec3_sub(node->center, p);
    float distance2 = vec3_length_squared(d), radius2 = radius * radius;
    float irradiance = intensity / float_max(distance2 + RADIUS_SQUARED_PART * radius2, 1e-30f);
    if (!(distance2 > radius2))
        return irradiance;
    float scale = 1.0f / float_sqrt(distance2);
    Vec3 w = vec3_scale(d, scale);
    Angle around; /* half the angle that the sphere subtends */
    around.sine = radius * scale;
    around.cosine = float_sqrt(float_max(1.0f - around.sine * around.sine, 0.0f));
    uint cones = node->cones;
    float arriving = float_max(float_abs(vec3_dot(n, w)), least);
    irradiance *= cosine_between(arriving, angle_less(angle_of_cosine(arriving), around).cosine);
    if ((cones >> LIGHT_NODE_NORMALS & 0x7fffu) == 0u) /* normals in all directions */
        return irradiance;
    float facing = -vec3_dot(direction_unpack(node->axis), w);
    if ((cones & LIGHT_NODE_TWO_SIDED) != 0u)
        facing = float_abs(facing);
    Angle leaving = angle_less(angle_of_cosine(facing), angle_of_cosine(light_node_cosine(cones, LIGHT_NODE_NORMALS)));
    float most = angle_less(leaving, around).cosine;
    if (most <= light_node_cosine(cones, LIGHT_NODE_EMISSION))
        return 0.0f;
    return irradiance * cosine_between(leaving.cosine, most);
}

/* The probability of the left one of two children. link: of their parent. */
SHARED_FUNCTION float light_node_share(uint link, __global const LightNode *left, __global const LightNode *right,
                                       Vec3 p, Vec3 n, float least)
{
    if ((link & LIGHT_NODE_EVEN) != 0u)
        return left->intensity / (left->intensity + right->intensity);
    float to_left = light_node_importance(left, p, n, least), to_right = light_node_importance(right, p, n, least);
    float share = to_left / (to_left + to_right);
    if (!(share >= 0.0f)) /* nothing from both, or infinite */
        return 0.5f;
    bool lamps = left->radius >= 0.0f && right->radius < 0.0f;
    return lamps ? float_clamp(share, LAMPS_LEAST, LAMPS_MOST) : share;
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

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

/* `least` of light_node_importance. */
SHARED_FUNCTION float light_tree_least(const SceneView *scene, Vec3 n)
{
    return SCENE_HAS(scene, FEATURE_SCATTERING | FEATURE_CURVE) && vec3_is_zero(n) ? 1.0f : 0.0f;
}

/* The normal for light_node_importance: a curve has none. */
SHARED_FUNCTION Vec3 light_tree_normal(const SceneView *scene, Vec3 ng)
{
    return normal_is_fibre(scene, ng) ? vec3_splat(0.0f) : ng;
}

/* Chooses a light for p with a number, uniform below 2^64, of which what is left is uniform given the light. *pdf: the
 * probability of the light. */
SHARED_FUNCTION_APART uint light_tree_choose(const SceneView *scene, Vec3 p, Vec3 n, ulong *number, float *pdf)
{
    __global const LightNode *node = scene->light_nodes;
    n = light_tree_normal(scene, n);
    float least = light_tree_least(scene, n);
    *pdf = 1.0f;
    uint link = node->link;
    while ((link & LIGHT_NODE_LEAF) == 0u) {
        __global const LightNode *left = node + 1, *right = scene->light_nodes + (link & LIGHT_NODE_INDEX);
        float share = light_node_share(link, left, right, p, n, least);
        bool below = number_below(number, share);
        node = below ? left : right;
        *pdf *= below ? share : 1.0f - share;
        link = node->link;
    }
    return link & LIGHT_NODE_INDEX;
}

/* The probability with which light_tree_choose chooses the light; 0 for those without power. */
SHARED_FUNCTION_APART float light_tree_pdf(const SceneView *scene, uint light, Vec3 p, Vec3 n)
{
    uint leaf = scene->lights[light].leaf, node = 0u;
    n = light_tree_normal(scene, n);
    float pdf = 1.0f, least = light_tree_least(scene, n);
    if (leaf == NONE)
        return 0.0f;
    for (;;) {
        uint link = scene->light_nodes[node].link;
        if ((link & LIGHT_NODE_LEAF) != 0u)
            return pdf;
        uint right = link & LIGHT_NODE_INDEX;
        float share = light_node_share(link, scene->light_nodes + node + 1u, scene->light_nodes + right, p, n, least);
        uint lower = (right - node) / 2u; /* leaves of the left child, which has 2 lower - 1 nodes */
        bool below = leaf < lower;
        leaf -= below ? 0u : lower;
        node = below ? node + 1u : right;
        pdf *= below ? share : 1.0f - share;
    }
}

#endif
