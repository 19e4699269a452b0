/* How far two programs' pictures of the same seeds are apart, in block means, and how much of that is noise.
 *
 * usage: block_difference BLOCKS A1.exr B1.exr A2.exr B2.exr ...: pairs of the same seed. With d the difference of a
 * block's mean in one pair, over the mean that all B have there plus 0.01 of the picture's, m the mean of d over the pairs
 * and e its standard error, prints one line:
 *   largest |m| of all blocks, its e, and the largest |m| - T e above zero, T Student's value for p = 0.01 of all blocks
 *   together; the root mean square of d that two seeds of one program differ by, which the same seed takes away. */
#include "bench_util.h"

#include "image.h"
#include "metrics.h"

#include <math.h>
#include <string.h>

#define BLOCKS_MAX 16
#define PAIRS_MAX 64

typedef struct Means {
    double value[BLOCKS_MAX * BLOCKS_MAX];
} Means;

static void means_read(const char *path, int blocks, Means *means)
{
    Image image;
    Error error = {0};
    float *rgb;
    if (!image_read(path, &image, &error) || !image_linear_rgb(&image, &rgb, &error))
        bench_fail(error.message);
    for (int j = 0; j < blocks; ++j)
        for (int i = 0; i < blocks; ++i) {
            int x0 = metrics_block_edge(i, blocks, image.width), x1 = metrics_block_edge(i + 1, blocks, image.width);
            int y0 = metrics_block_edge(j, blocks, image.height), y1 = metrics_block_edge(j + 1, blocks, image.height);
            double sum = 0.0;
            for (int y = y0; y < y1; ++y)
                for (int k = 3 * (y * image.width + x0); k < 3 * (y * image.width + x1); ++k)
                    sum += (double)rgb[k];
            means->value[j * blocks + i] = sum / (3.0 * (x1 - x0) * (y1 - y0));
        }
    free(rgb);
    image_destroy(&image);
}

/* Student's two-sided value for p = 0.01 / 64 with 3, 7 and 15 degrees of freedom, as tables have it. */
static double student(int pairs)
{
    return pairs >= 16 ? 5.0 : pairs >= 8 ? 7.2 : 18.0;
}

int main(int argc, char **argv)
{
    static Means a[PAIRS_MAX], b[PAIRS_MAX];
    int blocks = argc > 1 ? atoi(argv[1]) : 0, pairs = (argc - 2) / 2;
    if (blocks < 1 || blocks > BLOCKS_MAX || pairs < 4 || pairs > PAIRS_MAX || argc % 2 != 0)
        bench_fail("usage: block_difference BLOCKS A1.exr B1.exr ... (four pairs or more)");
    for (int g = 0; g < pairs; ++g) {
        means_read(argv[2 + 2 * g], blocks, &a[g]);
        means_read(argv[3 + 2 * g], blocks, &b[g]);
    }
    int cells = blocks * blocks;
    double whole = 0.0, largest = -1.0, error_there = 0.0, beyond = 0.0, seeds = 0.0;
    for (int k = 0; k < cells; ++k)
        for (int g = 0; g < pairs; ++g)
            whole += b[g].value[k] / (cells * pairs);
    for (int k = 0; k < cells; ++k) {
        double mean = 0.0, m = 0.0, squares = 0.0, spread = 0.0;
        for (int g = 0; g < pairs; ++g)
            mean += b[g].value[k] / pairs;
        for (int g = 0; g < pairs; ++g)
            m += (a[g].value[k] - b[g].value[k]) / (mean + 0.01 * whole) / pairs;
        for (int g = 0; g < pairs; ++g) {
            squares += pow((a[g].value[k] - b[g].value[k]) / (mean + 0.01 * whole) - m, 2.0);
            spread += 2.0 * pow((b[g].value[k] - mean) / (mean + 0.01 * whole), 2.0) / (pairs - 1);
        }
        double error = sqrt(squares / (pairs - 1) / pairs);
        if (fabs(m) > largest) {
            largest = fabs(m);
            error_there = error;
        }
        beyond = fmax(beyond, fabs(m) - student(pairs) * error);
        seeds += spread / cells;
    }
    printf("%.2e\t%.2e\t%.2e\t%.2e\n", largest, error_there, beyond, sqrt(seeds));
    return EXIT_SUCCESS;
}
