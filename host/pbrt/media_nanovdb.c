/* Media of NanoVDB files. */
#include "pbrt/media.h"
#include "pbrt/nanovdb.h"

#include <math.h>

/* Of a file, most of whose samples are 0. */
#define NANOVDB_SAMPLES_MAX ((uint64_t)1 << 34)

/* pbrt interpolates between values at whole indices, from the lowest active one to that after the highest. */
static void nanovdb_index(const NanoVdb *grid, const uint index[3], int out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = grid->low[i] + (int)index[i];
}

static void nanovdb_sample(const void *context, const uint index[3], float *out)
{
    int at[3];
    nanovdb_index(context, index, at);
    float value = nanovdb_value(context, at);
    *out = value > 0.0f ? fminf(value, FLOAT_MAX) : 0.0f;
}

static bool nanovdb_is_empty(const void *context, const uint low[3], const uint high[3])
{
    int from[3], to[3];
    nanovdb_index(context, low, from);
    nanovdb_index(context, high, to);
    return nanovdb_empty(context, from, to);
}

/* Reads the grid of that name, at the place of the parameter "filename". */
static bool nanovdb_open(ParamList *list, const char *path, const char *name, NanoVdb *grid, bool *found)
{
    Error error = {{0}, {0}};
    if (nanovdb_read(path, name, grid, found, &error))
        return true;
    param_error(list, "filename", "%s", error_text(&error));
    return error_fix(list->error, "%s", error.fix);
}

static bool nanovdb_place(PbrtImport *im, ParamList *list, const NanoVdb *grid, GridSource *source)
{
    Matrix index_from_medium;
    uint64_t samples = 1;
    for (int i = 0; i < 3; ++i) {
        int64_t size = (int64_t)grid->high[i] - grid->low[i] + 1;
        if (size < 1 || size > (int64_t)GRID_SIZE_MAX)
            size = (int64_t)NANOVDB_SAMPLES_MAX + 1;
        source->size[i] = (uint)size;
        samples = size > (int64_t)GRID_SIZE_MAX ? NANOVDB_SAMPLES_MAX + 1 : samples * (uint64_t)size;
    }
    if (samples > NANOVDB_SAMPLES_MAX) {
        param_error(list, "filename", "the grid of %s is empty, or larger than %u along an axis or 2^34 in all",
                    list->owner, GRID_SIZE_MAX);
        return false;
    }
    if (!matrix_inverse(&grid->medium_from_index, &index_from_medium)) {
        param_error(list, "filename", "the transform of the grid of %s cannot be inverted", list->owner);
        return false;
    }
    for (int i = 0; i < 3; ++i)
        index_from_medium.m[4 * i + 3] += (double)source->low - (double)grid->low[i];
    return medium_grid_place(im, list, "filename", &index_from_medium, source);
}

/* Reads the grid of that name, and where it is in the scene. *found: there is one, which is to be destroyed. */
static bool nanovdb_source(PbrtImport *im, ParamList *list, const char *path, const char *name, NanoVdb *grid,
                           GridSource *source, bool *found)
{
    *source = (GridSource){
        .words = 1, .low = 1.0f, .ends = 1, .sample = nanovdb_sample, .empty = nanovdb_is_empty, .context = grid};
    if (!nanovdb_open(list, path, name, grid, found))
        return false;
    if (!*found || nanovdb_place(im, list, grid, source))
        return true;
    nanovdb_destroy(grid);
    return false;
}

/* The grid of densities at `path`. */
static bool density_read(PbrtImport *im, ParamList *list, const char *path, const char *name, Medium *medium)
{
    NanoVdb grid;
    GridSource source;
    bool found;
    if (!nanovdb_source(im, list, path, name, &grid, &source, &found))
        return false;
    if (!found) {
        param_error(list, "filename", "%s has no grid \"%s\"", path, name);
        return error_fix(list->error, "name one that it has by \"string gridname\"");
    }
    bool good = medium_grid_add(im, list, &source, medium);
    nanovdb_destroy(&grid);
    return good;
}

/* The grid of temperatures at `path`, if there is one. */
static bool temperature_read(PbrtImport *im, ParamList *list, const char *path, const char *name,
                             const GridKelvin *kelvin, Medium *medium)
{
    NanoVdb grid;
    GridSource source;
    bool found;
    if (vec3_is_zero(medium->emission))
        return true;
    if (!nanovdb_source(im, list, path, name, &grid, &source, &found))
        return false;
    if (!found) {
        medium->emission = vec3_splat(0.0f);
        return true;
    }
    bool good = medium_emission_add(im, list, &source, kelvin, medium);
    nanovdb_destroy(&grid);
    return good;
}

bool medium_nanovdb_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    const char *file = param_string(list, "filename", ""), *density = param_string(list, "gridname", "density"),
               *temperature = param_string(list, "temperaturename", "temperature");
    GridKelvin kelvin;
    Vec3 absorption;
    medium_coefficients_read(im, list, MEDIUM_ONES, medium, &absorption);
    medium_kelvin_read(list, &kelvin);
    medium->emission = medium_coefficients_scale(list, absorption, (double)medium_emission_factor_read(list));
    if (!*file)
        param_error(list, "filename", "%s lacks \"string filename\"", list->owner);
    const char *path = list->failed ? NULL : import_path(im, file);
    if (!path)
        return false;
    return im->options.needs || (density_read(im, list, path, density, medium) &&
                                 temperature_read(im, list, path, temperature, &kelvin, medium));
}
