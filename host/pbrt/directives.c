#include "pbrt/directives.h"

#include "base/log.h"
#include "pbrt/errors.h"
#include "pbrt/parser.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/transforms.h"

#include <string.h>

/* Where a directive is allowed. */
enum { ANYWHERE, BEFORE_WORLD, IN_WORLD };

/* A directive is either its name with fixed arguments (`plain`), or its name, a string and parameters (`named`). */
typedef struct Directive {
    const char *name;
    int where;
    bool (*plain)(PbrtImport *im);
    bool (*named)(PbrtImport *im, const char *kind);
} Directive;

static bool directive_reverse_orientation(PbrtImport *im)
{
    im->state.reverse_orientation = !im->state.reverse_orientation;
    return true;
}

static bool directive_attribute_begin(PbrtImport *im)
{
    return state_push(im, "AttributeBegin");
}

static bool directive_attribute_end(PbrtImport *im)
{
    return state_pop(im, "AttributeBegin", "AttributeEnd");
}

/* pbrt-v4 treats them as AttributeBegin and AttributeEnd. */
static bool directive_transform_begin(PbrtImport *im)
{
    if (!im->warned_transform_begin)
        log_message_at(LOG_WARNING, im->place,
                       "TransformBegin is deprecated and saves all attributes, as "
                       "AttributeBegin does");
    im->warned_transform_begin = true;
    return state_push(im, "AttributeBegin");
}

static bool directive_transform_end(PbrtImport *im)
{
    return state_pop(im, "AttributeBegin", "TransformEnd");
}

static bool directive_attribute(PbrtImport *im)
{
    const char *target;
    SourcePlace place;
    return parser_string(im, "the target of the attributes", &target, &place) && parser_params(im) &&
           state_attribute(im, target, place);
}

static bool directive_color_space(PbrtImport *im)
{
    static const char *const KNOWN[] = {"srgb", "aces2065-1", "rec2020", "dci-p3"};
    const char *name;
    SourcePlace place;
    if (!parser_string(im, "the name of a colour space", &name, &place))
        return false;
    if (strcmp(name, "srgb") == 0)
        return true;
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; ++i)
        if (strcmp(name, KNOWN[i]) == 0)
            return import_unsupported(im, place, "a colour space other than srgb", "its numbers are read as srgb",
                                      "convert the scene's colours to srgb");
    return import_unknown(im, place, "colour space", name, KNOWN, sizeof KNOWN / sizeof *KNOWN);
}

static bool directive_world_begin(PbrtImport *im)
{
    Matrix world[2] = {matrix_identity(), matrix_identity()};
    im->in_world = true; /* even after an error: what follows belongs to the world */
    if (!import_settings_finish(im) || !state_coordinate_system(im, "world", world))
        return false;
    memcpy(im->state.ctm, world, sizeof world);
    im->state.active_transforms = 3;
    return true;
}

static bool directive_medium_interface(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    Token token;
    uint inside, outside;
    if (!parser_string(im, "the name of a medium", &name, &place) || !medium_number(im, name, place, &inside) ||
        !parser_next(im, &token))
        return false;
    parser_put_back(im, &token);
    outside = inside; /* as in pbrt, a single name is for both sides */
    if (token.kind == TOKEN_STRING &&
        (!parser_string(im, "the name of a medium", &name, &place) || !medium_number(im, name, place, &outside)))
        return false;
    im->state.inside = inside;
    im->state.outside = outside;
    return true;
}

static bool directive_named_material(PbrtImport *im)
{
    const char *name;
    if (!parser_string(im, "the name of a material", &name, &im->state.material_place))
        return false;
    im->state.material_name = arena_text(&im->arena, name, strlen(name), im->error);
    return im->state.material_name != NULL;
}

static bool directive_make_named_material(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    return parser_string(im, "the name of a material", &name, &place) && parser_params(im) &&
           import_named_material(im, name, place);
}

static bool directive_texture(PbrtImport *im)
{
    const char *name, *type, *kind;
    SourcePlace place;
    return parser_string(im, "the name of a texture", &name, &place) &&
           parser_string(im, "\"float\" or \"spectrum\"", &type, NULL) &&
           parser_string(im, "the kind of texture", &kind, NULL) && parser_params(im) &&
           import_use(im, "Texture", kind) && import_texture(im, name, place, type, kind);
}

static bool directive_object_begin(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    return parser_string(im, "the name of an object", &name, &place) && import_object_begin(im, name, place);
}

