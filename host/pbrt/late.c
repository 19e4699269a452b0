#include "pbrt/late.h"

#include "pbrt/errors.h"
#include "pbrt/values.h"

#include <stdlib.h>
#include <string.h>

/* ---- uses -------------------------------------------------------------------------------------------------------- */

static bool material_blank_add(PbrtImport *im, uint *index)
{
    const Material blank = {.kind = MATERIAL_DIFFUSE, .normal_map = NONE, .coat_table = NONE};
    return scene_add_material(im->scene, &blank, index, im->error);
}

bool late_material_use(PbrtImport *im, const char *name, SourcePlace place, uint *material)
{
    uint known = name_table_find(&im->late_names, name);
    if (known == NONE) {
        const char *kept = arena_text(&im->arena, name, strlen(name), im->error);
        LateUse *use = kept ? array_grow(&im->late_uses, 1, im->error) : NULL;
        if (!use || !material_blank_add(im, material))
            return false;
        *use = (LateUse){.name = kept, .place = place, .material = *material};
        return name_table_add(&im->late_names, kept, (uint)im->late_uses.count - 1, im->error);
    }
    *material = ARRAY_AT(&im->late_uses, LateUse, known).material;
    return true;
}

uint late_material_define(PbrtImport *im, const char *name)
{
    uint known = name_table_find(&im->late_names, name);
    if (known == NONE)
        return NONE;
    LateUse *use = &ARRAY_AT(&im->late_uses, LateUse, known);
    use->defined = true;
    return use->material;
}

/* ---- definitions ------------------------------------------------------------------------------------------------- */

static bool param_waits(const PbrtImport *im, const Param *param, bool mix)
{
    bool materials = mix && strcmp(param->name, "materials") == 0 && param->type == PARAM_STRING;
    if (param->type == PARAM_TEXTURE && param->count > 0)
        return name_table_find(&im->float_textures, param->strings[0]) == NONE &&
               name_table_find(&im->spectrum_textures, param->strings[0]) == NONE;
    for (size_t i = 0; materials && i < param->count; ++i)
        if (name_table_find(&im->materials, param->strings[i]) == NONE)
            return true;
    return false;
}

bool late_material_waits(const PbrtImport *im, const ParamList *list, const char *kind)
{
    for (size_t i = 0; i < list->entries.count; ++i)
        if (param_waits(im, ARRAY_AT(&list->entries, ParamEntry, i).param, strcmp(kind, "mix") == 0))
            return true;
    return false;
}

bool late_material_defer(PbrtImport *im, const ParamList *list, const char *kind, SourcePlace place, uint index)
{
    const char *kept = arena_text(&im->arena, kind, strlen(kind), im->error);
    const char *owner = kept ? arena_text(&im->arena, list->owner, strlen(list->owner), im->error) : NULL;
    const ParamSet *params = owner ? param_set_make(&im->params, NULL, &im->arena, im->error) : NULL;
    LateMaterial *late = params ? array_grow(&im->late_materials, 1, im->error) : NULL;
    if (!late)
        return false;
    *late = (LateMaterial){.kind = kept,
                           .owner = owner,
                           .kind_place = place,
                           .place = list->place,
                           .params = params,
                           .attributes = im->state.attributes[ATTRIBUTE_MATERIAL],
                           .material = index};
    return true;
}

/* ---- the end of the scene ---------------------------------------------------------------------------------------- */

static bool late_read(PbrtImport *im, const LateMaterial *late)
{
    ParamList list;
    param_list_init(&list, late->owner, late->place, im->error);
    param_list_add_set(&list, late->params, false);
    param_list_add_set(&list, late->attributes, true);
    param_string(&list, "type", NULL); /* of MakeNamedMaterial */
    bool good = value_material_read(im, &list, late->kind, late->kind_place, late->material);
    param_list_destroy(&list);
    return good;
}

/* A material that mixes another which mixes it would never end. state: of each material, 0: not looked at, 1: being
 * looked at, 2: good. */
static bool mix_is_cyclic(const Scene *scene, unsigned char *state, uint *stack, uint first)
{
    size_t depth = 0;
    stack[depth++] = first;
    while (depth > 0) {
        uint at = stack[depth - 1];
        const Material *m = &ARRAY_AT(&scene->materials, Material, at);
        const uint parts[2] = {m->mix_a, m->mix_b};
        bool pushed = false;
        state[at] = 1;
        for (int i = 0; m->kind == MATERIAL_MIX && i < 2 && !pushed; ++i) {
            if (state[parts[i]] == 1)
                return true;
            pushed = state[parts[i]] == 0;
            if (pushed)
                stack[depth++] = parts[i];
        }
        if (!pushed) {
            state[at] = 2;
            --depth;
        }
    }
    return false;
}

static bool cycles_check(PbrtImport *im)
{
    size_t count = im->scene->materials.count;
    unsigned char *state = calloc(count + 1, 1);
    uint *stack = malloc((count + 1) * sizeof *stack);
    bool good = state && stack;
    if (!good)
        error_memory(im->error, count * (1 + sizeof *stack), "materials");
    for (size_t i = 0; good && i < im->late_materials.count; ++i) {
        const LateMaterial *late = &ARRAY_AT(&im->late_materials, LateMaterial, i);
        if (state[late->material] != 0 || !mix_is_cyclic(im->scene, state, stack, late->material))
            continue;
        error_at(im->error, late->place, "%s is a mix of itself", late->owner);
        error_fix(im->error, "name materials that are not made of it");
        good = false;
    }
    free(state);
    free(stack);
    return good || errors_note(im, false);
}

static bool use_unknown(PbrtImport *im, const LateUse *use)
{
    const char *nearest = name_table_nearest(&im->materials, use->name);
    char known[400];
    name_table_list(&im->materials, known, sizeof known);
    errors_missing(im);
    error_at(im->error, use->place, "unknown material \"%s\"", use->name);
    error_fix(im->error, "%s%s%sdefined: %s", nearest ? "did you mean \"" : "", nearest ? nearest : "",
              nearest ? "\"? " : "", known);
    return errors_note(im, false);
}

bool late_materials_finish(PbrtImport *im)
{
    for (size_t i = 0; i < im->late_materials.count; ++i) {
        const LateMaterial late = ARRAY_AT(&im->late_materials, LateMaterial, i);
        if (!late_read(im, &late) && !errors_note(im, true))
            return false;
    }
    for (size_t i = 0; i < im->late_uses.count; ++i) {
        const LateUse use = ARRAY_AT(&im->late_uses, LateUse, i);
        if (!use.defined && !use_unknown(im, &use))
            return false;
    }
    return im->errors.count > 0 || im->late_materials.count == 0 || cycles_check(im);
}
