#include "scene/light_guide_setup.h"

#include "geometry/box.h"
#include "layout/distribution.h"
#include "math/warp.h"
#include "scene/portal_setup.h"

/* A light guide. The primitives of an emissive shape form one: the mean of their boxes' centres, weighted by their
 * probabilities as starts of light subpaths. */
typedef struct LightGuide {
    double place[3];
    double near; /* 1 for a position, 0 for a direction */
    double power; /* Guide.lights_power; by select_pdf, which for lights at infinity is not in proportion to power */
} LightGuide;

/* Inserts the guide into the list of the strongest ones, in descending order. */
static void guide_add(Scene *scene, const LightGuide *added)
{
    FrameParams *frame = &scene->frame;
    Guide *guide = &scene->guide;
    uint place = frame->scene.guide_count;
    float power = (float)added->power;
    while (place > 0 && guide->lights_power[place - 1] < power)
        --place;
    if (!(power > 0.0f) || place == LIGHT_GUIDES_MAX)
        return;
    frame->scene.guide_count += frame->scene.guide_count < LIGHT_GUIDES_MAX;
    for (uint i = frame->scene.guide_count - 1; i > place; --i) {
        guide->lights[i] = guide->lights[i - 1];
        guide->lights_near[i] = guide->lights_near[i - 1];
        guide->lights_power[i] = guide->lights_power[i - 1];
    }
    guide->lights[place] = vec3((float)added->place[0], (float)added->place[1], (float)added->place[2]);
    guide->lights_near[place] = (float)added->near;
    guide->lights_power[place] = power;
}

/* Makes a light guide of the lights that belong to the same shape as light `first`. Returns the first light after
 * them. */
static size_t shape_guide(const Scene *scene, const SceneView *view, size_t first, LightGuide *guide)
{
    uint shape = view->primitives[view->lights[first].primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK;
    double sum[3] = {0.0, 0.0, 0.0};
    size_t i = first;
    *guide = (LightGuide){.near = 1.0};
    for (; i < scene->lights.count && light_kind(&view->lights[i]) == LIGHT_AREA; ++i) {
        uint primitive = view->lights[i].primitive;
        double power = (double)view->lights[i].select_pdf;
        if ((view->primitives[primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK) != shape)
            break;
        Box box = primitive_box(view, primitive);
        for (int k = 0; k < 3; ++k)
            sum[k] += power * 0.5 * ((double)box.low[k] + (double)box.high[k]);
        guide->power += power;
    }
    for (int k = 0; k < 3 && guide->power > 0.0; ++k)
        guide->place[k] = sum[k] / guide->power;
    return i;
}

/* Makes a light guide of the brightest texel of an environment. radius: of the bounding sphere, by whose
 * disk the power is that at infinity, of which select_pdf is the light's part (scene/far_lights.h). */
static LightGuide environment_guide(const SceneView *view, const Light *light, double radius)
{
    const LightDetail *detail = light_detail(view, light);
    Distribution2D d = view->distributions2d[detail->distribution];
    bool equirectangular = (light->flags & LIGHT_EQUIRECTANGULAR) != 0;
    double most = -1.0;
    Vec2 uv = vec2(0.5f, 0.5f);
    for (uint y = 0; y < d.height; ++y) {
        double row =
            equirectangular ? sin(M_PI * ((double)y + 0.5) / d.height) : 1.0; /* relative solid angle of its cells */
        for (uint x = 0; x < d.width; ++x) {
            double density = (double)distribution2d_cell_pdf(view->lookup, d, x, y) / row;
            if (!(density > most))
                continue;
            most = density;
            uv = vec2(((float)x + 0.5f) / (float)d.width, ((float)y + 0.5f) / (float)d.height);
        }
    }
    Vec3 w = vec3_normalize(affine_vector(detail->world_from_light,
                                          equirectangular ? equirectangular_to_sphere(uv) : octahedral_to_sphere(uv)));
    return (LightGuide){.place = {(double)w.x, (double)w.y, (double)w.z},
                        .power = (double)light->select_pdf / (4.0 * radius * radius)};
}

/* Makes a light guide of the middle of a portal. */
static LightGuide portal_guide(const Portal *portal, const Light *light)
{
    Vec3 first = portal_corner(portal, 0), last = portal_corner(portal, 2);
    return (LightGuide){.place = {0.5 * ((double)first.x + (double)last.x), 0.5 * ((double)first.y + (double)last.y),
                                  0.5 * ((double)first.z + (double)last.z)},
                        .near = 1.0,
                        .power = (double)light->select_pdf};
}

void light_guide_setup(Scene *scene)
{
    SceneView view = {.positions = scene->positions.data,
                      .primitives = scene->primitives.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .curves = scene->curves.data,
                      .lights = scene->lights.data,
                      .light_details = scene->light_details.data,
                      .distributions2d = scene->distributions2d.data,
                      .lookup = scene->lookup.data};
    double radius = scene->frame.scene.world_radius > 0.0f ? (double)scene->frame.scene.world_radius : 1.0;
    scene->frame.scene.guide_count = 0;
    for (size_t i = 0, next; i < scene->lights.count; i = next) {
        const Light *light = &view.lights[i];
        LightGuide guide = {.power = 0.0};
        next = i + 1;
        if ((light->flags & LIGHT_INVISIBLE) != 0) /* no walk hits it */
            continue;
        uint kind = light_kind(light);
        if (kind == LIGHT_AREA)
            next = shape_guide(scene, &view, i, &guide);
        else if (kind == LIGHT_INFINITE_IMAGE && light->select_pdf > 0.0f)
            guide = environment_guide(&view, light, radius);
        else if (kind == LIGHT_PORTAL)
            guide = portal_guide(&ARRAY_AT(&scene->portals, Portal, light_detail(&view, light)->portal), light);
        guide_add(scene, &guide);
    }
}
