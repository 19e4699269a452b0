/* Where on the film chains are wanted. A chain is drawn to a path in proportion to its luminance times the importance of the
 * place where the film sees it (BUFFER_TARGET), and what it carries there is divided by that importance: any positive
 * importance that does not depend on the chain leaves the image right (Hoberock and Hart, "Arbitrary Importance Functions
 * for Metropolis Light Transport", 2010). Dark places get chains that bright ones can spare. */
#ifndef TWINLIGHT_TARGET_H
#define TWINLIGHT_TARGET_H

#include "state.h"
#include "vec.h"

SHARED_FUNCTION uint target_tile(float offset, uint count)
{
    float tile = float_floor(offset * (1.0f / (float)TARGET_TILE));
    return (uint)float_clamp(tile, 0.0f, (float)count - 1.0f);
}

/* Of film position `film` (pixels). Positions outside the crop window, of which a filter shows a little, count as its
 * border. target: target_rows x target_columns floats. */
SHARED_FUNCTION float target_importance(__global const FrameParams *frame, __global const uint *target, Vec2 film)
{
    if (frame->target_columns == 0u)
        return 1.0f;
    uint column = target_tile(film.x - (float)frame->crop_x0, frame->target_columns);
    uint row = target_tile(film.y - (float)frame->crop_y0, frame->target_rows);
    return bits_float(target[row * frame->target_columns + column]);
}

#endif
