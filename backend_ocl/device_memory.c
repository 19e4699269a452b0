#include "device_memory.h"

#include <stdio.h>
#include <string.h>

/* Default items per batch: few fit a CPU's caches better, many fill a GPU. */
#define BATCH_CPU 32768u
#define BATCH_PER_GPU_UNIT 8192u
#define BATCH_MIN 256u
#define BATCH_MAX (1u << 26)

/* Most words of splats of a batch in flight, unless --batch asks for more: 256 MB in pinned host memory and as much on
 * the device: enough for 64 steps of 258,000 chains. */
#define SPLAT_WORDS_MOST (1u << 26)

#define STRIDE_STEP 64u
#define STRIDE_OFFSET 32u

/* Fraction of the memory that may be used; the rest is left to the driver, other programs and the display. */
#define MEMORY_PART 0.9

uint device_memory_stride(uint count)
{
    return (count + STRIDE_STEP - 1) / STRIDE_STEP * STRIDE_STEP + STRIDE_OFFSET;
}

static const char *size_text(uint64_t bytes, char *text, size_t size)
{
    static const char *const UNITS[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double value = (double)bytes;
    int unit = 0;
    for (; value >= 1024.0 && unit < 4; ++unit)
        value /= 1024.0;
    snprintf(text, size, unit > 0 ? "%.2f %s" : "%.0f %s", value, UNITS[unit]);
    return text;
}

/* ---- the scene --------------------------------------------------------------------------------------------------- */

static const struct SceneBuffer {
    BufferId id;
    const char *name;
} SCENE_BUFFERS[] = {{BUFFER_GEOMETRY, "the scene's geometry"},
                     {BUFFER_TABLES, "the scene's tables"},
                     {BUFFER_TEXELS, "the scene's texture images"},
                     {BUFFER_BVH, "the scene's bounding volume hierarchy"}};
#define SCENE_BUFFER_COUNT (int)(sizeof SCENE_BUFFERS / sizeof SCENE_BUFFERS[0])

static bool scene_too_large(const OclDevice *device, const char *what, uint64_t bytes, const char *limit_name,
                            uint64_t limit, Error *error)
{
    char size[32], limit_size[32];
    error_set(error, "%s: %s of %s do not fit: %s is %s", device->info.name, size_text(bytes, size, sizeof size), what,
              limit_name, size_text(limit, limit_size, sizeof limit_size));
    return error_fix(error, "choose a device with more memory (--device, see twinlight devices), or --backend=cpu");
}

static bool scene_check(DeviceMemory *memory, const size_t bytes[SCENE_BUFFER_COUNT], Error *error)
{
    const BackendDevice *info = &memory->device->info;
    for (int i = 0; i < SCENE_BUFFER_COUNT; ++i) {
        if (bytes[i] > info->allocation_limit)
            return scene_too_large(memory->device, SCENE_BUFFERS[i].name, bytes[i], "its largest single buffer",
                                   info->allocation_limit, error);
        memory->scene_bytes += bytes[i];
    }
    if ((double)memory->scene_bytes > MEMORY_PART * (double)info->memory)
        return scene_too_large(memory->device, "the scene", memory->scene_bytes, "its memory", info->memory, error);
    return true;
}

static bool buffer_make(DeviceMemory *memory, cl_mem *buffer, cl_mem_flags flags, uint64_t bytes, Error *error)
{
    cl_int status;
    *buffer = clCreateBuffer(memory->context, flags, (size_t)bytes, NULL, &status);
    if (status == CL_SUCCESS) {
        memory->bytes += (size_t)bytes;
        return true;
    }
    char what[64], size[32];
    snprintf(what, sizeof what, "allocating %s", size_text(bytes, size, sizeof size));
    return ocl_fail(error, memory->device->info.name, what, status);
}

/* OpenCL has no empty buffers: an empty one gets one word. */
static bool scene_copy(DeviceMemory *memory, int i, const uint *words, size_t bytes, Error *error)
{
    cl_int status;
    cl_mem *buffer = &memory->scene[SCENE_BUFFERS[i].id];
    *buffer = clCreateBuffer(memory->context, CL_MEM_READ_ONLY, bytes > 0 ? bytes : sizeof(uint), NULL, &status);
    if (status == CL_SUCCESS && bytes > 0)
        status = clEnqueueWriteBuffer(memory->queue, *buffer, CL_TRUE, 0, bytes, words, 0, NULL, NULL);
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "copying the scene", status);
}

