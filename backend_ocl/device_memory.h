/* What a device holds: the scene, the state of a batch of items, and for each batch under way its parameters and its
 * splats. Everything is sized and compared with the device's limits before any of it is allocated. */
#ifndef TWINLIGHT_DEVICE_MEMORY_H
#define TWINLIGHT_DEVICE_MEMORY_H

#include "devices.h"

#include "backend/bvh.h"
#include "layout/diagnostics.h"
#include "layout/state.h"

/* Batches under way: one computed, one copied, one added to the film. */
#define BATCH_SLOTS 3

/* What is read back beside the splats. */
typedef struct BatchResults {
    uint live[2]; /* closest-hit rays up to the latest odd and even turn of the loop */
    uint counts[COUNT_WORDS]; /* of the whole batch */
    uint diagnostics[DIAGNOSTIC_COUNT];
} BatchResults;

typedef struct BatchMemory {
    cl_mem frame;
    cl_mem splats; /* what kernels write, and behind it what every STEP_SPLAT has put aside */
    cl_mem staging; /* host memory that the device reaches directly, mapped as long as it lives */
    uint *host; /* its splats */
    BatchResults *results; /* behind them */
} BatchMemory;

typedef struct DeviceMemory {
    cl_context context;
    cl_command_queue queue;
    const OclDevice *device;
    cl_mem scene[BUFFER_BVH + 1]; /* geometry, tables, texels, bvh */
    cl_mem state[BUFFER_COUNT]; /* per-item buffers but splats; diagnostics; counts */
    BatchMemory batches[BATCH_SLOTS];
    cl_mem guide; /* of the pass under way */
    cl_mem film; /* its sums, when the device adds (device_film.h) */
    uint words_per_item[BUFFER_COUNT]; /* that the state was made for */
    uint batch; /* items of a batch; 0 until state is made */
    uint batch_wanted; /* --batch, 0: chosen here */
    size_t scene_bytes, film_bytes, bytes;
} DeviceMemory;

/* Words between two fields of a batch of `count` items: whole groups, and an offset that keeps the fields of an item
 * off one another's cache sets when `count` is a power of two. */
uint device_memory_stride(uint count);

/* Copies the scene to the device. `batch`: items of a batch, 0 to choose. */
bool device_memory_init(DeviceMemory *memory, cl_context context, cl_command_queue queue, const OclDevice *device,
                        const BackendScene *scene, const Bvh *bvh, uint batch, Error *error);

/* Makes state for this list, unless what is there is enough. No command may be under way. */
bool device_memory_reserve(DeviceMemory *memory, const StepList *list, Error *error);

/* Makes room for a film of so many bytes, unless there is enough. No command may be under way. */
bool device_memory_reserve_film(DeviceMemory *memory, size_t bytes, Error *error);

void device_memory_destroy(DeviceMemory *memory);

#endif
