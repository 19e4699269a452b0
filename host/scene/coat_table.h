/* Tables of the transmittance of rough dielectric coats, appended to the scene's `lookup` array (layout:
 * shared/bsdf/coat.h). */
#ifndef TWINLIGHT_SCENE_COAT_TABLE_H
#define TWINLIGHT_SCENE_COAT_TABLE_H

#include "base/array.h"

#include <stdint.h>

/* Appends the table of a coat with constant roughness and returns its first float in *first, for Material.coat_table.
 * alpha_x, alpha_y: of the GGX coat, at least one >= ALPHA_DELTA (a smooth coat needs no table, but gets a valid one).
 * eta: coat over outside, > 0. Deterministic; takes a few milliseconds. Fails only when out of memory or if `lookup`
 * would exceed 32-bit indices. */
bool coat_table_build(float alpha_x, float alpha_y, float eta, Array *lookup, uint32_t *first, Error *error);

/* The same for all alphas in [0, 1], for a coat with textured roughness. Larger alphas use alpha = 1, anisotropic ones
 * sqrt(alpha_x alpha_y). */
bool coat_table_build_range(float eta, Array *lookup, uint32_t *first, Error *error);

/* 1 - R_i of an isotropic coat (shared/bsdf/coat.h): the part of diffuse light under it that gets out. */
float coat_escape(float alpha, float eta);

/* Mean transmittance of a round trip between the base and a smooth interface of index eta through a medium of the given
 * optical thickness: the integral of R(c) exp(-2 thickness / c) 2 c dc over that of R(c) 2 c dc, with R the internal
 * reflectance. 1 without absorption or reflection. */
float coat_round_trip(float eta, float thickness);

#endif
