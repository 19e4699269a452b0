/* The thread pool: the same items and the same bits for any number of threads; counters; stopping; denormals. */
#include "backend/group.h"
#include "backend_cpu.h"
#include "geometry/geometry_suites.h"
#include "kernels.h"
#include "layout/kernel_list.h"
#include "layout/state.h"
#include "rays_embree.h"
#include "support/geometry_fixture.h"
#include "support/walk_kernels.h"

#include <pthread.h>
#include <string.h>

#define ITEMS 5003u

/* The kernels of walks as steps of a list. */
enum { KERNEL_walk_start = KERNEL_COUNT, KERNEL_walk_extend, KERNEL_walk_splat };

/* What the CPU backend calls in this program, which runs no other kernels: being defined here, it is not taken from
 * kernels.c in the backend's library. */
void kernel_run(unsigned kernel, void *const *buffers, const uint *items, uint count)
{
    switch (kernel) {
    case KERNEL_walk_start:
        kernel_loop_walk_start(buffers, items, count);
        break;
    case KERNEL_walk_extend:
        kernel_loop_walk_extend(buffers, items, count);
        break;
    case KERNEL_walk_splat:
        kernel_loop_walk_splat(buffers, items, count);
        break;
    default:
        ck_abort_msg("kernel %u is not one of walks", kernel);
    }
}

static const Step WALK_STEPS[] = {{.kind = STEP_KERNEL, .kernel = KERNEL_walk_start},
                                  {.kind = STEP_TRACE_CLOSEST},
                                  {.kind = STEP_KERNEL, .kernel = KERNEL_walk_extend},
                                  {.kind = STEP_TRACE_CLOSEST},
                                  {.kind = STEP_KERNEL, .kernel = KERNEL_walk_extend},
                                  {.kind = STEP_TRACE_CLOSEST},
                                  {.kind = STEP_SKIP_IF_IDLE, .target = 8},
                                  {.kind = STEP_KERNEL, .kernel = KERNEL_walk_extend},
                                  {.kind = STEP_TRACE_SHADOW},
                                  {.kind = STEP_KERNEL, .kernel = KERNEL_walk_splat}};

static StepList walk_list(void)
{
    StepList list = {.steps = WALK_STEPS, .count = sizeof WALK_STEPS / sizeof *WALK_STEPS};
    list.words_per_item[BUFFER_PATHS] = WALK_WORDS;
    list.words_per_item[BUFFER_RAYS] = RAY_WORDS;
    list.words_per_item[BUFFER_HITS] = HIT_WORDS;
    list.words_per_item[BUFFER_SHADOWS] = SHADOW_WORDS;
    list.words_per_item[BUFFER_SPLATS] = SPLAT_WORDS;
    return list;
}

typedef struct Collector {
    pthread_mutex_t mutex;
    uint splats[ITEMS][SPLAT_WORDS];
    uint seen[ITEMS];
    uint outside;
} Collector;

static void collect(void *context, const uint *splats, uint count, uint stride)
{
    Collector *collector = context;
    pthread_mutex_lock(&collector->mutex);
    for (uint t = 0; t < count; ++t) {
        uint item = state_load(splats, stride, SPLAT_PIXEL, t);
        if (item >= ITEMS) {
            ++collector->outside;
            continue;
        }
        ++collector->seen[item];
        for (uint field = 0; field < SPLAT_WORDS; ++field)
            collector->splats[item][field] = state_load(splats, stride, field, t);
    }
    pthread_mutex_unlock(&collector->mutex);
}

/* Runs items [first, end) on `threads` threads. */
static void walk_run(const TestScene *test, int threads, uint first, uint end, Collector *collector)
{
    static const atomic_int never = 0;
    Error error = {0};
    const BackendInterface *interface = backend_cpu();
    BackendOptions options = {.threads = threads};
    Backend *backend = interface->open(&test->backend, &options, &error);
    ck_assert_msg(backend != NULL, "%s", error.message);
    FrameParams frame = *test->backend.frame;
    StepList list = walk_list();
    uint64_t done = 0;
    frame.pass.first_item = first;
    frame.pass.item_count = end - first;
    ck_assert(interface->run(backend, &frame, &list, &(SplatSink){.splats = collect, .context = collector}, &never,
                             &done, &error));
    ck_assert_uint_eq(done, end - first);
    BackendStatistics statistics;
    interface->statistics(backend, &statistics);
    ck_assert_int_eq(statistics.threads, threads);
    ck_assert_uint_eq(statistics.closest_rays, 3 * (uint64_t)(end - first));
    ck_assert_uint_gt(statistics.shadow_rays, 0);
    ck_assert(statistics.ray_seconds > 0.0);
    interface->close(backend);
}

