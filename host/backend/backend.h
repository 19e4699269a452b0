/* What the host asks of a backend: memory, kernels and rays, given as a list of steps recorded once.
 *
 * A pass runs the list over items first_item ... first_item + item_count - 1. A step touches only its own item's
 * fields, so a backend may run step by step over all items (OpenCL) or the whole list chunk by chunk (CPU); both give
 * the same bits. At the end of the list every item's splat goes to the sink, in any order: the film is integer. */
#ifndef TWINLIGHT_BACKEND_BACKEND_H
#define TWINLIGHT_BACKEND_BACKEND_H

#include "base/error.h"
#include "layout/scene_types.h"

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

/* Buffers that kernels name. Those before BUFFER_PATHS hold the scene; the others hold 32-bit words per item
 * (StepList). */
typedef enum BufferId {
    BUFFER_FRAME,
    BUFFER_GUIDE, /* StepList.guide */
    BUFFER_GEOMETRY,
    BUFFER_TABLES,
    BUFFER_TEXELS,
    BUFFER_BVH, /* backend/bvh.h; NULL where the backend has rays of its own */
    BUFFER_PATHS, /* path/path_state.h */
    BUFFER_RAYS, /* layout/state.h: closest-hit rays */
    BUFFER_HITS,
    BUFFER_SHADOWS, /* shadow rays and their visibility */
    BUFFER_SPLATS, /* what goes to the film */
    BUFFER_VERTICES, /* path/bd_state.h: vertices of bidirectional paths */
    BUFFER_DENSITIES, /* and their densities */
    BUFFER_DIAGNOSTICS, /* counters, per thread or device; summed by the host */
    BUFFER_PASS, /* words of the whole pass's items, from and to the host (StepList) */
    BUFFER_COUNTS, /* live rays, for backends that count with a kernel (kernels/count.cl) */
    BUFFER_FILM, /* the film's sums, for backends that add with a kernel (camera/film_sum.h) */
    BUFFER_COUNT
} BufferId;

typedef enum StepKind {
    STEP_KERNEL,
    STEP_TRACE_CLOSEST,
    STEP_TRACE_SHADOW,
    /* When no item of the chunk has had a live ray in the latest STEP_TRACE_CLOSEST, go on at step `target`. A backend
     * may ignore it: the kernels between do nothing to dead paths. */
    STEP_SKIP_IF_IDLE,
    /* Hands the splats to the sink before the list's end: for paths that meet the film in several places. */
    STEP_SPLAT
} StepKind;

typedef struct Step {
    StepKind kind;
    unsigned kernel; /* index into the kernel list (shared/layout/kernel_list.h) */
    /* The kernel does nothing to items without a live ray in the latest STEP_TRACE_CLOSEST, so a backend may leave them
     * out. */
    bool live_only;
    unsigned target;
} Step;

/* What words of a per-item buffer are called, for people. */
typedef struct StateField {
    BufferId buffer;
    uint first; /* word */
    uint words; /* 3: x, y, z */
    bool is_float;
    const char *name;
} StateField;

typedef struct StepList {
    const Step *steps;
    size_t count;
    uint words_per_item[BUFFER_COUNT]; /* of the per-item buffers used; 0 otherwise */
    /* BUFFER_PASS: field f of pass item k at pass_words[f * pass_stride + k], kernels read and write those of their own
     * item. NULL: none. */
    uint *pass_words;
    uint pass_fields;
    uint pass_stride;
    const Guide *guide; /* BUFFER_GUIDE during a pass; NULL: none */
    const StateField *fields; /* of BUFFER_PATHS, which integrators lay out as they like; may be NULL */
    size_t field_count;
} StepList;

/* Borrowed views of the packed scene. */
typedef struct BackendScene {
    const FrameParams *frame;
    const uint *geometry;
    size_t geometry_words;
    const uint *tables;
    size_t tables_words;
    const uint *texels;
    size_t texel_words;
    size_t primitive_count;
    size_t object_count;
    size_t instance_count;
} BackendScene;

typedef struct BackendOptions {
    int threads; /* 0: one per processor */
    const char *device; /* a number or a part of a name, for backends with a choice of devices; NULL: the first */
    uint batch; /* items a device takes through the list at a time; 0: the backend chooses */
    bool film_on_device; /* a device adds splats to sums of its own, where the sink takes such */
    bool record_spans; /* keep what ran when, for `spans` */
} BackendOptions;

