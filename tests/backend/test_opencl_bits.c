/* The same image, bit for bit, on the CPU and on the device. */
#include "backend/test_opencl.h"
#include "support/numerics.h"
#include "support/room_scene.h"

#include "backend_ocl.h"

#include <string.h>

static void films_equal(const char *what, const Film *a, const Film *b)
{
    size_t pixels = film_pixels(a);
    ck_assert_int_eq(a->quantum_exponent, b->quantum_exponent);
    for (size_t i = 0; i < 3 * pixels; ++i)
        if (film_sum_shown(a->sums[i]) != film_sum_shown(b->sums[i]))
            ck_abort_msg("%s: sum %zu differs: %lld on the CPU, %lld on the device", what, i, (long long)a->sums[i],
                         (long long)b->sums[i]);
    for (size_t i = 0; i < pixels; ++i)
        if (film_count(a, i) != film_count(b, i))
            ck_abort_msg("%s: pixel %zu has %u samples on the CPU, %u on the device", what, i, film_count(a, i),
                         film_count(b, i));
    for (size_t i = 0; a->light_sums && i < 3 * pixels; ++i)
        if (film_sum_shown(a->light_sums[i]) != film_sum_shown(b->light_sums[i]))
            ck_abort_msg("%s: the light's sum %zu differs: %lld on the CPU, %lld on the device", what, i,
                         (long long)a->light_sums[i], (long long)b->light_sums[i]);
    ck_assert_uint_eq(a->saturated, b->saturated);
    ck_assert_uint_eq(a->vanished, b->vanished);
    ck_assert_uint_eq(a->not_finite, b->not_finite);
}

static void device_agrees(const char *what, const RenderSetup *setup, const RenderedImage *cpu)
{
    RenderedImage image;
    fixture_render(setup, &image);
    films_equal(what, &cpu->film, &image.film);
    ck_assert_uint_eq(cpu->result.backend.closest_rays, image.result.backend.closest_rays);
    ck_assert_uint_eq(cpu->result.backend.shadow_rays, image.result.backend.shadow_rays);
    ck_assert_uint_eq(cpu->result.samples, image.result.samples);
    for (int i = 0; i < cpu->result.diagnostic_count; ++i)
        ck_assert_uint_eq(cpu->result.diagnostics[i], image.result.diagnostics[i]);
    fixture_destroy(&image);
}

/* Renders on both backends, also with the film on the device if it supports that; film, rays and diagnostics must be
 * equal. */
static void backends_agree(const char *what, RenderSetup setup)
{
    OclDevice device;
    RenderedImage cpu;
    test_device(&device);
    fixture_render(&setup, &cpu);
    ck_assert_msg(fixture_mean(&cpu) > 0.0, "%s: the picture is black", what);
    setup.backend = backend_ocl();
    device_agrees(what, &setup, &cpu);
    setup.film_on_device = true;
    if (device.info.atomics64)
        device_agrees(what, &setup, &cpu);
    fixture_destroy(&cpu);
}

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

START_TEST(test_bits_of_shapes)
{
    if (test_device_promises())
        backends_agree("shapes", (RenderSetup){.text = OPENCL_TEST_SCENE, .samples = 5, .max_depth = 30, .seed = 3});
}
END_TEST

START_TEST(test_bits_of_materials)
{
    if (test_device_promises())
        backends_agree(
            "materials",
            (RenderSetup){.text = OPENCL_MATERIALS_SCENE, .samples = 8, .max_depth = 12, .seed = 1ull << 40});
}
END_TEST

static const Integrator *(*const BIDIRECTIONAL[])(void) = {integrator_ibpt, integrator_bdpt};

/* At effort 1 the first scene, whose lights and shapes command/test_cli.sh compares as well, is left to path tracing:
 * building programs takes most of the time. */
static bool left_to_path_tracing(int i)
{
    return test_effort() == 1 && i < 2;
}

