/* The mean of an even number of independent renderings, as an EXR of half floats, and its error: the mean square
 * difference between the means of the two halves is four times the mean square error of the mean of all.
 * usage: average_images OUT.exr IN... */
#include "compare/metrics.h"
#include "image/image.h"
#include "image/rendering_file.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct Halves {
    int width, height;
    float *rgb[2]; /* sums of the images with even and odd numbers */
} Halves;

static bool image_add(Halves *halves, const char *path, int half, Error *error)
{
    float *rgb, *sum = halves->rgb[half];
    int width, height;
    if (!image_read_rgb(path, &rgb, &width, &height, error))
        return false;
    if (halves->rgb[0] && (width != halves->width || height != halves->height)) {
        free(rgb);
        return error_set(error, "%s has another size than the images before it", path);
    }
    halves->width = width;
    halves->height = height;
    if (!sum) {
        halves->rgb[half] = rgb;
        return true;
    }
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; ++i)
        sum[i] += rgb[i];
    free(rgb);
    return true;
}

/* From sums of n images each to means, and from both the mean to the file. */
static bool halves_finish(Halves *halves, int n, const char *path, Error *error)
{
    size_t count = (size_t)halves->width * (size_t)halves->height * 3;
    Metrics metrics;
    for (size_t i = 0; i < count; ++i) {
        halves->rgb[0][i] /= (float)n;
        halves->rgb[1][i] /= (float)n;
    }
    if (!metrics_compute(halves->rgb[0], halves->rgb[1], halves->width, halves->height, 16, &metrics, error))
        return false;
    printf("%s: relMSE %.2g, without the worst 0.1 %% %.2g; error of the means of 16 x 16 blocks %.2g %%\n", path,
           metrics.rel_mse / 4.0, metrics.rel_mse_trimmed / 4.0, 50.0 * metrics.block_mean);
    return rendering_mean_write(path, halves->rgb, halves->width, halves->height, false, error);
}

int main(int argc, char **argv)
{
    Error error = {0};
    Halves halves = {0};
    if (argc < 4 || argc % 2 != 0) {
        fprintf(stderr, "usage: average_images OUT.exr IN... (an even number)\n");
        return 2;
    }
    bool good = true;
    for (int i = 2; i < argc && good; ++i)
        good = image_add(&halves, argv[i], i % 2, &error);
    good = good && halves_finish(&halves, (argc - 2) / 2, argv[1], &error);
    free(halves.rgb[0]);
    free(halves.rgb[1]);
    if (!good)
        fprintf(stderr, "average_images: %s\n", error.message);
    return good ? 0 : 1;
}
