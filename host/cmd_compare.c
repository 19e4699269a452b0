#include "cmd_compare.h"

#include "command.h"
#include "error_image.h"
#include "image.h"
#include "json.h"
#include "metrics.h"
#include "option_values.h"

#include <stdio.h>
#include <stdlib.h>

#define BLOCKS_MAX 4096

typedef struct CompareCommand {
    bool json;
    int blocks;
    const char *output; /* error image, NULL: none */
} CompareCommand;

enum { OPTION_OUTPUT, OPTION_BLOCKS, OPTION_JSON };

static const OptionSpec SPECS[] = {
    [OPTION_OUTPUT] = {"output", 'o', "FILE", "write an error image (.exr or .png)"},
    [OPTION_BLOCKS] = {"blocks", 0, "N", "compare the means of N x N blocks (default 16)"},
    [OPTION_JSON] = {"json", 0, NULL, "print JSON"},
};

static const OptionTable TABLE = {
    "compare",
    "compare [OPTION]... IMAGE REFERENCE",
    "Prints how far IMAGE is from REFERENCE, both EXR, HDR, PFM, PNG, JPEG or TGA.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "Values are linear RGB; those that are not finite count as 0 and are counted.\n"
    "Exit status: 0 compared; 1 an image cannot be read or written, or the sizes differ;\n"
    "2 command line not understood.",
};

/* The two pictures as linear RGB, of one size. */
typedef struct ImagePair {
    int width, height;
    float *image, *reference;
} ImagePair;

static bool option_set(void *context, int index, const char *value, Error *error)
{
    CompareCommand *command = context;
    uint64_t blocks = 0;
    switch (index) {
    case OPTION_OUTPUT:
        command->output = value;
        return error_image_path_check(value, error);
    case OPTION_BLOCKS:
        if (!option_whole("blocks", value, 1, BLOCKS_MAX, &blocks, error))
            return false;
        command->blocks = (int)blocks;
        return true;
    default:
        command->json = true;
        return true;
    }
}

static bool rgb_load(const char *path, int size[2], float **rgb, Error *error)
{
    Image image;
    if (!image_read(path, &image, error))
        return false;
    size[0] = image.width;
    size[1] = image.height;
    bool good = image_linear_rgb(&image, rgb, error);
    image_destroy(&image);
    return good;
}

static bool pair_load(ImagePair *pair, const char *image, const char *reference, Error *error)
{
    int size[2], reference_size[2];
    if (!rgb_load(image, size, &pair->image, error) || !rgb_load(reference, reference_size, &pair->reference, error))
        return false;
    if (size[0] != reference_size[0] || size[1] != reference_size[1]) {
        error_set(error, "the sizes differ: %s has %d x %d pixels, %s has %d x %d", image, size[0], size[1], reference,
                  reference_size[0], reference_size[1]);
        return error_fix(error, "render or crop both to one size");
    }
    pair->width = size[0];
    pair->height = size[1];
    return true;
}

static void text_print(const char *image, const char *reference, const ImagePair *pair, const Metrics *m)
{
    printf("image            %s\nreference        %s\nsize             %d x %d\n", image, reference, pair->width,
           pair->height);
    printf("MSE              %.6g\n", m->mse);
    printf("relMSE           %.6g\n", m->rel_mse);
    printf("relMSE trimmed   %.6g  (without the worst 0.1 %% of pixels)\n", m->rel_mse_trimmed);
    printf("MAPE             %.6g\n", m->mape);
    printf("SMAPE            %.6g\n", m->smape);
    printf("mean             %.6g  (RGB %.6g %.6g %.6g)\n", m->mean, m->mean_rgb[0], m->mean_rgb[1], m->mean_rgb[2]);
    printf("reference mean   %.6g  (RGB %.6g %.6g %.6g)\n", m->mean_reference, m->mean_reference_rgb[0],
           m->mean_reference_rgb[1], m->mean_reference_rgb[2]);
    printf("mean ratio       %.6g\n", m->mean / m->mean_reference);
    printf("blocks           %d x %d: largest relative difference %.4g %%, mean %.4g %%\n", m->blocks, m->blocks,
           100.0 * m->block_max, 100.0 * m->block_mean);
    printf("not finite       %zu pixels, reference %zu\n", m->not_finite, m->not_finite_reference);
}

static void json_rgb(JsonWriter *json, const char *key, const double rgb[3])
{
    json_array_begin(json, key);
    for (int c = 0; c < 3; ++c)
        json_number(json, NULL, rgb[c]);
    json_array_end(json);
}

static void json_print(const char *image, const char *reference, const ImagePair *pair, const Metrics *m)
{
    JsonWriter json;
    json_init(&json, stdout);
    json_object_begin(&json, NULL);
    json_string(&json, "image", image);
    json_string(&json, "reference", reference);
    json_integer(&json, "width", pair->width);
    json_integer(&json, "height", pair->height);
    json_number(&json, "mse", m->mse);
    json_number(&json, "rel_mse", m->rel_mse);
    json_number(&json, "rel_mse_trimmed", m->rel_mse_trimmed);
    json_number(&json, "mape", m->mape);
    json_number(&json, "smape", m->smape);
    json_number(&json, "mean", m->mean);
    json_number(&json, "mean_reference", m->mean_reference);
    json_rgb(&json, "mean_rgb", m->mean_rgb);
    json_rgb(&json, "mean_reference_rgb", m->mean_reference_rgb);
    json_integer(&json, "blocks", m->blocks);
    json_number(&json, "block_max", m->block_max);
    json_number(&json, "block_mean", m->block_mean);
    json_unsigned(&json, "not_finite", m->not_finite);
    json_unsigned(&json, "not_finite_reference", m->not_finite_reference);
    json_object_end(&json);
}

static bool pair_compare(const CompareCommand *command, const char *image, const char *reference, Error *error)
{
    ImagePair pair = {0};
    Metrics metrics;
    bool good = pair_load(&pair, image, reference, error) &&
                metrics_compute(pair.image, pair.reference, pair.width, pair.height, command->blocks, &metrics, error);
    if (good && command->output)
        good = error_image_write(command->output, pair.image, pair.reference, pair.width, pair.height, error);
    if (good)
        (command->json ? json_print : text_print)(image, reference, &pair, &metrics);
    free(pair.image);
    free(pair.reference);
    return good;
}

int cmd_compare(int argc, char **argv, Error *error)
{
    CompareCommand command = {.blocks = 16};
    int first = 0;
    OptionsEnd end = options_parse(&TABLE, argc, argv, option_set, &command, &first, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    if (argc - first != 2) {
        error_set(error, argc - first < 2 ? "compare needs two images" : "compare takes only two images");
        error_fix(error, "write twinlight compare IMAGE REFERENCE");
        return EXIT_USAGE;
    }
    return pair_compare(&command, argv[first], argv[first + 1], error) ? EXIT_OK : EXIT_FAILED;
}
