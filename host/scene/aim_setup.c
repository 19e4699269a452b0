#include "scene/aim_setup.h"

#include "geometry/box.h"
#include "layout/distribution.h"
#include "math/warp.h"

/* A light's shape has several primitives, which are one aim: the mean of their boxes' centres by what they send. */
typedef struct Aim {
    double place[3];
    double near; /* 1 of a position, 0 of a direction */
    double power; /* as FrameParams.aims_power */
} Aim;

/* Takes its place among the strongest, the strongest first. */
static void aim_add(FrameParams *frame, const Aim *aim)
{
    uint place = frame->aim_count;
    float power = (float)aim->power;
    while (place > 0 && frame->aims_power[place - 1] < power)
        --place;
    if (!(power > 0.0f) || place == AIMS_MAX)
        return;
    frame->aim_count += frame->aim_count < AIMS_MAX;
    for (uint i = frame->aim_count - 1; i > place; --i) {
        frame->aims[i] = frame->aims[i - 1];
        frame->aims_near[i] = frame->aims_near[i - 1];
        frame->aims_power[i] = frame->aims_power[i - 1];
    }
    frame->aims[place] = vec3((float)aim->place[0], (float)aim->place[1], (float)aim->place[2]);
    frame->aims_near[place] = (float)aim->near;
    frame->aims_power[place] = power;
}

/* The lights of the shape that light `first` is of. Returns the first light that is not. */
static size_t shape_aim(const Scene *scene, const SceneView *view, size_t first, Aim *aim)
{
    uint shape = view->primitives[view->lights[first].primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK;
    double sum[3] = {0.0, 0.0, 0.0};
    size_t i = first;
    *aim = (Aim){.near = 1.0};
    for (; i < scene->lights.count && view->lights[i].kind == LIGHT_AREA; ++i) {
        uint primitive = view->lights[i].primitive;
        double power = (double)view->lights[i].select_pdf;
        if ((view->primitives[primitive].shape_and_kind & PRIMITIVE_SHAPE_MASK) != shape)
            break;
        Box box = primitive_box(view, primitive);
        for (int k = 0; k < 3; ++k)
            sum[k] += power * 0.5 * ((double)box.low[k] + (double)box.high[k]);
        aim->power += power;
    }
    for (int k = 0; k < 3 && aim->power > 0.0; ++k)
        aim->place[k] = sum[k] / aim->power;
    return i;
}

/* The brightest place of an environment's image. radius: of the scene; its power has passed a disk of that. */
static Aim environment_aim(const SceneView *view, const Light *light, double radius)
{
    Distribution2D d = view->distributions2d[light->distribution];
    bool equirectangular = (light->flags & LIGHT_EQUIRECTANGULAR) != 0;
    double most = -1.0;
    Vec2 uv = vec2(0.5f, 0.5f);
    for (uint y = 0; y < d.height; ++y) {
        double row =
            equirectangular ? sin(M_PI * ((double)y + 0.5) / d.height) : 1.0; /* its cells' part of the sphere */
        for (uint x = 0; x < d.width; ++x) {
            double density = (double)distribution2d_cell_pdf(view->lookup, d, x, y) / row;
            if (!(density > most))
                continue;
            most = density;
            uv = vec2(((float)x + 0.5f) / (float)d.width, ((float)y + 0.5f) / (float)d.height);
        }
    }
    Vec3 w = vec3_normalize(affine_vector(light->world_from_light,
                                          equirectangular ? equirectangular_to_sphere(uv) : octahedral_to_sphere(uv)));
    return (Aim){.place = {(double)w.x, (double)w.y, (double)w.z},
                 .power = (double)light->select_pdf / (4.0 * radius * radius)};
}

void aim_setup(Scene *scene)
{
    SceneView view = {.positions = scene->positions.data,
                      .primitives = scene->primitives.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .lights = scene->lights.data,
                      .distributions2d = scene->distributions2d.data,
                      .lookup = scene->lookup.data};
    double radius = scene->frame.world_radius > 0.0f ? (double)scene->frame.world_radius : 1.0;
    scene->frame.aim_count = 0;
    for (size_t i = 0, next; i < scene->lights.count; i = next) {
        const Light *light = &view.lights[i];
        Aim aim = {.power = 0.0};
        next = i + 1;
        if (light->kind == LIGHT_AREA)
            next = shape_aim(scene, &view, i, &aim);
        else if (light->kind == LIGHT_INFINITE_IMAGE && light->select_pdf > 0.0f)
            aim = environment_aim(&view, light, radius);
        aim_add(&scene->frame, &aim);
    }
}