/* A device that a backend can compute on, in words. */
typedef struct BackendDevice {
    char platform[128];
    char name[256];
    char version[256]; /* of platform and driver */
    char kind[32];
    uint64_t memory; /* bytes */
    uint64_t allocation_limit; /* bytes of the largest single buffer */
    unsigned units;
    bool promises_division; /* says that division and square root are correctly rounded */
    bool rounds_division; /* they are: by the probe, or as promised where there was none */
    uint64_t probed; /* divisions and roots that were compared with the host's; 0: there was no probe */
    bool keeps_denormals;
    bool atomics64;
    bool same_bits; /* the image of the CPU backend, bit for bit, is to be expected */
} BackendDevice;

/* Something that took time while rendering. */
typedef enum SpanTrack { SPAN_COMPUTE, SPAN_COPY, SPAN_FILM } SpanTrack;

typedef struct BackendSpan {
    const char *name; /* of a kernel or stage; outlives the backend */
    SpanTrack track;
    uint lane; /* which host thread, for SPAN_FILM */
    uint64_t batch; /* counted since the backend was opened */
    uint64_t begin, end; /* nanoseconds since some moment in the past, one clock for all tracks */
} BackendSpan;

/* Rays and time since the backend was opened. */
typedef struct BackendStatistics {
    uint64_t closest_rays;
    uint64_t shadow_rays;
    double ray_seconds; /* in ray queries, summed over threads */
    double build_seconds; /* acceleration structure */
    size_t bytes; /* device or backend memory now */
    int threads;
    char device[256]; /* in words */
} BackendStatistics;

/* Where splats go. Functions are called from many threads at once. */
typedef struct SplatSink {
    /* Receives one finished chunk's splat buffer: `count` items at `stride`, fields of layout/state.h. */
    void (*splats)(void *context, const uint *splats, uint count, uint stride);
    /* Receives instead what a device has summed up by itself (BackendOptions.film_on_device): `sum_words` words as
     * camera/film_sum.h lays them out for the pass's crop and film_exponent. NULL: sums are of no use. */
    void (*sums)(void *context, ulong *words);
    size_t sum_words;
    void *context;
    bool whole; /* splats of a pass are of no use unless all items are done */
} SplatSink;

/* Receives the words of one per-item buffer: `count` items at `stride`, the first of them item `first` of the pass.
 * Called from many threads at once. */
typedef void (*StateSink)(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride);

typedef struct Backend Backend;

/* Functions named "may be NULL" are of backends that have such a thing. */
typedef struct BackendInterface {
    const char *name;
    /* Fills up to `capacity` devices and returns how many there are; --device counts them in this order. Those that do
     * not promise correctly rounded division are probed, or were once; all of them, and now, where `probe_all`. */
    size_t (*devices)(BackendDevice *devices, size_t capacity, bool probe_all);
    /* Which of `devices` BackendOptions.device means; false with an error when it fits none or several. NULL for
     * backends without a choice of devices. */
    bool (*device_index)(const char *device, size_t *index, Error *error);
    /* Builds the acceleration structure and worker threads or queues. NULL on failure. */
    Backend *(*open)(const BackendScene *scene, const BackendOptions *options, Error *error);
    void (*close)(Backend *backend);
    /* Runs the list over the pass that `frame` describes and returns when every splat has reached the sink. When
     * *stop becomes non-zero no new chunk is begun, and those under way end at the next step: without a trace, or, when
     * the sink has got splats of theirs (STEP_SPLAT) and is not `whole`, at the end of the list. `items_done` (may be
     * NULL) gets how many items were delivered, also when the run fails. */
    bool (*run)(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                const atomic_int *stop, uint64_t *items_done, Error *error);
    /* Runs the list, or its beginning, like `run`, on buffers that are zero before, and hands every per-item buffer of
     * the list to the sink instead of the splats alone: for finding where two backends part (render/verify.h). */
    bool (*inspect)(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink, void *context,
                    Error *error);
    /* Sums the diagnostics counters (layout/diagnostics.h) into counters[DIAGNOSTIC_COUNT]. */
    void (*diagnostics)(Backend *backend, uint64_t *counters);
    void (*statistics)(Backend *backend, BackendStatistics *statistics);
    /* What ran when, if BackendOptions.record_spans was set. Returns the count and sets *dropped to how many did not
     * fit. Borrowed until the next call of any function. May be NULL. */
    size_t (*spans)(Backend *backend, const BackendSpan **spans, uint64_t *dropped);
} BackendInterface;

#endif