static void walk_scene(TestScene *test, float scale)
{
    TestMesh mesh = mesh_star(8, 11, 0.3f, 200);
    mesh_map(&mesh, scale, vec3_splat(0.0f));
    test_scene_init(test);
    test_scene_mesh(test, &mesh, 0);
    test_scene_finish(test);
    mesh_destroy(&mesh);
}

START_TEST(test_same_bits_for_any_threads)
{
    static const int threads[] = {1, 2, 3, 8};
    static Collector results[5];
    TestScene test;
    walk_scene(&test, 1.0f);
    for (uint i = 0; i < 5; ++i)
        pthread_mutex_init(&results[i].mutex, NULL);
    for (uint i = 0; i < 4; ++i)
        walk_run(&test, threads[i], 0, ITEMS, &results[i]);
    /* The same in two runs, divided off chunk borders. */
    walk_run(&test, 2, 0, 1777, &results[4]);
    walk_run(&test, 2, 1777, ITEMS, &results[4]);
    for (uint i = 0; i < 5; ++i) {
        ck_assert_uint_eq(results[i].outside, 0);
        for (uint item = 0; item < ITEMS; ++item)
            ck_assert_uint_eq(results[i].seen[item], 1);
        ck_assert_msg(memcmp(results[i].splats, results[0].splats, sizeof results[0].splats) == 0, "run %u differs", i);
    }
    test_scene_destroy(&test);
}
END_TEST

/* A stop before the first chunk: nothing is delivered, and the backend still works afterwards. */
START_TEST(test_stop)
{
    static Collector collector;
    static const atomic_int stopped = 1, never = 0;
    Error error = {0};
    TestScene test;
    BackendOptions options = {.threads = 2};
    uint64_t done = 99;
    walk_scene(&test, 1.0f);
    pthread_mutex_init(&collector.mutex, NULL);
    Backend *backend = backend_cpu()->open(&test.backend, &options, &error);
    ck_assert(backend != NULL);
    FrameParams frame = *test.backend.frame;
    StepList list = walk_list();
    frame.pass.first_item = 0;
    frame.pass.item_count = 600;
    ck_assert(backend_cpu()->run(backend, &frame, &list, &(SplatSink){.splats = collect, .context = &collector},
                                 &stopped, &done, &error));
    ck_assert_uint_eq(done, 0);
    ck_assert(backend_cpu()->run(backend, &frame, &list, &(SplatSink){.splats = collect, .context = &collector}, &never,
                                 &done, &error));
    ck_assert_uint_eq(done, 600);
    frame.pass.item_count = 0;
    ck_assert(backend_cpu()->run(backend, &frame, &list, &(SplatSink){.splats = collect, .context = &collector}, &never,
                                 &done, &error));
    ck_assert_uint_eq(done, 0);
    backend_cpu()->close(backend);
    test_scene_destroy(&test);
}
END_TEST

static atomic_int stop_now;

/* A sink that requests a stop. */
static void collect_and_stop(void *context, const uint *splats, uint count, uint stride)
{
    collect(context, splats, count, stride);
    stop_now = 1;
}

/* A stop during a chunk that has already delivered some splats: the chunk is completed, so that the film contains no
 * partial chunks, unless the pass is useless after a stop (`whole`). */
START_TEST(test_stop_in_chunk)
{
    static const Step steps[] = {{.kind = STEP_KERNEL, .kernel = KERNEL_walk_start},
                                 {.kind = STEP_KERNEL, .kernel = KERNEL_walk_splat},
                                 {.kind = STEP_SPLAT},
                                 {.kind = STEP_TRACE_CLOSEST},
                                 {.kind = STEP_KERNEL, .kernel = KERNEL_walk_splat}};
    static Collector collector;
    BackendOptions options = {.threads = 1};
    Error error = {0};
    TestScene test;
    uint64_t done = 99;
    walk_scene(&test, 1.0f);
    Backend *backend = backend_cpu()->open(&test.backend, &options, &error);
    FrameParams frame = *test.backend.frame;
    StepList list = walk_list();
    list.steps = steps;
    list.count = sizeof steps / sizeof *steps;
    frame.pass.item_count = ITEMS;
    for (int whole = 0; whole < 2; ++whole) {
        memset(collector.seen, 0, sizeof collector.seen);
        stop_now = 0;
        SplatSink sink = {.splats = collect_and_stop, .context = &collector, .whole = whole == 1};
        ck_assert(backend_cpu()->run(backend, &frame, &list, &sink, &stop_now, &done, &error));
        ck_assert_uint_eq(collector.seen[0], whole ? 1 : 2);
        ck_assert_uint_eq(collector.seen[ITEMS - 1], 0);
        ck_assert(whole ? done == 0 : done > 0 && done < ITEMS);
    }
    backend_cpu()->close(backend);
    test_scene_destroy(&test);
}
END_TEST

