/* What the two parts of a blend share: what it learns (blend_learn.c), and what it does with that (blend.c). */
#ifndef TWINLIGHT_BLEND_LEARN_H
#define TWINLIGHT_BLEND_LEARN_H

#include "blend.h"

/* Errors of places darker than the root of this part of the mean square light count as there. */
#define DARK_PART 0.1

size_t blend_tile_count(const Blend *blend);
size_t blend_tile_of(const Blend *blend, size_t pixel);

/* What the streams of a generation show joins the series. picture, tiles: room for as many values. */
void blend_films_learn(Blend *blend, Film *const films[], float *picture, float *tiles);

/* What is known of the tiles from the series. ratios: room for as many as there are tiles. */
void blend_spreads_update(Blend *blend, double *ratios);

#endif
