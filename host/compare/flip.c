/* LDR-FLIP. Sections and equations are those of Andersson et al. 2020. */
#include "compare/display_error.h"

#include "image/plane_filter.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

/* Section 4.1 and table 1: contrast sensitivity in the spatial domain, a sum of terms a sqrt(pi / b) exp(-pi^2 x^2 /
 * b), x in degrees. */
#define SENSITIVITY_B_MAX 0.04
static const double SENSITIVITY[3][2][2] = {
    {{1.0, 0.0047}, {0.0, 1e-5}}, {{1.0, 0.0053}, {0.0, 1e-5}}, {{34.1, 0.04}, {13.5, 0.025}}};

#define COLOR_EXPONENT 0.7 /* q_c */
#define COLOR_KNEE 0.4 /* p_c */
#define COLOR_KNEE_ERROR 0.95 /* p_t */
#define FEATURE_EXPONENT 0.5 /* q_f */
#define FEATURE_DEGREES 0.082 /* w, width of detected edges in degrees */

/* Planes stored per image. */
enum { LIGHTNESS, GREEN_RED, BLUE_YELLOW, ACHROMATIC, EDGES, POINTS, KEPT_PLANES };
enum { SCRATCH_PLANES = 3 };

typedef struct FlipImage {
    int width, height;
    double *planes[KEPT_PLANES]; /* filtered L*, a*, b* with Hunt's adjustment; unfiltered lightness; features */
    double *scratch[SCRATCH_PLANES];
} FlipImage;

/* ---- colour spaces ---------------------------------------------------------------------------------------------- */

/* Linear sRGB to XYZ relative to the white point, which is the matrix's row sums. */
static const double XYZ_FROM_RGB[3][3] = {{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
                                          {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
                                          {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

static void rgb_to_relative_xyz(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; ++i) {
        const double *row = XYZ_FROM_RGB[i];
        xyz[i] = (row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]) / (row[0] + row[1] + row[2]);
    }
}

/* Inverse of rgb_to_relative_xyz, by Cramer's rule. */
static void relative_xyz_to_rgb(const double relative[3], double rgb[3])
{
    const double(*m)[3] = XYZ_FROM_RGB;
    double xyz[3], cofactor[3][3], determinant = 0.0;
    for (int i = 0; i < 3; ++i) {
        xyz[i] = relative[i] * (m[i][0] + m[i][1] + m[i][2]);
        for (int j = 0; j < 3; ++j)
            cofactor[i][j] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                             m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
        determinant += m[i][0] * cofactor[i][0];
    }
    for (int j = 0; j < 3; ++j)
        rgb[j] = (cofactor[0][j] * xyz[0] + cofactor[1][j] * xyz[1] + cofactor[2][j] * xyz[2]) / determinant;
}

/* YCxCz, a linear opponent colour space. */
static void rgb_to_opponent(const double rgb[3], double out[3])
{
    double xyz[3];
    rgb_to_relative_xyz(rgb, xyz);
    out[0] = 116.0 * xyz[1] - 16.0;
    out[1] = 500.0 * (xyz[0] - xyz[1]);
    out[2] = 200.0 * (xyz[1] - xyz[2]);
}

static void opponent_to_rgb(const double in[3], double rgb[3])
{
    double y = (in[0] + 16.0) / 116.0;
    const double xyz[3] = {y + in[1] / 500.0, y, y - in[2] / 200.0};
    relative_xyz_to_rgb(xyz, rgb);
}

/* CIE 1976 L*a*b* with a* and b* multiplied by 0.01 L* (Hunt effect: dark colours look less colourful; equation 4). */
static void rgb_to_hunt_lab(const double rgb[3], double lab[3])
{
    const double delta = 6.0 / 29.0;
    double f[3];
    rgb_to_relative_xyz(rgb, f);
    for (int i = 0; i < 3; ++i)
        f[i] = f[i] > delta * delta * delta ? cbrt(f[i]) : f[i] / (3.0 * delta * delta) + 4.0 / 29.0;
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 0.01 * lab[0] * 500.0 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200.0 * (f[1] - f[2]);
}

/* HyAB distance (equation 5) to the power of q_c. */
static double color_distance(const double a[3], const double b[3])
{
    return pow(fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]), COLOR_EXPONENT);
}