static bool directive_object_instance(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    return parser_string(im, "the name of an object", &name, &place) && import_object_instance(im, name, place);
}

static bool directive_option(PbrtImport *im)
{
    const char *name;
    Token value;
    return parser_string(im, "the name of an option", &name, NULL) && parser_next(im, &value) &&
           import_option(im, name, &value);
}

static bool directive_include(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    return parser_string(im, "the name of a file", &name, &place) && parser_open_file(im, name, place, false);
}

/* An imported file has a graphics state of its own, but the names that it defines stay known afterwards. */
static bool directive_import(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    if (!parser_string(im, "the name of a file", &name, &place) || !state_push(im, "Import"))
        return false;
    if (parser_open_file(im, name, place, true))
        return true;
    --im->saved.count;
    return false;
}

static const Directive DIRECTIVES[] = {
    {"Accelerator", BEFORE_WORLD, NULL, import_accelerator},
    {"ActiveTransform", ANYWHERE, directive_active_transform, NULL},
    {"AreaLightSource", IN_WORLD, NULL, state_area_light},
    {"Attribute", ANYWHERE, directive_attribute, NULL},
    {"AttributeBegin", IN_WORLD, directive_attribute_begin, NULL},
    {"AttributeEnd", IN_WORLD, directive_attribute_end, NULL},
    {"Camera", BEFORE_WORLD, NULL, import_camera},
    {"ColorSpace", ANYWHERE, directive_color_space, NULL},
    {"ConcatTransform", ANYWHERE, directive_concat_transform, NULL},
    {"CoordSysTransform", ANYWHERE, directive_coord_sys_transform, NULL},
    {"CoordinateSystem", ANYWHERE, directive_coordinate_system, NULL},
    {"Film", BEFORE_WORLD, NULL, import_film},
    {"Identity", ANYWHERE, directive_identity, NULL},
    {"Import", IN_WORLD, directive_import, NULL},
    {"Include", ANYWHERE, directive_include, NULL},
    {"Integrator", BEFORE_WORLD, NULL, import_integrator},
    {"LightSource", IN_WORLD, NULL, import_light},
    {"LookAt", ANYWHERE, directive_look_at, NULL},
    {"MakeNamedMaterial", IN_WORLD, directive_make_named_material, NULL},
    {"MakeNamedMedium", ANYWHERE, NULL, import_named_medium},
    {"Material", IN_WORLD, NULL, import_material},
    {"MediumInterface", ANYWHERE, directive_medium_interface, NULL},
    {"NamedMaterial", IN_WORLD, directive_named_material, NULL},
    {"ObjectBegin", IN_WORLD, directive_object_begin, NULL},
    {"ObjectEnd", IN_WORLD, import_object_end, NULL},
    {"ObjectInstance", IN_WORLD, directive_object_instance, NULL},
    {"Option", ANYWHERE, directive_option, NULL},
    {"PixelFilter", BEFORE_WORLD, NULL, import_filter},
    {"ReverseOrientation", IN_WORLD, directive_reverse_orientation, NULL},
    {"Rotate", ANYWHERE, directive_rotate, NULL},
    {"Sampler", BEFORE_WORLD, NULL, import_sampler},
    {"Scale", ANYWHERE, directive_scale, NULL},
    {"Shape", IN_WORLD, NULL, import_shape},
    {"Texture", IN_WORLD, directive_texture, NULL},
    {"Transform", ANYWHERE, directive_transform, NULL},
    {"TransformBegin", IN_WORLD, directive_transform_begin, NULL},
    {"TransformEnd", IN_WORLD, directive_transform_end, NULL},
    {"TransformTimes", BEFORE_WORLD, directive_transform_times, NULL},
    {"Translate", ANYWHERE, directive_translate, NULL},
    {"WorldBegin", BEFORE_WORLD, directive_world_begin, NULL},
};
#define DIRECTIVE_COUNT (sizeof DIRECTIVES / sizeof *DIRECTIVES)

static bool directive_unknown(PbrtImport *im, const Token *token)
{
    const char *names[DIRECTIVE_COUNT];
    if (token->kind != TOKEN_WORD)
        return token_unexpected(token, "a directive", im->error);
    if (token_is(token, "WorldEnd")) {
        error_at(im->error, token->place, "WorldEnd belongs to pbrt-v3");
        return error_fix(im->error, "delete it");
    }
    for (size_t i = 0; i < DIRECTIVE_COUNT; ++i)
        names[i] = DIRECTIVES[i].name;
    Token shown = *token;
    shown.length = token->length < 60 ? token->length : 60;
    const char *name = token_text(&shown, &im->params.texts, im->error);
    return name ? import_unknown(im, token->place, "directive", name, names, DIRECTIVE_COUNT) : false;
}

