/* The median filter with a threshold (Frolov 2018, section 6), for what impulse noise a long rendering leaves. It is no
 * estimate of the light any more: for looking at, never for figures of error. */
#ifndef TWINLIGHT_IMAGE_DESPECKLE_H
#define TWINLIGHT_IMAGE_DESPECKLE_H

/* out: width x rows x 3, of rows first ... first + rows - 1 of rgb, width x height x 3. A pixel more than `threshold`
 * times as bright as the median of the 3 x 3 pixels around it (luminance; those inside the picture) takes the colour of
 * the pixel that is the median. Others stay. */
void despeckle(const float *rgb, int width, int height, int first, int rows, float threshold, float *out);

#endif
