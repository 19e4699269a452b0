/* Access to BUFFER_PASS, the words that the host hands to the items of a pass and gets back. It has a stride of its
 * own. */
#ifndef TWINLIGHT_LAYOUT_PASS_DATA_H
#define TWINLIGHT_LAYOUT_PASS_DATA_H

#include "layout/frame_params.h"

/* Index of a field of an item. */
SHARED_FUNCTION size_t pass_place(__global const FrameParams *frame, uint field, uint item)
{
    return (size_t)field * frame->pass.data_stride + (frame->pass.first_item + item - frame->pass.data_first);
}

SHARED_FUNCTION uint pass_load(__global const FrameParams *frame, __global const uint *pass, uint field, uint item)
{
    return pass[pass_place(frame, field, item)];
}

SHARED_FUNCTION void pass_store(__global const FrameParams *frame, __global uint *pass, uint field, uint item,
                                uint value)
{
    pass[pass_place(frame, field, item)] = value;
}

#endif
