#include "image/despeckle.h"

#include "math/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static float luminance(const float *pixel)
{
    return rgb_luminance(vec3(pixel[0], pixel[1], pixel[2]));
}

/* The pixel of median luminance among the 3 x 3 around (x, y), the lower median of an even number. */
static const float *median_around(const float *rgb, int width, int height, int x, int y)
{
    const float *sorted[9] = {rgb};
    int count = 0;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; ++j)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; ++i) {
            const float *pixel = rgb + 3 * ((size_t)j * (size_t)width + (size_t)i);
            int place = count++;
            for (; place > 0 && luminance(sorted[place - 1]) > luminance(pixel); --place)
                sorted[place] = sorted[place - 1];
            sorted[place] = pixel;
        }
    return sorted[(count - 1) / 2];
}

void despeckle(const float *rgb, int width, int height, int first, int rows, float threshold, float *out)
{
    for (int y = first; y < first + rows; ++y)
        for (int x = 0; x < width; ++x, out += 3) {
            size_t pixel = 3 * ((size_t)y * (size_t)width + (size_t)x);
            const float *median = median_around(rgb, width, height, x, y);
            bool speck = luminance(rgb + pixel) > threshold * luminance(median);
            memcpy(out, speck ? median : rgb + pixel, 3 * sizeof *out);
        }
}