/* Counters are summed over all threads and persist from run to run. */
START_TEST(test_diagnostics)
{
    static Collector collector;
    static const atomic_int never = 0;
    static const Step steps[] = {{.kind = STEP_KERNEL, .kernel = KERNEL_walk_start},
                                 {.kind = STEP_KERNEL, .kernel = KERNEL_walk_splat}};
    Error error = {0};
    TestScene test;
    BackendOptions options = {.threads = 3};
    uint64_t counters[DIAGNOSTIC_COUNT];
    walk_scene(&test, 1.0f);
    pthread_mutex_init(&collector.mutex, NULL);
    Backend *backend = backend_cpu()->open(&test.backend, &options, &error);
    ck_assert(backend != NULL);
    FrameParams frame = *test.backend.frame;
    StepList list = walk_list();
    list.steps = steps;
    list.count = 2;
    frame.pass.first_item = 0;
    frame.pass.item_count = ITEMS;
    for (int i = 0; i < 2; ++i)
        ck_assert(backend_cpu()->run(backend, &frame, &list, &(SplatSink){.splats = collect, .context = &collector},
                                     &never, NULL, &error));
    backend_cpu()->diagnostics(backend, counters);
    ck_assert_uint_eq(counters[DIAGNOSTIC_ZERO_DIRECTION], 2 * (uint64_t)ITEMS);
    ck_assert_uint_eq(counters[DIAGNOSTIC_NOT_FINITE], 0);
    backend_cpu()->close(backend);
    test_scene_destroy(&test);
}
END_TEST

typedef struct DenormalSum {
    pthread_mutex_t mutex;
    uint chunks, kept;
} DenormalSum;

/* Runs on the worker's own thread: the smallest denormals survive addition, multiplication and comparison. */
static void denormal_sink(void *context, const uint *splats, uint count, uint stride)
{
    DenormalSum *sum = context;
    volatile float tiny = bits_float(3u), half = 0.5f;
    bool kept = float_bits(tiny + tiny) == 6u && float_bits(bits_float(0x00800000u) * half) == 0x00400000u &&
                tiny > 0.0f && tiny - bits_float(2u) == bits_float(1u);
    (void)splats;
    (void)count;
    (void)stride;
    pthread_mutex_lock(&sum->mutex);
    ++sum->chunks;
    sum->kept += kept;
    pthread_mutex_unlock(&sum->mutex);
}

START_TEST(test_denormals_kept)
{
    static const atomic_int never = 0;
    Error error = {0};
    TestScene test;
    DenormalSum sum = {.chunks = 0};
    BackendOptions options = {.threads = 4};
    walk_scene(&test, 1.0f);
    pthread_mutex_init(&sum.mutex, NULL);
    Backend *backend = backend_cpu()->open(&test.backend, &options, &error);
    ck_assert(backend != NULL);
    FrameParams frame = *test.backend.frame;
    StepList list = walk_list();
    frame.pass.first_item = 0;
    frame.pass.item_count = ITEMS;
    ck_assert(backend_cpu()->run(backend, &frame, &list, &(SplatSink){.splats = denormal_sink, .context = &sum}, &never,
                                 NULL, &error));
    ck_assert_uint_gt(sum.chunks, 4);
    ck_assert_uint_eq(sum.kept, sum.chunks);
    backend_cpu()->close(backend);
    test_scene_destroy(&test);
}
END_TEST

/* Directions and whole scenes so small that products are denormal: Embree and brute force agree, and this thread's
 * floating-point mode is unchanged. */
START_TEST(test_denormal_rays)
{
    TestRandom random = {.seed = 210};
    Error error = {0};
    uint differ = 0, met = 0;
    for (uint k = 0; k < 3; ++k) {
        TestScene test;
        walk_scene(&test, k == 0 ? 1.0f : k == 1 ? 1e-9f : 3e-10f);
        RaysEmbree *rays = rays_embree_create(&test.backend, 1, &error);
        ck_assert(rays != NULL);
        for (uint i = 0; i < 20000; ++i) {
            float length = k == 0 ? 1e-37f : k == 1 ? 1e-25f : 1.0f;
            Ray ray = {vec3_splat(0.0f), vec3_scale(random_direction(&random), length), FLOAT_MAX};
            Hit a = rays_embree_closest(rays, &ray), b = brute_force(&test, &ray);
            differ += !hit_same(&a, &b);
            met += b.primitive != NONE;
        }
        rays_embree_destroy(rays);
        test_scene_destroy(&test);
    }
    volatile float tiny = bits_float(1u);
    ck_assert(float_bits(tiny + tiny) == 2u);
    ck_assert_uint_gt(met, 50000);
    ck_assert_msg(differ == 0, "%u differ, %u hit", differ, met);
}
END_TEST