static bool directive_run(PbrtImport *im, const Directive *directive)
{
    bool misplaced = directive->where == (im->in_world ? BEFORE_WORLD : IN_WORLD);
    if (misplaced && im->errors.world_order)
        errors_missing(im);
    im->errors.world_order = im->errors.world_order || misplaced;
    if (directive->plain == directive_world_begin && im->in_world) {
        error_at(im->error, im->place, "this is a second WorldBegin");
        return error_fix(im->error, "delete it: a file holds one scene");
    }
    if (misplaced && im->in_world) {
        error_at(im->error, im->place, "%s must stand before WorldBegin", directive->name);
        return error_fix(im->error, "move it up: WorldBegin ends the options, camera and film");
    }
    if (misplaced) {
        error_at(im->error, im->place, "%s must stand after WorldBegin", directive->name);
        return error_fix(im->error, "move it down, or add WorldBegin above it");
    }
    if (directive->plain)
        return directive->plain(im);
    const char *kind;
    bool names_kind = directive->named != import_named_medium; /* whose type is a parameter */
    return parser_string(im, "a quoted name", &kind, NULL) && parser_params(im) &&
           (!names_kind || import_use(im, directive->name, kind)) && directive->named(im, kind);
}

static const Directive *directive_find(const Token *token)
{
    for (size_t i = 0; i < DIRECTIVE_COUNT; ++i)
        if (token_is(token, DIRECTIVES[i].name))
            return &DIRECTIVES[i];
    return NULL;
}

/* Whether later directives may depend on this one. */
static bool directive_defines(const Directive *directive)
{
    static const char *const NAMES[] = {"AttributeBegin", "CoordinateSystem",  "Import",
                                        "Include",        "MakeNamedMaterial", "MakeNamedMedium",
                                        "ObjectBegin",    "Texture",           "TransformBegin"};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; ++i)
        if (strcmp(directive->name, NAMES[i]) == 0)
            return true;
    return false;
}

/* Skips tokens up to the next directive or the end of a file. */
static bool directive_skip(PbrtImport *im)
{
    Token token;
    do {
        if (!parser_next(im, &token)) {
            errors_note(im, false);
            return false;
        }
    } while (token.kind != TOKEN_END && !directive_find(&token));
    parser_put_back(im, &token);
    return true;
}

/* Reads a directive; false if reading must end. */
static bool directive_read(PbrtImport *im, const Token *token)
{
    const Directive *directive = directive_find(token);
    param_buffer_clear(&im->params);
    im->place = token->place;
    if (im->options.needs)
        needs_directive(im->options.needs);
    bool good = directive ? directive_run(im, directive) : directive_unknown(im, token);
    if (im->options.needs)
        needs_warned(im->options.needs, im->place);
    if (good)
        return true;
    return errors_note(im, !directive || directive_defines(directive) || im->errors.world_order) && directive_skip(im);
}

/* Handles the end of an imported file, which ends its scope, or of the scene. */
static bool file_end(PbrtImport *im)
{
    const SourceFile *file = &im->files[im->file_count - 1];
    size_t open = im->saved.count - file->nesting;
    if (open > 0) {
        const StateSave *save = &ARRAY_AT(&im->saved, StateSave, im->saved.count - 1);
        error_at(im->error, save->place, "%s has no matching end", save->opened_by);
        error_fix(im->error, "add the missing end, or delete this line");
        if (!errors_note(im, false))
            return false;
        im->saved.count = file->nesting;
    }
    if (!file->is_import)
        return true;
    parser_close(im);
    return state_pop(im, "Import", "the end of the file");
}

static bool world_missing(PbrtImport *im)
{
    error_at(im->error, im->place, "the file ends before WorldBegin");
    return error_fix(im->error, "give the scene file itself, or add WorldBegin after the camera and the film");
}

bool directives_read(PbrtImport *im)
{
    for (;;) {
        Token token;
        if (!parser_next(im, &token)) {
            errors_note(im, false);
            return false;
        }
        if (token.kind != TOKEN_END) {
            if (!directive_read(im, &token))
                return false;
            continue;
        }
        bool last = im->file_count == 1;
        im->place = token.place;
        if (!file_end(im))
            return false;
        if (last)
            return im->in_world || im->errors.count > 0 || (world_missing(im) || errors_note(im, false));
    }
}
