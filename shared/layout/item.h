/* Which sample of which pixel an item of a pass is. */
#ifndef TWINLIGHT_LAYOUT_ITEM_H
#define TWINLIGHT_LAYOUT_ITEM_H

#include "layout/scene_types.h"

typedef struct ItemPlace {
    uint pixel; /* y * width + x of the whole film */
    uint sample;
} ItemPlace;

/* Cell `i` of an axis of `size` pixels begins with this one: pixel x is of cell x * IMPORTANCE_SIDE / size. */
SHARED_FUNCTION uint cell_begin(uint i, uint size)
{
    return (i * size + IMPORTANCE_SIDE - 1u) / IMPORTANCE_SIDE;
}

/* The cell that visit `slot` is of: the last that does not begin after it. */
SHARED_FUNCTION uint visits_cell(__global const FrameParams *frame, uint slot)
{
    uint first = 0u, last = IMPORTANCE_CELLS - 1u;
    while (first < last) {
        uint middle = (first + last + 1u) / 2u;
        if (frame->visits[middle] <= slot)
            first = middle;
        else
            last = middle - 1u;
    }
    return first;
}

/* Of item `item` counted from the beginning of a pool that visits some pixels more often than others. Visits of one
 * pixel stand behind each other, and each is another sample. */
SHARED_FUNCTION ItemPlace item_place_visited(__global const FrameParams *frame, uint item)
{
    uint width = frame->crop_x1 - frame->crop_x0, height = frame->crop_y1 - frame->crop_y0;
    uint all = frame->visits[IMPORTANCE_CELLS], slot = (uint)((ulong)(item % all) * frame->pixel_stride % all);
    uint cell = visits_cell(frame, slot), column = cell % IMPORTANCE_SIDE, row = cell / IMPORTANCE_SIDE;
    uint x = cell_begin(column, width), y = cell_begin(row, height);
    uint columns = cell_begin(column + 1u, width) - x, rows = cell_begin(row + 1u, height) - y;
    uint each = (frame->visits[cell + 1u] - frame->visits[cell]) / (columns * rows);
    slot -= frame->visits[cell];
    uint at = slot / each;
    ItemPlace place;
    place.pixel = (frame->crop_y0 + y + at / columns) * frame->width + frame->crop_x0 + x + at % columns;
    place.sample = frame->sample_index + item / all * VISITS_MOST + slot % each;
    return place;
}

/* By how much more rarely a pool visits the pixel than if it visited all alike: what a sample there counts for. */
SHARED_FUNCTION float pool_density_ratio(__global const FrameParams *frame, uint pixel)
{
    uint all = frame->visits[IMPORTANCE_CELLS];
    if (all == 0u)
        return 1.0f;
    uint width = frame->crop_x1 - frame->crop_x0, height = frame->crop_y1 - frame->crop_y0;
    uint column = (pixel % frame->width - frame->crop_x0) * IMPORTANCE_SIDE / width;
    uint row = (pixel / frame->width - frame->crop_y0) * IMPORTANCE_SIDE / height;
    uint cell = row * IMPORTANCE_SIDE + column;
    uint pixels = (cell_begin(column + 1u, width) - cell_begin(column, width)) *
                  (cell_begin(row + 1u, height) - cell_begin(row, height));
    uint each = (frame->visits[cell + 1u] - frame->visits[cell]) / pixels;
    return (float)all / ((float)each * (float)(width * height));
}

/* Of pass item `item`. */
SHARED_FUNCTION ItemPlace item_place_of(__global const FrameParams *frame, uint item)
{
    uint crop_width = frame->crop_x1 - frame->crop_x0, crop_height = frame->crop_y1 - frame->crop_y0;
    uint crop_pixels = crop_width * crop_height;
    item += frame->pixel_first;
    if (frame->visits[IMPORTANCE_CELLS] != 0u)
        return item_place_visited(frame, item);
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
