/* How far the pictures of two programs, A and B, with the same seeds differ in block means, and how much of that is
 * noise.
 *
 * usage: block_difference BLOCKS A1.exr B1.exr A2.exr B2.exr ...: pairs with the same seed. For a block, let d be the
 * difference of its mean in one pair, relative to its mean over all B plus 0.01 of the picture's mean; m the mean of d
 * over the pairs; and e the standard error of m. Prints one line:
 *   the largest |m| of all blocks, and its e;
 *   the largest |m| - T e, or 0, where T is Student's value for p = 0.01 of all blocks together;
 *   |m| and e of the whole picture, relative to its mean;
 *   the root mean square of d between two seeds of B, most of which cancels if seeds are equal. */
#include "bench_util.h"

#include "base/student.h"
#include "compare/metrics.h"
#include "image/read.h"

#include <math.h>
#include <string.h>

#define BLOCKS_MAX 16
#define PAIRS_MAX 64
#define PROBABILITY 0.01 /* of all blocks together (Bonferroni) */

typedef struct Means {
    double value[BLOCKS_MAX * BLOCKS_MAX];
} Means;

static void means_read(const char *path, int blocks, Means *means)
{
    Error error = {0};
    float *rgb;
    int width, height;
    if (!image_read_rgb(path, &rgb, &width, &height, &error))
        bench_fail(error.message);
    metrics_block_means(rgb, width, height, blocks, means->value);
    free(rgb);
}

/* Mean difference of a block over all pairs, relative to `scale`, and its standard error. */
typedef struct Difference {
    double mean, error;
} Difference;

static Difference difference_of(const double *a, const double *b, int pairs, double scale)
{
    Difference d = {0.0, 0.0};
    double squares = 0.0;
    for (int g = 0; g < pairs; ++g)
        d.mean += (a[g] - b[g]) / scale / pairs;
    for (int g = 0; g < pairs; ++g)
        squares += pow((a[g] - b[g]) / scale - d.mean, 2.0);
    d.error = sqrt(squares / (pairs - 1) / pairs);
    return d;
}

/* Mean squared difference between two seeds' values, relative to scale^2. */
static double spread_of(const double *b, int pairs, double mean, double scale)
{
    double spread = 0.0;
    for (int g = 0; g < pairs; ++g)
        spread += 2.0 * pow((b[g] - mean) / scale, 2.0) / (pairs - 1);
    return spread;
}

static double mean_of(const double *values, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
        sum += values[i];
    return sum / count;
}

int main(int argc, char **argv)
{
    static Means a, b;
    static double block_a[BLOCKS_MAX * BLOCKS_MAX][PAIRS_MAX], block_b[BLOCKS_MAX * BLOCKS_MAX][PAIRS_MAX];
    double picture_a[PAIRS_MAX], picture_b[PAIRS_MAX], beyond = 0.0, seeds = 0.0;
    int blocks = argc > 1 ? atoi(argv[1]) : 0, pairs = (argc - 2) / 2, cells = blocks * blocks;
    if (blocks < 1 || blocks > BLOCKS_MAX || pairs < 4 || pairs > PAIRS_MAX || argc % 2 != 0)
        bench_fail("usage: block_difference BLOCKS A1.exr B1.exr ... (four pairs or more)");
    for (int g = 0; g < pairs; ++g) {
        means_read(argv[2 + 2 * g], blocks, &a);
        means_read(argv[3 + 2 * g], blocks, &b);
        picture_a[g] = mean_of(a.value, cells);
        picture_b[g] = mean_of(b.value, cells);
        for (int k = 0; k < cells; ++k) {
            block_a[k][g] = a.value[k];
            block_b[k][g] = b.value[k];
        }
    }
    double whole = mean_of(picture_b, pairs), deviations = student_threshold(PROBABILITY / cells, pairs - 1);
    Difference largest = {0.0, 0.0}, picture = difference_of(picture_a, picture_b, pairs, whole);
    for (int k = 0; k < cells; ++k) {
        double mean = mean_of(block_b[k], pairs), scale = mean + 0.01 * whole;
        Difference d = difference_of(block_a[k], block_b[k], pairs, scale);
        if (fabs(d.mean) >= fabs(largest.mean))
            largest = d;
        beyond = fmax(beyond, fabs(d.mean) - deviations * d.error);
        seeds += spread_of(block_b[k], pairs, mean, scale) / cells;
    }
    printf("%.2e\t%.2e\t%.2e\t%.2e\t%.2e\t%.2e\n", fabs(largest.mean), largest.error, beyond, fabs(picture.mean),
           picture.error, sqrt(seeds));
    return EXIT_SUCCESS;
}