/* ---- one image --------------------------------------------------------------------------------------------------- */

/* Filters a channel by the contrast sensitivity at this viewing distance, normalised over the taps within the
 * radius. */
static void sensitivity_filter(FlipImage *image, int channel, double pixels_per_degree, double *plane)
{
    int radius = (int)ceil(3.0 * sqrt(SENSITIVITY_B_MAX / (2.0 * PI * PI)) * pixels_per_degree);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    double *sum = image->scratch[1], weights = 0.0;
    FilterTaps taps;
    for (size_t i = 0; i < pixels; ++i)
        sum[i] = 0.0;
    for (int term = 0; term < 2; ++term) {
        const double *ab = SENSITIVITY[channel][term];
        double weight = ab[0] * sqrt(PI / ab[1]);
        if (weight == 0.0)
            continue;
        filter_gaussian(&taps, radius, PI * PI / (ab[1] * pixels_per_degree * pixels_per_degree));
        weights += weight * filter_sum(&taps) * filter_sum(&taps);
        plane_filter(plane, image->width, image->height, &taps, &taps, image->scratch[0], image->scratch[2]);
        for (size_t i = 0; i < pixels; ++i)
            sum[i] += weight * image->scratch[2][i];
    }
    for (size_t i = 0; i < pixels; ++i)
        plane[i] = sum[i] / weights;
}

/* Scales the positive taps to a sum of 1 and the negative ones to a sum of -1. */
static void taps_balance(FilterTaps *filter)
{
    double positive = 0.0, negative = 0.0;
    for (int i = 0; i <= 2 * filter->radius; ++i)
        *(filter->taps[i] > 0.0 ? &positive : &negative) += fabs(filter->taps[i]);
    for (int i = 0; i <= 2 * filter->radius; ++i)
        filter->taps[i] /= filter->taps[i] > 0.0 ? positive : negative;
}

/* Magnitude of the gradient of the lightness, with derivative filter `along` and smoothing filter `across`. */
static void gradient_fill(FlipImage *image, const FilterTaps *along, const FilterTaps *across, double *out)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    const double *in = image->planes[ACHROMATIC];
    plane_filter(in, image->width, image->height, along, across, image->scratch[0], image->scratch[1]);
    plane_filter(in, image->width, image->height, across, along, image->scratch[0], image->scratch[2]);
    for (size_t i = 0; i < pixels; ++i)
        out[i] = hypot(image->scratch[1][i], image->scratch[2][i]);
}

/* Section 4.2: detects edges by the first and points by the second derivative of a Gaussian. */
static void features_fill(FlipImage *image, double pixels_per_degree)
{
    double sigma = 0.5 * FEATURE_DEGREES * pixels_per_degree;
    int radius = (int)ceil(3.0 * sigma);
    FilterTaps smooth, edge, point;
    filter_gaussian(&smooth, radius, 0.5 / (sigma * sigma));
    edge = point = smooth;
    for (int i = -radius; i <= radius; ++i) {
        edge.taps[radius + i] *= -i;
        point.taps[radius + i] *= i * i / (sigma * sigma) - 1.0;
    }
    filter_scale(&smooth, 1.0 / filter_sum(&smooth));
    taps_balance(&edge);
    taps_balance(&point);
    gradient_fill(image, &edge, &smooth, image->planes[EDGES]);
    gradient_fill(image, &point, &smooth, image->planes[POINTS]);
}

