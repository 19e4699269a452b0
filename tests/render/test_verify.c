/* Word-by-word comparison of two backends: equal states pass, and a planted difference is found where it was
 * planted. */
#include "support/test_util.h"
#include "support/verify_fixture.h"

#include "backend/step_recorder.h"
#include "backend_cpu.h"
#include "layout/kernel_list.h"
#include "path/path_state.h"

#include <string.h>

static const char *const SCENE = "LookAt 0 1 4  0 1 0  0 1 0\n"
                                 "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
                                 "Camera \"perspective\" \"float fov\" 60\nWorldBegin\n"
                                 "LightSource \"infinite\" \"rgb L\" [ 0.3 0.3 0.3 ]\n"
                                 "AttributeBegin\n"
                                 "AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]\n"
                                 "Shape \"disk\" \"float height\" 3 \"float radius\" 0.5\n"
                                 "AttributeEnd\n"
                                 "Material \"dielectric\"\n"
                                 "Shape \"sphere\" \"float radius\" 0.7\n"
                                 "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"
                                 "Shape \"bilinearmesh\" \"point3 P\" [ -9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9 ]\n";

/* Most walks end by Russian roulette, at vertices that the camera sees. */
static const char *const ROOM = "LookAt 0 1 4  0 1 0  0 1 0\n"
                                "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\n"
                                "Camera \"perspective\" \"float fov\" 60\nWorldBegin\n"
                                "AttributeBegin\n"
                                "AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]\n"
                                "Translate 0 3 0  Rotate 90 1 0 0\n"
                                "Shape \"disk\" \"float radius\" 0.5\n"
                                "AttributeEnd\n"
                                "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]\n"
                                "Shape \"bilinearmesh\" \"point3 P\" [ -9 -1 -9  9 -1 -9  -9 -1 9  9 -1 9 ]\n"
                                "Shape \"bilinearmesh\" \"point3 P\" [ -9 4 -9  9 4 -9  -9 4 9  9 4 9 ]\n";

static const atomic_int NEVER = 0;

/* Verifies paths of up to setup->max_depth segments on CPU backends with one and three threads, the second with
 * setup->backend. */
static bool setup_verify(const RenderSetup *setup, uint64_t items, const atomic_int *stop, VerifyReport *report,
                         Error *error)
{
    RenderSetup setups[2] = {*setup, {.threads = 3, .backend = setup->backend}};
    setups[0].threads = 1;
    setups[0].backend = NULL;
    VerifyPair pair;
    verify_pair_open(setups, &pair);
    bool same = verify_run(pair.sides, &pair.frame, &pair.list, items, stop, report, error);
    verify_pair_close(&pair);
    return same;
}

/* Path tracing. */
static bool scene_verify(const BackendInterface *interface, int depth, uint64_t items, const atomic_int *stop,
                         VerifyReport *report, Error *error)
{
    const RenderSetup setup = {.text = SCENE, .max_depth = depth, .seed = 3, .backend = interface};
    return setup_verify(&setup, items, stop, report, error);
}

START_TEST(test_equal)
{
    Error error = {0};
    VerifyReport report;
    ck_assert_msg(scene_verify(backend_cpu(), 6, 3 * 64 * 48 * 2, &NEVER, &report, &error), "%s", error.message);
    ck_assert_uint_eq(report.items, 3 * 64 * 48 * 2);
    ck_assert_uint_eq(report.words, PATH_WORDS + RAY_WORDS + HIT_WORDS + SHADOW_WORDS + SPLAT_WORDS);
}
END_TEST

