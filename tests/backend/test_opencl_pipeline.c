/* Memory limits, failures during rendering, and the record of spans. */
#include "backend/test_opencl.h"

#include "backend_ocl.h"
#include "device_film.h"

#include <string.h>

static const RenderSetup SMALL = {.text = OPENCL_TEST_SCENE, .samples = 4, .max_depth = 4, .batch = 256};

/* A rendering that may fail. */
typedef struct Attempt {
    Scene scene;
    Film film;
    RenderResult result;
    Backend *backend;
    bool done;
    Error error;
} Attempt;

static void attempt_make(RenderSetup setup, const RenderCallbacks *callbacks, const atomic_int *stop, Attempt *attempt)
{
    memset(attempt, 0, sizeof *attempt);
    setup.backend = backend_ocl();
    fixture_scene(&setup, &attempt->scene);
    const SceneSettings *settings = &attempt->scene.settings;
    ck_assert(film_init(&attempt->film, settings->width, settings->height, settings->crop, &attempt->error));
    attempt->backend = fixture_open(&setup, &attempt->scene, &attempt->error);
    if (!attempt->backend)
        return;
    RenderOptions options = {.samples = setup.samples, .max_depth = setup.max_depth, .stop = stop};
    const RenderTask task = {.integrator = integrator_pt(),
                             .scene = &attempt->scene,
                             .backend = {backend_ocl(), attempt->backend},
                             .options = &options,
                             .callbacks = callbacks};
    attempt->done = render_film(&task, &attempt->film, &attempt->result, &attempt->error);
}

static void attempt_end(Attempt *attempt)
{
    backend_ocl()->close(attempt->backend);
    film_destroy(&attempt->film);
    scene_destroy(&attempt->scene);
}

/* ---- memory ------------------------------------------------------------------------------------------------------ */

START_TEST(test_batch_too_large)
{
    OclDevice device;
    Attempt attempt;
    RenderSetup setup = SMALL;
    test_device(&device);
    setup.batch = 1u << 26; /* the state of this many paths takes 19 GiB */
    if (device.info.allocation_limit > (uint64_t)setup.batch * 43 * 4)
        return;
    attempt_make(setup, NULL, NULL, &attempt);
    ck_assert(attempt.backend && !attempt.done);
    ck_assert_ptr_nonnull(strstr(attempt.error.message, "the state of 67108864 paths takes"));
    const char *fix = strstr(attempt.error.fix, "--batch=");
    ck_assert_msg(fix != NULL, "%s", attempt.error.fix);
    ck_assert_uint_eq(attempt.result.samples, 0);
    attempt_end(&attempt);
    unsigned long advice = strtoul(fix + strlen("--batch="), NULL, 10); /* the suggested batch must fit */
    ck_assert(advice > 0 && (double)advice * 43 * 4 <= (double)device.info.allocation_limit);
}
END_TEST

