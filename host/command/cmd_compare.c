#include "command/cmd_compare.h"

#include "base/option_values.h"
#include "base/path_name.h"
#include "command/command.h"
#include "command/output_check.h"
#include "compare/error_image.h"
#include "compare/print.h"
#include "image/rendering_file.h"

#include <stdlib.h>

#define BLOCKS_MAX 4096

typedef struct CompareCommand {
    bool json;
    int blocks;
    const char *output; /* error image; NULL: none */
    const char *side_by_side; /* PNG; NULL: none */
    DisplaySettings display;
} CompareCommand;

enum { OPTION_OUTPUT, OPTION_SIDE_BY_SIDE, OPTION_BLOCKS, OPTION_EXPOSURE, OPTION_PIXELS_PER_DEGREE, OPTION_JSON };

static const OptionSpec SPECS[] = {
    [OPTION_OUTPUT] = {"output", 'o', "FILE", "write an error image (.exr or .png)"},
    [OPTION_SIDE_BY_SIDE] = {"side-by-side", 0, "FILE.png", "write image, reference and error image side by side"},
    [OPTION_BLOCKS] = {"blocks", 0, "N", "compare the means of N x N blocks (default 16)"},
    [OPTION_EXPOSURE] = {"exposure", 0, "STOPS",
                         "for FLIP, SSIM and --side-by-side: multiply values by 2^STOPS (default 0)"},
    [OPTION_PIXELS_PER_DEGREE] = {"pixels-per-degree", 0, "N",
                                  "for FLIP: pixels per degree of visual angle (default 67)"},
    [OPTION_JSON] = {"json", 0, NULL, "print JSON"},
};

static const OptionTable TABLE = {
    "compare",
    "compare [OPTION]... IMAGE REFERENCE",
    "Prints how far IMAGE is from REFERENCE, both EXR, HDR, PFM, PNG, JPEG or TGA.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "Values are linear RGB; pixels that are not finite count as 0, and their number is printed.\n"
    "Exit status: 0 compared; 1 an image cannot be read or written, or the sizes differ;\n"
    "2 invalid command line.",
};

static bool side_by_side_set(CompareCommand *command, const char *value, Error *error)
{
    command->side_by_side = value;
    if (path_ends(value, ".png"))
        return true;
    error_set(error, "--side-by-side=%s: the name does not end in .png", value);
    return error_fix(error, "use --side-by-side=FILE.png");
}

static bool option_set(void *context, int index, const char *value, Error *error)
{
    CompareCommand *command = context;
    uint64_t blocks = 0;
    switch (index) {
    case OPTION_OUTPUT:
        command->output = value;
        return error_image_path_check(value, error);
    case OPTION_SIDE_BY_SIDE:
        return side_by_side_set(command, value, error);
    case OPTION_BLOCKS:
        if (!option_whole("blocks", value, 1, BLOCKS_MAX, &blocks, error))
            return false;
        command->blocks = (int)blocks;
        return true;
    case OPTION_EXPOSURE:
        return option_number("exposure", value, -100.0, 100.0, &command->display.exposure, error);
    case OPTION_PIXELS_PER_DEGREE:
        return option_number("pixels-per-degree", value, 1.0, FLIP_PIXELS_PER_DEGREE_MAX,
                             &command->display.pixels_per_degree, error);
    default:
        command->json = true;
        return true;
    }
}

static bool figures_compute(const CompareCommand *command, const Rendering *image, const Rendering *reference,
                            Comparison *comparison, Error *error)
{
    int width = image->width, height = image->height;
    comparison->width = width;
    comparison->height = height;
    comparison->display = command->display;
    comparison->tested = rendering_has_halves(image) && rendering_has_halves(reference);
    const float *const halves[2][2] = {{image->halves[0], image->halves[1]},
                                       {reference->halves[0], reference->halves[1]}};
    return metrics_compute(image->rgb, reference->rgb, width, height, command->blocks, &comparison->metrics, error) &&
           display_error_compute(image->rgb, reference->rgb, width, height, &command->display,
                                 &comparison->display_error, error) &&
           (!comparison->tested || z_test_compute(halves, width, height, &comparison->test, error));
}

static bool pictures_write(const CompareCommand *command, const Rendering *image, const Rendering *reference,
                           Error *error)
{
    return (!command->output ||
            error_image_write(command->output, image->rgb, reference->rgb, image->width, image->height, error)) &&
           (!command->side_by_side ||
            error_image_side_by_side(command->side_by_side, image->rgb, reference->rgb, image->width, image->height,
                                     command->display.exposure, error));
}

static bool pair_compare(const CompareCommand *command, const char *image_path, const char *reference_path,
                         Error *error)
{
    Rendering image = {0}, reference = {0};
    Comparison comparison = {.image = image_path, .reference = reference_path};
    const CommandFile files[] = {{"the image", image_path, false},
                                 {"the reference", reference_path, false},
                                 {"the error image", command->output, true},
                                 {"the pictures side by side", command->side_by_side, true}};
    bool good = output_files_check(files, sizeof files / sizeof files[0],
                                   "give each its own name, with --output and --side-by-side", error) &&
                rendering_load(image_path, &image, error) && rendering_load(reference_path, &reference, error) &&
                rendering_same_size(&image, image_path, &reference, reference_path, error) &&
                figures_compute(command, &image, &reference, &comparison, error) &&
                pictures_write(command, &image, &reference, error);
    if (good)
        (command->json ? comparison_print_json : comparison_print_text)(&comparison);
    rendering_destroy(&image);
    rendering_destroy(&reference);
    return good;
}

int cmd_compare(int argc, char **argv, Error *error)
{
    CompareCommand command = {.blocks = 16, .display = {.pixels_per_degree = FLIP_PIXELS_PER_DEGREE}};
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
