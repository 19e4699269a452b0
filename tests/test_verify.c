/* Comparing two backends word by word: what is equal passes, and a planted difference is found where it was planted. */
#include "render_fixture.h"
#include "test_util.h"

#include "backend_cpu.h"
#include "kernel_list.h"
#include "path_state.h"
#include "verify.h"

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

static const atomic_int NEVER = 0;

/* A CPU backend whose state is changed in one word, as a kernel with a fault would: from step `step` on. */
typedef struct Fault {
    unsigned kernel;
    BufferId buffer;
    uint field, item;
} Fault;

static Fault fault;

typedef struct FaultSink {
    StateSink sink;
    void *context;
    const FrameParams *frame;
} FaultSink;

static void fault_sink(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride)
{
    const FaultSink *faulty = context;
    uint item = fault.item - faulty->frame->first_item;
    if (buffer == fault.buffer && item >= first && item < first + count)
        ((uint *)(uintptr_t)words)[(size_t)fault.field * stride + item - first] ^= 1u;
    faulty->sink(faulty->context, buffer, words, first, count, stride);
}

static bool fault_inspect(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink,
                          void *context, Error *error)
{
    bool reached = false;
    for (size_t i = 0; i < list->count; ++i)
        reached = reached || (list->steps[i].kind == STEP_KERNEL && list->steps[i].kernel == fault.kernel);
    FaultSink faulty = {sink, context, frame};
    return reached ? backend_cpu()->inspect(backend, frame, list, fault_sink, &faulty, error)
                   : backend_cpu()->inspect(backend, frame, list, sink, context, error);
}

static bool integrator_list(const Scene *scene, const RenderOptions *options, StepList *list, FrameParams *frame,
                            Error *error)
{
    render_frame(integrator_pt(), scene, options, frame);
    return integrator_pt()->list(frame, list, error);
}

/* Verifies the scene on CPU backends of one and three threads, the second with `interface`. */
static bool scene_verify(const BackendInterface *interface, uint64_t items, const atomic_int *stop,
                         VerifyReport *report, Error *error)
{
    RenderSetup setup = {.text = SCENE};
    RenderOptions options = {.max_depth = 6, .seed = 3};
    Scene scene;
    StepList list;
    FrameParams frame;
    fixture_scene(&setup, &scene);
    BackendMember sides[2] = {{backend_cpu(), NULL}, {interface, NULL}};
    for (int i = 0; i < 2; ++i) {
        setup.threads = 1 + 2 * i;
        sides[i].backend = fixture_open(&setup, &scene, error);
        ck_assert_msg(sides[i].backend != NULL, "%s", error->message);
    }
    ck_assert(integrator_list(&scene, &options, &list, &frame, error));
    bool same = verify_run(sides, &frame, &list, items, stop, report, error);
    step_list_destroy(&list);
    for (int i = 0; i < 2; ++i)
        sides[i].interface->close(sides[i].backend);
    scene_destroy(&scene);
    return same;
}

START_TEST(test_equal)
{
    Error error = {0};
    VerifyReport report;
    ck_assert_msg(scene_verify(backend_cpu(), 3 * 64 * 48 * 2, &NEVER, &report, &error), "%s", error.message);
    ck_assert_uint_eq(report.items, 3 * 64 * 48 * 2);
    ck_assert_uint_eq(report.words, PATH_WORDS + RAY_WORDS + HIT_WORDS + SHADOW_WORDS + SPLAT_WORDS);
}
END_TEST

/* In the first block, in a later one, at its last item, in every buffer. */
START_TEST(test_difference_named)
{
    static const struct {
        Fault fault;
        const char *step, *field;
    } cases[] = {
        {{KERNEL_pt_shade_hits, BUFFER_PATHS, PATH_POINT + 1, 77}, "kernel pt_shade_hits (segment 1)", "vertex.y"},
        {{KERNEL_pt_start_paths, BUFFER_RAYS, RAY_T_MAX, 0}, "kernel pt_start_paths (segment 0)", "ray length"},
        {{KERNEL_pt_sample_lights, BUFFER_SHADOWS, RAY_DIRECTION + 2, 8191},
         "kernel pt_sample_lights (segment 1)",
         "shadow ray direction.z"},
        {{KERNEL_pt_extend_paths, BUFFER_PATHS, PATH_PDF_W, 8192}, "kernel pt_extend_paths (segment 1)", "density"},
        {{KERNEL_pt_splat, BUFFER_SPLATS, SPLAT_COLOR, 17000}, "kernel pt_splat (segment 6)", "splat colour.x"},
    };
    BackendInterface faulty = *backend_cpu();
    faulty.inspect = fault_inspect;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        Error error = {0};
        VerifyReport report;
        char item[32];
        fault = cases[i].fault;
        snprintf(item, sizeof item, "item %u:", fault.item);
        ck_assert(!scene_verify(&faulty, 64 * 48 * 6, &NEVER, &report, &error));
        ck_assert_msg(strstr(error.message, cases[i].step) && strstr(error.message, cases[i].field) &&
                          strstr(error.message, item),
                      "case %zu: %s", i, error.message);
    }
}
END_TEST

/* Every word of a path has one name. */
START_TEST(test_field_names)
{
    RenderSetup setup = {.text = SCENE};
    RenderOptions options = {.max_depth = 1};
    Error error = {0};
    Scene scene;
    StepList list;
    FrameParams frame;
    uint named[PATH_WORDS] = {0};
    fixture_scene(&setup, &scene);
    ck_assert(integrator_list(&scene, &options, &list, &frame, &error));
    for (size_t i = 0; i < list.field_count; ++i)
        for (uint k = 0; k < list.fields[i].words; ++k)
            ++named[list.fields[i].first + k];
    for (uint word = 0; word < PATH_WORDS; ++word)
        ck_assert_msg(named[word] == 1, "word %u has %u names", word, named[word]);
    step_list_destroy(&list);
    scene_destroy(&scene);
}
END_TEST

/* A list far longer than any path is compared as far as paths go: were it not, this would take days. */
START_TEST(test_long_list)
{
    RenderSetup setup = {.text = SCENE};
    RenderOptions options = {.max_depth = 65535};
    Error error = {0};
    VerifyReport report;
    Scene scene;
    StepList list;
    FrameParams frame;
    fixture_scene(&setup, &scene);
    BackendMember sides[2] = {{backend_cpu(), NULL}, {backend_cpu(), NULL}};
    for (int i = 0; i < 2; ++i)
        sides[i].backend = fixture_open(&setup, &scene, &error);
    ck_assert(sides[0].backend && sides[1].backend && integrator_list(&scene, &options, &list, &frame, &error));
    ck_assert_msg(verify_run(sides, &frame, &list, 64 * 48, &NEVER, &report, &error), "%s", error.message);
    ck_assert_uint_eq(report.items, 64 * 48);
    ck_assert_msg(report.prefixes > 14 && report.prefixes < 7000, "%llu", (unsigned long long)report.prefixes);
    for (int i = 0; i < 2; ++i)
        backend_cpu()->close(sides[i].backend);
    step_list_destroy(&list);
    scene_destroy(&scene);
}
END_TEST

START_TEST(test_stop)
{
    static const atomic_int stopped = 1;
    Error error = {0};
    VerifyReport report;
    ck_assert(scene_verify(backend_cpu(), 64 * 48, &stopped, &report, &error));
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
    tcase_add_test(tcase, test_stop);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
