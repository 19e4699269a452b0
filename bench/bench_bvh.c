/* Rays per second of CPU time, on path tracing's own rays:
 *   embree   the query path of the CPU backend,
 *   c        the hierarchy for devices, traversed by the shared kernels compiled as C,
 *   opencl   the same on an OpenCL CPU device (one that computes in this process, as PoCL does).
 * Output: one line per scene, kind of ray and path, tab-separated. Every path traces the same rays, step by step of the
 * integrator; differing results are counted. Usage: bench_bvh SHARED_FOLDER SCENE.pbrt ... */
#include "backend/bvh.h"
#include "bench_util.h"
#include "kernels.h"
#include "layout/kernel_list.h"
#include "path/path_state.h"
#include "pbrt/import.h"
#include "rays_embree.h"
#include "scene/scene.h"
#include "support/opencl_probe.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define ITEMS 65536u
#define STRIDE (ITEMS + 16u)
#define BLOCK 512u
#define MAX_DEPTH 8u
#define REPEATS 3

typedef enum RayPath { PATH_EMBREE, PATH_C, PATH_OPENCL, PATH_COUNT } RayPath;
static const char *const PATH_NAMES[PATH_COUNT] = {"embree", "c", "opencl"};

static const uint BUFFER_WORDS[BUFFER_COUNT] = {
    [BUFFER_PATHS] = PATH_WORDS,     [BUFFER_RAYS] = RAY_WORDS,     [BUFFER_HITS] = HIT_WORDS,
    [BUFFER_SHADOWS] = SHADOW_WORDS, [BUFFER_SPLATS] = SPLAT_WORDS, [BUFFER_DIAGNOSTICS] = 1};

static const BufferId CLOSEST_BUFFERS[] = {BUFFER_FRAME, BUFFER_GEOMETRY, BUFFER_TABLES, BUFFER_TEXELS,
                                           BUFFER_BVH,   BUFFER_RAYS,     BUFFER_HITS};
static const BufferId SHADOW_BUFFERS[] = {BUFFER_FRAME,  BUFFER_GEOMETRY, BUFFER_TABLES,
                                          BUFFER_TEXELS, BUFFER_BVH,      BUFFER_SHADOWS};

typedef struct Bench {
    Scene scene;
    BackendScene backend;
    FrameParams frame;
    RaysEmbree *rays;
    Bvh bvh;
    void *buffers[BUFFER_COUNT];
    OpenclProbe *probe;
    OpenclBuffer *device[BUFFER_COUNT];
    double seconds[2][PATH_COUNT]; /* closest, shadow */
    double traced[2];
    uint differ;
} Bench;

/* ---- opening ----------------------------------------------------------------------------------------------------- */

static void device_open(Bench *bench, const char *shared)
{
    char options[4096], message[8192] = "";
    bool absent;
    snprintf(options, sizeof options,
             "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -DTWINLIGHT_FEATURES=0x%" PRIx64 "ul -I%s",
             frame_features(&bench->frame), shared);
    bench->probe = opencl_probe_open("#include \"kernels/trace.cl\"\n", options, message, sizeof message, &absent);
    if (!bench->probe) {
        printf("# no OpenCL: %s\n", message);
        return;
    }
    const BackendScene *scene = &bench->backend;
    const uint nothing[4] = {0};
    const size_t words[BUFFER_PATHS] = {sizeof bench->frame / 4, scene->geometry_words, scene->tables_words,
                                        scene->texel_words, bench->bvh.word_count};
    for (int i = 0; i < BUFFER_PATHS; ++i)
        bench->device[i] =
            opencl_buffer_create(bench->probe, words[i] > 0 ? bench->buffers[i] : nothing, words[i] > 0 ? words[i] : 4);
    for (int i = BUFFER_RAYS; i <= BUFFER_SHADOWS; ++i)
        bench->device[i] = opencl_buffer_create(bench->probe, bench->buffers[i], (size_t)BUFFER_WORDS[i] * STRIDE);
}

