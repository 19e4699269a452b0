/* Where grids are, and media of grids whose samples are in the scene file: "uniformgrid" and "rgbgrid". */
#include "pbrt/errors.h"
#include "pbrt/media.h"
#include "pbrt/state.h"
#include "pbrt/values.h"

#include <math.h>

const float MEDIUM_ONES[2][3] = {{1.0f, 1.0f, 1.0f}, {1.0f, 1.0f, 1.0f}};

/* ---- place ------------------------------------------------------------------------------------------------------- */

bool medium_grid_place(PbrtImport *im, ParamList *list, const char *name, const Matrix *grid_from_medium,
                       GridSource *source)
{
    Matrix ctm, inverse;
    if (!import_ctm(im, list->place, &ctm))
        return false;
    import_matrix_move(im, &ctm);
    if (!import_inverse(im, list->place, &ctm, &inverse))
        return false;
    source->grid_from_world = matrix_multiply(grid_from_medium, &inverse);
    if (matrix_fits_float(&source->grid_from_world))
        return true;
    param_error(list, name, "the grid of %s is too small or too far away", list->owner);
    return false;
}

bool medium_box_read(ParamList *list, MediumBox *box)
{
    float p0[3] = {0.0f, 0.0f, 0.0f}, p1[3] = {1.0f, 1.0f, 1.0f};
    param_vector(list, "p0", PARAM_POINT3, p0);
    param_vector(list, "p1", PARAM_POINT3, p1);
    for (int i = 0; i < 3; ++i) {
        box->low[i] = fmin((double)p0[i], (double)p1[i]);
        box->extent[i] = fabs((double)p1[i] - (double)p0[i]);
        if (!(box->extent[i] > 0.0))
            param_error(list, "p1", "the box from \"p0\" to \"p1\" of %s is flat", list->owner);
    }
    return !list->failed;
}

bool medium_box_place(PbrtImport *im, ParamList *list, const MediumBox *box, GridSource *source)
{
    Matrix grid_from_medium = matrix_identity();
    for (int i = 0; i < 3; ++i) {
        grid_from_medium.m[5 * i] = (double)source->size[i] / box->extent[i];
        grid_from_medium.m[4 * i + 3] = (double)source->low - box->low[i] * grid_from_medium.m[5 * i];
    }
    return medium_grid_place(im, list, "p1", &grid_from_medium, source);
}

bool medium_grid_add(PbrtImport *im, ParamList *list, const GridSource *source, Medium *medium)
{
    float largest[6];
    if (im->options.needs)
        return true;
    if (!grid_add(im->scene, source, &medium->grid, largest, im->error))
        return false;
    const float *l = largest;
    Vec3 extinction = vec3_splat(l[0]), scattering = extinction;
    if (source->words > 1) {
        extinction = vec3(l[0], l[1], l[2]);
        scattering = vec3(l[3], l[4], l[5]);
    }
    medium->extinction = medium_coefficients_scale(list, vec3_mul(medium->extinction, extinction), 1.0);
    medium->scattering = medium_coefficients_scale(list, vec3_mul(medium->scattering, scattering), 1.0);
    medium->emission = medium_coefficients_scale(list, vec3_mul(medium->emission, extinction), 1.0);
    return !list->failed;
}

/* ---- samples ----------------------------------------------------------------------------------------------------- */

static void size_read(ParamList *list, GridSource *source)
{
    static const char *const NAMES[3] = {"nx", "ny", "nz"};
    size_t samples = 1;
    for (int i = 0; i < 3; ++i) {
        int size = param_integer(list, NAMES[i], 1);
        if (size < 1 || size > (int)GRID_SIZE_MAX) {
            param_error(list, NAMES[i], "\"%s\" of %s is %d, which is not from 1 to %u", NAMES[i], list->owner, size,
                        GRID_SIZE_MAX);
            size = 1;
        }
        source->size[i] = (uint)size;
        samples *= source->size[i];
    }
    if (samples > GRID_SAMPLES_MAX)
        param_error(list, "nx", "the grid of %s has %zu samples, which is more than %u", list->owner, samples,
                    GRID_SAMPLES_MAX);
}

/* The values of a grid: `words` for each of the source's samples, none of which is negative. NULL if it is absent. */
static const float *values_read(ParamList *list, const GridSource *source, const char *name, ParamType type,
                                size_t words)
{
    size_t count, samples = (size_t)source->size[0] * source->size[1] * source->size[2];
    const float *values = param_floats(list, name, type, &count);
    if (values && count != words * samples)
        param_error(list, name, "\"%s\" of %s has %zu values instead of %zu, which is %snx ny nz", name, list->owner,
                    count, words * samples, words == 1 ? "" : "3 ");
    for (size_t i = 0; values && !list->failed && i < count; ++i)
        if (values[i] < 0.0f)
            param_error(list, name, "\"%s\" of %s is negative (%g, its value number %zu)", name, list->owner,
                        (double)values[i], i + 1);
    return values;
}

