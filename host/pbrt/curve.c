#include "pbrt/curve.h"

#include "base/log.h"
#include "geometry/medium.h"
#include "pbrt/errors.h"
#include "pbrt/ribbon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum CurveType { TYPE_FLAT, TYPE_CYLINDER, TYPE_RIBBON, TYPE_COUNT } CurveType;
static const char *const TYPES[TYPE_COUNT] = {"flat", "cylinder", "ribbon"};

typedef enum CurveBasis { BASIS_BEZIER, BASIS_BSPLINE, BASIS_COUNT } CurveBasis;
static const char *const BASES[BASIS_COUNT] = {"bezier", "bspline"};

/* The parameters of the shape. */
typedef struct CurveParams {
    CurveType type;
    CurveBasis basis;
    int degree;
    const float *points, *normals; /* three floats each; normals: one more than segments, of ribbons */
    size_t point_count, segment_count;
    float width[2]; /* at both ends */
    uint levels;
} CurveParams;

/* ---- parameters -------------------------------------------------------------------------------------------------- */

/* Index of the parameter's value among `names`; sets an error if it is none of them. */
static uint choice_read(ParamList *list, const char *name, const char *const *names, uint count)
{
    const char *value = param_string(list, name, names[0]);
    for (uint i = 0; i < count; ++i)
        if (strcmp(value, names[i]) == 0)
            return i;
    param_error(list, name, "unknown %s \"%s\" of a curve", name, value);
    error_fix(list->error, count == 2 ? "use \"%s\" or \"%s\"" : "use \"%s\", \"%s\" or \"%s\"", names[0], names[1],
              names[count - 1]);
    return 0;
}

static void points_read(ParamList *list, CurveParams *params)
{
    size_t count, degree = (size_t)params->degree;
    params->points = param_floats(list, "P", PARAM_POINT3, &count);
    params->point_count = count / 3;
    if (!params->points)
        param_error(list, "P", "curve lacks \"point3 P\", its control points");
    if (list->failed)
        return;
    if (params->point_count < degree + 1) {
        param_error(list, "P", "a curve of degree %zu has %zu control points instead of at least %zu", degree,
                    params->point_count, degree + 1);
    } else if (params->basis == BASIS_BEZIER && (params->point_count - 1) % degree != 0) {
        param_error(list, "P", "%zu control points do not make a Bezier curve of degree %zu", params->point_count,
                    degree);
        error_fix(list->error, "give %zu points, and %zu more for every further segment", degree + 1, degree);
    }
    params->segment_count =
        params->basis == BASIS_BEZIER ? (params->point_count - 1) / degree : params->point_count - degree;
}

static void normals_read(ParamList *list, CurveParams *params)
{
    size_t count;
    params->normals = param_floats(list, "N", PARAM_NORMAL, &count);
    if (list->failed)
        return;
    if (params->type != TYPE_RIBBON && params->normals)
        log_message_at(LOG_WARNING, param_place(list, "N"), "the normals are ignored: only ribbons have normals");
    if (params->type != TYPE_RIBBON)
        return;
    if (!params->normals)
        param_error(list, "N", "a ribbon lacks \"normal N\", its normals at the ends of segments");
    else if (count != 3 * (params->segment_count + 1))
        param_error(list, "N", "\"N\" has %zu normals instead of %zu: one more than the curve has segments", count / 3,
                    params->segment_count + 1);
}

static void widths_read(ParamList *list, CurveParams *params)
{
    static const char *const NAMES[] = {"width0", "width1"};
    float width = param_float(list, "width", 1.0f);
    if (width < 0.0f)
        param_error(list, "width", "\"width\" is negative");
    for (int i = 0; i < 2; ++i) {
        params->width[i] = param_float(list, NAMES[i], width);
        if (params->width[i] < 0.0f)
            param_error(list, NAMES[i], "\"%s\" is negative", NAMES[i]);
    }
}

