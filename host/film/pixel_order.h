/* The order in which a pass visits pixels if it may visit only some of them. */
#ifndef TWINLIGHT_FILM_PIXEL_ORDER_H
#define TWINLIGHT_FILM_PIXEL_ORDER_H

#include "math/platform.h"

/* The stride s for an image of width x height pixels, both >= 1: item k goes to pixel k * s mod (width * height), which
 * visits all pixels in turn. The pixels of any contiguous range of items are spread evenly, and neighbours are visited
 * far apart, as in an ordered dither by the plastic number (Roberts, "The unreasonable effectiveness of quasirandom
 * sequences", 2018). */
uint pixel_order_stride(uint width, uint height);

/* The same for n >= 1 items in a row: s is the first number from n / phi (golden ratio) on that is coprime to n. */
uint pixel_order_stride_of(uint n);

#endif
