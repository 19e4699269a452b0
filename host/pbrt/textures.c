/* Texture directives: expressions are compiled to postfix programs, with constants folded. */
#include "base/log.h"
#include "base/path_name.h"
#include "pbrt/errors.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "pbrt/texture_builder.h"
#include "pbrt/values.h"

#include <string.h>

void builder_ops(Builder *b, const TextureOp *ops, uint count)
{
    if (b->list->failed)
        return;
    if (count > TEXTURE_OPS_MAX - b->count) {
        error_at(b->im->error, b->im->place, "the texture has more than %d operations", TEXTURE_OPS_MAX);
        error_fix(b->im->error, "bake it into an imagemap");
        b->list->failed = true;
        return;
    }
    memcpy(b->ops + b->count, ops, count * sizeof *ops);
    b->count += count;
}

void builder_constant(Builder *b, Vec3 value)
{
    TextureOp op = {.code = TEXTURE_CONSTANT, .value = value};
    builder_ops(b, &op, 1);
}

static void code_add(Builder *b, uint code)
{
    TextureOp op = {.code = code};
    builder_ops(b, &op, 1);
}

uint builder_operand(Builder *b, const char *name, bool spectrum, float fallback)
{
    uint first = b->count;
    unsigned constants = spectrum ? PARAM_COLORS : PARAM_BIT(PARAM_FLOAT);
    const Param *param = param_find(b->list, name, constants | PARAM_BIT(PARAM_TEXTURE));
    if (param && param->type == PARAM_TEXTURE) {
        uint texture = value_texture_index(b->im, b->list, param, spectrum);
        if (texture != NONE) {
            const ImportTexture *found = &ARRAY_AT(&b->im->textures, ImportTexture, texture);
            builder_ops(b, found->ops, found->count);
        }
        return first;
    }
    float rgb[3] = {fallback, fallback, fallback};
    if (spectrum)
        value_color(b->im, b->list, name, COLOR_REFLECTANCE, rgb);
    else
        rgb[0] = rgb[1] = rgb[2] = param_float(b->list, name, fallback);
    builder_constant(b, vec3(rgb[0], rgb[1], rgb[2]));
    return first;
}

/* Whether the ops from `first` to `end` are a single constant. */
static bool is_constant(const Builder *b, uint first, uint end)
{
    return end == first + 1 && b->ops[first].code == TEXTURE_CONSTANT;
}

static void constant_read(Builder *b)
{
    builder_operand(b, "value", b->spectrum, 1.0f);
}

static void ops_drop(Builder *b, uint first, uint count)
{
    memmove(b->ops + first, b->ops + first + count, (b->count - first - count) * sizeof *b->ops);
    b->count -= count;
}

static bool is_image(const Builder *b, uint first, uint end)
{
    return end == first + 1 && (b->ops[first].code == TEXTURE_IMAGE || b->ops[first].code == TEXTURE_IMAGE_FLOAT);
}

/* tex * scale. A constant factor of an image is folded into the image's own scale, which applies before inversion, as
 * in pbrt. */
static void scale_read(Builder *b)
{
    uint tex = builder_operand(b, "tex", b->spectrum, 1.0f);
    uint scale = builder_operand(b, "scale", false, 1.0f), end = b->count;
    if (b->list->failed)
        return;
    bool tex_constant = is_constant(b, tex, scale), scale_constant = is_constant(b, scale, end);
    if (tex_constant && scale_constant) {
        b->ops[tex].value = vec3_mul(b->ops[tex].value, b->ops[scale].value);
        ops_drop(b, scale, 1);
    } else if (scale_constant && is_image(b, tex, scale)) {
        b->ops[tex].scale *= b->ops[scale].value.x;
        ops_drop(b, scale, 1);
    } else if (tex_constant && is_image(b, scale, end) && !b->spectrum) {
        b->ops[scale].scale *= b->ops[tex].value.x;
        ops_drop(b, tex, 1);
    } else if (scale_constant && b->ops[scale].value.x == 1.0f) {
        ops_drop(b, scale, 1);
    } else {
        code_add(b, TEXTURE_SCALE);
    }
}

/* (1 - amount) tex1 + amount tex2 */
static void mix_read(Builder *b)
{
    uint amount = builder_operand(b, "amount", false, 0.5f);
    uint tex1 = builder_operand(b, "tex1", b->spectrum, 0.0f);
    uint tex2 = builder_operand(b, "tex2", b->spectrum, 1.0f), end = b->count;
    if (b->list->failed)
        return;
    if (!is_constant(b, amount, tex1) || !is_constant(b, tex1, tex2) || !is_constant(b, tex2, end)) {
        code_add(b, TEXTURE_MIX);
        return;
    }
    b->ops[amount].value = vec3_lerp(b->ops[tex1].value, b->ops[tex2].value, b->ops[amount].value.x);
    ops_drop(b, tex1, 2);
}

