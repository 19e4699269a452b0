/* The trace kernels on an OpenCL device against the same kernels as C, on the rays of random walks: the same bits in
 * every field, and untouched words for items without a ray. */
#include "backend/bvh.h"
#include "geometry/bvh_scenes.h"
#include "geometry/test_bvh.h"
#include "kernels.h"
#include "layout/kernel_list.h"
#include "layout/state.h"
#include "support/opencl_probe.h"
#include "support/walk_kernels.h"

#include <inttypes.h>
#include <string.h>

#define WALKS 2000u
#define STRIDE 2016u
#define BOUNCES 4

static const uint STATE_WORDS[BUFFER_COUNT] = {[BUFFER_PATHS] = WALK_WORDS,
                                               [BUFFER_RAYS] = RAY_WORDS,
                                               [BUFFER_HITS] = HIT_WORDS,
                                               [BUFFER_SHADOWS] = SHADOW_WORDS,
                                               [BUFFER_DIAGNOSTICS] = 1};

static const BufferId CLOSEST[] = {BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS,
                                   BUFFER_BVH,   BUFFER_RAYS,     BUFFER_HITS,   BUFFER_DIAGNOSTICS};
static const BufferId SHADOW[] = {BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES,     BUFFER_TEXELS,
                                  BUFFER_BVH,   BUFFER_SHADOWS,  BUFFER_DIAGNOSTICS};

typedef struct Twin {
    TestScene test;
    FrameParams frame;
    Bvh bvh;
    void *buffers[BUFFER_COUNT];
    size_t words[BUFFER_COUNT];
    OpenclProbe *probe;
    OpenclBuffer *device[BUFFER_COUNT];
} Twin;

static void twin_buffer(Twin *twin, BufferId id, const void *words, size_t count)
{
    twin->buffers[id] = (void *)(uintptr_t)words;
    twin->words[id] = count;
}

static bool device_open(Twin *twin, bool specialised)
{
    static const uint nothing[4];
    char options[4096], message[8192] = "";
    bool absent;
    int used = snprintf(options, sizeof options, "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -I%s/shared",
                        test_source_folder());
    if (specialised)
        snprintf(options + used, sizeof options - (size_t)used, " -DTWINLIGHT_FEATURES=0x%" PRIx64 "ul",
                 frame_features(&twin->frame));
    setenv("POCL_KERNEL_CACHE", "0", 0); /* the cache does not notice changed include files */
    twin->probe = opencl_probe_open("#include \"kernels/trace.cl\"\n", options, message, sizeof message, &absent);
    if (!twin->probe) {
        ck_assert_msg(absent, "%s", message);
        fprintf(stderr, "skipped: %s\n", message);
        return false;
    }
    for (int i = 0; i < BUFFER_COUNT; ++i)
        twin->device[i] = opencl_buffer_create(twin->probe, twin->words[i] > 0 ? twin->buffers[i] : nothing,
                                               twin->words[i] > 0 ? twin->words[i] : 4);
    return true;
}

static bool twin_open(Twin *twin, const BvhCase *entry, bool specialised)
{
    Error error = {0};
    memset(twin, 0, sizeof *twin);
    entry->make(&twin->test);
    const BackendScene *scene = &twin->test.backend;
    ck_assert_msg(bvh_build(scene, &twin->bvh, &error), "%s", error.message);
    twin->frame = *scene->frame;
    twin->frame.pass.stride = STRIDE;
    twin->frame.pass.item_count = WALKS;
    twin_buffer(twin, BUFFER_FRAME, &twin->frame, sizeof twin->frame / sizeof(uint));
    twin_buffer(twin, BUFFER_GEOMETRY, scene->geometry, scene->geometry_words);
    twin_buffer(twin, BUFFER_TABLES, scene->tables, scene->tables_words);
    twin_buffer(twin, BUFFER_TEXELS, scene->texels, scene->texel_words);
    twin_buffer(twin, BUFFER_BVH, twin->bvh.words, twin->bvh.word_count);
    for (int i = BUFFER_PATHS; i < BUFFER_COUNT; ++i)
        if (STATE_WORDS[i] > 0)
            twin_buffer(twin, (BufferId)i, calloc(STATE_WORDS[i] * STRIDE, sizeof(uint)), STATE_WORDS[i] * STRIDE);
    return device_open(twin, specialised);
}

