/* Material, MakeNamedMaterial, and the current material of a shape. */
#include "base/log.h"
#include "pbrt/coats.h"
#include "pbrt/errors.h"
#include "pbrt/hair.h"
#include "pbrt/late.h"
#include "pbrt/readers.h"
#include "pbrt/values.h"

#include <stdio.h>
#include <string.h>

typedef struct MaterialReader {
    PbrtImport *im;
    ParamList *list;
    Material material;
    CoatMedium medium; /* of a coat over a conductor */
} MaterialReader;

static Material material_blank(uint kind)
{
    return (Material){.kind = kind,
                      .color0 = value_color_constant(0.5f),
                      .color1 = value_color_constant(0.0f),
                      .roughness_u = value_float_constant(0.0f),
                      .roughness_v = value_float_constant(0.0f),
                      .amount = value_float_constant(0.5f),
                      .displacement = value_float_constant(0.0f),
                      .base_u = value_float_constant(0.0f),
                      .base_v = value_float_constant(0.0f),
                      .eta = 1.5f,
                      .scale = 1.0f,
                      .normal_map = NONE,
                      .mix_a = NONE,
                      .mix_b = NONE,
                      .coat_table = NONE};
}

static void roughness_check(MaterialReader *r, const char *name, const FloatParam *roughness)
{
    if (roughness->program == NONE && roughness->value < 0.0f)
        param_error(r->list, name, "\"%s\" is negative", name);
}

/* names: roughness, uroughness, vroughness; the latter two default to the first. */
static void roughness_pair_read(MaterialReader *r, const char *const names[3], FloatParam *u, FloatParam *v)
{
    FloatParam both = value_float_constant(0.0f);
    value_float_param(r->im, r->list, names[0], &both);
    *u = *v = both;
    value_float_param(r->im, r->list, names[1], u);
    value_float_param(r->im, r->list, names[2], v);
    roughness_check(r, names[0], &both);
    roughness_check(r, names[1], u);
    roughness_check(r, names[2], v);
    if (param_bool(r->list, "remaproughness", true))
        r->material.flags |= MATERIAL_REMAP_ROUGHNESS;
}

static void roughness_read(MaterialReader *r)
{
    static const char *const NAMES[] = {"roughness", "uroughness", "vroughness"};
    roughness_pair_read(r, NAMES, &r->material.roughness_u, &r->material.roughness_v);
}

/* A normal map overrides displacement, as in pbrt. */
static void relief_read(MaterialReader *r)
{
    Material *m = &r->material;
    const char *file = param_string(r->list, "normalmap", "");
    value_float_param(r->im, r->list, "displacement", &m->displacement);
    m->displacement.value = 0.0f;
    if (!*file || r->list->failed)
        return;
    TextureImageOptions options = {
        .encoding = ENCODING_LINEAR, .gamma = 1.0f, .wrap = WRAP_REPEAT, .filter = FILTER_BILINEAR};
    SourcePlace place = param_place(r->list, "normalmap");
    const char *path = import_path(r->im, file);
    if (!path || !value_image(r->im, place, path, &options, "normal map", &m->normal_map)) {
        r->list->failed = true;
        return;
    }
    if (m->normal_map == NONE) /* images are not read for what a scene needs */
        return;
    uint channels = ARRAY_AT(&r->im->scene->images, TextureImage, m->normal_map).channels;
    if (channels < 3)
        param_error(r->list, "normalmap", "the normal map %s has %u channel instead of 3", path, channels);
    if (m->displacement.program != NONE)
        log_message_at(LOG_INFO, place, "the displacement is ignored: the normal map takes precedence");
    m->displacement.program = NONE;
}

static void diffuse_read(MaterialReader *r)
{
    value_color_param(r->im, r->list, "reflectance", COLOR_REFLECTANCE, &r->material.color0);
}

