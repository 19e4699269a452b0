/* Shape directives: context of a shape, and quadrics (meshes: mesh.c). */
#include "base/log.h"
#include "geometry/medium.h"
#include "pbrt/curve.h"
#include "pbrt/errors.h"
#include "pbrt/mesh.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/values.h"

#include <stdio.h>
#include <string.h>

#define DEGREES_TO_RADIANS 0.017453292519943295f

/* As pbrt's Sphere::Create: defaults zmin -radius, zmax radius, phimax 360; clamped to the sphere. */
static bool sphere_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    float radius = param_float(list, "radius", 1.0f);
    float a = param_float(list, "zmin", -radius), b = param_float(list, "zmax", radius);
    float phi = param_float(list, "phimax", 360.0f);
    if (!(radius > 0.0f))
        param_error(list, "radius", "the radius of a sphere must be above 0");
    Quadric quadric = {.radius = radius,
                       .z_min = float_clamp(float_min(a, b), -radius, radius),
                       .z_max = float_clamp(float_max(a, b), -radius, radius),
                       .phi_max = float_clamp(phi, 0.0f, 360.0f) * DEGREES_TO_RADIANS};
    return param_list_finish(list, im->options.lenient) && shape_add_quadric(im, context, PRIMITIVE_SPHERE, &quadric);
}

static bool disk_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    float height = param_float(list, "height", 0.0f), radius = param_float(list, "radius", 1.0f);
    float inner = param_float(list, "innerradius", 0.0f), phi = param_float(list, "phimax", 360.0f);
    if (!(radius > 0.0f))
        param_error(list, "radius", "the radius of a disk must be above 0");
    if (!(inner >= 0.0f && inner < radius))
        param_error(list, "innerradius", "the inner radius of a disk must be at least 0 and below the radius");
    Quadric quadric = {.radius = radius,
                       .inner_radius = inner,
                       .z_min = height,
                       .z_max = height,
                       .phi_max = float_clamp(phi, 0.0f, 360.0f) * DEGREES_TO_RADIANS};
    return param_list_finish(list, im->options.lenient) && shape_add_quadric(im, context, PRIMITIVE_DISK, &quadric);
}

/* As pbrt's Cylinder::Create: the heights in either order. */
static bool cylinder_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    float radius = param_float(list, "radius", 1.0f), phi = param_float(list, "phimax", 360.0f);
    float a = param_float(list, "zmin", -1.0f), b = param_float(list, "zmax", 1.0f);
    if (!(radius > 0.0f))
        param_error(list, "radius", "the radius of a cylinder must be above 0");
    if (a == b)
        param_error(list, "zmax", "the cylinder has no height: \"zmin\" and \"zmax\" are equal");
    Quadric quadric = {.radius = radius,
                       .z_min = float_min(a, b),
                       .z_max = float_max(a, b),
                       .phi_max = float_clamp(phi, 0.0f, 360.0f) * DEGREES_TO_RADIANS};
    return param_list_finish(list, im->options.lenient) && shape_add_quadric(im, context, PRIMITIVE_CYLINDER, &quadric);
}

/* Rays ask for alpha before there is a normal. */
static void alpha_check(const PbrtImport *im, ParamList *list, uint program)
{
    for (uint i = program; ARRAY_AT(&im->scene->texture_ops, TextureOp, i).code != TEXTURE_END; ++i)
        if (ARRAY_AT(&im->scene->texture_ops, TextureOp, i).code == TEXTURE_DIRECTION_MIX) {
            param_error(list, "alpha", "alpha cannot depend on the normal (texture \"directionmix\")");
            error_fix(list->error, "use another texture for alpha");
            return;
        }
}

/* Reads the alpha texture, or a constant below 1. */
static bool alpha_read(PbrtImport *im, ParamList *list, uint *alpha)
{
    FloatParam param = {.value = 1.0f, .program = NONE};
    value_float_param(im, list, "alpha", &param);
    *alpha = param.program;
    if (param.program != NONE)
        alpha_check(im, list, param.program);
    if (param.program != NONE || list->failed)
        return !list->failed;
    if (param.value < 0.0f)
        param_error(list, "alpha", "alpha must not be negative");
    else if (param.value < 1.0f)
        *alpha = value_constant_program(im, param.value);
    return !list->failed && (param.value >= 1.0f || *alpha != NONE);
}

