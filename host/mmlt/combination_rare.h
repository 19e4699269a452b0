/* Whether path tracing finds the rare light that it leaves to the chains, and so may show it itself. */
#ifndef TWINLIGHT_MMLT_COMBINATION_RARE_H
#define TWINLIGHT_MMLT_COMBINATION_RARE_H

#include "mmlt/combination_learn.h"

/* Adds the chains' rare light in the whole image, of the generation that the series have learnt from last, and sets
 * combination->rare_missed. The tiles' light must be known (mmlt/combination_variances.c). */
void combination_rare_update(Combination *combination);

/* Whether path tracing's own rare light must not be trusted, whatever variance it states: that of light which is never
 * or hardly ever found is zero. */
bool combination_rare_hidden(const Combination *combination);

#endif