/* Planted in the first block, in a later one, at its last item, in every buffer. */
START_TEST(test_difference_named)
{
    static const struct {
        Fault fault;
        const char *step, *field;
    } cases[] = {
        {{STEP_KERNEL, KERNEL_pt_shade_hits, BUFFER_PATHS, PATH_POINT + 1, 77},
         "kernel pt_shade_hits (segment 1)",
         "vertex.y"},
        {{STEP_KERNEL, KERNEL_pt_start_paths, BUFFER_RAYS, RAY_T_MAX, 0},
         "kernel pt_start_paths (segment 0)",
         "ray length"},
        {{STEP_KERNEL, KERNEL_pt_sample_lights, BUFFER_SHADOWS, RAY_DIRECTION + 2, 8191},
         "kernel pt_sample_lights (segment 1)",
         "shadow ray direction.z"},
        {{STEP_KERNEL, KERNEL_pt_extend_paths, BUFFER_PATHS, PATH_PDF_W, 8192},
         "kernel pt_extend_paths (segment 1)",
         "density"},
        {{STEP_KERNEL, KERNEL_pt_splat, BUFFER_SPLATS, SPLAT_COLOR, 17000},
         "kernel pt_splat (segment 6)",
         "splat colour.x"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        Error error = {0};
        VerifyReport report;
        char item[32];
        BackendInterface faulty = fault_backend(backend_cpu(), &cases[i].fault);
        snprintf(item, sizeof item, "item %u:", cases[i].fault.item);
        ck_assert(!scene_verify(&faulty, 6, 64 * 48 * 6, &NEVER, &report, &error));
        ck_assert_msg(strstr(error.message, cases[i].step) && strstr(error.message, cases[i].field) &&
                          strstr(error.message, item),
                      "case %zu: %s", i, error.message);
    }
}
END_TEST

/* Every word of a path has exactly one name. */
START_TEST(test_field_names)
{
    FrameParams frame = {.path.max_depth = 1};
    Error error = {0};
    StepList list;
    uint named[PATH_WORDS] = {0};
    ck_assert(integrator_pt()->list(&frame, &list, &error));
    for (size_t i = 0; i < list.field_count; ++i)
        for (uint k = 0; k < list.fields[i].words; ++k)
            ++named[list.fields[i].first + k];
    for (uint word = 0; word < PATH_WORDS; ++word)
        ck_assert_msg(named[word] == 1, "word %u has %u names", word, named[word]);
    step_list_destroy(&list);
}
END_TEST

/* A list far longer than any path is compared only as far as paths go. */
START_TEST(test_long_list)
{
    Error error = {0};
    VerifyReport report;
    ck_assert_msg(scene_verify(backend_cpu(), 65535, 64 * 48, &NEVER, &report, &error), "%s", error.message);
    ck_assert_uint_eq(report.items, 64 * 48);
    ck_assert_msg(report.prefixes > 14 && report.prefixes < 7000, "%llu", (unsigned long long)report.prefixes);
}
END_TEST

/* Kernels leave paths that have ended unchanged: a backend need not skip, and chunks that skip need not be of one
 * size. */
START_TEST(test_unskipped)
{
    const Integrator *integrators[] = {integrator_pt(), integrator_ibpt(), integrator_bdpt()};
    BackendInterface unskipping = unskipping_backend(backend_cpu());
    for (size_t i = 0; i < sizeof integrators / sizeof integrators[0]; ++i) {
        const RenderSetup setup = {
            .text = ROOM, .max_depth = 5, .seed = 3, .integrator = integrators[i], .backend = &unskipping};
        Error error = {0};
        VerifyReport report;
        ck_assert_msg(setup_verify(&setup, 64 * 48 * 2, &NEVER, &report, &error), "%s: %s", integrators[i]->name,
                      error.message);
        ck_assert_uint_eq(report.items, 64 * 48 * 2);
    }
}
END_TEST

START_TEST(test_stop)
{
    static const atomic_int stopped = 1;
    Error error = {0};
    VerifyReport report;
    ck_assert(scene_verify(backend_cpu(), 6, 64 * 48, &stopped, &report, &error));
    ck_assert_uint_eq(report.items, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("verify");
    TCase *tcase = tcase_create("verify");
    tcase_set_timeout(tcase, 60.0);
    tcase_add_test(tcase, test_equal);
    tcase_add_test(tcase, test_difference_named);
    tcase_add_test(tcase, test_field_names);
    tcase_add_test(tcase, test_long_list);
    tcase_add_test(tcase, test_unskipped);
    tcase_add_test(tcase, test_stop);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
