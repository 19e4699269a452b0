/* What the readers of media have in common. */
#ifndef TWINLIGHT_PBRT_MEDIA_H
#define TWINLIGHT_PBRT_MEDIA_H

#include "pbrt/context.h"
#include "scene/grid_build.h"

/* Reads preset, sigma_a, sigma_s, scale and g into the medium, whose extinction and scattering are set. fallback: of
 * sigma_a and sigma_s. *absorption: the scaled sigma_a. */
void medium_coefficients_read(PbrtImport *im, ParamList *list, const float fallback[2][3], Medium *medium,
                              Vec3 *absorption);

/* The parameter g. */
void medium_g_read(ParamList *list, Medium *medium);

/* A factor that must not be negative; 1 if absent. */
float medium_factor_read(ParamList *list, const char *name);

/* The factor Lescale of emission, which older files call LeScale; 1 if absent. */
float medium_emission_factor_read(ParamList *list);

/* scale * coefficients; an error if that overflows a float. */
Vec3 medium_coefficients_scale(ParamList *list, Vec3 coefficients, double scale);

/* ---- media of grids ---------------------------------------------------------------------------------------------- */

/* pbrt's sigma_a and sigma_s of media that vary. */
extern const float MEDIUM_ONES[2][3];

/* A box in the space of a medium, of which no side is 0. */
typedef struct MediumBox {
    double low[3], extent[3];
} MediumBox;

/* The box with the corners p0 and p1. */
bool medium_box_read(ParamList *list, MediumBox *box);

/* Sets source->grid_from_world: from the box that the grid fills, or from the map from the medium's space to the grid.
 * name: the parameter to blame. */
bool medium_box_place(PbrtImport *im, ParamList *list, const MediumBox *box, GridSource *source);
bool medium_grid_place(PbrtImport *im, ParamList *list, const char *name, const Matrix *grid_from_medium,
                       GridSource *source);

/* Adds the grid to the scene and the medium, unless only the scene's needs are wanted; multiplies the medium's
 * coefficients by the largest of its factors. */
bool medium_grid_add(PbrtImport *im, ParamList *list, const GridSource *source, Medium *medium);

/* Reads temperatureoffset, or temperaturecutoff, and temperaturescale. */
void medium_kelvin_read(ParamList *list, GridKelvin *kelvin);

/* Adds the grid of the emission of a medium that has its grid, unless it emits nothing or only needs are wanted;
 * multiplies its emission by the largest of the factors. kelvin: as of grid_emission_add. */
bool medium_emission_add(PbrtImport *im, ParamList *list, const GridSource *source, const GridKelvin *kelvin,
                         Medium *medium);

bool medium_uniform_grid_read(PbrtImport *im, ParamList *list, Medium *medium);
bool medium_rgb_grid_read(PbrtImport *im, ParamList *list, Medium *medium);
bool medium_nanovdb_read(PbrtImport *im, ParamList *list, Medium *medium);
bool medium_cloud_read(PbrtImport *im, ParamList *list, Medium *medium);

#endif
