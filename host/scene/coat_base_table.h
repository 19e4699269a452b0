/* Records of coats over conductors, appended to the scene's `lookup` array (layout: shared/bsdf/coated_conductor.h). */
#ifndef TWINLIGHT_SCENE_COAT_BASE_TABLE_H
#define TWINLIGHT_SCENE_COAT_BASE_TABLE_H

#include "base/array.h"

#include <stdint.h>

/* Appends a record and returns its first float in *first, for Material.coat_table. rough: with X and R; the caller then
 * appends a table of bsdf/coat.h. eta: coat over outside, > 0. thickness: the coat's optical thickness along
 * its normal. Deterministic; takes about 50 milliseconds. Fails only when out of memory or if `lookup` would exceed
 * 32-bit indices. */
bool coat_base_build(float eta, float thickness, bool rough, Array *lookup, uint32_t *first, Error *error);

#endif
