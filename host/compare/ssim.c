#include "compare/display_error.h"

#include "image/color.h"
#include "image/plane_filter.h"

#include <math.h>
#include <stdlib.h>

#define RADIUS (SSIM_WINDOW / 2)
#define SIGMA 1.5
#define C1 (0.01 * 0.01)
#define C2 (0.03 * 0.03)

/* Planes of local moments under the window. */
enum { MEAN_X, MEAN_Y, SQUARE_X, SQUARE_Y, PRODUCT, SCRATCH, PLANES };

static double luma(const float *rgb)
{
    static const double WEIGHTS[3] = {0.2126, 0.7152, 0.0722};
    double sum = 0.0;
    for (int c = 0; c < 3; ++c)
        sum += WEIGHTS[c] * color_srgb_encode((double)rgb[c]);
    return sum;
}

/* Equation 13 of the paper for one pixel. */
static double similarity(double *const planes[PLANES], size_t i)
{
    double x = planes[MEAN_X][i], y = planes[MEAN_Y][i];
    double variance_x = planes[SQUARE_X][i] - x * x, variance_y = planes[SQUARE_Y][i] - y * y;
    double covariance = planes[PRODUCT][i] - x * y;
    return (2.0 * x * y + C1) * (2.0 * covariance + C2) / ((x * x + y * y + C1) * (variance_x + variance_y + C2));
}

static void moments_fill(const float *image, const float *reference, int width, int height, double *const *planes)
{
    FilterTaps window;
    filter_gaussian(&window, RADIUS, 0.5 / (SIGMA * SIGMA));
    filter_scale(&window, 1.0 / filter_sum(&window));
    size_t pixels = (size_t)width * (size_t)height;
    for (size_t i = 0; i < pixels; ++i) {
        double x = luma(image + 3 * i), y = luma(reference + 3 * i);
        const double values[] = {x, y, x * x, y * y, x * y};
        for (int p = MEAN_X; p <= PRODUCT; ++p)
            planes[p][i] = values[p];
    }
    for (int p = MEAN_X; p <= PRODUCT; ++p)
        plane_filter(planes[p], width, height, &window, &window, planes[SCRATCH], planes[p]);
}

bool ssim_compute(const float *image, const float *reference, int width, int height, double *mean, Error *error)
{
    size_t pixels = (size_t)width * (size_t)height;
    *mean = (double)NAN;
    if (width < SSIM_WINDOW || height < SSIM_WINDOW)
        return true;
    double *memory = malloc(PLANES * pixels * sizeof *memory), *planes[PLANES];
    if (!memory)
        return error_memory(error, PLANES * pixels * sizeof *memory, "structural similarity");
    for (size_t p = 0; p < PLANES; ++p)
        planes[p] = memory + p * pixels;
    moments_fill(image, reference, width, height, planes);
    double sum = 0.0;
    for (int y = RADIUS; y < height - RADIUS; ++y)
        for (int x = RADIUS; x < width - RADIUS; ++x)
            sum += similarity(planes, (size_t)y * (size_t)width + (size_t)x);
    const int inner[2] = {width - 2 * RADIUS, height - 2 * RADIUS};
    *mean = sum / ((double)inner[0] * (double)inner[1]);
    free(memory);
    return true;
}