/* Sizes that no machine has: limits are checked before anything is allocated. */
START_TEST(test_scene_too_large)
{
    FrameParams frame;
    memset(&frame, 0, sizeof frame);
    OclDevice device;
    DeviceMemory memory;
    Error error = {0};
    Bvh bvh = {0};
    test_device(&device);
    BackendScene scene = {.frame = &frame, .geometry_words = device.info.allocation_limit / 4 + 1};
    ck_assert(!device_memory_init(&memory, NULL, NULL, &device, &scene, &bvh, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "geometry"));
    ck_assert_ptr_nonnull(strstr(error.message, "largest single buffer"));
    ck_assert_ptr_nonnull(strstr(error.fix, "--backend=cpu"));
    device_memory_destroy(&memory);
    device.info.memory = device.info.allocation_limit;
    scene.geometry_words = scene.texel_words = device.info.allocation_limit / 8;
    bvh.word_count = 1000;
    ck_assert(!device_memory_init(&memory, NULL, NULL, &device, &scene, &bvh, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the scene"));
    device_memory_destroy(&memory);
}
END_TEST

/* A list with many splats per item has smaller batches, whose splats fit the memory that is reserved. */
START_TEST(test_batch_of_many_splats)
{
    static const uint SECTIONS[] = {1, 64, 3000, 16384};
    Step steps[16384];
    for (int i = 0; i < 16384; ++i)
        steps[i] = (Step){.kind = STEP_SPLAT};
    const DeviceMemory memory = {.batch = 1u << 20, .splat_words = 1u << 26};
    for (int i = 0; i < 4; ++i) {
        StepList list = {.steps = steps, .count = SECTIONS[i] - 1, .words_per_item[BUFFER_SPLATS] = SPLAT_WORDS};
        uint batch = device_memory_batch(&memory, &list);
        uint64_t words = (uint64_t)device_memory_stride(batch) * SPLAT_WORDS * SECTIONS[i];
        ck_assert_uint_eq(step_list_splats(&list), SECTIONS[i]);
        ck_assert_uint_ge(batch, 256);
        ck_assert_uint_le(words, memory.splat_words);
        if (i == 0)
            ck_assert_uint_eq(batch, memory.batch);
        else /* hardly any is left unused */
            ck_assert_uint_ge(words + 200ull * SPLAT_WORDS * SECTIONS[i], memory.splat_words);
    }
}
END_TEST

START_TEST(test_film_too_large)
{
    OclDevice device;
    DeviceMemory memory = {.device = &device};
    Error error = {0};
    test_device(&device);
    ck_assert(!device_memory_reserve_film(&memory, device.info.allocation_limit + 1, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the sums of the film take"));
    ck_assert_ptr_nonnull(strstr(error.fix, "--film=host"));
    memory.bytes = device.info.memory;
    ck_assert(!device_memory_reserve_film(&memory, 4096, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "4.00 KiB; the device has room for 0 bytes"));
}
END_TEST

START_TEST(test_film_without_atomics)
{
    OclDevice device;
    Error error = {0};
    test_device(&device);
    device.info.atomics64 = true;
    ck_assert(device_film_check(&device, &error));
    device.info.atomics64 = false;
    ck_assert(!device_film_check(&device, &error));
    ck_assert_ptr_nonnull(strstr(error.message, device.info.name));
    ck_assert_ptr_nonnull(strstr(error.message, "cl_khr_int64_base_atomics"));
    ck_assert_ptr_nonnull(strstr(error.fix, "--film=host"));
}
END_TEST

/* ---- failure and stop -------------------------------------------------------------------------------------------- */

/* Batch 0 is the pilot's first; 4096 pilot paths are 16 batches. The film holds exactly the batches finished before the
 * failure. */
START_TEST(test_failure_on_the_way)
{
    Attempt attempt;
    char number[16];
    snprintf(number, sizeof number, "%d", 16 + _i);
    setenv("TWINLIGHT_TEST_FAIL_BATCH", number, 1);
    attempt_make(SMALL, NULL, NULL, &attempt);
    ck_assert(attempt.backend && !attempt.done);
    ck_assert_ptr_nonnull(strstr(attempt.error.message, "CL_OUT_OF_RESOURCES"));
    ck_assert_ptr_nonnull(strstr(attempt.error.fix, "--batch"));
    ck_assert_uint_eq(attempt.result.samples, 256u * (unsigned)_i);
    ck_assert_uint_eq(film_samples(&attempt.film), attempt.result.samples);
    attempt_end(&attempt);
}
END_TEST

/* With the film on the device, a failed pass contributes nothing, and the passes before it everything. */
START_TEST(test_failure_with_film_on_device)
{
    OclDevice device;
    Attempt attempt;
    RenderSetup setup = SMALL;
    test_device(&device);
    setup.film_on_device = true;
    setup.samples = 70; /* three passes; the first has 16384 paths, 64 batches after the pilot's 16 */
    if (!device.info.atomics64)
        return;
    setenv("TWINLIGHT_TEST_FAIL_BATCH", _i == 0 ? "20" : "81", 1);
    attempt_make(setup, NULL, NULL, &attempt);
    ck_assert(attempt.backend && !attempt.done);
    ck_assert_ptr_nonnull(strstr(attempt.error.message, "CL_OUT_OF_RESOURCES"));
    ck_assert_uint_eq(attempt.result.samples, _i == 0 ? 0u : 16384u);
    ck_assert_uint_eq(film_samples(&attempt.film), attempt.result.samples);
    attempt_end(&attempt);
}
END_TEST

static atomic_int stop_flag;

static void stop_set(void *context, const RenderProgress *progress)
{
    (void)context;
    (void)progress;
    stop_flag = 1;
}

START_TEST(test_stop)
{
    Attempt attempt;
    RenderSetup setup = SMALL;
    RenderCallbacks callbacks = {.progress = stop_set};
    OclDevice device;
    test_device(&device);
    setup.samples = 1000000;
    setup.film_on_device = _i == 1 && device.info.atomics64;
    stop_flag = 0;
    attempt_make(setup, &callbacks, &stop_flag, &attempt);
    ck_assert_msg(attempt.done, "%s", attempt.error.message);
    ck_assert(attempt.result.stopped);
    ck_assert_uint_gt(attempt.result.samples, 0);
    ck_assert_uint_eq(film_samples(&attempt.film), attempt.result.samples);
    attempt_end(&attempt);
}
END_TEST

/* ---- the record -------------------------------------------------------------------------------------------------- */

/* Kernels in one queue do not overlap; a batch is computed, then copied, then added. */
START_TEST(test_spans)
{
    Attempt attempt;
    RenderSetup setup = SMALL;
    const BackendSpan *spans = NULL;
    uint64_t dropped = 1, batch_end[64] = {0}, copied[64] = {0};
    int tracks[3] = {0};
    setup.record_spans = true;
    attempt_make(setup, NULL, NULL, &attempt);
    ck_assert_msg(attempt.done, "%s", attempt.error.message);
    size_t count = backend_ocl()->spans(attempt.backend, &spans, &dropped);
    ck_assert(count > 0 && dropped == 0);
    for (size_t i = 0; i < count; ++i) {
        const BackendSpan *span = &spans[i];
        TEST_TRUE(span->begin <= span->end && span->name && span->batch < 64);
        ++tracks[span->track];
        if (span->track == SPAN_COMPUTE && span->batch > 0 && span->end > batch_end[span->batch])
            batch_end[span->batch] = span->end;
        if (span->track == SPAN_COPY)
            copied[span->batch] = span->end;
    }
    ck_assert_int_eq(tracks[SPAN_COPY], 16 + 8); /* 1920 samples in batches of 256 */
    ck_assert_int_ge(tracks[SPAN_FILM], tracks[SPAN_COPY]);
    ck_assert_int_ge(tracks[SPAN_COMPUTE], 10 * tracks[SPAN_COPY]);
    for (size_t i = 0; i < count; ++i) {
        const BackendSpan *span = &spans[i];
        if (span->track == SPAN_COPY)
            TEST_TRUE(span->begin >= batch_end[span->batch]);
        if (span->track == SPAN_FILM) /* host spans use another clock */
            TEST_TRUE(span->begin + 1000000 >= copied[span->batch]);
    }
    ck_assert(attempt.result.backend.ray_seconds > 0.0);
    ck_assert(attempt.result.backend.ray_seconds < attempt.result.seconds + 60.0);
    attempt_end(&attempt);
}
END_TEST

START_TEST(test_no_spans_unless_asked)
{
    Attempt attempt;
    const BackendSpan *spans;
    uint64_t dropped;
    attempt_make(SMALL, NULL, NULL, &attempt);
    ck_assert_msg(attempt.done, "%s", attempt.error.message);
    ck_assert_uint_eq(backend_ocl()->spans(attempt.backend, &spans, &dropped), 0);
    attempt_end(&attempt);
}
END_TEST

TCase *opencl_pipeline_tests(void)
{
    TCase *pipeline = tcase_create("pipeline");
    tcase_set_timeout(pipeline, 120);
    tcase_add_test(pipeline, test_batch_too_large);
    tcase_add_test(pipeline, test_scene_too_large);
    tcase_add_test(pipeline, test_batch_of_many_splats);
    tcase_add_test(pipeline, test_film_too_large);
    tcase_add_test(pipeline, test_film_without_atomics);
    tcase_add_loop_test(pipeline, test_failure_on_the_way, 0, 4);
    tcase_add_loop_test(pipeline, test_failure_with_film_on_device, 0, 2);
    tcase_add_loop_test(pipeline, test_stop, 0, 2);
    tcase_add_test(pipeline, test_spans);
    tcase_add_test(pipeline, test_no_spans_unless_asked);
    return pipeline;
}
