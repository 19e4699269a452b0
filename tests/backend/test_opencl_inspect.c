/* The whole state of every path after every step: the device's equals the CPU's, and --verify notices when it does
 * not. */
#include "backend/test_opencl.h"
#include "support/verify_fixture.h"

#include "backend_ocl.h"
#include "layout/state.h"

#include <string.h>

static const atomic_int NEVER = 0;

/* Media that absorb, scatter and emit, inside each other, in glass and around the camera. */
static const char *const MEDIA_SCENE =
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.01 0.02 0.03 ]\n"
    "\"rgb sigma_s\" [ 0.1 0.2 0.3 ] \"float g\" 0.6\n"
    "MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"float sigma_s\" 0.5\n"
    "\"rgb Le\" [ 3 2 1 ]\n"
    "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 0.5 2 ] \"float sigma_s\" 0\n"
    "MediumInterface \"fog\" LookAt 0 1.2 -6  0 -0.2 0  0 1 0 Camera \"perspective\" \"float fov\" 38\nWorldBegin\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ] AttributeEnd\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]\n"
    "AttributeBegin MediumInterface \"ink\" \"fog\" Translate -1 0 0 Material \"dielectric\" Shape \"sphere\"\n"
    "AttributeEnd MediumInterface \"fire\" \"fog\" Translate 1.2 0 0 Material \"interface\" Shape \"sphere\"\n"
    "MediumInterface \"\" \"fire\" Shape \"sphere\" \"float radius\" 0.4";

/* Grids of one factor, which emits, and of colours, one of them around the camera. */
static const char *const GRID_SCENE =
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
    "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 9 \"integer nz\" 1\n"
    "\"point3 p0\" [ -3 -1 -7 ] \"point3 p1\" [ 3 2 2 ] \"float g\" 0.3 \"rgb sigma_s\" [ 0.2 0.3 0.4 ]\n"
    "\"float density\" [ 1 0 0.2 1 0.1 2 0 0 0.4 1 0.7 1 0.3 0.2 0.1 0.3 0 0.6 ] \"float sigma_a\" 0.05 \"rgb Le\" [ 1 "
    "2 3 ]\n"
    "MakeNamedMedium \"dye\" \"string type\" \"rgbgrid\" \"integer nz\" 3 \"point3 p0\" [ -1 -1 -1 ]\n"
    "\"point3 p1\" [ 1 1 1 ] \"rgb sigma_a\" [ 0.1 0.2 0.4 0 0.5 0 0.7 0 0.1 ]\n"
    "\"rgb sigma_s\" [ 2 1 0 0 0.5 3 1.5 4 1 ]\n"
    "MediumInterface \"smoke\" LookAt 0 1.2 -6  0 -0.2 0  0 1 0 Camera \"perspective\" \"float fov\" 38\nWorldBegin\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -1 2 -1  1 2 -1  -1 2 1  1 2 1 ] AttributeEnd\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]\n"
    "MediumInterface \"dye\" \"smoke\" Material \"interface\" Shape \"sphere\"";

/* Opens the setup on the CPU and on a device. */
static void pair_open(RenderSetup setup, const BackendInterface *device, VerifyPair *pair)
{
    RenderSetup setups[2] = {setup, setup};
    setups[1].backend = device;
    verify_pair_open(setups, pair);
}

/* Scenes that together have every shape, material, light and texture; batches smaller and larger than verify's blocks,
 * and one that is not a multiple of the work-group size. */
START_TEST(test_state_is_the_same)
{
    const struct {
        const char *text;
        uint batch;
        const Integrator *integrator;
        int depth;
        uint items;
    } cases[] = {{OPENCL_TEST_SCENE, 0, integrator_pt(), 7, 20000},
                 {OPENCL_MATERIALS_SCENE, 0, integrator_pt(), 7, 20000},
                 {OPENCL_MATERIALS_SCENE, 1000, integrator_pt(), 7, 20000},
                 {OPENCL_MATERIALS_SCENE, 0, integrator_ibpt(), 5, 3000},
                 {OPENCL_MATERIALS_SCENE, 0, integrator_bdpt(), 4, 3000},
                 {MEDIA_SCENE, 0, integrator_pt(), 7, 3000},
                 {MEDIA_SCENE, 0, integrator_ibpt(), 5, 3000},
                 {MEDIA_SCENE, 0, integrator_bdpt(), 4, 3000},
                 {GRID_SCENE, 0, integrator_pt(), 7, 3000},
                 {GRID_SCENE, 0, integrator_ibpt(), 5, 3000},
                 {GRID_SCENE, 0, integrator_bdpt(), 4, 3000}};
    const bool takes_long = cases[_i].text == GRID_SCENE || (cases[_i].text == MEDIA_SCENE && cases[_i].depth == 5);
    if ((test_effort() == 1 && takes_long) || !test_device_promises())
        return; /* the programs of some scenes only in make check-long */
    RenderSetup setup = {.text = cases[_i].text,
                         .max_depth = cases[_i].depth,
                         .seed = 11,
                         .batch = cases[_i].batch,
                         .integrator = cases[_i].integrator};
    Error error = {0};
    VerifyReport report;
    VerifyPair pair;
    pair_open(setup, backend_ocl(), &pair);
    ck_assert_msg(verify_run(pair.sides, &pair.frame, &pair.list, cases[_i].items, &NEVER, &report, &error), "%s",
                  error.message);
    ck_assert_uint_eq(report.items, cases[_i].items);
    ck_assert_uint_gt(report.prefixes, 9);
    ck_assert_uint_le(report.prefixes, pair.list.count);
    verify_pair_close(&pair);
}
END_TEST

