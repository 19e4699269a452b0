/* The film on a device that has 64-bit integer atomics. */
#ifndef TWINLIGHT_FILM_ADD_CL
#define TWINLIGHT_FILM_ADD_CL

#include "camera/film_sum.h"
#include "layout/scene_types.h"

#ifdef atomic_sum_add

/* From: splats. To: added to the sums of the film (film_words). */
__kernel void film_add(__global const FrameParams *frame, __global const uint *splats, __global ulong *words)
{
    uint item = (uint)get_global_id(0);
    if (item >= frame->item_count)
        return;
    FilmView film;
    film.width = frame->width;
    film.x0 = frame->crop_x0;
    film.y0 = frame->crop_y0;
    film.x1 = frame->crop_x1;
    film.y1 = frame->crop_y1;
    film.exponent = frame->film_exponent;
    film.depth_kinds = frame->split_depths;
    film.depth_last = frame->max_depth;
    film_view_words(&film, words, (film.x1 - film.x0) * (film.y1 - film.y0));
    film_splat_add(&film, splats, frame->stride, item);
}

#endif
#endif
