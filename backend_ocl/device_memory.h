/* Memory of a device: the scene, the state of a batch of items and, for each batch in flight, its parameters and
 * splats. All sizes are checked against the device's limits before anything is allocated. */
#ifndef TWINLIGHT_DEVICE_MEMORY_H
#define TWINLIGHT_DEVICE_MEMORY_H

#include "devices.h"

#include "backend/bvh.h"
#include "layout/diagnostics.h"
#include "layout/state.h"

/* Batches in flight: one being computed, one being copied, one being added to the film. */
#define BATCH_SLOTS 3

/* Read back in addition to the splats. */
typedef struct BatchResults {
    uint live[2]; /* closest-hit rays in total up to the latest even [0] and odd [1] turn */
    uint counts[COUNT_WORDS]; /* numbers of rays of the whole batch */
    uint diagnostics[DIAGNOSTIC_COUNT];
} BatchResults;

typedef struct BatchMemory {
    cl_mem frame;
    cl_mem splats; /* output of kernels, followed by the sections saved by STEP_SPLATs */
    cl_mem staging; /* pinned host memory, mapped during its whole life */
    uint *host; /* the splats in `staging` */
    BatchResults *results; /* after the splats in `staging` */
} BatchMemory;

typedef struct DeviceMemory {
    cl_context context;
    cl_command_queue queue;
    const OclDevice *device;
    cl_mem scene[BUFFER_BVH + 1]; /* geometry, tables, texels, bvh */
    cl_mem state[BUFFER_COUNT]; /* per-item buffers except splats; diagnostics; counts */
    BatchMemory batches[BATCH_SLOTS];
    cl_mem guide; /* of the current pass */
    cl_mem photons; /* of the rendering; at first a placeholder */
    unsigned photon_number; /* PhotonMap.number of those that it holds a copy of; 0: none */
    size_t photon_bytes;
    cl_mem film; /* sums of the film, if the device adds splats (device_film.h) */
    uint words_per_item[BUFFER_COUNT]; /* for which the state was allocated */
    uint batch; /* items per batch at most; 0: no state yet */
    uint64_t splat_words; /* of each batch in flight */
    uint batch_wanted; /* --batch, set by the owner; 0: chosen automatically */
    size_t scene_bytes, film_bytes, bytes;
} DeviceMemory;

/* Words between two fields for a batch of `count` items: a multiple of the group size plus an offset, which avoids
 * cache conflicts between the fields of an item if `count` is a power of two. */
uint device_memory_stride(uint count);

/* Copies the scene to the device. */
bool device_memory_init(DeviceMemory *memory, cl_context context, cl_command_queue queue, const OclDevice *device,
                        const BackendScene *scene, const Bvh *bvh, Error *error);

/* Allocates state for this list, unless the existing one suffices. No command may be in flight. */
bool device_memory_reserve(DeviceMemory *memory, const StepList *list, Error *error);

/* Items per batch of a list for which memory is reserved. Fewer than `batch` if the list has so many splats per item,
 * as those of chains, that a full batch of them would take gigabytes of pinned host memory. */
uint device_memory_batch(const DeviceMemory *memory, const StepList *list);

/* Splats per item: one for every STEP_SPLAT and one for the end of the list. */
uint step_list_splats(const StepList *list);

/* Whether the sums of a film of `bytes` bytes fit beside all else; allocates them, unless the existing ones suffice (no
 * command may be in flight). */
bool device_memory_film_fits(const DeviceMemory *memory, size_t bytes);
bool device_memory_reserve_film(DeviceMemory *memory, size_t bytes, Error *error);

/* Copies a map of photons to the device unless it is there already. photons: may be NULL. No command may be in
 * flight. */
bool device_memory_photons(DeviceMemory *memory, const PhotonMap *photons, Error *error);

void device_memory_destroy(DeviceMemory *memory);

#endif