static void coated_diffuse_read(MaterialReader *r)
{
    diffuse_read(r);
    roughness_read(r);
    r->material.eta = value_eta(r->im, r->list, "eta", 1.5f);
    CoatMedium medium;
    coat_medium_read(r->im, r->list, false, &medium);
    r->material.color1.value.x = medium.thickness;
}

/* Reads eta and k, or reflectance; copper by default. Names differ for the inner layer of a coated conductor. */
static void conductor_colors_read(MaterialReader *r, const char *eta_name, const char *k_name)
{
    Material *m = &r->material;
    float copper[3];
    Error error;
    bool has_reflectance = value_color_param(r->im, r->list, "reflectance", COLOR_REFLECTANCE, &m->color0);
    if (has_reflectance) {
        m->flags |= MATERIAL_CONDUCTOR_REFLECTANCE;
        if (param_find(r->list, eta_name, ~0u) || param_find(r->list, k_name, ~0u))
            param_error(r->list, "reflectance", "a conductor takes either reflectance or eta and k");
        return;
    }
    if (!value_color_param(r->im, r->list, eta_name, COLOR_INDEX, &m->color0) && !r->list->failed &&
        color_named_spectrum("metal-Cu-eta", COLOR_INDEX, copper, &error))
        m->color0.value = vec3(copper[0], copper[1], copper[2]);
    if (!value_color_param(r->im, r->list, k_name, COLOR_INDEX, &m->color1) && !r->list->failed &&
        color_named_spectrum("metal-Cu-k", COLOR_INDEX, copper, &error))
        m->color1.value = vec3(copper[0], copper[1], copper[2]);
}

static void conductor_read(MaterialReader *r)
{
    conductor_colors_read(r, "eta", "k");
    roughness_read(r);
}

static void coated_conductor_read(MaterialReader *r)
{
    static const char *const COAT[] = {"interface.roughness", "interface.uroughness", "interface.vroughness"};
    static const char *const BASE[] = {"conductor.roughness", "conductor.uroughness", "conductor.vroughness"};
    Material *m = &r->material;
    conductor_colors_read(r, "conductor.eta", "conductor.k");
    roughness_pair_read(r, COAT, &m->roughness_u, &m->roughness_v);
    roughness_pair_read(r, BASE, &m->base_u, &m->base_v);
    m->eta = value_eta(r->im, r->list, "interface.eta", 1.5f);
    coat_medium_read(r->im, r->list, true, &r->medium);
}

static void dielectric_read(MaterialReader *r)
{
    r->material.eta = value_eta(r->im, r->list, "eta", 1.5f);
    roughness_read(r);
}

static void thin_dielectric_read(MaterialReader *r)
{
    r->material.eta = value_eta(r->im, r->list, "eta", 1.5f);
}

static void diffuse_transmission_read(MaterialReader *r)
{
    Material *m = &r->material;
    m->color0 = m->color1 = value_color_constant(0.25f);
    value_color_param(r->im, r->list, "reflectance", COLOR_REFLECTANCE, &m->color0);
    value_color_param(r->im, r->list, "transmittance", COLOR_REFLECTANCE, &m->color1);
    m->scale = param_float(r->list, "scale", 1.0f);
    if (m->scale < 0.0f)
        param_error(r->list, "scale", "\"scale\" is negative");
    float most = vec3_max_component(vec3_add(m->color0.value, m->color1.value)) * m->scale;
    if (m->color0.program == NONE && m->color1.program == NONE && most > 1.00001f)
        log_message_at(LOG_WARNING, r->list->place,
                       "reflectance and transmittance add up to more than 1: the material creates energy");
}

static void hair_read(MaterialReader *r)
{
    hair_material_read(r->im, r->list, &r->material);
}

