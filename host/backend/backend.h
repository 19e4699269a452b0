/* The interface of a backend: memory, kernels and ray queries, driven by a list of steps that is recorded once.
 *
 * A pass runs the list over items first_item ... first_item + item_count - 1. A step touches only the fields of its own
 * item, so a backend may run step by step over all items (OpenCL) or the whole list chunk by chunk (CPU); both give the
 * same bits. At the end of the list every item's splat goes to the sink, in any order, because the film sums
 * integers. */
#ifndef TWINLIGHT_BACKEND_BACKEND_H
#define TWINLIGHT_BACKEND_BACKEND_H

#include "base/error.h"
#include "layout/frame_params.h"

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

/* Buffers that kernels refer to. Those before BUFFER_PATHS hold the scene; the others hold 32-bit words per item,
 * unless noted (StepList). */
typedef enum BufferId {
    BUFFER_FRAME,
    BUFFER_GUIDE, /* StepList.guide */
    BUFFER_PHOTONS, /* StepList.photons */
    BUFFER_GEOMETRY,
    BUFFER_TABLES,
    BUFFER_TEXELS,
    BUFFER_BVH, /* backend/bvh.h; NULL if the backend traces rays by other means */
    BUFFER_PATHS, /* path/path_state.h */
    BUFFER_RAYS, /* layout/state.h: closest-hit rays */
    BUFFER_HITS,
    BUFFER_SHADOWS, /* shadow rays and their visibility, layout/state.h */
    BUFFER_SPLATS, /* contributions to the film, layout/state.h */
    BUFFER_VERTICES, /* path/bd_state.h: vertices of subpaths */
    BUFFER_DENSITIES, /* path/bd_state.h: their densities */
    BUFFER_DIAGNOSTICS, /* counters, per thread or device, summed by the host (layout/diagnostics.h) */
    BUFFER_PASS, /* words of all items of the pass, copied from and to the host (StepList) */
    BUFFER_COUNTS, /* numbers of live rays, for backends that count with a kernel (kernels/count.cl) */
    BUFFER_FILM, /* sums of the film, for backends that add splats with a kernel (camera/film_sum.h) */
    BUFFER_COUNT
} BufferId;

typedef enum StepKind {
    STEP_KERNEL,
    STEP_TRACE_CLOSEST,
    STEP_TRACE_SHADOW,
    /* Jump to step `target` if no item of the chunk had a live ray in the latest STEP_TRACE_CLOSEST. A backend may
     * ignore it: the kernels in between leave dead paths unchanged. */
    STEP_SKIP_IF_IDLE,
    /* Hands the splats to the sink before the end of the list, for paths that contribute to several pixels. */
    STEP_SPLAT
} StepKind;

typedef struct Step {
    StepKind kind;
    unsigned kernel; /* index into the kernel list (shared/layout/kernel_list.h) */
    /* The kernel leaves items without a live ray in the latest STEP_TRACE_CLOSEST unchanged, so a backend may skip
     * them. */
    bool live_only;
    unsigned target;
} Step;

/* Name of some words of a per-item buffer, for messages. */
typedef struct StateField {
    BufferId buffer;
    uint first; /* index of the first word */
    uint words; /* number of words; 3: x, y, z */
    bool is_float;
    const char *name;
} StateField;

/* The words of BUFFER_PHOTONS (layout/photon_map.h) and the parameters that go with them. They do not change during a
 * rendering. */
typedef struct PhotonMap {
    uint *words; /* NULL: no photons */
    size_t word_count;
    unsigned number; /* of no other map of this process: a later one may have the same address */
    PhotonParams params;
} PhotonMap;

typedef struct StepList {
    const Step *steps;
    size_t count;
    uint words_per_item[BUFFER_COUNT]; /* for the per-item buffers in use; 0 otherwise */
    /* BUFFER_PASS: field f of item k of the pass is pass_words[f * pass_stride + k]. Kernels read and write the words
     * of their own item. NULL: none. */
    uint *pass_words;
    uint pass_fields;
    uint pass_stride;
    const Guide *guide; /* BUFFER_GUIDE during a pass; NULL: none */
    const PhotonMap *photons; /* BUFFER_PHOTONS during a pass; NULL: none */
    const StateField *fields; /* of BUFFER_PATHS, whose layout is up to the integrator; may be NULL */
    size_t field_count;
} StepList;

/* Borrowed pointers to the packed scene. */
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

/* Where the splats of a device are added to the film. The image is the same. */
typedef enum FilmPlace {
    FILM_BY_DEVICE, /* on GPUs that can and have room, if the pass has splats enough to be worth the copy of the sums */
    FILM_ON_HOST,
    FILM_ON_DEVICE /* to sums of its own, if the sink has `sums` */
} FilmPlace;

typedef struct BackendOptions {
    int threads; /* 0: by processors_usable (base/processors.h) */
    const char *device; /* device number or part of its name, for backends with several devices; NULL: the first */
    uint batch; /* items that a device takes through the list at a time; 0: chosen by the backend */
    FilmPlace film;
    bool record_spans; /* record timings, for `spans` */
} BackendOptions;