/* The scenes above, by both bidirectional integrators. */
START_TEST(test_bits_of_bidirectional_paths)
{
    if (!left_to_path_tracing(_i) && test_device_promises())
        backends_agree("bidirectional", (RenderSetup){.text = _i < 2 ? OPENCL_TEST_SCENE : OPENCL_MATERIALS_SCENE,
                                                      .samples = 4,
                                                      .max_depth = 6,
                                                      .seed = 11,
                                                      .integrator = BIDIRECTIONAL[_i % 2](),
                                                      .balance = true});
}
END_TEST

/* The same by chains, in both schemes; pools and chains start and end in words that the host reads. */
START_TEST(test_bits_of_chains)
{
    RenderSetup setup = {.text = _i < 2 ? OPENCL_TEST_SCENE : OPENCL_MATERIALS_SCENE,
                         .samples = 48,
                         .max_depth = 6,
                         .seed = 7,
                         .integrator = integrator_mmlt(),
                         .chains = {.chains = 1500, .steps = 9, .pool = 3000, .paper = _i % 2 == 1}};
    if (left_to_path_tracing(_i) || !test_device_promises())
        return;
    backends_agree("chains", setup);
    setup.chains.ungrouped = true;
    setup.chains.order = CHAIN_ORDER_NONE;
    backends_agree("chains, neither sorted nor grouped", setup);
}
END_TEST

/* Openings, which each backend finds by itself. */
START_TEST(test_bits_of_openings)
{
    RenderedImage cpu, image;
    RenderSetup setup = {.text = ROOM_SCENE_TURNED, .samples = 3, .threads = 2, .integrator = integrator_bdpt()};
    if (!test_device_promises())
        return;
    fixture_render(&setup, &cpu);
    ck_assert_uint_eq(cpu.result.openings, 2);
    setup.backend = backend_ocl();
    fixture_render(&setup, &image);
    films_equal("openings", &cpu.film, &image.film);
    fixture_destroy(&image);
    fixture_destroy(&cpu);
}
END_TEST

/* Caustics by photons, those of this rendering and not of an earlier one on the device. */
START_TEST(test_bits_of_photons)
{
    RenderedImage cpu;
    RenderSetup setup = {.text = OPENCL_MATERIALS_SCENE,
                         .samples = 8,
                         .max_depth = 6,
                         .photons = 4096,
                         .integrator = _i == 0 ? integrator_pt() : integrator_mmlt()};
    if (!test_device_promises())
        return;
    fixture_render(&setup, &cpu);
    ck_assert_uint_gt(cpu.result.photons, 1000);
    setup.backend = backend_ocl();
    setup.after_another = true;
    RenderedImage image;
    fixture_render(&setup, &image);
    films_equal("photons", &cpu.film, &image.film);
    fixture_destroy(&image);
    fixture_destroy(&cpu);
}
END_TEST

/* Coincident surfaces: both backends hit the same one everywhere. In make check, test_bvh compares such hits. */
START_TEST(test_bits_of_coincident_surfaces)
{
    if (test_effort() > 1)
        backends_agree("coincident", (RenderSetup){.text = COINCIDENT_SCENE, .samples = 16, .max_depth = 4});
}
END_TEST

/* A quantum so small that most contributions are clamped; one with which sums saturate; one so large that most
 * contributions vanish. */
START_TEST(test_bits_of_sums_out_of_range)
{
    static const int EXPONENTS[] = {-66, -61, 1};
    const Film film = {.quantum_exponent = EXPONENTS[_i]};
    RenderSetup setup = {.text = OPENCL_MATERIALS_SCENE, .samples = 16, .max_depth = 5, .quantum_of = &film};
    RenderedImage image;
    setup.integrator = integrator_ibpt();
    fixture_render(&setup, &image);
    printf("unit 2^%d: %llu clamped, %llu vanished, %zu of %zu pixels full\n", EXPONENTS[_i],
           (unsigned long long)image.film.saturated, (unsigned long long)image.film.vanished,
           film_full_pixels(&image.film), film_pixels(&image.film));
    ck_assert_uint_gt(_i == 0 ? image.film.saturated : _i == 2 ? image.film.vanished : 1001, 1000);
    ck_assert_uint_gt(_i < 2 ? film_full_pixels(&image.film) : 101, 100);
    fixture_destroy(&image);
    if (test_device_promises())
        backends_agree("out of range", setup);
}
END_TEST