/* Resolves one of the two materials named by a mix. */
static uint mix_part(MaterialReader *r, const Param *param, size_t i)
{
    const char *name = param->strings[i];
    uint material = name_table_find(&r->im->materials, name);
    if (material == NONE) { /* at the end of the scene: all that are defined are known */
        char known[400];
        name_table_list(&r->im->materials, known, sizeof known);
        errors_missing(r->im);
        param_error(r->list, "materials", "unknown material \"%s\"", name);
        error_fix(r->list->error, "defined: %s", known);
    } else if (material == MATERIAL_INTERFACE) {
        param_error(r->list, "materials", "the material \"%s\" is an \"interface\" and cannot be mixed", name);
    }
    return material;
}

static void mix_read(MaterialReader *r)
{
    const Param *param = param_find(r->list, "materials", PARAM_BIT(PARAM_STRING));
    FloatParam *amount = &r->material.amount;
    value_float_param(r->im, r->list, "amount", amount);
    if (amount->program == NONE && !(amount->value >= 0.0f && amount->value <= 1.0f))
        param_error(r->list, "amount", "the amount of a mix must be from 0 to 1");
    if (!param || param->count != 2) {
        param_error(r->list, "materials", "a mix needs \"string materials\" with two names");
        return;
    }
    r->material.mix_a = mix_part(r, param, 0);
    if (!r->list->failed)
        r->material.mix_b = mix_part(r, param, 1);
}

