#include "scene/light_node.h"

#include <math.h>

/* Radii are larger by this factor than distances, and cones by this angle in radians than their normals, so that the
 * kernels' rounding makes no light seem to send nothing. */
#define RADIUS_MARGIN (1.0 + 1e-6)
#define ANGLE_MARGIN 1e-3

/* Ratios of intensities beyond this are stored as it: a light may be chosen too often, but never too rarely to be
 * found, and no product overflows (light_importance is below 1e30). */
#define RATIO_MOST 0x1p28

/* The packed bounds of a child. */
typedef struct ChildBits {
    uint xy, z_size, axis;
} ChildBits;

#define SIZE_SHIFT 12
#define SIZE_WHOLE 0xfffu

/* A child that has its node's sphere. */
static const ChildBits WHOLE = {2047u | 2047u << 12, 2047u | SIZE_WHOLE << SIZE_SHIFT, 0};

static uint offset_pack(double offset, double radius)
{
    double steps = radius > 0.0 ? floor(offset / radius * 2047.0 + 0.5) : 0.0;
    return (uint)(fmin(fmax(steps, -2047.0), 2047.0) + 2047.0);
}

/* The smallest size whose radius is at least `reach`, or SIZE_WHOLE. */
static uint size_pack(LightSphere node, double reach)
{
    uint low = 0, high = SIZE_WHOLE;
    while (low < high) {
        uint middle = (low + high) / 2u;
        bool enough = (double)light_child_sphere(node, 0, middle << SIZE_SHIFT).radius >= reach;
        *(enough ? &high : &low) = enough ? middle : middle + 1u;
    }
    return low;
}

/* A sphere around the box in that of its node: the smallest about its centre, or the node's own. */
static ChildBits sphere_pack(const Box *box, LightSphere node)
{
    Vec3 center = box_center(box);
    double radius = (double)node.radius;
    ChildBits child = {offset_pack((double)center.x - (double)node.center.x, radius) |
                           offset_pack((double)center.y - (double)node.center.y, radius) << 12,
                       offset_pack((double)center.z - (double)node.center.z, radius), 0};
    Vec3 packed = light_child_sphere(node, child.xy, child.z_size).center;
    uint size = size_pack(node, RADIUS_MARGIN * box_reach(box, packed));
    child.z_size |= size << SIZE_SHIFT;
    return size < SIZE_WHOLE ? child : WHOLE;
}

/* The angle of normals, which includes the error of the axis. */
static uint cone_pack(Cone normals)
{
    double away =
        acos(fmin(fmax((double)vec3_dot(direction_unpack(direction_pack(normals.axis)), normals.axis), -1.0), 1.0));
    double angle = fmax(normals.angle, 0.0) + away + ANGLE_MARGIN;
    return angle < M_PI ? (uint)ceil(255.0 * sin(0.5 * angle)) : LIGHT_CONE_ALL;
}

static ChildBits child_pack(const LightBounds *bounds, LightSphere node)
{
    ChildBits child = bounds->infinite ? WHOLE : sphere_pack(&bounds->box, node);
    child.z_size |= cone_pack(bounds->normals) << 24;
    child.axis = direction_pack(bounds->normals.axis);
    return child;
}

/* In the upper half of a float, without the sign and rounded. */
static uint ratio_pack(double left, double right)
{
    float ratio = (float)fmin(fmax(right / left, 1.0 / RATIO_MOST), RATIO_MOST);
    return (float_bits(ratio) + 0x4000u) >> 15;
}

/* Those that hold for both. */
static uint flags_of(const LightBounds *a, const LightBounds *b)
{
    return (a->two_sided || b->two_sided ? LIGHT_NODE_TWO_SIDED : 0u) |
           (a->emission > 0.0 || b->emission > 0.0 ? 0u : LIGHT_NODE_BEAMS);
}

LightTree light_tree_pack(const LightBounds *lamps, const LightBounds *far, uint leaves)
{
    LightTree tree = {.leaves = leaves, .lamps = (float)lamps->intensity, .far = (float)far->intensity};
    if (!(lamps->intensity > 0.0))
        return tree;
    tree.center = box_center(&lamps->box);
    tree.radius = (float)(RADIUS_MARGIN * box_reach(&lamps->box, tree.center));
    tree.cone = cone_pack(lamps->normals);
    tree.axis = direction_pack(lamps->normals.axis);
    tree.flags = flags_of(lamps, lamps);
    return tree;
}

static LightNode node_of(uint left, ChildBits first, ChildBits second, uint ratio)
{
    return (LightNode){.left = left,
                       .xy = {first.xy | (ratio >> 8) << 24, second.xy | (ratio & 0xffu) << 24},
                       .z_size = {first.z_size, second.z_size},
                       .axes = first.axis | second.axis << 16};
}

LightNode light_node_pack(const LightBounds *left, const LightBounds *right, uint lower, LightSphere sphere)
{
    bool even = left->infinite || light_bounds_alike(left, right);
    uint flags = flags_of(left, right) | (even ? LIGHT_NODE_EVEN : 0u);
    return node_of(lower | flags, child_pack(left, sphere), child_pack(right, sphere),
                   ratio_pack(left->intensity, right->intensity));
}

LightNode light_node_pack_far(uint lamps)
{
    return node_of(lamps | LIGHT_NODE_FAR, WHOLE, WHOLE, 0u);
}
