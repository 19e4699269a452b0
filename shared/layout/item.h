/* Which sample of which pixel an item of a pass is for. */
#ifndef TWINLIGHT_LAYOUT_ITEM_H
#define TWINLIGHT_LAYOUT_ITEM_H

#include "layout/frame_params.h"

typedef struct ItemPlace {
    uint pixel; /* y * width + x of the whole film */
    uint sample;
} ItemPlace;

/* The first pixel of cell `i` along an axis of `size` pixels: pixel x is in cell x * IMPORTANCE_SIDE / size. */
SHARED_FUNCTION uint cell_begin(uint i, uint size)
{
    return (i * size + IMPORTANCE_SIDE - 1u) / IMPORTANCE_SIDE;
}

/* The cell of visit `slot`: the last cell that does not begin after it. */
SHARED_FUNCTION uint visits_cell(__global const Guide *guide, uint slot)
{
    uint first = 0u, last = IMPORTANCE_CELLS - 1u;
    while (first < last) {
        uint middle = (first + last + 1u) / 2u;
        if (guide->visits[middle] <= slot)
            first = middle;
        else
            last = middle - 1u;
    }
    return first;
}

/* The place of item `item`, counted from the beginning of a pool that visits some pixels more often than others. The
 * visits of one pixel are consecutive, and each is another sample. */
SHARED_FUNCTION ItemPlace item_place_visited(__global const FrameParams *frame, __global const Guide *guide, uint item)
{
    uint width = frame->film.crop_x1 - frame->film.crop_x0, height = frame->film.crop_y1 - frame->film.crop_y0;
    uint all = frame->pool.visits, slot = (uint)((ulong)(item % all) * frame->pass.pixel_stride % all);
    uint cell = visits_cell(guide, slot), column = cell % IMPORTANCE_SIDE, row = cell / IMPORTANCE_SIDE;
    uint x = cell_begin(column, width), y = cell_begin(row, height);
    uint columns = cell_begin(column + 1u, width) - x, rows = cell_begin(row + 1u, height) - y;
    uint each = (guide->visits[cell + 1u] - guide->visits[cell]) / (columns * rows);
    slot -= guide->visits[cell];
    uint at = slot / each;
    ItemPlace place;
    place.pixel = (frame->film.crop_y0 + y + at / columns) * frame->film.width + frame->film.crop_x0 + x + at % columns;
    place.sample = frame->pass.sample_index + item / all * VISITS_MOST + slot % each;
    return place;
}

/* The density ratio of a pool at a pixel: how many times less often the pool visits it than if it visited all pixels
 * equally. Samples there are weighted by it. */
SHARED_FUNCTION float pool_density_ratio(__global const FrameParams *frame, __global const Guide *guide, uint pixel)
{
    uint all = frame->pool.visits;
    if (all == 0u)
        return 1.0f;
    uint width = frame->film.crop_x1 - frame->film.crop_x0, height = frame->film.crop_y1 - frame->film.crop_y0;
    uint column = (pixel % frame->film.width - frame->film.crop_x0) * IMPORTANCE_SIDE / width;
    uint row = (pixel / frame->film.width - frame->film.crop_y0) * IMPORTANCE_SIDE / height;
    uint cell = row * IMPORTANCE_SIDE + column;
    uint pixels = (cell_begin(column + 1u, width) - cell_begin(column, width)) *
                  (cell_begin(row + 1u, height) - cell_begin(row, height));
    uint each = (guide->visits[cell + 1u] - guide->visits[cell]) / pixels;
    return (float)all / ((float)each * (float)(width * height));
}

/* Rows of a band. */
#define BAND_ROWS 8u

/* Pixel `at` in the order of passes that visit all pixels in turn, as an index into the crop's rows: in bands of a few
 * rows, each column by column, so that items of a chunk are near each other in both directions. */
SHARED_FUNCTION uint pixel_in_bands(uint at, uint width, uint height)
{
    uint first = at / (BAND_ROWS * width) * BAND_ROWS, rows = height - first < BAND_ROWS ? height - first : BAND_ROWS;
    uint inside = at - first * width;
    return (first + inside % rows) * width + inside / rows;
}

/* The place of item `item`, counted from the beginning of the pixels' order, if all pixels are visited equally. */
SHARED_FUNCTION ItemPlace item_place_even(__global const FrameParams *frame, uint item)
{
    uint crop_width = frame->film.crop_x1 - frame->film.crop_x0,
         crop_height = frame->film.crop_y1 - frame->film.crop_y0;
    uint crop_pixels = crop_width * crop_height;
    uint at = frame->pass.pixel_stride == 1u
                  ? pixel_in_bands(item % crop_pixels, crop_width, crop_height)
                  : (uint)((ulong)(item % crop_pixels) * frame->pass.pixel_stride % crop_pixels);
    ItemPlace place;
    place.pixel = (frame->film.crop_y0 + at / crop_width) * frame->film.width + frame->film.crop_x0 + at % crop_width;
    place.sample = frame->pass.sample_index + item / crop_pixels;
    return place;
}

/* The place of item `item` of a pass: a pool's, or one that visits all pixels equally. */
SHARED_FUNCTION ItemPlace pool_item_place(__global const FrameParams *frame, __global const Guide *guide, uint item)
{
    item += frame->pass.pixel_first;
    return frame->pool.visits != 0u ? item_place_visited(frame, guide, item) : item_place_even(frame, item);
}

/* The place of item `item` of a launch, in a pass that is no pool's. */
SHARED_FUNCTION ItemPlace item_place(__global const FrameParams *frame, uint item)
{
    return item_place_even(frame, frame->pass.first_item + item + frame->pass.pixel_first);
}

#endif