/* Every scene of the bidirectional tests, by both integrators; most need a program of their own, so only in make
 * check-long. */
START_TEST(test_bits_of_bidirectional_scenes)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i];
    for (int i = 0; test_effort() > 1 && test_device_promises() && i < 2; ++i)
        backends_agree(scene->name, (RenderSetup){.text = bidirectional_text(scene),
                                                  .samples = 4,
                                                  .max_depth = scene->depth,
                                                  .seed = 5,
                                                  .integrator = BIDIRECTIONAL[i]()});
}
END_TEST

/* The repository's own scenes are compared in command/test_cli.sh. */
static const char *const PUBLIC_SCENES[] = {"cornell-box/gray.pbrt", "veach-mis/gray.pbrt", "veach-bidir/gray.pbrt",
                                            "coffee/gray.pbrt"};

START_TEST(test_bits_of_public_scenes)
{
    static const Integrator *(*const all[])(void) = {integrator_pt, integrator_ibpt, integrator_bdpt};
    char path[1200];
    if (!getenv("SCENES") || !test_device_promises() || !test_public_scene(PUBLIC_SCENES[_i], path, sizeof path))
        return;
    for (int i = 0; i < 3; ++i)
        backends_agree(
            path,
            (RenderSetup){.path = path, .width = 40, .height = 24, .samples = 4, .seed = 7, .integrator = all[i]()});
}
END_TEST

/* ---- any batch, any number of threads, with overlap and without -------------------------------------------------- */

START_TEST(test_bits_for_any_batch)
{
    static const uint BATCHES[] = {33, 63, 100, 1000, 0};
    RenderSetup setup = {.text = OPENCL_TEST_SCENE, .samples = 2, .max_depth = 5, .backend = backend_ocl()};
    RenderedImage reference, image;
    OclDevice device;
    test_device(&device);
    fixture_render(&setup, &reference);
    for (int i = 0; i < 10; ++i) {
        setup.batch = BATCHES[i % 5];
        setup.film_on_device = i >= 5 && device.info.atomics64;
        setup.threads = 1 + 2 * i;
        setenv("TWINLIGHT_OVERLAP", i % 5 >= 3 ? "0" : "1", 1);
        fixture_render(&setup, &image);
        films_equal("another batch", &reference.film, &image.film);
        ck_assert_uint_eq(reference.result.backend.closest_rays, image.result.backend.closest_rays);
        fixture_destroy(&image);
    }
    fixture_destroy(&reference);
}
END_TEST

TCase *opencl_bits_tests(void)
{
    TCase *bits = tcase_create("bits");
    tcase_set_timeout(bits, 600); /* kernels are built on first use */
    tcase_set_tags(bits, "pictures");
    tcase_add_test(bits, test_bits_of_shapes);
    tcase_add_test(bits, test_bits_of_materials);
    tcase_add_test(bits, test_bits_of_coincident_surfaces);
    tcase_add_loop_test(bits, test_bits_of_sums_out_of_range, 0, 3);
    tcase_add_loop_test(bits, test_bits_of_bidirectional_paths, 0, 4);
    tcase_add_loop_test(bits, test_bits_of_chains, 0, 4);
    tcase_add_loop_test(bits, test_bits_of_photons, 0, 2);
    tcase_add_test(bits, test_bits_of_openings);
    tcase_add_loop_test(bits, test_bits_of_public_scenes, 0, 4);
    tcase_add_test(bits, test_bits_for_any_batch);
    return bits;
}

TCase *opencl_bidirectional_tests(void)
{
    TCase *scenes = tcase_create("bits of bidirectional scenes");
    tcase_set_timeout(scenes, 300);
    tcase_set_tags(scenes, "pictures");
    tcase_add_unchecked_fixture(scenes, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(scenes, test_bits_of_bidirectional_scenes, 0, BIDIRECTIONAL_SCENE_COUNT);
    return scenes;
}