/* A group of several CPU backends, one of which may fail in every pass. */
static Backend *group_open(const TestScene *test, const BackendInterface *last, size_t count)
{
    Error error = {0};
    BackendMember members[3];
    for (size_t i = 0; i < count; ++i) {
        BackendOptions options = {.threads = 1 + (int)i};
        members[i].interface = i + 1 == count ? last : backend_cpu();
        members[i].backend = backend_cpu()->open(&test->backend, &options, &error);
        ck_assert_msg(members[i].backend != NULL, "%s", error.message);
    }
    Backend *group = backend_group_create(members, count, &error);
    ck_assert(group != NULL);
    return group;
}

/* Three members, twelve passes of various sizes: every item once, and the bits of a single backend. */
START_TEST(test_group_same_bits)
{
    static Collector alone, together;
    static const atomic_int never = 0;
    TestScene test;
    Error error = {0};
    const BackendInterface *interface = backend_group_interface();
    walk_scene(&test, 1.0f);
    pthread_mutex_init(&alone.mutex, NULL);
    pthread_mutex_init(&together.mutex, NULL);
    walk_run(&test, 2, 0, ITEMS, &alone);
    Backend *group = group_open(&test, backend_cpu(), 3);
    StepList list = walk_list();
    FrameParams frame = *test.backend.frame;
    uint first = 0;
    for (uint pass = 1; first < ITEMS; ++pass) {
        uint count = pass * 113u < ITEMS - first ? pass * 113u : ITEMS - first;
        uint64_t done = 0;
        frame.pass.first_item = first;
        frame.pass.item_count = count;
        ck_assert(interface->run(group, &frame, &list, &(SplatSink){.splats = collect, .context = &together}, &never,
                                 &done, &error));
        ck_assert_uint_eq(done, count);
        first += count;
    }
    for (uint item = 0; item < ITEMS; ++item)
        ck_assert_uint_eq(together.seen[item], 1);
    ck_assert(memcmp(alone.splats, together.splats, sizeof alone.splats) == 0);
    BackendStatistics statistics;
    interface->statistics(group, &statistics);
    ck_assert_int_eq(statistics.threads, 1 + 2 + 3);
    ck_assert_uint_eq(statistics.closest_rays, 3 * (uint64_t)ITEMS);
    ck_assert(strstr(statistics.device, " + ") != NULL);
    interface->close(group);
    test_scene_destroy(&test);
}
END_TEST

static bool failing_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                        const atomic_int *stop, uint64_t *items_done, Error *error)
{
    (void)backend, (void)frame, (void)list, (void)sink, (void)stop;
    *items_done = 0;
    return error_set(error, "the device is lost");
}

/* One member fails: its error is returned, and the other members' items are delivered and counted. */
START_TEST(test_group_member_fails)
{
    static Collector collector;
    static const atomic_int never = 0;
    TestScene test;
    Error error = {0};
    BackendInterface failing = *backend_cpu();
    failing.run = failing_run;
    walk_scene(&test, 1.0f);
    pthread_mutex_init(&collector.mutex, NULL);
    Backend *group = group_open(&test, &failing, 3);
    StepList list = walk_list();
    FrameParams frame = *test.backend.frame;
    uint64_t done = 0, seen = 0;
    frame.pass.first_item = 0;
    frame.pass.item_count = ITEMS;
    ck_assert(!backend_group_interface()->run(
        group, &frame, &list, &(SplatSink){.splats = collect, .context = &collector}, &never, &done, &error));
    ck_assert_str_eq(error.message, "error: the device is lost");
    for (uint item = 0; item < ITEMS; ++item)
        seen += collector.seen[item];
    ck_assert_uint_eq(seen, done);
    ck_assert_uint_gt(done, ITEMS / 2);
    ck_assert_uint_lt(done, ITEMS);
    backend_group_interface()->close(group);
    test_scene_destroy(&test);
}
END_TEST

TCase *geometry_backend_tcase(void)
{
    TCase *tcase = tcase_create("CPU backend");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_test(tcase, test_same_bits_for_any_threads);
    tcase_add_test(tcase, test_stop);
    tcase_add_test(tcase, test_stop_in_chunk);
    tcase_add_test(tcase, test_diagnostics);
    tcase_add_test(tcase, test_group_same_bits);
    tcase_add_test(tcase, test_group_member_fails);
    tcase_add_test(tcase, test_denormals_kept);
    tcase_add_test(tcase, test_denormal_rays);
    return tcase;
}
