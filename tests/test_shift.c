/* Shifts where surfaces are finer than a thousandth of a segment: what a chain keeps has to be what it kept. */
#include "bidirectional.h"

#include <stdlib.h>

/* A distant light comes from below and passes the floor, at y = 0. A black triangle far away makes the scene large and thereby
 * light tracing rare, so that paths with one vertex from the light, whose z_2 shifts keep, have nearly all of the weight. */
static const char FLOOR[] = BD_FILM "LookAt -1 3 0  -1 0 0  0 0 1 Camera \"perspective\" \"float fov\" 36\n"
                                    "WorldBegin\n"
                                    "LightSource \"distant\" \"point3 from\" [ -.2 -.6 -1.5 ] \"point3 to\" [ 0 0 0 ]\n"
                                    "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                                    "Shape \"trianglemesh\" \"point3 P\" [ 30 0 0  30 1 0  30 0 1 ]\n" BD_GREY
                                    "Shape \"bilinearmesh\" \"point3 P\" [ -3 0 -1  2 0 -1  -3 0 1  2 0 1 ]\n"
                                    "Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.2 0.2 ]\n"
                                    "Shape \"bilinearmesh\" \"point3 P\" [ .1 1 -.5  .3 1 -.5  .1 1 .5  .3 1 .5 ]\n";

/* Bright fins hang from the dark patch at y = 1, so many, as long as they are apart: 0.0008. The floor's pixels see the patch at
 * slants from 0.2 to 2.2, and more and more of what is between the fins is hidden. */
#define FINS 250

static void fins_print(FILE *file)
{
    const double apart = 0.2 / FINS;
    fputs("Material \"diffuse\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\nShape \"trianglemesh\" \"point3 P\" [\n", file);
    for (int i = 0; i < FINS; ++i) {
        double x = 0.1 + i * apart, y = 1.0 - apart;
        fprintf(file, "%.9g 1 -.5  %.9g 1 .5  %.9g %.9g -.5  %.9g %.9g .5\n", x, x, x, y, x, y);
    }
    fputs("] \"integer indices\" [\n", file);
    for (int i = 0; i < 4 * FINS; i += 4)
        fprintf(file, "%d %d %d  %d %d %d\n", i, i + 1, i + 2, i + 1, i + 3, i + 2);
    fputs("]\n", file);
}

/* Quarters of the picture by chains of 64 steps and of 2048 against path tracing. */
START_TEST(test_fins)
{
    char *text;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(file);
    fputs(FLOOR, file);
    fins_print(file);
    fclose(file);
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16, .render = {.text = text, .samples = 512, .max_depth = 3, .threads = 2}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.samples = 1536;
    setup.render.seed = 100;
    setup.render.chains = (ChainOptions){.chains = 64, .steps = _i == 0 ? 64 : 2048, .unblended = true};
    groups_render(&setup, &got);
    for (int quarter = 0; quarter < 4; ++quarter) {
        double mean, error, other, other_error;
        int x = quarter % 2 * 8, y = quarter / 2 * 8;
        groups_block(&got, x, y, x + 8, y + 8, &mean, &error);
        groups_block(&expected, x, y, x + 8, y + 8, &other, &other_error);
        printf("fins, quarter %d %d: %.4g, by path tracing %.4g, ratio %.3f +- %.3f\n", quarter % 2, quarter / 2, mean,
               other, mean / other, hypot(error, other_error) / other);
    }
    fflush(stdout);
    groups_compare(_i == 0 ? "fins, 64 steps" : "fins, 2048 steps", &got, &expected, 2, false);
    groups_destroy(&got);
    groups_destroy(&expected);
    free(text);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shift");
    TCase *fins = tcase_create("fins");
    tcase_set_timeout(fins, 600);
    tcase_add_loop_test(fins, test_fins, 0, 2);
    suite_add_tcase(suite, fins);
    return test_run(suite);
}