typedef struct SplatSum {
    uint items;
    uint64_t sum;
} SplatSum;

static void splat_sum(void *context, const uint *splats, uint count, uint stride)
{
    SplatSum *sum = context;
    for (uint field = 0; field < SPLAT_WORDS; ++field)
        for (uint t = 0; t < count; ++t)
            sum->sum += (uint64_t)splats[(size_t)field * stride + t] * (field + 1);
    sum->items += count;
}

static void inspect_sum(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride)
{
    (void)first;
    if (buffer == BUFFER_SPLATS)
        splat_sum(context, words, count, stride);
}

/* inspect returns what run adds to the film, for a pass that starts anywhere. */
START_TEST(test_inspect_is_run)
{
    RenderSetup setup = {.text = OPENCL_TEST_SCENE, .max_depth = 5, .batch = 100, .threads = 1};
    SplatSum run = {0}, inspected = {0};
    BackendStatistics before, after;
    Error error = {0};
    VerifyPair pair;
    pair_open(setup, backend_ocl(), &pair);
    Backend *device = pair.sides[1].backend;
    pair.frame.pass.first_item = 123;
    pair.frame.pass.item_count = 357;
    ck_assert(backend_ocl()->run(device, &pair.frame, &pair.list, &(SplatSink){.splats = splat_sum, .context = &run},
                                 &NEVER, NULL, &error));
    backend_ocl()->statistics(device, &before);
    ck_assert(backend_ocl()->inspect(device, &pair.frame, &pair.list, inspect_sum, &inspected, &error));
    backend_ocl()->statistics(device, &after);
    ck_assert_uint_eq(run.items, 357);
    ck_assert_uint_eq(inspected.items, 357);
    ck_assert_uint_eq(run.sum, inspected.sum);
    ck_assert_uint_eq(before.closest_rays, after.closest_rays); /* inspection does not count as rendering */
    verify_pair_close(&pair);
}
END_TEST

/* A device that gets one bit of one word wrong, for an item of the second block, from the first closest-hit step on. */
START_TEST(test_fault_is_named)
{
    RenderSetup setup = {.text = OPENCL_TEST_SCENE, .max_depth = 3};
    const Fault fault = {.kind = STEP_TRACE_CLOSEST, .buffer = BUFFER_HITS, .field = HIT_U, .item = 9000};
    BackendInterface faulty = fault_backend(backend_ocl(), &fault);
    Error error = {0};
    VerifyReport report;
    VerifyPair pair;
    if (!test_device_promises())
        return;
    pair_open(setup, &faulty, &pair);
    ck_assert(!verify_run(pair.sides, &pair.frame, &pair.list, 10000, &NEVER, &report, &error));
    ck_assert_msg(strstr(error.message, "closest hits (segment 1), item 9000: hit u is"), "%s", error.message);
    ck_assert_uint_eq(report.items, 8192);
    verify_pair_close(&pair);
}
END_TEST

/* A batch that cannot be launched is an error, not a difference. */
START_TEST(test_failure)
{
    RenderSetup setup = {.text = OPENCL_TEST_SCENE, .max_depth = 3, .batch = 1024};
    Error error = {0};
    VerifyReport report;
    VerifyPair pair;
    setenv("TWINLIGHT_TEST_FAIL_BATCH", "5", 1);
    pair_open(setup, backend_ocl(), &pair);
    ck_assert(!verify_run(pair.sides, &pair.frame, &pair.list, 5000, &NEVER, &report, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "CL_OUT_OF_RESOURCES"));
    verify_pair_close(&pair);
}
END_TEST

TCase *opencl_inspect_tests(void)
{
    TCase *inspect = tcase_create("inspect");
    tcase_set_timeout(inspect, 120);
    tcase_add_loop_test(inspect, test_state_is_the_same, 0, 11);
    tcase_add_test(inspect, test_inspect_is_run);
    tcase_add_test(inspect, test_fault_is_named);
    tcase_add_test(inspect, test_failure);
    return inspect;
}
