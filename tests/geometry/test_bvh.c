/* The devices' hierarchy against the CPU backend's path through Embree: random walks of eight bounces; every field of
 * every hit and every visibility result from both. The traversal is compiled as C from the text that a device
 * compiles. */
#include "backend/bvh.h"
#include "geometry/bvh_scenes.h"
#include "geometry/test_bvh.h"
#include "kernels.h"
#include "layout/kernel_list.h"
#include "layout/state.h"
#include "rays_embree.h"
#include "support/walk_kernels.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#define BOUNCES 8
#define BLOCK 500u /* walks at a time */
#define THREADS 2

static const uint WALK_BUFFER_WORDS[BUFFER_COUNT] = {
    [BUFFER_PATHS] = WALK_WORDS, [BUFFER_RAYS] = RAY_WORDS, [BUFFER_HITS] = HIT_WORDS, [BUFFER_SHADOWS] = SHADOW_WORDS};

typedef struct Comparison {
    const TestScene *test;
    const RaysEmbree *rays;
    const Bvh *bvh;
    uint blocks;
    atomic_uint next_block;
    atomic_uint hits, shadows; /* number of differences */
    atomic_uint traced, met, occluded;
} Comparison;

/* State of a block of walks, with a copy of the results for either path. */
typedef struct WalkState {
    FrameParams frame;
    void *buffers[BUFFER_COUNT];
    uint hits[HIT_WORDS * BLOCK], shadows[SHADOW_WORDS * BLOCK]; /* Embree's results */
} WalkState;

static void walk_state_init(WalkState *state, const Comparison *comparison)
{
    const BackendScene *scene = &comparison->test->backend;
    memset(state, 0, sizeof *state);
    state->frame = *scene->frame;
    state->frame.pass.stride = BLOCK;
    state->frame.pass.item_count = BLOCK;
    for (int i = 0; i < BUFFER_COUNT; ++i)
        state->buffers[i] = WALK_BUFFER_WORDS[i] > 0 ? calloc(WALK_BUFFER_WORDS[i] * BLOCK, sizeof(uint)) : NULL;
    state->buffers[BUFFER_FRAME] = &state->frame;
    state->buffers[BUFFER_GEOMETRY] = (void *)(uintptr_t)scene->geometry;
    state->buffers[BUFFER_TABLES] = (void *)(uintptr_t)scene->tables;
    state->buffers[BUFFER_TEXELS] = (void *)(uintptr_t)scene->texels;
    state->buffers[BUFFER_BVH] = comparison->bvh->words;
}

static void walk_state_destroy(WalkState *state)
{
    for (int i = BUFFER_PATHS; i < BUFFER_COUNT; ++i)
        free(state->buffers[i]);
}

/* Items without a ray must leave the hit buffer untouched, so both start from the same contents. */
static void closest_compare(Comparison *comparison, WalkState *state)
{
    uint *hits = state->buffers[BUFFER_HITS];
    memcpy(state->hits, hits, sizeof state->hits);
    kernel_run(KERNEL_trace_closest, state->buffers, NULL, BLOCK);
    atomic_fetch_add(&comparison->traced, rays_embree_trace_closest(comparison->rays, state->buffers[BUFFER_RAYS],
                                                                    state->hits, NULL, NULL, BLOCK, BLOCK));
    uint differ = 0, met = 0;
    for (uint t = 0; t < BLOCK; ++t) {
        uint different = 0;
        for (uint field = 0; field < HIT_WORDS; ++field)
            different |= state_load(hits, BLOCK, field, t) ^ state_load(state->hits, BLOCK, field, t);
        differ += different != 0u;
        met += state_load(hits, BLOCK, HIT_PRIMITIVE, t) != NONE;
    }
    atomic_fetch_add(&comparison->hits, differ);
    atomic_fetch_add(&comparison->met, met);
}

/* Segments from each walk's vertex to another walk's: many are occluded. */
static void shadows_make(WalkState *state)
{
    const uint *paths = state->buffers[BUFFER_PATHS];
    for (uint t = 0; t < BLOCK; ++t) {
        uint other = (t + 7u) % BLOCK;
        ray_store(state->buffers[BUFFER_SHADOWS], BLOCK, t,
                  ray_between(state_load_vec3(paths, BLOCK, WALK_POINT, t), state_load_vec3(paths, BLOCK, WALK_NG, t),
                              state_load_vec3(paths, BLOCK, WALK_POINT, other),
                              state_load_vec3(paths, BLOCK, WALK_NG, other)));
    }
}

