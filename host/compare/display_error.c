#include "compare/display_error.h"

#include <math.h>
#include <stdlib.h>

void display_linear(const float *in, size_t count, double exposure_stops, float *out)
{
    double factor = exp2(exposure_stops);
    for (size_t i = 0; i < count; ++i) {
        double value = factor * (double)in[i];
        out[i] = !(value > 0.0) ? 0.0f : value < 1.0 ? (float)value : 1.0f;
    }
}

bool display_error_compute(const float *image, const float *reference, int width, int height,
                           const DisplaySettings *settings, DisplayError *result, Error *error)
{
    size_t values = 3 * (size_t)width * (size_t)height;
    float *shown = malloc(2 * values * sizeof *shown);
    if (!shown)
        return error_memory(error, 2 * values * sizeof *shown, "tone-mapped pictures");
    display_linear(image, values, settings->exposure, shown);
    display_linear(reference, values, settings->exposure, shown + values);
    const float *const both[2] = {shown, shown + values};
    bool good = flip_compute(both, width, height, settings->pixels_per_degree, NULL, &result->flip, error) &&
                ssim_compute(shown, shown + values, width, height, &result->ssim, error);
    free(shown);
    return good;
}