bool device_memory_init(DeviceMemory *memory, cl_context context, cl_command_queue queue, const OclDevice *device,
                        const BackendScene *scene, const Bvh *bvh, Error *error)
{
    memset(memory, 0, sizeof *memory);
    memory->context = context;
    memory->queue = queue;
    memory->device = device;
    const uint *words[SCENE_BUFFER_COUNT] = {scene->geometry, scene->tables, scene->texels, bvh->words};
    const size_t bytes[SCENE_BUFFER_COUNT] = {scene->geometry_words * sizeof(uint), scene->tables_words * sizeof(uint),
                                              scene->texel_words * sizeof(uint), bvh->word_count * sizeof(uint)};
    if (!scene_check(memory, bytes, error))
        return false;
    for (int i = 0; i < SCENE_BUFFER_COUNT; ++i)
        if (!scene_copy(memory, i, words[i], bytes[i], error))
            return false;
    if (!buffer_make(memory, &memory->guide, CL_MEM_READ_ONLY, sizeof(Guide), error))
        return false;
    if (!buffer_make(memory, &memory->photons, CL_MEM_READ_ONLY, sizeof(uint), error))
        return false;
    memory->scene_bytes += sizeof(Guide);
    memory->bytes = memory->scene_bytes;
    return true;
}

/* ---- the state of a batch ---------------------------------------------------------------------------------------- */

static uint64_t item_bytes(const uint *words_per_item)
{
    uint64_t words = (uint64_t)(BATCH_SLOTS - 1) * words_per_item[BUFFER_SPLATS];
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id)
        words += words_per_item[id];
    return words * sizeof(uint);
}

static uint64_t item_bytes_largest(const uint *words_per_item)
{
    uint words = 1;
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id)
        words = words_per_item[id] > words ? words_per_item[id] : words;
    return (uint64_t)words * sizeof(uint);
}

/* Items whose state fits next to the scene, a multiple of STRIDE_STEP. */
static uint batch_limit(const DeviceMemory *memory, const uint *words_per_item)
{
    const BackendDevice *info = &memory->device->info;
    double left = MEMORY_PART * (double)info->memory - (double)(memory->scene_bytes + memory->film_bytes);
    double by_memory = left / (double)item_bytes(words_per_item);
    double by_buffer = (double)info->allocation_limit / (double)item_bytes_largest(words_per_item);
    double items = (by_memory < by_buffer ? by_memory : by_buffer) - STRIDE_STEP - STRIDE_OFFSET;
    return items < 1.0 ? 0u : items > (double)BATCH_MAX ? BATCH_MAX : (uint)items / STRIDE_STEP * STRIDE_STEP;
}

static bool state_too_large(const DeviceMemory *memory, const uint *words_per_item, uint batch, uint limit,
                            Error *error)
{
    const BackendDevice *info = &memory->device->info;
    char size[32], scene[32], single[32];
    uint64_t stride = device_memory_stride(batch);
    error_set(
        error,
        "%s: the state of %u paths takes %s (its largest buffer %s) and the scene %s; the device has %.2f GiB, and "
        "%.2f GiB in a single buffer",
        info->name, batch, size_text(stride * item_bytes(words_per_item), size, sizeof size),
        size_text(stride * item_bytes_largest(words_per_item), single, sizeof single),
        size_text(memory->scene_bytes, scene, sizeof scene), (double)info->memory / 1073741824.0,
        (double)info->allocation_limit / 1073741824.0);
    if (limit < BATCH_MIN)
        return error_fix(error, "the scene leaves no room: choose another device (--device), or --backend=cpu");
    return error_fix(error, "use --batch=%u or less", limit);
}