typedef struct GridValues {
    const GridSource *source;
    const float *density; /* of a uniformgrid */
    const float *absorption, *scattering; /* of an rgbgrid; NULL: 1 everywhere */
} GridValues;

static size_t sample_index(const GridValues *values, const uint index[3])
{
    const uint *size = values->source->size;
    return ((size_t)index[2] * size[1] + index[1]) * size[0] + index[0];
}

static void density_sample(const void *context, const uint index[3], float *out)
{
    const GridValues *values = context;
    *out = values->density[sample_index(values, index)];
}

static void rgb_sample(const void *context, const uint index[3], float *out)
{
    const GridValues *values = context;
    size_t at = 3 * sample_index(values, index);
    for (size_t c = 0; c < 3; ++c) {
        float absorbed = values->absorption ? values->absorption[at + c] : 1.0f;
        out[3 + c] = values->scattering ? values->scattering[at + c] : 1.0f;
        out[c] = fminf(absorbed + out[3 + c], FLOAT_MAX);
    }
}

/* ---- media ------------------------------------------------------------------------------------------------------- */

/* Emission that differs from place to place is refused, or left out: by temperatures or, with `colors`, a colour for
 * each sample. */
static bool emission_refuse(PbrtImport *im, ParamList *list, bool colors)
{
    static const char *const WITH_IT[] = {"Lescale", "temperatureoffset", "temperaturecutoff", "temperaturescale"};
    bool le = colors && param_ignore(list, "Le"), temperature = param_ignore(list, "temperature") != NULL;
    for (size_t i = 0; i < sizeof WITH_IT / sizeof *WITH_IT; ++i)
        param_ignore(list, WITH_IT[i]);
    const char *name = le ? "Le" : "temperature";
    return (!le && !temperature) || import_unsupported(im, param_place(list, name), "emission that varies in a medium",
                                                       "no emission", "use a uniformgrid with \"Le\" alone");
}

/* A uniformgrid's Le, times its Lescale, which must be the same for all samples. */
static bool emission_read(PbrtImport *im, ParamList *list, const GridSource *source, Vec3 absorption, Medium *medium)
{
    float le[3] = {0.0f, 0.0f, 0.0f}, factor = 1.0f;
    if (!value_color(im, list, "Le", COLOR_ILLUMINANT, le) || list->failed)
        return !list->failed;
    const float *values = values_read(list, source, "Lescale", PARAM_FLOAT, 1);
    size_t count = (size_t)source->size[0] * source->size[1] * source->size[2];
    for (size_t i = 0; values && !list->failed && i < count; ++i) {
        factor = values[0];
        if (values[i] != factor)
            return import_unsupported(im, param_place(list, "Lescale"), "emission that varies in a medium",
                                      "no emission", "give \"Lescale\" the same value everywhere");
    }
    medium->emission = medium_coefficients_scale(list, vec3_mul(absorption, vec3(le[0], le[1], le[2])), (double)factor);
    return !list->failed;
}

/* Both: the samples have been read. */
static bool samples_add(PbrtImport *im, ParamList *list, GridSource *source, Medium *medium)
{
    MediumBox box;
    return !list->failed && emission_refuse(im, list, source->words > 1) && medium_box_read(list, &box) &&
           medium_box_place(im, list, &box, source) && medium_grid_add(im, list, source, medium);
}

bool medium_uniform_grid_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    GridValues values = {.density = NULL};
    GridSource source = {.words = 1, .low = 0.5f, .sample = density_sample, .context = &values};
    values.source = &source;
    Vec3 absorption;
    medium_coefficients_read(im, list, MEDIUM_ONES, medium, &absorption);
    size_read(list, &source);
    values.density = values_read(list, &source, "density", PARAM_FLOAT, 1);
    if (!values.density)
        param_error(list, "density", "%s lacks \"float density\"", list->owner);
    return emission_read(im, list, &source, absorption, medium) && samples_add(im, list, &source, medium);
}

bool medium_rgb_grid_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    GridValues values = {.density = NULL};
    GridSource source = {.words = 6, .low = 0.5f, .sample = rgb_sample, .context = &values};
    values.source = &source;
    size_read(list, &source);
    values.absorption = values_read(list, &source, "sigma_a", PARAM_RGB, 3);
    values.scattering = values_read(list, &source, "sigma_s", PARAM_RGB, 3);
    if (!values.absorption && !values.scattering)
        param_error(list, "sigma_s", "%s lacks \"rgb sigma_a\" and \"rgb sigma_s\"", list->owner);
    float scale = medium_factor_read(list, "scale");
    medium->extinction = medium->scattering = vec3_splat(scale);
    medium_g_read(list, medium);
    return samples_add(im, list, &source, medium);
}
