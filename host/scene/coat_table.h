/* Tables of what rough dielectric coats transmit, appended to the scene's `lookup` array. shared/bsdf/coat.h has the
 * layout. */
#ifndef TWINLIGHT_SCENE_COAT_TABLE_H
#define TWINLIGHT_SCENE_COAT_TABLE_H

#include "base/array.h"

#include <stdint.h>

/* Appends the table of a coat with constant roughness and returns its first float in *first, which is what
 * Material.coat_table wants. alpha_x, alpha_y: of the GGX coat, at least one >= ALPHA_DELTA (a smooth coat needs no
 * table, but gets a valid one). eta: coat over outside, > 0. Deterministic; a few milliseconds. Fails only when memory
 * is out or `lookup` would exceed 32 bits. */
bool coat_table_build(float alpha_x, float alpha_y, float eta, Array *lookup, uint32_t *first, Error *error);

/* The same for every alpha in 0..1 at once, for a coat whose roughness is textured. Larger alphas use alpha = 1, and
 * anisotropic ones sqrt(alpha_x alpha_y). */
bool coat_table_build_range(float eta, Array *lookup, uint32_t *first, Error *error);

/* Mean transmittance of a round trip between the base and a smooth interface of index eta through a medium of the given
 * optical thickness: integral of R(c) exp(-2 thickness / c) 2 c dc over that of R(c) 2 c dc, R the reflectance from the
 * inside. 1 when nothing absorbs or nothing is reflected. */
float coat_round_trip(float eta, float thickness);

#endif