static bool batch_choose(const DeviceMemory *memory, const uint *words_per_item, uint *batch, Error *error)
{
    const BackendDevice *info = &memory->device->info;
    uint limit = batch_limit(memory, words_per_item);
    *batch = memory->batch_wanted;
    if (*batch == 0) {
        *batch = strcmp(info->kind, "CPU") == 0 ? BATCH_CPU : BATCH_PER_GPU_UNIT * (info->units > 0 ? info->units : 1u);
        if (*batch > limit && limit >= BATCH_MIN)
            *batch = limit;
    }
    return *batch <= limit || state_too_large(memory, words_per_item, *batch, limit, error);
}

static bool staging_map(DeviceMemory *memory, BatchMemory *batch, size_t bytes, Error *error)
{
    cl_int status;
    batch->host = clEnqueueMapBuffer(memory->queue, batch->staging, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes, 0,
                                     NULL, NULL, &status);
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "mapping host memory", status);
}

/* Words of splats of a batch in flight, at least for BATCH_MIN items. */
static uint64_t splat_words_reserved(const DeviceMemory *memory, uint64_t stride)
{
    uint64_t each = memory->words_per_item[BUFFER_SPLATS], most = device_memory_stride(BATCH_MIN) * each;
    most = most > SPLAT_WORDS_MOST ? most : SPLAT_WORDS_MOST;
    return memory->batch_wanted > 0 || stride * each < most ? stride * each : most;
}

static bool batches_make(DeviceMemory *memory, uint64_t stride, Error *error)
{
    uint64_t words = splat_words_reserved(memory, stride), bytes = words * sizeof(uint);
    memory->splat_words = words;
    uint64_t staging = bytes + sizeof(BatchResults);
    for (int i = 0; i < BATCH_SLOTS; ++i) {
        BatchMemory *batch = &memory->batches[i];
        if (!buffer_make(memory, &batch->frame, CL_MEM_READ_ONLY, sizeof(FrameParams), error) ||
            (bytes > 0 && !buffer_make(memory, &batch->splats, CL_MEM_READ_WRITE, bytes, error)) ||
            !buffer_make(memory, &batch->staging, CL_MEM_ALLOC_HOST_PTR, staging, error) ||
            !staging_map(memory, batch, (size_t)staging, error))
            return false;
        batch->results = (BatchResults *)(batch->host + words);
    }
    return true;
}

static void buffer_release(cl_mem *buffer)
{
    if (*buffer)
        clReleaseMemObject(*buffer);
    *buffer = NULL;
}

static void state_release(DeviceMemory *memory)
{
    for (int id = 0; id < BUFFER_COUNT; ++id)
        buffer_release(&memory->state[id]);
    for (int i = 0; i < BATCH_SLOTS; ++i) {
        BatchMemory *batch = &memory->batches[i];
        if (batch->host)
            clEnqueueUnmapMemObject(memory->queue, batch->staging, batch->host, 0, NULL, NULL);
        batch->host = NULL;
        buffer_release(&batch->frame);
        buffer_release(&batch->splats);
        buffer_release(&batch->staging);
    }
    if (memory->queue)
        clFinish(memory->queue);
    memory->bytes = memory->scene_bytes + memory->film_bytes;
    memory->batch = 0;
}

static bool state_make(DeviceMemory *memory, uint batch, Error *error)
{
    uint64_t stride = device_memory_stride(batch);
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id) {
        uint64_t words = stride * memory->words_per_item[id];
        if (id == BUFFER_DIAGNOSTICS || id == BUFFER_COUNTS)
            words = id == BUFFER_COUNTS ? COUNT_WORDS : DIAGNOSTIC_COUNT;
        if (words > 0 && id != BUFFER_SPLATS &&
            !buffer_make(memory, &memory->state[id], CL_MEM_READ_WRITE, words * sizeof(uint), error))
            return false;
    }
    if (!batches_make(memory, stride, error))
        return false;
    memory->batch = batch;
    return true;
}

uint step_list_splats(const StepList *list)
{
    uint sections = 1;
    for (size_t i = 0; i < list->count; ++i)
        sections += list->steps[i].kind == STEP_SPLAT;
    return sections;
}

