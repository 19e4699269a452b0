/* The film on a device that has 64-bit integer atomics. */
#ifndef TWINLIGHT_FILM_ADD_CL
#define TWINLIGHT_FILM_ADD_CL

#include "camera/film_spread.h"
#include "layout/scene_view.h"

#ifdef atomic_sum_add

/* From: splats. To: added to the sums of the film (film_words). */
__kernel void film_add(__global const FrameParams *frame, __global const uint *tables, __global const uint *splats,
                       __global ulong *words)
{
    uint item = (uint)get_global_id(0);
    if (item >= frame->pass.item_count)
        return;
    FilmView film;
    film.width = frame->film.width;
    film.x0 = frame->film.crop_x0;
    film.y0 = frame->film.crop_y0;
    film.x1 = frame->film.crop_x1;
    film.y1 = frame->film.crop_y1;
    film.exponent = frame->film.exponent;
    film.depth_kinds = frame->film.split_depths;
    film.depth_last = frame->path.max_depth;
    film.reconstruction = frame->film.reconstruction;
    __global const float *lookup = scene_lookup(frame, tables);
    film.axis_x = film_axis_x(&frame->film, lookup);
    film.axis_y = film_axis_y(&frame->film, lookup);
    film_view_words(&film, words, (film.x1 - film.x0) * (film.y1 - film.y0));
    film_splat_add(&film, 0, splats, frame->pass.stride, item);
}

#endif
#endif