/* Description of a device that a backend can compute on. */
typedef struct BackendDevice {
    char platform[128];
    char name[256];
    char version[256]; /* of platform and driver */
    char kind[32];
    uint64_t memory; /* bytes */
    uint64_t allocation_limit; /* bytes of the largest single buffer */
    unsigned units;
    bool promises_division; /* claims correctly rounded division and square root */
    bool rounds_division; /* has them, as found by the probe or, without a probe, as claimed */
    uint64_t probed; /* results compared with the host's; 0: no probe */
    bool keeps_denormals;
    bool atomics64;
    bool same_bits; /* expected to give bit for bit the image of the CPU backend */
} BackendDevice;

/* A timed activity during rendering. */
typedef enum SpanTrack { SPAN_COMPUTE, SPAN_COPY, SPAN_FILM } SpanTrack;

typedef struct BackendSpan {
    const char *name; /* of a kernel or stage; valid after the backend is closed */
    SpanTrack track;
    uint lane; /* index of the host thread, for SPAN_FILM */
    uint64_t batch; /* counted from the opening of the backend */
    uint64_t begin, end; /* nanoseconds from an arbitrary origin; one clock for all tracks */
} BackendSpan;

/* What the processes of a rendering have sent each other in its passes (ranks/ranks.h); zeros for a single one. */
typedef struct ExchangeStatistics {
    uint ranks;
    int threads; /* of all ranks */
    uint64_t passes, bytes; /* of all ranks together */
    double seconds, latest_seconds; /* in which nothing was computed: in all passes, in the latest one */
} ExchangeStatistics;

/* Rays and time since the backend was opened. */
typedef struct BackendStatistics {
    uint64_t closest_rays;
    uint64_t shadow_rays;
    double ray_seconds; /* in ray queries, summed over threads */
    double build_seconds; /* time to build the acceleration structure */
    size_t bytes; /* memory of device or backend now in use */
    int threads; /* of this process */
    uint width; /* items that a device must work on at a time to be busy: a pass of few takes as long as one of these */
    char device[256]; /* its name */
    ExchangeStatistics exchange;
} BackendStatistics;

/* Receives splats. Functions are called by many threads concurrently. */
typedef struct SplatSink {
    /* Receives the splat buffer of a finished chunk: `count` items at `stride`, fields as in layout/state.h. NULL:
     * nobody needs the splats. */
    void (*splats)(void *context, const uint *splats, uint count, uint stride);
    /* Receives instead the sums made on a device (BackendOptions.film): `sum_words` words, laid out as in
     * camera/film_sum.h for the crop and film_exponent of the pass. NULL: not supported. */
    void (*sums)(void *context, ulong *words);
    size_t sum_words;
    void *context;
    bool whole; /* splats of an incomplete pass are useless */
} SplatSink;

/* Receives the words of one per-item buffer: `count` items at `stride`, beginning with item `first` of the pass. Called
 * by many threads concurrently. */
typedef void (*StateSink)(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride);

typedef struct Backend Backend;

/* Functions marked "may be NULL" are optional. */
typedef struct BackendInterface {
    const char *name;
    /* Fills up to `capacity` devices and returns their number; --device uses their order. Devices that do not claim
     * correctly rounded division are probed, or get the stored result of an earlier probe; with `probe_all`, every
     * device is probed anew. May be NULL. */
    size_t (*devices)(BackendDevice *devices, size_t capacity, bool probe_all);
    /* Index of the device that BackendOptions.device selects; false with an error if it matches none or several. NULL
     * for backends without a choice of devices. */
    bool (*device_index)(const char *device, size_t *index, Error *error);
    /* Builds the acceleration structure and worker threads or queues. Returns NULL with `error` filled on failure. */
    Backend *(*open)(const BackendScene *scene, const BackendOptions *options, Error *error);
    void (*close)(Backend *backend);
    /* Runs the list over the pass that `frame` describes and returns when every splat has reached the sink. Once *stop
     * is nonzero, no new chunk is started and running ones end at the next step, without contributing; a chunk whose
     * splats the sink has already received in part (STEP_SPLAT) runs to the end of the list, unless sink->whole.
     * `items_done` (may be NULL) gets the number of items delivered, also on failure. */
    bool (*run)(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                const atomic_int *stop, uint64_t *items_done, Error *error);
    /* Runs a list, or its beginning, like `run`, on buffers that are first cleared, and hands every per-item buffer of
     * the list to the sink: to find where two backends differ (render/verify.h). */
    bool (*inspect)(Backend *backend, const FrameParams *frame, const StepList *list, StateSink sink, void *context,
                    Error *error);
    /* Sums the diagnostics counters (layout/diagnostics.h) into counters[DIAGNOSTIC_COUNT]. */
    void (*diagnostics)(Backend *backend, uint64_t *counters);
    void (*statistics)(Backend *backend, BackendStatistics *statistics);
    /* Timings, if BackendOptions.record_spans was set. Returns their number and sets *dropped to the number of those
     * that did not fit. Valid until the next call of any function. May be NULL. */
    size_t (*spans)(Backend *backend, const BackendSpan **spans, uint64_t *dropped);
} BackendInterface;

#endif