/* Reads the emission of a shape; one without material has none, with a warning as in pbrt. */
static bool emission_read(PbrtImport *im, ShapeContext *context)
{
    if (!value_area_emission(im, &context->emission, &context->emits))
        return false;
    if (context->emits && context->interface) {
        log_message_at(LOG_WARNING, im->place, "the area light is ignored: the shape's material is \"interface\"");
        context->emits = false;
    }
    return true;
}

/* As in pbrt, an area light whose alpha is the constant 0 is invisible and has its whole emission. */
static void invisible_light_mark(const PbrtImport *im, ShapeContext *context)
{
    if (!context->emits || context->shape.alpha == NONE)
        return;
    const TextureOp *op = &ARRAY_AT(&im->scene->texture_ops, TextureOp, context->shape.alpha);
    if (op->code == TEXTURE_CONSTANT && op->value.x == 0.0f && op[1].code == TEXTURE_END)
        context->emission.flags |= LIGHT_INVISIBLE;
}

static bool context_make(PbrtImport *im, ParamList *list, ShapeContext *context)
{
    *context = (ShapeContext){.place = im->place};
    if (!import_ctm(im, im->place, &context->ctm) || !value_material(im, &context->shape.material))
        return false;
    if (im->open_object < 0)
        import_matrix_move(im, &context->ctm);
    bool interface = context->shape.material == MATERIAL_INTERFACE;
    context->invisible = interface && im->state.inside == im->state.outside;
    context->interface = interface;
    context->has_inverse = matrix_inverse(&context->ctm, &context->inverse);
    bool reverse = im->state.reverse_orientation;
    context->shape.flags =
        (reverse ? SHAPE_REVERSE : 0u) | (reverse != matrix_swaps_handedness(&context->ctm) ? SHAPE_FLIP_NORMAL : 0u);
    context->shape.flags |= media_bits(im->state.inside, im->state.outside) | (interface ? (uint)SHAPE_INTERFACE : 0u);
    if (interface)
        context->shape.material = NONE;
    context->shape.first_light = NONE;
    if (!alpha_read(im, list, &context->shape.alpha) || !emission_read(im, context))
        return false;
    invisible_light_mark(im, context);
    return true;
}

static bool mesh_kind_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    return mesh_read(im, list->owner, list, context);
}

static const struct ShapeKind {
    const char *name;
    bool (*read)(PbrtImport *im, ParamList *list, const ShapeContext *context);
    bool quadric; /* needs the inverse of the transform */
} KINDS[] = {{"sphere", sphere_read, true},         {"disk", disk_read, true},
             {"cylinder", cylinder_read, true},     {"trianglemesh", mesh_kind_read, false},
             {"plymesh", mesh_kind_read, false},    {"bilinearmesh", mesh_kind_read, false},
             {"loopsubdiv", mesh_kind_read, false}, {"curve", curve_read, false}};
#define KIND_COUNT (sizeof KINDS / sizeof *KINDS)

static bool kind_missing(PbrtImport *im, const char *kind)
{
    const char *known[KIND_COUNT];
    for (size_t i = 0; i < KIND_COUNT; ++i)
        known[i] = KINDS[i].name;
    return import_unknown(im, im->place, "shape", kind, known, KIND_COUNT);
}

static bool shape_read(PbrtImport *im, const char *kind, ParamList *list)
{
    ShapeContext context;
    size_t k = 0;
    while (k < KIND_COUNT && strcmp(kind, KINDS[k].name) != 0)
        ++k;
    if (k == KIND_COUNT)
        return kind_missing(im, kind);
    return context_make(im, list, &context) &&
           (!KINDS[k].quadric || import_inverse(im, im->place, &context.ctm, &context.inverse)) &&
           KINDS[k].read(im, list, &context);
}

bool import_shape(PbrtImport *im, const char *kind)
{
    ParamList list;
    import_list(im, &list, kind, ATTRIBUTE_SHAPE);
    bool good = shape_read(im, kind, &list);
    param_list_destroy(&list);
    return good;
}