static const struct {
    const char *name;
    uint kind;
    void (*read)(MaterialReader *r);
    bool relief; /* takes normalmap and displacement */
} KINDS[] = {
#define KIND(NAME, name, text, traits)                                                                                 \
    {text, MATERIAL_##NAME, name##_read, MATERIAL_##NAME != MATERIAL_MIX && MATERIAL_##NAME != MATERIAL_HAIR},
    MATERIAL_LIST(KIND)
#undef KIND
};
#define KIND_COUNT (sizeof KINDS / sizeof *KINDS)

/* Substitutes for unsupported materials with --lenient. */
static void diffuse_substitute(MaterialReader *r)
{
    r->material = material_blank(MATERIAL_DIFFUSE);
    diffuse_read(r);
}

static const struct {
    const char *name;
    const char *substitute;
    void (*read)(MaterialReader *r);
} UNSUPPORTED[] = {{"subsurface", "diffuse, with its reflectance or 0.5", diffuse_substitute},
                   {"measured", "diffuse, reflectance 0.5", diffuse_substitute}};

static bool material_unknown(PbrtImport *im, SourcePlace place, const char *kind)
{
    const char *names[KIND_COUNT + 1];
    for (size_t i = 0; i < KIND_COUNT; ++i)
        names[i] = KINDS[i].name;
    names[KIND_COUNT] = "interface";
    return import_unknown(im, place, "material", kind, names, KIND_COUNT + 1);
}

static bool material_read(MaterialReader *r, const char *kind, SourcePlace place)
{
    PbrtImport *im = r->im;
    for (size_t i = 0; i < KIND_COUNT; ++i)
        if (strcmp(kind, KINDS[i].name) == 0) {
            r->material = material_blank(KINDS[i].kind);
            KINDS[i].read(r);
            if (KINDS[i].relief)
                relief_read(r);
            if (r->material.kind == MATERIAL_COATED_CONDUCTOR)
                coat_medium_apply(im, r->list, &r->medium, &r->material);
            return param_list_finish(r->list, im->options.lenient);
        }
    for (size_t i = 0; i < sizeof UNSUPPORTED / sizeof *UNSUPPORTED; ++i)
        if (strcmp(kind, UNSUPPORTED[i].name) == 0) {
            char what[64];
            snprintf(what, sizeof what, "the material \"%s\"", kind);
            if (!import_unsupported(im, place, what, UNSUPPORTED[i].substitute,
                                    "use diffuse, conductor, dielectric, thindielectric, coateddiffuse, "
                                    "coatedconductor, diffusetransmission, hair or mix"))
                return false;
            UNSUPPORTED[i].read(r);
            return !r->list->failed;
        }
    return material_unknown(im, place, kind);
}

bool value_material_read(PbrtImport *im, ParamList *list, const char *kind, SourcePlace place, uint index)
{
    MaterialReader reader = {.im = im, .list = list};
    if (!material_read(&reader, kind, place))
        return false;
    ARRAY_AT(&im->scene->materials, Material, index) = reader.material;
    return true;
}

/* Adds the material described by `list` to the scene, at *index if that is not NONE. */
static bool material_add(PbrtImport *im, ParamList *list, const char *kind, SourcePlace place, uint *index)
{
    const Material blank = material_blank(MATERIAL_DIFFUSE);
    if (strcmp(kind, "interface") == 0 || strcmp(kind, "none") == 0 || !*kind) {
        if (kind[0] != 'i')
            log_message_at(LOG_INFO, place, "the material \"%s\" is an older name of \"interface\"", kind);
        *index = MATERIAL_INTERFACE;
        return true;
    }
    if (*index == NONE && !scene_add_material(im->scene, &blank, index, im->error))
        return false;
    return late_material_waits(im, list, kind) ? late_material_defer(im, list, kind, place, *index)
                                               : value_material_read(im, list, kind, place, *index);
}

bool import_material(PbrtImport *im, const char *kind)
{
    ParamList list;
    char owner[96];
    snprintf(owner, sizeof owner, "the material %s", kind);
    import_list(im, &list, owner, ATTRIBUTE_MATERIAL);
    uint index = NONE;
    bool good = material_add(im, &list, kind, im->place, &index);
    if (good) {
        im->state.material = index;
        im->state.material_name = NULL;
    }
    param_list_destroy(&list);
    return good;
}

static bool named_read(PbrtImport *im, ParamList *list, const char *name, SourcePlace name_place)
{
    const char *kind = param_string(list, "type", NULL);
    if (name_table_find(&im->materials, name) != NONE) {
        error_at(im->error, name_place, "the material \"%s\" is defined twice", name);
        return error_fix(im->error, "rename one of the two");
    }
    if (!kind) {
        param_error(list, "type", "%s lacks \"string type\"", list->owner);
        return error_fix(im->error, "add \"string type\" \"diffuse\" or another kind of material");
    }
    if (!import_use(im, "Material", kind))
        return false;
    const uint used = late_material_define(im, name);
    uint index = used;
    if (!material_add(im, list, kind, param_place(list, "type"), &index))
        return false;
    if (used != NONE && index == MATERIAL_INTERFACE) {
        error_at(im->error, name_place, "the material \"%s\", an \"interface\", is used before it is defined", name);
        return error_fix(im->error, "move this line up, before the first shape that uses the material");
    }
    const char *kept = arena_text(&im->arena, name, strlen(name), im->error);
    return kept && name_table_add(&im->materials, kept, index, im->error);
}

bool import_named_material(PbrtImport *im, const char *name, SourcePlace name_place)
{
    ParamList list;
    char owner[96];
    snprintf(owner, sizeof owner, "the material \"%s\"", name);
    import_list(im, &list, owner, ATTRIBUTE_MATERIAL);
    bool good = named_read(im, &list, name, name_place);
    param_list_destroy(&list);
    return good;
}

static bool default_material(PbrtImport *im, uint *material)
{
    if (im->default_material == NONE) {
        Material diffuse = material_blank(MATERIAL_DIFFUSE);
        if (!scene_add_material(im->scene, &diffuse, &im->default_material, im->error))
            return false;
    }
    *material = im->default_material;
    return true;
}

bool value_material(PbrtImport *im, uint *material)
{
    const GraphicsState *state = &im->state;
    *material = state->material;
    if (!state->material_name)
        return *material != NONE || default_material(im, material);
    *material = name_table_find(&im->materials, state->material_name);
    return *material != NONE || late_material_use(im, state->material_name, state->material_place, material);
}