static void shadows_compare(Comparison *comparison, WalkState *state)
{
    uint *shadows = state->buffers[BUFFER_SHADOWS];
    memcpy(state->shadows, shadows, sizeof state->shadows);
    kernel_run(KERNEL_trace_shadow, state->buffers, NULL, BLOCK);
    rays_embree_trace_shadow(comparison->rays, state->shadows, NULL, BLOCK, BLOCK);
    uint differ = 0, occluded = 0;
    for (uint t = 0; t < BLOCK; ++t) {
        uint a = state_load(shadows, BLOCK, SHADOW_OCCLUDED, t);
        differ += a != state_load(state->shadows, BLOCK, SHADOW_OCCLUDED, t);
        occluded += a;
    }
    atomic_fetch_add(&comparison->shadows, differ);
    atomic_fetch_add(&comparison->occluded, occluded);
}

static void *compare_thread(void *argument)
{
    Comparison *comparison = argument;
    WalkState *state = malloc(sizeof *state);
    if (!state)
        return NULL;
    walk_state_init(state, comparison);
    for (;;) {
        uint block = atomic_fetch_add(&comparison->next_block, 1);
        if (block >= comparison->blocks)
            break;
        state->frame.pass.first_item = block * BLOCK;
        kernel_loop_walk_start(state->buffers, NULL, BLOCK);
        for (int bounce = 0; bounce < BOUNCES; ++bounce) {
            closest_compare(comparison, state);
            kernel_loop_walk_extend(state->buffers, NULL, BLOCK);
            if (bounce % 4 == 0)
                shadows_make(state);
            if (bounce % 2 == 0)
                shadows_compare(comparison, state);
        }
    }
    walk_state_destroy(state);
    free(state);
    return NULL;
}

/* A quarter of them at effort 1; all in make check-long. */
static uint walks_of(const BvhCase *entry)
{
    return test_effort() == 1 ? entry->walks / 4u : entry->walks;
}

START_TEST(test_same_hits_as_embree)
{
    const BvhCase *entry = &BVH_CASES[_i];
    Error error = {0};
    TestScene test;
    Bvh bvh;
    pthread_t threads[THREADS];
    entry->make(&test);
    Comparison comparison = {.test = &test, .bvh = &bvh, .blocks = walks_of(entry) / BLOCK};
    comparison.rays = rays_embree_create(&test.backend, THREADS, &error);
    ck_assert_msg(comparison.rays != NULL, "%s", error.message);
    ck_assert_msg(bvh_build(&test.backend, &bvh, &error), "%s", error.message);
    for (int i = 0; i < THREADS; ++i)
        ck_assert_int_eq(pthread_create(&threads[i], NULL, compare_thread, &comparison), 0);
    for (int i = 0; i < THREADS; ++i)
        pthread_join(threads[i], NULL);
    ck_assert_msg(comparison.hits == 0 && comparison.shadows == 0, "%s: %u of %u hits and %u visibilities differ",
                  entry->name, comparison.hits, comparison.traced, comparison.shadows);
    ck_assert_uint_eq(comparison.traced, walks_of(entry) * BOUNCES);
    ck_assert_uint_gt(comparison.met, comparison.traced / 50);
    ck_assert_uint_gt(comparison.occluded, comparison.traced / 100);
    printf("# %s: %u primitives, %u rays, %u%% hit, %u%% occluded; %u nodes, depth %u, stack %u\n", entry->name,
           bvh.item_count, comparison.traced, (uint)(100ull * comparison.met / comparison.traced),
           (uint)(100ull * comparison.occluded / comparison.traced), bvh.node_count, bvh.max_depth, bvh.stack);
    bvh_destroy(&bvh);
    rays_embree_destroy((RaysEmbree *)(uintptr_t)comparison.rays);
    test_scene_destroy(&test);
}
END_TEST

START_TEST(test_enough_walks)
{
    uint walks = 0;
    for (uint i = 0; i < BVH_CASE_COUNT; ++i)
        walks += BVH_CASES[i].walks;
    ck_assert_uint_ge(walks, 1u << 20);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("hierarchy");
    TCase *tcase = tcase_create("against Embree");
    tcase_set_timeout(tcase, 240.0);
    tcase_add_loop_test(tcase, test_same_hits_as_embree, 0, (int)BVH_CASE_COUNT);
    tcase_add_test(tcase, test_enough_walks);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, bvh_adversary_tcase());
    suite_add_tcase(suite, bvh_build_tcase());
    suite_add_tcase(suite, bvh_opencl_tcase());
    return test_run(suite);
}
