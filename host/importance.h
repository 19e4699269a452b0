/* Where the chains of a picture go. The error that counts is relative: dark places need as many visits as bright ones, but
 * chains that go after f spend them where light is. So they go after f times an importance that is the smaller the brighter a
 * place is known to be, and what they carry to the film is divided by it. */
#ifndef TWINLIGHT_IMPORTANCE_H
#define TWINLIGHT_IMPORTANCE_H

#include "blend.h"
#include "scene_types.h"

/* No place before another. */
void importance_even(float importance[IMPORTANCE_CELLS]);

/* From what `blend` has learnt of the picture so far. Scaled such that the mean worth of a path stays what it is without. */
void importance_learn(const Blend *blend, float importance[IMPORTANCE_CELLS]);

#endif
