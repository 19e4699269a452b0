/* Every scene that has an image in scenes/reference/ by every integrator, against that image, which is path traced or
 * bidirectionally path traced (scenes/make_references.sh). */
#include "base/sample_statistics.h"
#include "support/render_fixture.h"
#include "support/test_util.h"

#include <math.h>

enum { INTEGRATORS = 4, SIDE = 32, GRID = 4 };

/* Median relative difference of the means of GRID x GRID blocks that noise explains, for pt, ibpt, bdpt and mmlt with
 * SAMPLES: 1.5 times the largest of eight seeds (1 to 8), but less than for a black image. The median is used because
 * paths that are found once in a million samples make a block or two many times too bright. */
static const struct {
    const char *name;
    double reference; /* mean error of the reference's blocks (docs/SCENES.md); for cornell's pixel filter, 0.01 */
    bool pt_misses; /* path tracing hardly ever finds some of the light, and a few times more samples do not help */
    double noise[INTEGRATORS];
} SCENES[] = {
    {"cornell", 0.010, false, {0.027, 0.029, 0.026, 0.018}}, {"door", 0.014, false, {0.65, 0.49, 0.52, 0.30}},
    {"glossy", 0.012, true, {0.97, 0.50, 0.27, 0.24}},       {"lamp", 0.003, true, {0.80, 0.054, 0.068, 0.099}},
    {"pool", 0.009, false, {0.78, 0.91, 0.95, 0.76}},        {"relief", 0.021, true, {0.61, 0.147, 0.12, 0.105}},
    {"windows", 0.031, true, {0.61, 0.30, 0.38, 0.58}},
};
#define SCENE_COUNT (int)(sizeof SCENES / sizeof SCENES[0])

static const unsigned SAMPLES[INTEGRATORS] = {64, 32, 16, 512};

static double blocks_median(const float *rgb, PictureView reference)
{
    enum { BLOCKS = GRID * GRID, STEP = SIDE / GRID };
    double differences[BLOCKS];
    int wide = reference.width / GRID, high = reference.height / GRID;
    for (int i = 0; i < BLOCKS; ++i) {
        int x = i % GRID, y = i / GRID;
        double a = fixture_block_mean(rgb, SIDE, x * STEP, y * STEP, (x + 1) * STEP, (y + 1) * STEP);
        double b =
            fixture_block_mean(reference.rgb, reference.width, x * wide, y * high, (x + 1) * wide, (y + 1) * high);
        differences[i] = fabs(a - b) / b;
    }
    return sample_quantile(differences, BLOCKS, 0.5);
}

static double noise_limit(int scene, int which)
{
    double noise = SCENES[scene].noise[which];
    if (test_effort() == 1 || (which == 0 && SCENES[scene].pt_misses))
        return noise;
    return noise / sqrt(test_effort()) + SCENES[scene].reference;
}

START_TEST(test_scene)
{
    const Integrator *const integrators[INTEGRATORS] = {integrator_pt(), integrator_ibpt(), integrator_bdpt(),
                                                        integrator_mmlt()};
    const char *name = SCENES[_i / INTEGRATORS].name;
    int which = _i % INTEGRATORS;
    double limit = noise_limit(_i / INTEGRATORS, which);
    char path[1200];
    snprintf(path, sizeof path, "%s/scenes/%s.pbrt", test_source_folder(), name);
    RenderSetup setup = {.path = path,
                         .samples = SAMPLES[which] * test_effort(),
                         .max_depth = 10,
                         .width = SIDE,
                         .height = SIDE,
                         .seed = 1,
                         .integrator = integrators[which]};
    RenderedImage image;
    PictureView view;
    fixture_render(&setup, &image);
    snprintf(path, sizeof path, "%s/scenes/reference/%s.exr", test_source_folder(), name);
    float *reference = fixture_picture_read(path, &view);
    double median = blocks_median(image.rgb, view);
    printf("%-8s %-5s blocks differ by %.2f %%, limit %.2f %%\n", name, integrators[which]->name, 100.0 * median,
           100.0 * limit);
    ck_assert_uint_eq(image.film.not_finite, 0);
    ck_assert_double_le(median, limit);
    free(reference);
    fixture_destroy(&image);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scenes");
    TCase *scenes = tcase_create("scenes");
    tcase_set_timeout(scenes, 120 * test_effort());
    tcase_add_loop_test(scenes, test_scene, 0, SCENE_COUNT * INTEGRATORS);
    suite_add_tcase(suite, scenes);
    return test_run(suite);
}
