#include "pbrt/state.h"

#include "base/log.h"
#include "pbrt/errors.h"

#include <string.h>

void state_init(GraphicsState *state)
{
    memset(state, 0, sizeof *state);
    state->ctm[0] = state->ctm[1] = matrix_identity();
    state->active_transforms = 3;
    state->material = NONE;
}

static bool transform_check(PbrtImport *im)
{
    if (matrix_finite(&im->state.ctm[0]) && matrix_finite(&im->state.ctm[1]))
        return true;
    error_at(im->error, im->place, "the current transform overflows here");
    return error_fix(im->error, "look for Scale, Translate or Transform with huge numbers above");
}

bool state_concat(PbrtImport *im, const Matrix *matrix)
{
    for (unsigned i = 0; i < 2; ++i)
        if (im->state.active_transforms & (1u << i))
            im->state.ctm[i] = matrix_multiply(&im->state.ctm[i], matrix);
    return transform_check(im);
}

bool state_replace(PbrtImport *im, const Matrix *matrix)
{
    for (unsigned i = 0; i < 2; ++i)
        if (im->state.active_transforms & (1u << i))
            im->state.ctm[i] = *matrix;
    return transform_check(im);
}

bool state_push(PbrtImport *im, const char *opened_by)
{
    if (im->saved.count >= IMPORT_NESTING_MAX) {
        error_at(im->error, im->place, "%s is nested more than %d deep", opened_by, IMPORT_NESTING_MAX);
        return error_fix(im->error, "close the scopes with AttributeEnd");
    }
    StateSave *save = array_grow(&im->saved, 1, im->error);
    if (!save)
        return false;
    *save = (StateSave){.state = im->state, .place = im->place, .opened_by = opened_by};
    return true;
}

bool state_pop(PbrtImport *im, const char *opened_by, const char *closed_by)
{
    size_t floor =
        im->file_count > 0 && im->files[im->file_count - 1].is_import ? im->files[im->file_count - 1].nesting : 0;
    if (im->saved.count <= floor) {
        errors_missing(im);
        error_at(im->error, im->place, "%s without %s", closed_by, opened_by);
        return error_fix(im->error, "delete it, or add %s before it", opened_by);
    }
    const StateSave *save = &ARRAY_AT(&im->saved, StateSave, im->saved.count - 1);
    if (strcmp(save->opened_by, opened_by) != 0) {
        errors_missing(im);
        error_at(im->error, im->place, "%s, but the innermost open scope is the %s of line %d", closed_by,
                 save->opened_by, save->place.line);
        return error_fix(im->error, "close that one first");
    }
    im->state = save->state;
    --im->saved.count;
    return true;
}

bool state_coordinate_system(PbrtImport *im, const char *name, const Matrix transforms[2])
{
    uint known = name_table_find(&im->coordinate_systems, name);
    if (known == NONE) {
        if (im->coordinate_systems.entries.count >= IMPORT_COORDINATE_SYSTEMS_MAX) {
            error_at(im->error, im->place, "more than %d coordinate systems", IMPORT_COORDINATE_SYSTEMS_MAX);
            return error_fix(im->error, "reuse a name that is no longer needed");
        }
        known = (uint)(im->coordinate_matrices.count / 2);
        name = arena_text(&im->arena, name, strlen(name), im->error);
        if (!name || !array_grow(&im->coordinate_matrices, 2, im->error) ||
            !name_table_add(&im->coordinate_systems, name, known, im->error))
            return false;
    }
    memcpy(&ARRAY_AT(&im->coordinate_matrices, Matrix, 2 * (size_t)known), transforms, 2 * sizeof *transforms);
    return true;
}

bool state_use_coordinate_system(PbrtImport *im, const char *name, SourcePlace name_place)
{
    uint known = name_table_find(&im->coordinate_systems, name);
    if (known == NONE) {
        char names[400];
        name_table_list(&im->coordinate_systems, names, sizeof names);
        errors_missing(im);
        error_at(im->error, name_place, "unknown coordinate system \"%s\"", name);
        return error_fix(im->error, "define it before this line; defined so far: %s", names);
    }
    memcpy(im->state.ctm, &ARRAY_AT(&im->coordinate_matrices, Matrix, 2 * (size_t)known), sizeof im->state.ctm);
    return true;
}