static void colors_fill(FlipImage *image, const float *rgb, double pixels_per_degree)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    double **planes = image->planes;
    for (size_t i = 0; i < pixels; ++i) {
        const double linear[3] = {(double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]};
        double opponent[3];
        rgb_to_opponent(linear, opponent);
        for (int c = 0; c < 3; ++c)
            planes[c][i] = opponent[c];
        planes[ACHROMATIC][i] = (opponent[0] + 16.0) / 116.0;
    }
    for (int c = 0; c < 3; ++c)
        sensitivity_filter(image, c, pixels_per_degree, planes[c]);
    for (size_t i = 0; i < pixels; ++i) {
        double opponent[3] = {planes[0][i], planes[1][i], planes[2][i]}, linear[3], lab[3];
        opponent_to_rgb(opponent, linear);
        for (int c = 0; c < 3; ++c)
            linear[c] = fmin(fmax(linear[c], 0.0), 1.0);
        rgb_to_hunt_lab(linear, lab);
        for (int c = 0; c < 3; ++c)
            planes[c][i] = lab[c];
    }
}

/* ---- two images -------------------------------------------------------------------------------------------------- */

/* Largest possible distance of two display colours: green to blue. */
static double color_distance_max(void)
{
    const double green[3] = {0.0, 1.0, 0.0}, blue[3] = {0.0, 0.0, 1.0};
    double green_lab[3], blue_lab[3];
    rgb_to_hunt_lab(green, green_lab);
    rgb_to_hunt_lab(blue, blue_lab);
    return color_distance(green_lab, blue_lab);
}

/* Section 4.1.4 (equation 6): maps small distances to most of [0, 1]. */
static double color_error(double distance, double largest)
{
    double knee = COLOR_KNEE * largest;
    if (distance < knee)
        return COLOR_KNEE_ERROR / knee * distance;
    return COLOR_KNEE_ERROR + (distance - knee) / (largest - knee) * (1.0 - COLOR_KNEE_ERROR);
}

static double pixel_flip(const FlipImage *image, const FlipImage *reference, double largest, size_t i)
{
    double a[3], b[3];
    for (int c = 0; c < 3; ++c) {
        a[c] = image->planes[c][i];
        b[c] = reference->planes[c][i];
    }
    double edges = fabs(image->planes[EDGES][i] - reference->planes[EDGES][i]);
    double points = fabs(image->planes[POINTS][i] - reference->planes[POINTS][i]);
    double feature = pow(fmin(fmax(edges, points) / sqrt(2.0), 1.0), FEATURE_EXPONENT);
    return pow(color_error(color_distance(a, b), largest), 1.0 - feature); /* equation 8 */
}

/* Divides `memory` into the planes of both images. */
static void images_lay_out(FlipImage images[2], int width, int height, double *memory)
{
    size_t pixels = (size_t)width * (size_t)height;
    for (int i = 0; i < 2; ++i) {
        images[i].width = width;
        images[i].height = height;
        for (int p = 0; p < KEPT_PLANES; ++p, memory += pixels)
            images[i].planes[p] = memory;
    }
    for (int p = 0; p < SCRATCH_PLANES; ++p, memory += pixels)
        images[0].scratch[p] = images[1].scratch[p] = memory;
}

bool flip_compute(const float *const shown[2], int width, int height, double pixels_per_degree, float *map,
                  double *mean, Error *error)
{
    size_t pixels = (size_t)width * (size_t)height, planes = 2 * KEPT_PLANES + SCRATCH_PLANES;
    double *memory = malloc(planes * pixels * sizeof *memory), largest = color_distance_max(), sum = 0.0;
    if (!memory)
        return error_memory(error, planes * pixels * sizeof *memory, "FLIP");
    FlipImage images[2];
    images_lay_out(images, width, height, memory);
    for (int i = 0; i < 2; ++i) {
        colors_fill(&images[i], shown[i], pixels_per_degree);
        features_fill(&images[i], pixels_per_degree);
    }
    for (size_t i = 0; i < pixels; ++i) {
        double value = pixel_flip(&images[0], &images[1], largest, i);
        sum += value;
        if (map)
            map[i] = (float)value;
    }
    *mean = sum / (double)pixels;
    free(memory);
    return true;
}
