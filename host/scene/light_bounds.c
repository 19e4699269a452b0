#include "scene/light_bounds.h"

#include "light/area.h"
#include "light/delta.h"
#include "scene/portal_setup.h"

#include <math.h>

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

LightBounds light_bounds_empty(void)
{
    return (LightBounds){.box = box_empty(), .normals = NO_CONE};
}

void light_bounds_join(LightBounds *a, const LightBounds *b)
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

static LightBounds area_bounds(const SceneView *view, uint light, double power)
{
    const Light *source = &view->lights[light];
    uint kind = view->primitives[source->primitive].shape_and_kind >> PRIMITIVE_KIND_SHIFT;
    bool two_sided = (source->flags & LIGHT_TWO_SIDED) != 0;
    double facing = area_shown(kind);
    return (LightBounds){.box = primitive_box(view, source->primitive),
                         .normals = area_normals(view, light),
                         .emission = 0.5 * M_PI,
                         .intensity = power * facing / (M_PI * (two_sided ? 2.0 : 1.0)),
                         .two_sided = two_sided};
}

/* The largest luminance of a point light's intensity in any direction. */
static double intensity_most(const SceneView *view, const Light *light)
{
    if (!light_has_intensity_image(light_kind(light)))
        return (double)rgb_luminance(light->emission);
    double most = 0.0;
    TextureImage image = view->images[light_detail(view, light)->image];
    for (uint y = 0; y < image.height; ++y)
        for (uint x = 0; x < image.width; ++x)
            most = fmax(most, (double)rgb_luminance(vec3_mul(light->emission, image_texel(view, &image, x, y))));
    return most;
}

static LightBounds position_bounds(const SceneView *view, const Light *light)
{
    const LightDetail *detail = light_detail(view, light);
    LightBounds bounds = {.box = box_empty(),
                          .normals = {NO_CONE.axis, M_PI},
                          .emission = 0.5 * M_PI,
                          .intensity = intensity_most(view, light)};
    box_add(&bounds.box, detail->position);
    if (light_kind(light) == LIGHT_SPOT || light_kind(light) == LIGHT_PROJECTION) {
        bounds.normals = (Cone){detail->direction, acos((double)detail->cos_total)};
        bounds.emission = 0.0;
    }
    return bounds;
}

/* As of an area light that emits the same flux. */
static LightBounds portal_bounds(const Portal *portal, double power)
{
    LightBounds bounds = {.box = box_empty(),
                          .normals = {vec3_negate(portal->axes.n), 0.0},
                          .emission = 0.5 * M_PI,
                          .intensity = power / M_PI};
    for (int i = 0; i < 4; ++i)
        box_add(&bounds.box, portal_corner(portal, i));
    return bounds;
}

LightBounds light_bounds(const SceneView *view, uint light, double power)
{
    const Light *source = &view->lights[light];
    uint kind = light_kind(source);
    if (kind == LIGHT_AREA)
        return area_bounds(view, light, power);
    if (light_has_position(kind))
        return position_bounds(view, source);
    if (kind == LIGHT_PORTAL)
        return portal_bounds(&view->portals[light_detail(view, source)->portal], power);
    return (LightBounds){.box = box_empty(), .normals = NO_CONE, .intensity = power, .infinite = true};
}

/* ---- comparison -------------------------------------------------------------------------------------------------- */

double box_reach(const Box *box, Vec3 from)
{
    const double x = fmax((double)box->high[0] - (double)from.x, (double)from.x - (double)box->low[0]);
    const double y = fmax((double)box->high[1] - (double)from.y, (double)from.y - (double)box->low[1]);
    const double z = fmax((double)box->high[2] - (double)from.z, (double)from.z - (double)box->low[2]);
    return sqrt(x * x + y * y + z * z);
}

bool light_bounds_alike(const LightBounds *a, const LightBounds *b)
{
    if (a->infinite || b->infinite || a->two_sided != b->two_sided || a->emission != b->emission)
        return false;
    Vec3 a_center = box_center(&a->box), b_center = box_center(&b->box);
    double a_radius = box_reach(&a->box, a_center), b_radius = box_reach(&b->box, b_center), most = 0.01 * a_radius;
    return a_radius > 0.0 && fabs(a_radius - b_radius) <= most &&
           (double)vec3_length(vec3_sub(a_center, b_center)) <= most &&
           fabs(a->normals.angle - b->normals.angle) < 1e-3 &&
           (a->normals.angle >= M_PI || vec3_dot(a->normals.axis, b->normals.axis) > 0.9999f);
}
