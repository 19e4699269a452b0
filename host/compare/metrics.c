#include "compare/metrics.h"

#include "base/sample_statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RELATIVE_FLOOR 0.01 /* keeps the relative error of dark values finite */
#define TILE METRICS_TILE

typedef struct Pixel {
    double image[3], reference[3];
} Pixel;

/* Replaces values that are not finite by 0; returns whether there were any. */
static bool pixel_clean(const float *from, double out[3])
{
    bool damaged = false;
    for (int c = 0; c < 3; ++c) {
        bool finite = isfinite(from[c]);
        out[c] = finite ? (double)from[c] : 0.0;
        damaged = damaged || !finite;
    }
    return damaged;
}

double metrics_relative_square(double square, double reference)
{
    return square / (reference * reference + RELATIVE_FLOOR);
}

static double pixel_rel_mse(const Pixel *p)
{
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
        double difference = p->image[c] - p->reference[c];
        sum += metrics_relative_square(difference * difference, p->reference[c]);
    }
    return sum / 3.0;
}

/* Means over the pixels of a tile whose first one is (x0, y0). */
static Pixel tile_mean(const float *image, const float *reference, int width, int height, int x0, int y0)
{
    Pixel sum = {{0.0}, {0.0}};
    int x1 = x0 + TILE < width ? x0 + TILE : width, y1 = y0 + TILE < height ? y0 + TILE : height;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            Pixel p;
            size_t at = 3 * ((size_t)y * (size_t)width + (size_t)x);
            pixel_clean(image + at, p.image);
            pixel_clean(reference + at, p.reference);
            for (int c = 0; c < 3; ++c) {
                sum.image[c] += p.image[c] / ((x1 - x0) * (y1 - y0));
                sum.reference[c] += p.reference[c] / ((x1 - x0) * (y1 - y0));
            }
        }
    }
    return sum;
}

static double tiles_rel_mse(const float *image, const float *reference, int width, int height)
{
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < height; y += TILE) {
        for (int x = 0; x < width; x += TILE) {
            Pixel p = tile_mean(image, reference, width, height, x, y);
            sum += pixel_rel_mse(&p);
            count += 1.0;
        }
    }
    return sum / count;
}

static void metrics_add(Metrics *metrics, const Pixel *p)
{
    for (int c = 0; c < 3; ++c) {
        double i = p->image[c], r = p->reference[c], difference = fabs(i - r);
        metrics->mse += difference * difference;
        metrics->mape += difference / (fabs(r) + RELATIVE_FLOOR);
        metrics->smape += difference / (0.5 * (fabs(i) + fabs(r)) + RELATIVE_FLOOR);
        metrics->mean_rgb[c] += i;
        metrics->mean_reference_rgb[c] += r;
    }
}

/* Sets both relMSEs from the values of all pixels; sorts the array. */
static void rel_mse_set(Metrics *metrics, double *values, size_t count)
{
    size_t dropped = count / METRICS_TRIMMED_SHARE;
    double kept_sum = 0.0, dropped_sum = 0.0;
    sample_sort(values, count);
    for (size_t i = 0; i < count; ++i)
        *(i < count - dropped ? &kept_sum : &dropped_sum) += values[i];
    metrics->rel_mse = (kept_sum + dropped_sum) / (double)count;
    metrics->rel_mse_trimmed = kept_sum / (double)(count - dropped);
}

int metrics_block_edge(int i, int n, int size)
{
    long long product = (long long)i * size, whole = product / n, twice_rest = 2 * (product % n);
    return (int)(whole + (twice_rest > n || (twice_rest == n && whole % 2 != 0)));
}

/* Mean of a block over pixels and channels. */
static double block_mean(const float *rgb, int width, int x0, int x1, int y0, int y1)
{
    double sum = 0.0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            double values[3];
            pixel_clean(rgb + 3 * ((size_t)y * (size_t)width + (size_t)x), values);
            sum += values[0] + values[1] + values[2];
        }
    }
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
}

void metrics_block_means(const float *rgb, int width, int height, int n, double *means)
{
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            int x0 = metrics_block_edge(i, n, width), x1 = metrics_block_edge(i + 1, n, width);
            int y0 = metrics_block_edge(j, n, height), y1 = metrics_block_edge(j + 1, n, height);
            means[j * n + i] = block_mean(rgb, width, x0, x1, y0, y1);
        }
    }
}

static bool blocks_compare(const float *image, const float *reference, int width, int height, Metrics *metrics,
                           Error *error)
{
    size_t count = (size_t)metrics->blocks * (size_t)metrics->blocks;
    double *means = calloc(2 * count, sizeof *means), floor_value = 0.0;
    if (!means)
        return error_memory(error, 2 * count * sizeof *means, "block means");
    metrics_block_means(image, width, height, metrics->blocks, means);
    metrics_block_means(reference, width, height, metrics->blocks, means + count);
    for (size_t i = 0; i < count; ++i)
        floor_value += means[count + i];
    floor_value = RELATIVE_FLOOR * fabs(floor_value / (double)count);
    for (size_t i = 0; i < count; ++i) {
        double difference = fabs(means[i] - means[count + i]);
        /* for a reference that is black everywhere, equal blocks give 0 and others infinity */
        double relative = difference > 0.0 ? difference / (fabs(means[count + i]) + floor_value) : 0.0;
        metrics->block_mean += relative / (double)count;
        metrics->block_max = fmax(metrics->block_max, relative);
    }
    free(means);
    return true;
}

/* Turns sums over all pixels into means. */
static void metrics_divide(Metrics *metrics, size_t pixels)
{
    double values = 3.0 * (double)pixels;
    metrics->mse /= values;
    metrics->mape /= values;
    metrics->smape /= values;
    for (int c = 0; c < 3; ++c) {
        metrics->mean_rgb[c] /= (double)pixels;
        metrics->mean_reference_rgb[c] /= (double)pixels;
        metrics->mean += metrics->mean_rgb[c] / 3.0;
        metrics->mean_reference += metrics->mean_reference_rgb[c] / 3.0;
    }
}

bool metrics_compute(const float *image, const float *reference, int width, int height, int blocks, Metrics *metrics,
                     Error *error)
{
    size_t pixels = (size_t)width * (size_t)height;
    int shorter = width < height ? width : height;
    *metrics = (Metrics){.blocks = blocks < shorter ? blocks : shorter};
    double *relative = malloc(pixels * sizeof *relative);
    if (!relative)
        return error_memory(error, pixels * sizeof *relative, "figures of error");
    for (size_t i = 0; i < pixels; ++i) {
        Pixel p;
        metrics->not_finite += pixel_clean(image + 3 * i, p.image);
        metrics->not_finite_reference += pixel_clean(reference + 3 * i, p.reference);
        metrics_add(metrics, &p);
        relative[i] = pixel_rel_mse(&p);
    }
    metrics_divide(metrics, pixels);
    rel_mse_set(metrics, relative, pixels);
    metrics->rel_mse_8x8 = tiles_rel_mse(image, reference, width, height);
    free(relative);
    return blocks_compare(image, reference, width, height, metrics, error);
}