static void twin_close(Twin *twin)
{
    for (int i = 0; i < BUFFER_COUNT; ++i) {
        opencl_buffer_destroy(twin->device[i]);
        if (i >= BUFFER_PATHS)
            free(twin->buffers[i]);
    }
    opencl_probe_close(twin->probe);
    bvh_destroy(&twin->bvh);
    test_scene_destroy(&twin->test);
}

/* Runs the kernel on both over the same rays; returns how many words of `out` differ. */
static uint twin_trace(Twin *twin, unsigned kernel, const char *name, const BufferId *ids, size_t count, BufferId in,
                       BufferId out)
{
    OpenclBuffer *arguments[8];
    double seconds;
    uint differ = 0;
    uint *theirs = malloc(twin->words[out] * sizeof *theirs), *ours = twin->buffers[out];
    ck_assert(theirs != NULL);
    for (size_t i = 0; i < count; ++i)
        arguments[i] = twin->device[ids[i]];
    ck_assert(opencl_buffer_write(twin->probe, twin->device[in], twin->buffers[in], twin->words[in]));
    ck_assert(opencl_buffer_write(twin->probe, twin->device[out], ours, twin->words[out]));
    ck_assert(opencl_probe_launch(twin->probe, name, arguments, count, WALKS, &seconds));
    ck_assert(opencl_buffer_read(twin->probe, twin->device[out], theirs, twin->words[out]));
    kernel_run(kernel, twin->buffers, NULL, WALKS);
    for (size_t i = 0; i < twin->words[out]; ++i)
        differ += ours[i] != theirs[i];
    free(theirs);
    return differ;
}

/* Every seventh item gets no ray. */
static void rays_blank(Twin *twin, BufferId id, uint first)
{
    for (uint t = first; t < WALKS; t += 7u)
        state_store_float(twin->buffers[id], STRIDE, RAY_T_MAX, t, t % 2u == 0u ? 0.0f : -1.0f);
}

static void walks_compare(const BvhCase *entry, bool specialised)
{
    Twin twin;
    uint hits = 0, shadows = 0, met = 0;
    if (twin_open(&twin, entry, specialised)) {
        kernel_loop_walk_start(twin.buffers, NULL, WALKS);
        for (uint bounce = 0; bounce < BOUNCES; ++bounce) {
            if (bounce > 0)
                rays_blank(&twin, BUFFER_RAYS, bounce);
            hits += twin_trace(&twin, KERNEL_trace_closest, "trace_closest", CLOSEST, 8, BUFFER_RAYS, BUFFER_HITS);
            for (uint t = 0; t < WALKS; ++t)
                met += state_load(twin.buffers[BUFFER_HITS], STRIDE, HIT_PRIMITIVE, t) != NONE;
            kernel_loop_walk_extend(twin.buffers, NULL, WALKS);
            rays_blank(&twin, BUFFER_SHADOWS, bounce);
            shadows +=
                twin_trace(&twin, KERNEL_trace_shadow, "trace_shadow", SHADOW, 7, BUFFER_SHADOWS, BUFFER_SHADOWS);
        }
        ck_assert_msg(hits == 0 && shadows == 0, "%s: %u words of hits and %u of shadows differ", entry->name, hits,
                      shadows);
        ck_assert_msg(met > WALKS * BOUNCES / 10, "%s: %u hits", entry->name, met);
    }
    twin_close(&twin);
}

/* Building a program takes longer than running it; together these scenes need every branch of the kernels. */
static const char *const CASES[] = {"huge", "coplanar", "instances", "curves"};
#define CASE_COUNT ((int)(sizeof CASES / sizeof CASES[0]))

static const BvhCase *case_named(const char *name)
{
    for (uint i = 0; i < BVH_CASE_COUNT; ++i)
        if (strcmp(BVH_CASES[i].name, name) == 0)
            return &BVH_CASES[i];
    ck_abort_msg("no case %s", name);
    return NULL;
}

START_TEST(test_same_bits)
{
    walks_compare(case_named(CASES[_i]), true);
}
END_TEST

/* With the features read at run time, as in C. */
START_TEST(test_same_bits_unspecialised)
{
    walks_compare(case_named("instances"), false);
}
END_TEST

TCase *bvh_opencl_tcase(void)
{
    TCase *tcase = tcase_create("OpenCL");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_loop_test(tcase, test_same_bits, 0, CASE_COUNT);
    tcase_add_test(tcase, test_same_bits_unspecialised);
    return tcase;
}