static bool params_read(PbrtImport *im, ParamList *list, CurveParams *params)
{
    params->type = (CurveType)choice_read(list, "type", TYPES, TYPE_COUNT);
    params->basis = (CurveBasis)choice_read(list, "basis", BASES, BASIS_COUNT);
    params->degree = param_integer(list, "degree", 3);
    if (params->degree != 2 && params->degree != 3)
        param_error(list, "degree", "a curve cannot have the degree %d: only 2 and 3", params->degree);
    int depth = param_integer(list, "splitdepth", CURVE_LEVELS_DEFAULT);
    if (depth < 0)
        param_error(list, "splitdepth", "\"splitdepth\" is negative");
    params->levels = depth < CURVE_LEVELS_MAX ? (uint)depth : CURVE_LEVELS_MAX;
    if (!list->failed)
        points_read(list, params);
    normals_read(list, params);
    widths_read(list, params);
    return param_list_finish(list, im->options.lenient);
}

/* ---- segments ---------------------------------------------------------------------------------------------------- */

/* Coefficients of the control points in those of a cubic Bezier segment, and their common divisor. In a B-spline the
 * last row is the first of the next segment, so that segments meet. */
typedef struct Conversion {
    double row[4][4], divisor;
} Conversion;

static const Conversion CONVERSIONS[BASIS_COUNT][2] = {{{{{3, 0, 0, 0}, {1, 2, 0, 0}, {0, 2, 1, 0}, {0, 0, 3, 0}}, 3},
                                                        {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, 1}},
                                                       {{{{3, 3, 0, 0}, {1, 5, 0, 0}, {0, 5, 1, 0}, {0, 3, 3, 0}}, 6},
                                                        {{{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}}, 6}}};

/* Segment i as a cubic Bezier segment in the current space. */
static Curve segment_make(const CurveParams *params, size_t i)
{
    const Conversion *conversion = &CONVERSIONS[params->basis][params->degree - 2];
    size_t first = params->basis == BASIS_BEZIER ? i * (size_t)params->degree : i;
    double count = (double)params->segment_count;
    Curve curve;
    for (size_t k = 0; k < 4; ++k) {
        double sum[3] = {0.0, 0.0, 0.0};
        for (size_t j = 0; j <= (size_t)params->degree; ++j)
            for (size_t c = 0; c < 3; ++c)
                sum[c] += conversion->row[k][j] * (double)params->points[3 * (first + j) + c];
        curve.p[k] = vec3((float)(sum[0] / conversion->divisor), (float)(sum[1] / conversion->divisor),
                          (float)(sum[2] / conversion->divisor));
    }
    for (size_t end = 0; end < 2; ++end) {
        double t = (double)(i + end) / count;
        curve.width[end] = (float)((1.0 - t) * (double)params->width[0] + t * (double)params->width[1]);
    }
    return curve;
}

/* Curves do not separate media and emit nothing. False if that is an error. */
static bool context_check(PbrtImport *im, const ShapeContext *context)
{
    if (media_differ(context->shape.flags & MEDIA_BITS))
        log_message_at(LOG_WARNING, context->place, "the curve does not separate media: only a ribbon can");
    return !context->emits || import_unsupported(im, context->place, "an area light on a curve", "it emits no light",
                                                 "make the curve a ribbon");
}

static bool curves_add(PbrtImport *im, const ShapeContext *context, const CurveParams *params, Curve *segments)
{
    ShapeContext alone = *context;
    CurveData data = {.count = params->segment_count,
                      .levels = params->levels,
                      .type = params->type == TYPE_CYLINDER ? CURVE_ROUND : CURVE_FLAT};
    alone.shape.flags &= ~MEDIA_BITS;
    return context_check(im, context) && (context->interface || shape_add_curves(im, &alone, &data, segments));
}

bool curve_read(PbrtImport *im, ParamList *list, const ShapeContext *context)
{
    CurveParams params = {0};
    if (!params_read(im, list, &params))
        return false;
    Curve *segments = malloc((params.segment_count + 1) * sizeof *segments);
    if (!segments)
        return error_memory(im->error, params.segment_count * sizeof *segments, "a curve");
    for (size_t i = 0; i < params.segment_count; ++i)
        segments[i] = segment_make(&params, i);
    bool good = params.type == TYPE_RIBBON ? ribbon_add(im, context, segments, params.segment_count, params.normals)
                                           : curves_add(im, context, &params, segments);
    free(segments);
    return good;
}