static void bench_open(Bench *bench, const char *path)
{
    Error error = {0};
    scene_init(&bench->scene);
    if (!pbrt_load(path, false, &bench->scene, &error))
        bench_fail(error.message);
    bench->backend = scene_backend_view(&bench->scene);
    bench->rays = rays_embree_create(&bench->backend, 2, &error);
    if (!bench->rays || !bvh_build(&bench->backend, &bench->bvh, &error))
        bench_fail(error.message);
    FrameParams *frame = &bench->frame;
    *frame = *bench->backend.frame;
    uint pixels = (frame->film.crop_x1 - frame->film.crop_x0) * (frame->film.crop_y1 - frame->film.crop_y0);
    frame->path.max_depth = MAX_DEPTH;
    frame->pass.stride = STRIDE;
    frame->pass.item_count = ITEMS;
    frame->pass.pixel_stride = pixels / ITEMS < 1u ? 1u : pixels / ITEMS;
    for (int i = 0; i < BUFFER_COUNT; ++i)
        if (BUFFER_WORDS[i] > 0 && !(bench->buffers[i] = calloc((size_t)BUFFER_WORDS[i] * STRIDE, sizeof(uint))))
            bench_fail("out of memory");
    bench->buffers[BUFFER_FRAME] = frame;
    bench->buffers[BUFFER_GEOMETRY] = (void *)(uintptr_t)bench->backend.geometry;
    bench->buffers[BUFFER_TABLES] = (void *)(uintptr_t)bench->backend.tables;
    bench->buffers[BUFFER_TEXELS] = (void *)(uintptr_t)bench->backend.texels;
    bench->buffers[BUFFER_BVH] = bench->bvh.words;
}

static void bench_close(Bench *bench)
{
    for (int i = 0; i < BUFFER_COUNT; ++i) {
        opencl_buffer_destroy(bench->device[i]);
        if (i >= BUFFER_PATHS)
            free(bench->buffers[i]);
    }
    opencl_probe_close(bench->probe);
    rays_embree_destroy(bench->rays);
    bvh_destroy(&bench->bvh);
    scene_destroy(&bench->scene);
}

/* ---- tracing ----------------------------------------------------------------------------------------------------- */

static double trace_device(Bench *bench, bool shadow)
{
    OpenclBuffer *arguments[8];
    const BufferId *ids = shadow ? SHADOW_BUFFERS : CLOSEST_BUFFERS;
    size_t count = shadow ? 7 : 8;
    BufferId in = shadow ? BUFFER_SHADOWS : BUFFER_RAYS, out = shadow ? BUFFER_SHADOWS : BUFFER_HITS;
    double wall;
    for (size_t i = 0; i < count; ++i)
        arguments[i] = bench->device[ids[i]];
    if (!opencl_buffer_write(bench->probe, bench->device[in], bench->buffers[in], (size_t)BUFFER_WORDS[in] * STRIDE))
        bench_fail("the OpenCL device takes no rays");
    double begin = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    if (!opencl_probe_launch(bench->probe, shadow ? "trace_shadow" : "trace_closest", arguments, count, ITEMS, &wall))
        bench_fail("the OpenCL device does not trace");
    double seconds = bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
    if (!opencl_buffer_read(bench->probe, bench->device[out], bench->buffers[out], (size_t)BUFFER_WORDS[out] * STRIDE))
        bench_fail("the OpenCL device returns no hits");
    return seconds;
}

