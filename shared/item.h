/* Which sample of which pixel an item of a pass is. */
#ifndef TWINLIGHT_ITEM_H
#define TWINLIGHT_ITEM_H

#include "scene_types.h"

typedef struct ItemPlace {
    uint pixel; /* y * width + x of the whole film */
    uint sample;
} ItemPlace;

/* Of pass item `item`. */
SHARED_FUNCTION ItemPlace item_place_of(__global const FrameParams *frame, uint item)
{
    uint crop_width = frame->crop_x1 - frame->crop_x0, crop_height = frame->crop_y1 - frame->crop_y0;
    uint crop_pixels = crop_width * crop_height;
    item += frame->pixel_first;
    uint at = (uint)((ulong)(item % crop_pixels) * frame->pixel_stride % crop_pixels);
    ItemPlace place;
    place.pixel = (frame->crop_y0 + at / crop_width) * frame->width + frame->crop_x0 + at % crop_width;
    place.sample = frame->sample_index + item / crop_pixels;
    return place;
}

/* Of item t of a launch. */
SHARED_FUNCTION ItemPlace item_place(__global const FrameParams *frame, uint t)
{
    return item_place_of(frame, frame->first_item + t);
}

#endif
