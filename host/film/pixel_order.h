/* The order in which a pass goes through pixels of which it may visit only some. */
#ifndef TWINLIGHT_FILM_PIXEL_ORDER_H
#define TWINLIGHT_FILM_PIXEL_ORDER_H

#include "math/platform.h"

/* The stride s of a picture of width x height pixels, >= 1 each: item k goes to pixel k * s mod (width * height), which
 * are all of them in turn. Wherever it begins and ends, pixels that it visits are spread evenly, and neighbours are
 * visited far apart, as in an ordered dither by the plastic number (Roberts, "The unreasonable effectiveness of
 * quasirandom sequences", 2018). */
uint pixel_order_stride(uint width, uint height);

/* The same for n >= 1 items in a row: s has no common factor with n, and is the golden part of it but for that. */
uint pixel_order_stride_of(uint n);

#endif
