/* Separable filters over one channel of an image, in double precision. Edge pixels are repeated beyond the border. */
#ifndef TWINLIGHT_IMAGE_PLANE_FILTER_H
#define TWINLIGHT_IMAGE_PLANE_FILTER_H

#define FILTER_RADIUS_MAX 160

/* Taps for offsets -radius ... radius: taps[radius + i] belongs to offset i. */
typedef struct FilterTaps {
    int radius; /* <= FILTER_RADIUS_MAX */
    double taps[2 * FILTER_RADIUS_MAX + 1];
} FilterTaps;

/* taps[radius + i] = exp(-exponent i^2), not normalised. */
void filter_gaussian(FilterTaps *filter, int radius, double exponent);

/* Multiplies all taps by `factor`. */
void filter_scale(FilterTaps *filter, double factor);

double filter_sum(const FilterTaps *filter);

/* out(x, y) = sum over (i, j) of along_x(i) along_y(j) in(x + i, y + j). All three planes have width x height values;
 * `scratch` is overwritten, `out` may be `in`. */
void plane_filter(const double *in, int width, int height, const FilterTaps *along_x, const FilterTaps *along_y,
                  double *scratch, double *out);

#endif
