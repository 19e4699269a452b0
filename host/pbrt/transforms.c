#include "pbrt/transforms.h"

#include "pbrt/errors.h"
#include "pbrt/parser.h"
#include "pbrt/state.h"

bool directive_identity(PbrtImport *im)
{
    Matrix identity = matrix_identity();
    return state_replace(im, &identity);
}

bool directive_translate(PbrtImport *im)
{
    double v[3];
    if (!parser_floats(im, 3, v))
        return false;
    Matrix m = matrix_translate(v[0], v[1], v[2]);
    return state_concat(im, &m);
}

bool directive_scale(PbrtImport *im)
{
    double v[3];
    if (!parser_floats(im, 3, v))
        return false;
    Matrix m = matrix_scale(v[0], v[1], v[2]);
    return state_concat(im, &m);
}

bool directive_rotate(PbrtImport *im)
{
    double v[4];
    if (!parser_floats(im, 4, v))
        return false;
    if (v[1] == 0.0 && v[2] == 0.0 && v[3] == 0.0) {
        error_at(im->error, im->place, "Rotate has an axis of length 0");
        return error_fix(im->error, "write Rotate DEGREES X Y Z with an axis other than 0 0 0");
    }
    Matrix m = matrix_rotate(v[0], v + 1);
    return state_concat(im, &m);
}

bool directive_look_at(PbrtImport *im)
{
    double v[9];
    Matrix m;
    if (!parser_floats(im, 9, v))
        return false;
    if (!matrix_look_at(v, v + 3, v + 6, &m)) {
        error_at(im->error, im->place, "LookAt gives no direction: the two points coincide, or up is along the view");
        return error_fix(im->error, "give a point to look at other than the eye, or another up vector");
    }
    return state_concat(im, &m);
}

bool directive_transform(PbrtImport *im)
{
    Matrix m;
    return parser_matrix(im, &m) && state_replace(im, &m);
}

bool directive_concat_transform(PbrtImport *im)
{
    Matrix m;
    return parser_matrix(im, &m) && state_concat(im, &m);
}

bool directive_coordinate_system(PbrtImport *im)
{
    const char *name;
    return parser_string(im, "the name of a coordinate system", &name, NULL) &&
           state_coordinate_system(im, name, im->state.ctm);
}

bool directive_coord_sys_transform(PbrtImport *im)
{
    const char *name;
    SourcePlace place;
    return parser_string(im, "the name of a coordinate system", &name, &place) &&
           state_use_coordinate_system(im, name, place);
}

bool directive_active_transform(PbrtImport *im)
{
    Token token;
    if (!parser_next(im, &token))
        return false;
    if (token_is(&token, "All"))
        im->state.active_transforms = 3;
    else if (token_is(&token, "StartTime"))
        im->state.active_transforms = 1;
    else if (token_is(&token, "EndTime"))
        im->state.active_transforms = 2;
    else
        return token_unexpected(&token, "All, StartTime or EndTime", im->error);
    return true;
}

bool directive_transform_times(PbrtImport *im)
{
    double times[2];
    return parser_floats(im, 2, times);
}