static uint splat_words(const StepList *list)
{
    return list->words_per_item[BUFFER_SPLATS] * step_list_splats(list);
}

bool device_memory_reserve(DeviceMemory *memory, const StepList *list, Error *error)
{
    uint words[BUFFER_COUNT], batch;
    bool enough = memory->batch > 0;
    for (int id = 0; id < BUFFER_COUNT; ++id) {
        uint wanted = id == BUFFER_SPLATS ? splat_words(list) : list->words_per_item[id];
        enough = enough && wanted <= memory->words_per_item[id];
        words[id] = wanted > memory->words_per_item[id] ? wanted : memory->words_per_item[id];
    }
    if (enough)
        return true;
    if (!batch_choose(memory, words, &batch, error))
        return false;
    state_release(memory);
    memcpy(memory->words_per_item, words, sizeof words);
    return state_make(memory, batch, error);
}

uint device_memory_batch(const DeviceMemory *memory, const StepList *list)
{
    uint words = splat_words(list), items = memory->batch;
    if (words == 0 || (uint64_t)device_memory_stride(items) * words <= memory->splat_words)
        return items;
    items = (uint)(memory->splat_words / words) / STRIDE_STEP * STRIDE_STEP - STRIDE_STEP;
    return items > BATCH_MIN ? items : BATCH_MIN;
}

/* ---- the film ---------------------------------------------------------------------------------------------------- */

/* Bytes for the sums of a film beside all else. */
static double film_room(const DeviceMemory *memory)
{
    return MEMORY_PART * (double)memory->device->info.memory - (double)(memory->bytes - memory->film_bytes);
}

bool device_memory_film_fits(const DeviceMemory *memory, size_t bytes)
{
    return bytes <= memory->device->info.allocation_limit && (double)bytes <= film_room(memory);
}

bool device_memory_reserve_film(DeviceMemory *memory, size_t bytes, Error *error)
{
    const BackendDevice *info = &memory->device->info;
    if (bytes <= memory->film_bytes)
        return true;
    bool fits = device_memory_film_fits(memory, bytes);
    double left = film_room(memory);
    buffer_release(&memory->film);
    memory->bytes -= memory->film_bytes;
    memory->film_bytes = 0;
    if (!fits) {
        char size[32], room[32], single[32];
        error_set(error, "%s: the sums of the film take %s; the device has room for %s, and %s in a single buffer",
                  info->name, size_text(bytes, size, sizeof size),
                  size_text(left > 0.0 ? (uint64_t)left : 0, room, sizeof room),
                  size_text(info->allocation_limit, single, sizeof single));
        return error_fix(error, "use --film=host, or a smaller --resolution or --batch");
    }
    if (!buffer_make(memory, &memory->film, CL_MEM_READ_WRITE, bytes, error))
        return false;
    memory->film_bytes = bytes;
    return true;
}

bool device_memory_photons(DeviceMemory *memory, const PhotonMap *photons, Error *error)
{
    if (!photons || !photons->words || photons->number == memory->photon_number)
        return true;
    size_t bytes = photons->word_count * sizeof(uint);
    buffer_release(&memory->photons);
    memory->photon_number = 0;
    if (!buffer_make(memory, &memory->photons, CL_MEM_READ_ONLY, bytes, error))
        return false;
    cl_int status =
        clEnqueueWriteBuffer(memory->queue, memory->photons, CL_TRUE, 0, bytes, photons->words, 0, NULL, NULL);
    memory->bytes += bytes - memory->photon_bytes;
    memory->photon_bytes = bytes;
    if (status == CL_SUCCESS)
        memory->photon_number = photons->number;
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "copying photons", status);
}

void device_memory_destroy(DeviceMemory *memory)
{
    state_release(memory);
    buffer_release(&memory->film);
    buffer_release(&memory->guide);
    buffer_release(&memory->photons);
    for (int id = 0; id <= BUFFER_BVH; ++id)
        buffer_release(&memory->scene[id]);
    memset(memory, 0, sizeof *memory);
}