void builder_space(Builder *b, TextureOp *op)
{
    Matrix ctm, inverse;
    if (b->list->failed || !import_ctm_inverse(b->im, b->im->place, false, &ctm, &inverse)) {
        b->list->failed = true;
        return;
    }
    op->texture_from_world = matrix_affine(inverse.m);
}

static void planar_read(Builder *b, TextureOp *op)
{
    float v1[3] = {1.0f, 0.0f, 0.0f}, v2[3] = {0.0f, 1.0f, 0.0f};
    param_vector(b->list, "v1", PARAM_VECTOR3, v1);
    param_vector(b->list, "v2", PARAM_VECTOR3, v2);
    memcpy(op->uv_map, v1, sizeof v1);
    op->uv_map[3] = param_float(b->list, "udelta", 0.0f);
    memcpy(op->uv_map + 4, v2, sizeof v2);
    op->uv_map[7] = param_float(b->list, "vdelta", 0.0f);
    op->mapping = MAPPING_PLANAR;
    builder_space(b, op);
}

void builder_mapping(Builder *b, TextureOp *op)
{
    static const char *const KNOWN[] = {"uv", "planar", "spherical", "cylindrical"};
    const char *mapping = param_string(b->list, "mapping", "uv");
    if (strcmp(mapping, "uv") == 0) {
        op->mapping = MAPPING_UV;
        op->uv_map[0] = param_float(b->list, "uscale", 1.0f);
        op->uv_map[1] = param_float(b->list, "vscale", 1.0f);
        op->uv_map[2] = param_float(b->list, "udelta", 0.0f);
        op->uv_map[3] = param_float(b->list, "vdelta", 0.0f);
    } else if (strcmp(mapping, "planar") == 0) {
        planar_read(b, op);
    } else if (strcmp(mapping, "spherical") == 0 || strcmp(mapping, "cylindrical") == 0) {
        op->mapping = mapping[0] == 's' ? MAPPING_SPHERICAL : MAPPING_CYLINDRICAL;
        builder_space(b, op);
    } else if (!b->list->failed) {
        b->list->failed = !import_unknown(b->im, param_place(b->list, "mapping"), "mapping", mapping, KNOWN, 4);
    }
}

static void checkerboard_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_CHECKERBOARD};
    int dimension = param_integer(b->list, "dimension", 2);
    builder_operand(b, "tex1", b->spectrum, 1.0f);
    builder_operand(b, "tex2", b->spectrum, 0.0f);
    if (dimension == 2) {
        builder_mapping(b, &op);
    } else if (dimension == 3) {
        op.mapping = MAPPING_3D;
        builder_space(b, &op);
    } else {
        param_error(b->list, "dimension", "the dimension of a checkerboard is 2 or 3");
    }
    builder_ops(b, &op, 1);
}

static uint choice_read(Builder *b, const char *name, const char *fallback, const char *const *known, size_t count)
{
    const char *value = param_string(b->list, name, fallback);
    for (size_t i = 0; i < count; ++i)
        if (strcmp(value, known[i]) == 0)
            return (uint)i;
    if (!b->list->failed)
        b->list->failed = !import_unknown(b->im, param_place(b->list, name), name, value, known, count);
    return 0;
}

/* As in pbrt, PNG is sRGB and everything else linear, unless "encoding" is given. */
static void image_options_read(Builder *b, const char *file, TextureImageOptions *options)
{
    static const char *const WRAPS[] = {"repeat", "black", "clamp", "octahedralsphere"};
    static const char *const FILTERS[] = {"bilinear", "point", "trilinear", "ewa", "EWA"};
    param_float(b->list, "maxanisotropy", 8.0f);
    uint filter = choice_read(b, "filter", "bilinear", FILTERS, 5);
    const char *encoding = param_string(b->list, "encoding", path_ends(file, ".png") ? "sRGB" : "linear");
    options->wrap = choice_read(b, "wrap", "repeat", WRAPS, 4);
    options->filter = filter == 1 ? FILTER_POINT : FILTER_BILINEAR;
    if (filter > 1)
        log_message_at(LOG_INFO, param_place(b->list, "filter"), "the texture is filtered bilinearly");
    if (!texture_encoding_parse(encoding, options) && !b->list->failed) {
        param_error(b->list, "encoding", "unknown encoding \"%s\"", encoding);
        error_fix(b->list->error, "use sRGB, linear or gamma N");
    }
}

static void imagemap_read(Builder *b)
{
    TextureImageOptions options = {.gamma = 1.0f};
    TextureOp op = {.code = b->spectrum ? TEXTURE_IMAGE : TEXTURE_IMAGE_FLOAT};
    const char *file = param_string(b->list, "filename", "");
    if (!*file)
        param_error(b->list, "filename", "imagemap lacks \"string filename\"");
    builder_mapping(b, &op);
    image_options_read(b, file, &options);
    op.scale = param_float(b->list, "scale", 1.0f);
    op.invert = param_bool(b->list, "invert", false);
    const char *path = b->list->failed ? NULL : import_path(b->im, file);
    if (!path || !value_image(b->im, param_place(b->list, "filename"), path, &options, "texture", &op.index))
        b->list->failed = true;
    builder_ops(b, &op, 1);
}

