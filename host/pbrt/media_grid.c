/* Where grids are, and media of grids whose samples are in the scene file: "uniformgrid" and "rgbgrid". */
#include "pbrt/media.h"
#include "pbrt/state.h"
#include "pbrt/values.h"

#include <math.h>
#include <string.h>

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
    const float *temperature, *factor; /* of its emission, or NULL */
    const float *absorption, *scattering; /* of an rgbgrid; NULL: 1 everywhere */
    const float *radiance; /* that it emits, or NULL */
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

/* pbrt's illuminants are normalised to this luminance; that of an rgbgrid is not divided by it. */
#define ILLUMINANT_LUMINANCE 106.856895

void medium_kelvin_read(ParamList *list, GridKelvin *kelvin)
{
    float offset = param_float(list, "temperatureoffset", param_float(list, "temperaturecutoff", 0.0f));
    kelvin->scale = medium_factor_read(list, "temperaturescale");
    kelvin->offset = -offset * kelvin->scale;
    if (!isfinite(kelvin->offset))
        param_error(list, "temperaturescale", "the temperatures of %s overflow", list->owner);
}

bool medium_emission_add(PbrtImport *im, ParamList *list, const GridSource *source, const GridKelvin *kelvin,
                         Medium *medium)
{
    float largest[6];
    if (im->options.needs || vec3_is_zero(medium->emission))
        return true;
    if (!grid_emission_add(im->scene, medium->grid, source, kelvin, largest, im->error))
        return false;
    if (kelvin && !isfinite(kelvin->scale * largest[0])) {
        param_error(list, "temperaturescale", "the temperatures of %s overflow", list->owner);
        return false;
    }
    Vec3 factor = vec3_splat(kelvin ? 1.0f : largest[0]);
    if (source->words == 2)
        factor = vec3_splat(largest[1]);
    if (source->words == 6)
        factor = vec3(largest[0] * largest[3], largest[1] * largest[4], largest[2] * largest[5]);
    medium->emission = medium_coefficients_scale(list, vec3_mul(medium->emission, factor), 1.0);
    return !list->failed;
}

/* The samples have been read. */
static bool samples_add(PbrtImport *im, ParamList *list, GridSource *source, Medium *medium)
{
    MediumBox box;
    return !list->failed && medium_box_read(list, &box) && medium_box_place(im, list, &box, source) &&
           medium_grid_add(im, list, source, medium);
}

/* A temperature, its radiance's factor or both. */
static void emission_sample(const void *context, const uint index[3], float *out)
{
    const GridValues *values = context;
    size_t at = sample_index(values, index);
    if (values->temperature)
        *out++ = values->temperature[at];
    if (values->factor)
        *out = values->factor[at];
}

/* A uniformgrid's Le or temperature, and Lescale, into the medium and `values`. */
static void emission_read(PbrtImport *im, ParamList *list, const GridSource *source, Vec3 absorption,
                          GridValues *values, Medium *medium)
{
    float le[3] = {0.0f, 0.0f, 0.0f};
    bool colored = value_color(im, list, "Le", COLOR_ILLUMINANT, le);
    values->temperature = values_read(list, source, "temperature", PARAM_FLOAT, 1);
    values->factor = values_read(list, source, "Lescale", PARAM_FLOAT, 1);
    if (colored && values->temperature) {
        param_error(list, "temperature", "%s has both \"Le\" and \"temperature\"", list->owner);
        error_fix(list->error, "remove one of the two");
    }
    medium->emission = values->temperature ? absorption : vec3_mul(absorption, vec3(le[0], le[1], le[2]));
}

bool medium_uniform_grid_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    GridValues values = {.density = NULL};
    GridSource source = {.words = 1, .low = 0.5f, .sample = density_sample, .context = &values};
    GridKelvin kelvin;
    values.source = &source;
    Vec3 absorption;
    medium_coefficients_read(im, list, MEDIUM_ONES, medium, &absorption);
    size_read(list, &source);
    values.density = values_read(list, &source, "density", PARAM_FLOAT, 1);
    if (!values.density)
        param_error(list, "density", "%s lacks \"float density\"", list->owner);
    emission_read(im, list, &source, absorption, &values, medium);
    medium_kelvin_read(list, &kelvin);
    if (!samples_add(im, list, &source, medium))
        return false;
    source.sample = emission_sample;
    source.words = (values.temperature ? 1u : 0u) + (values.factor ? 1u : 0u);
    return source.words == 0 || medium_emission_add(im, list, &source, values.temperature ? &kelvin : NULL, medium);
}

/* Absorption and radiance. */
static void rgb_emission_sample(const void *context, const uint index[3], float *out)
{
    const GridValues *values = context;
    size_t at = 3 * sample_index(values, index);
    memcpy(out, values->absorption + at, 3 * sizeof *out);
    memcpy(out + 3, values->radiance + at, 3 * sizeof *out);
}

bool medium_rgb_grid_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    GridValues values = {.density = NULL};
    GridSource source = {.words = 6, .low = 0.5f, .sample = rgb_sample, .context = &values};
    values.source = &source;
    size_read(list, &source);
    values.absorption = values_read(list, &source, "sigma_a", PARAM_RGB, 3);
    values.scattering = values_read(list, &source, "sigma_s", PARAM_RGB, 3);
    values.radiance = values_read(list, &source, "Le", PARAM_RGB, 3);
    if (!values.absorption && !values.scattering)
        param_error(list, "sigma_s", "%s lacks \"rgb sigma_a\" and \"rgb sigma_s\"", list->owner);
    if (values.radiance && !values.absorption) {
        param_error(list, "Le", "%s has \"Le\" and lacks \"rgb sigma_a\"", list->owner);
        error_fix(list->error, "emission is sigma_a times Le: give \"rgb sigma_a\" for each sample");
    }
    float scale = medium_factor_read(list, "scale"), factor = medium_emission_factor_read(list);
    medium->extinction = medium->scattering = vec3_splat(scale);
    medium_g_read(list, medium);
    if (!samples_add(im, list, &source, medium))
        return false;
    if (!values.radiance)
        return true;
    source.sample = rgb_emission_sample;
    medium->emission = medium_coefficients_scale(list, vec3_splat(scale), (double)factor * ILLUMINANT_LUMINANCE);
    return medium_emission_add(im, list, &source, NULL, medium);
}
