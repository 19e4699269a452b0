/* Which sample of which pixel an item of a pass is. */
#ifndef TWINLIGHT_ITEM_H
#define TWINLIGHT_ITEM_H

#include "scene_types.h"

typedef struct ItemPlace {
    uint pixel; /* y * width + x of the whole film */
    uint sample;
} ItemPlace;

SHARED_FUNCTION ItemPlace item_place(__global const FrameParams *frame, uint t)
{
    uint crop_width = frame->crop_x1 - frame->crop_x0, crop_height = frame->crop_y1 - frame->crop_y0;
    uint crop_pixels = crop_width * crop_height, item = frame->first_item + t;
    uint at = (uint)((ulong)(item % crop_pixels) * frame->pixel_stride % crop_pixels);
    ItemPlace place;
    place.pixel = (frame->crop_y0 + at / crop_width) * frame->width + frame->crop_x0 + at % crop_width;
    place.sample = frame->sample_index + item / crop_pixels;
    return place;
}

#endif
