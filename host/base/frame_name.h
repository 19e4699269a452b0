/* File names that hold the number of a frame: "beauty.%04d.exr" is "beauty.0012.exr" for frame 12. */
#ifndef TWINLIGHT_BASE_FRAME_NAME_H
#define TWINLIGHT_BASE_FRAME_NAME_H

#include "base/arena.h"

#include <stdbool.h>

#define FRAME_MAX 99999999

/* Whether the name has such a place: %d, or % with a width of one or two digits and d. */
bool frame_name_has(const char *name);

/* The name with `frame` in every such place; all else stays as it is. A width that begins with 0 fills up with zeros,
 * another one with blanks, as printf does. NULL when memory is out. */
const char *frame_name_fill(Arena *arena, const char *name, int frame, Error *error);

#endif
