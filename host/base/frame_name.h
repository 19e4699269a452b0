/* File names with a placeholder for the frame number: "beauty.%04d.exr" is "beauty.0012.exr" for frame 12. */
#ifndef TWINLIGHT_BASE_FRAME_NAME_H
#define TWINLIGHT_BASE_FRAME_NAME_H

#include "base/arena.h"

#include <stdbool.h>

#define FRAME_MAX 99999999

/* Whether the name has a placeholder: %d, or %Nd or %NNd with digits N. */
bool frame_name_has(const char *name);

/* Replaces every placeholder by `frame`, padded as printf does: with zeros if the width begins with 0, else with
 * blanks. Everything else is kept as it is, a lone % included. Returns NULL when out of memory. */
const char *frame_name_fill(Arena *arena, const char *name, int frame, Error *error);

#endif