#define TEXTURE_OF_FLOATS 1u
#define TEXTURE_OF_SPECTRA 2u

static const struct TextureKind {
    const char *kind;
    void (*read)(Builder *b);
    unsigned types; /* TEXTURE_OF_* */
} KINDS[] = {{"constant", constant_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"scale", scale_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"mix", mix_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"imagemap", imagemap_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"checkerboard", checkerboard_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"dots", texture_dots_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"directionmix", texture_direction_mix_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"bilerp", texture_bilerp_read, TEXTURE_OF_FLOATS | TEXTURE_OF_SPECTRA},
             {"fbm", texture_fbm_read, TEXTURE_OF_FLOATS},
             {"wrinkled", texture_wrinkled_read, TEXTURE_OF_FLOATS},
             {"windy", texture_windy_read, TEXTURE_OF_FLOATS},
             {"marble", texture_marble_read, TEXTURE_OF_SPECTRA}};
#define KIND_COUNT (sizeof KINDS / sizeof *KINDS)

static unsigned type_wanted(const Builder *b)
{
    return b->spectrum ? TEXTURE_OF_SPECTRA : TEXTURE_OF_FLOATS;
}

/* There is no texture of this kind and type. Substitutes a constant of about its mean for pbrt's ptex. */
static bool kind_missing(Builder *b, const char *kind)
{
    const char *known[KIND_COUNT];
    size_t count = 0;
    if (strcmp(kind, "ptex") == 0) {
        builder_constant(b, vec3_splat(0.5f));
        return import_unsupported(b->im, b->im->place, "the texture \"ptex\"", "the constant 0.5",
                                  "bake it into an imagemap");
    }
    for (size_t i = 0; i < KIND_COUNT; ++i) {
        if ((KINDS[i].types & type_wanted(b)) != 0) {
            known[count++] = KINDS[i].kind;
        } else if (strcmp(kind, KINDS[i].kind) == 0) {
            const char *type = b->spectrum ? "float" : "spectrum";
            error_at(b->im->error, b->im->place, "there is no %s texture \"%s\"", b->spectrum ? "spectrum" : "float",
                     kind);
            return error_fix(b->im->error, "\"%s\" makes textures of type %s", kind, type);
        }
    }
    return import_unknown(b->im, b->im->place, "texture", kind, known, count);
}

static bool texture_store(Builder *b, const char *name)
{
    PbrtImport *im = b->im;
    TextureOp *ops = arena_alloc(&im->arena, b->count * sizeof *ops, im->error);
    const char *kept = ops ? arena_text(&im->arena, name, strlen(name), im->error) : NULL;
    ImportTexture *texture = kept ? array_grow(&im->textures, 1, im->error) : NULL;
    if (!texture)
        return false;
    memcpy(ops, b->ops, b->count * sizeof *ops);
    *texture = (ImportTexture){.ops = ops, .count = b->count, .program = NONE};
    return name_table_add(b->spectrum ? &im->spectrum_textures : &im->float_textures, kept,
                          (uint)(im->textures.count - 1), im->error);
}

static bool stack_check(Builder *b)
{
    code_add(b, TEXTURE_END);
    if (b->list->failed)
        return false;
    unsigned depth = texture_program_depth(b->ops, b->count--);
    if (depth >= 1 && depth <= TEXTURE_STACK)
        return true;
    error_at(b->im->error, b->im->place, "the texture is nested too deeply: it needs more than %d values at once",
             TEXTURE_STACK);
    return error_fix(b->im->error, "put the deeper texture into tex1, or simplify it");
}

static bool texture_read(Builder *b, const char *name, const char *kind)
{
    for (size_t i = 0; i < KIND_COUNT; ++i)
        if (strcmp(kind, KINDS[i].kind) == 0 && (KINDS[i].types & type_wanted(b)) != 0) {
            KINDS[i].read(b);
            return param_list_finish(b->list, b->im->options.lenient) && stack_check(b) && texture_store(b, name);
        }
    return kind_missing(b, kind) && texture_store(b, name);
}

bool import_texture(PbrtImport *im, const char *name, SourcePlace name_place, const char *type, const char *kind)
{
    static const char *const TYPES[] = {"float", "spectrum"};
    ParamList list;
    Builder builder = {.im = im, .list = &list, .spectrum = strcmp(type, "spectrum") == 0};
    if (!builder.spectrum && strcmp(type, "float") != 0)
        return import_unknown(im, im->place, "type of texture", type, TYPES, 2);
    if (name_table_find(builder.spectrum ? &im->spectrum_textures : &im->float_textures, name) != NONE) {
        error_at(im->error, name_place, "the %s texture \"%s\" is defined twice", type, name);
        return error_fix(im->error, "rename one of the two");
    }
    import_list(im, &list, kind, ATTRIBUTE_TEXTURE);
    bool good = texture_read(&builder, name, kind);
    param_list_destroy(&list);
    return good;
}