/* CPU seconds for all rays of the step by one path. */
static double trace(Bench *bench, RayPath path, bool shadow, uint *traced)
{
    if (path == PATH_OPENCL)
        return trace_device(bench, shadow);
    double begin = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    if (path == PATH_C)
        kernel_run(shadow ? KERNEL_trace_shadow : KERNEL_trace_closest, bench->buffers, NULL, ITEMS);
    else if (shadow)
        *traced = rays_embree_trace_shadow(bench->rays, bench->buffers[BUFFER_SHADOWS], NULL, ITEMS, STRIDE);
    else
        *traced = rays_embree_trace_closest(bench->rays, bench->buffers[BUFFER_RAYS], bench->buffers[BUFFER_HITS], NULL,
                                            NULL, ITEMS, STRIDE);
    return bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
}

static void trace_step(Bench *bench, bool shadow)
{
    BufferId out = shadow ? BUFFER_SHADOWS : BUFFER_HITS;
    size_t words = (size_t)BUFFER_WORDS[out] * STRIDE;
    uint *before = malloc(words * sizeof *before), *first = malloc(words * sizeof *first), traced = 0;
    if (!before || !first)
        bench_fail("out of memory");
    memcpy(before, bench->buffers[out], words * sizeof *before);
    for (int path = 0; path < PATH_COUNT; ++path) {
        double best = HUGE_VAL;
        if (path == PATH_OPENCL && !bench->probe)
            continue;
        for (int repeat = 0; repeat < REPEATS; ++repeat) {
            memcpy(bench->buffers[out], before, words * sizeof *before);
            best = fmin(best, trace(bench, (RayPath)path, shadow, &traced));
        }
        bench->seconds[shadow][path] += best;
        if (path == PATH_EMBREE)
            memcpy(first, bench->buffers[out], words * sizeof *first);
        for (size_t i = 0; i < words; ++i)
            bench->differ += first[i] != ((uint *)bench->buffers[out])[i];
    }
    bench->traced[shadow] += traced;
    free(before);
    free(first);
}

static void scene_bench(const char *shared, const char *path)
{
    Bench bench = {.probe = NULL};
    bench_open(&bench, path);
    device_open(&bench, shared);
    kernel_run(KERNEL_pt_start_paths, bench.buffers, NULL, ITEMS);
    for (uint depth = 1; depth <= MAX_DEPTH; ++depth) {
        trace_step(&bench, false);
        kernel_run(KERNEL_pt_shade_hits, bench.buffers, NULL, ITEMS);
        kernel_run(KERNEL_pt_sample_lights, bench.buffers, NULL, ITEMS);
        trace_step(&bench, true);
        kernel_run(KERNEL_pt_add_lights, bench.buffers, NULL, ITEMS);
        kernel_run(KERNEL_pt_extend_paths, bench.buffers, NULL, ITEMS);
    }
    printf("# %s: %u items, %u nodes, depth %u, stack %u, %.1f MB, built in %.3f s; %u words differ\n", path,
           bench.bvh.item_count, bench.bvh.node_count, bench.bvh.max_depth, bench.bvh.stack,
           4e-6 * (double)bench.bvh.word_count, bench.bvh.build_seconds, bench.differ);
    for (int shadow = 0; shadow < 2; ++shadow)
        for (int kind = 0; kind < (bench.probe ? PATH_COUNT : PATH_OPENCL); ++kind)
            printf("%s\t%s\t%s\t%.3f\t%.3f\n", path, shadow ? "shadow" : "closest", PATH_NAMES[kind],
                   1e-6 * bench.traced[shadow] / bench.seconds[shadow][kind],
                   bench.seconds[shadow][kind] / bench.seconds[shadow][PATH_EMBREE]);
    fflush(stdout);
    bench_close(&bench);
}

int main(int argc, char **argv)
{
    setenv("POCL_KERNEL_CACHE", "0", 0);
    if (argc < 3)
        bench_fail("usage: bench_bvh SHARED_FOLDER SCENE.pbrt ...");
    printf("scene\trays\tpath\tMrays/s\tratio\n");
    for (int i = 2; i < argc; ++i)
        scene_bench(argv[1], argv[i]);
    return EXIT_SUCCESS;
}
