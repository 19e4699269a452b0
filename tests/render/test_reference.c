/* Public scenes against other renderers' images: gray.pbrt is each scene without colour, so that a spectral renderer
 * and this one must agree, and gray_pbrt-v4.exr is pbrt-v4's converged image of it. TungstenRender.exr is Tungsten's
 * image of the coloured scene, in RGB as ours. */
#include "support/render_fixture.h"
#include "support/test_util.h"

typedef struct ReferenceCase {
    const Integrator *(*integrator)(void);
    const char *scene, *reference;
    int max_depth, side; /* segments; pixels of a square film. 0: the scene's */
    unsigned samples; /* at effort 1; multiplied by the effort */
    double block_limit; /* mean relative difference of the means of 16 x 16 blocks; 0: not tested */
    double mean_limit; /* relative difference of the means */
    bool long_only; /* not at effort 1 */
} ReferenceCase;

#define GRAY(folder) folder "/gray.pbrt", folder "/gray_pbrt-v4.exr"
#define CORNELL_COLOR "cornell-box/scene-v4.pbrt", "cornell-box/TungstenRender.exr"

/* Our own noise is part of the difference, and every figure is the mean over 256 blocks, so it hardly changes from seed
 * to seed. With these samples and effort 1, two seeds differ by the following in the same measure, which is sqrt(2)
 * times the noise:
 * pt 0.8 % (cornell-box), 1.6 % (veach-mis), 1.1 % (coffee)
 * ibpt 0.7 % (cornell-box), 1.5 % (veach-mis), 2.1 % (veach-bidir), 1.4 % (cornell-box in colour)
 * bdpt 0.75 %, 2.0 %, 1.7 %, 1.7 %
 * In path tracing, veach-bidir's caustics are too noisy for its blocks to be meaningful; its mean is tested. In
 * veach-mis the means of single images vary by 1 % (ibpt and bdpt at effort 1): lamps smaller than a pixel. */
static const ReferenceCase CASES[] = {
    {integrator_pt, GRAY("cornell-box"), 0, 0, 512, 0.01, 0.01, false},
    {integrator_pt, GRAY("veach-mis"), 0, 0, 512, 0.02, 0.01, false},
    {integrator_pt, GRAY("veach-bidir"), 0, 0, 256, 0.0, 0.02, false},
    {integrator_pt, GRAY("coffee"), 0, 0, 256, 0.05, 0.03, false},
    {integrator_ibpt, GRAY("cornell-box"), 0, 0, 256, 0.01, 0.01, false},
    {integrator_bdpt, GRAY("cornell-box"), 0, 0, 128, 0.01, 0.01, false},
    {integrator_ibpt, GRAY("veach-mis"), 0, 0, 128, 0.02, 0.04, false},
    {integrator_bdpt, GRAY("veach-mis"), 0, 0, 64, 0.02, 0.04, false},
    {integrator_ibpt, GRAY("veach-bidir"), 0, 0, 128, 0.02, 0.02, true},
    {integrator_bdpt, GRAY("veach-bidir"), 0, 0, 64, 0.02, 0.02, true},
    {integrator_ibpt, CORNELL_COLOR, 30, 256, 16, 0.02, 0.01, false},
    {integrator_bdpt, CORNELL_COLOR, 16, 256, 8, 0.02, 0.01, false},
};

START_TEST(test_reference)
{
    const ReferenceCase *test = &CASES[_i];
    char scene[1200], reference_path[1200];
    if ((test->long_only && test_effort() == 1) || !test_public_scene(test->scene, scene, sizeof scene) ||
        !test_public_scene(test->reference, reference_path, sizeof reference_path))
        return;
    RenderSetup setup = {.path = scene,
                         .samples = test->samples * test_effort(),
                         .max_depth = test->max_depth,
                         .width = test->side,
                         .height = test->side,
                         .seed = 3,
                         .integrator = test->integrator()};
    RenderedImage image;
    PictureView view;
    fixture_render(&setup, &image);
    float *reference = fixture_picture_read(reference_path, &view);
    double reference_mean = fixture_block_mean(reference, view.width, 0, 0, view.width, view.height);
    double ratio = fixture_mean(&image) / reference_mean;
    double blocks = fixture_block_difference((PictureView){image.rgb, image.width, image.height}, view, 16);
    fprintf(stderr, "%s, %s: mean %.4f of the reference, blocks differ by %.2f %%\n", test->scene,
            setup.integrator->name, ratio, 100.0 * blocks);
    ck_assert_double_eq_tol(ratio, 1.0, test->mean_limit);
    if (test->block_limit > 0.0)
        ck_assert_double_le(blocks, test->block_limit);
    free(reference);
    fixture_destroy(&image);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("reference");
    TCase *references = tcase_create("references");
    tcase_set_timeout(references, 300 * test_effort());
    tcase_add_loop_test(references, test_reference, 0, (int)(sizeof CASES / sizeof CASES[0]));
    suite_add_tcase(suite, references);
    return test_run(suite);
}