bool state_attribute(PbrtImport *im, const char *target, SourcePlace target_place)
{
    static const char *const TARGETS[ATTRIBUTE_COUNT] = {"shape", "light", "material", "medium", "texture"};
    for (int i = 0; i < ATTRIBUTE_COUNT; ++i) {
        if (strcmp(target, TARGETS[i]) != 0)
            continue;
        const ParamSet *older = im->state.attributes[i];
        if (im->params.params.count == 0)
            return true;
        if (im->params.params.count + (older ? older->total : 0) > IMPORT_ATTRIBUTES_MAX) {
            error_at(im->error, im->place, "more than %d parameters of Attribute directives are in force",
                     IMPORT_ATTRIBUTES_MAX);
            return error_fix(im->error, "enclose the directives that they are for in AttributeBegin and AttributeEnd");
        }
        im->state.attributes[i] = param_set_make(&im->params, older, &im->arena, im->error);
        return im->state.attributes[i] != NULL;
    }
    return import_unknown(im, target_place, "attribute target", target, TARGETS, ATTRIBUTE_COUNT);
}

bool state_area_light(PbrtImport *im, const char *kind)
{
    AreaLightSource *light = arena_alloc(&im->arena, sizeof *light, im->error);
    const char *name = light ? arena_text(&im->arena, kind, strlen(kind), im->error) : NULL;
    const ParamSet *params = name ? param_set_make(&im->params, NULL, &im->arena, im->error) : NULL;
    if (!params)
        return false;
    *light = (AreaLightSource){
        .kind = name, .place = im->place, .params = params, .attributes = im->state.attributes[ATTRIBUTE_LIGHT]};
    im->state.area_light = light;
    return true;
}

/* ---- the current transform --------------------------------------------------------------------------------------- */

static bool ctm_at_start(PbrtImport *im, SourcePlace place, Matrix *ctm)
{
    *ctm = im->state.ctm[0];
    if (matrix_equal(&im->state.ctm[0], &im->state.ctm[1]))
        return true;
    return import_unsupported(im, place, "motion (a transform that differs between StartTime and EndTime)",
                              "everything stays where it is at StartTime", NULL);
}

static bool is_projective(const Matrix *matrix)
{
    return matrix->m[12] != 0.0 || matrix->m[13] != 0.0 || matrix->m[14] != 0.0;
}

bool import_ctm(PbrtImport *im, SourcePlace place, Matrix *ctm)
{
    if (!ctm_at_start(im, place, ctm))
        return false;
    if (!is_projective(ctm))
        return true;
    error_at(im->error, place, "a projective transform is not supported");
    return error_fix(im->error, "the 4th, 8th and 12th number of every Transform and ConcatTransform before must be 0");
}

void import_matrix_move(const PbrtImport *im, Matrix *matrix)
{
    matrix->m[3] -= (double)im->offset.x;
    matrix->m[7] -= (double)im->offset.y;
    matrix->m[11] -= (double)im->offset.z;
}

bool import_inverse(PbrtImport *im, SourcePlace place, const Matrix *matrix, Matrix *inverse)
{
    if (!matrix_inverse(matrix, inverse)) {
        error_at(im->error, place, "the current transform cannot be inverted");
        return error_fix(im->error, "look for a Scale by 0 or a Transform with linearly dependent rows");
    }
    if (matrix_fits_float(matrix) && matrix_fits_float(inverse))
        return true;
    error_at(im->error, place, "the current transform or its inverse is beyond the range of a float");
    return error_fix(im->error, "look for a Scale or Transform with huge or tiny numbers");
}

/* Leaves out what a projective transform without translation does to points. */
static bool ctm_of_directions(PbrtImport *im, SourcePlace place, Matrix *ctm)
{
    static const double LAST[4] = {0.0, 0.0, 0.0, 1.0};
    if (!ctm_at_start(im, place, ctm))
        return false;
    if (ctm->m[3] != 0.0 || ctm->m[7] != 0.0 || ctm->m[11] != 0.0)
        return import_ctm(im, place, ctm);
    memcpy(ctm->m + 12, LAST, sizeof LAST);
    return true;
}

bool import_ctm_inverse(PbrtImport *im, SourcePlace place, bool directions, Matrix *ctm, Matrix *inverse)
{
    if (!(directions ? ctm_of_directions(im, place, ctm) : import_ctm(im, place, ctm)))
        return false;
    if (im->in_world)
        import_matrix_move(im, ctm);
    return import_inverse(im, place, ctm, inverse);
}
