#include "rounding_probe.h"

#include "program.h"
#include "program_cache.h"
#include "program_source.h"
#include "timeline.h"

#include "kernels/rounding.cl"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Number of operand sets, and how many are computed and compared at a time: doubled from CHUNK_FIRST to CHUNK_LAST. */
#define ITEMS (1u << 20)
#define CHUNK_FIRST (1u << 10)
#define CHUNK_LAST (1u << 17)

/* Nanoseconds after which no further chunk is started. All sets take 0.1 s on two cores, but an hour on simulated
 * devices. */
#define TIME_LIMIT 5000000000u

typedef struct ProbeDevice {
    const char *name;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    cl_kernel kernel;
    cl_mem out;
} ProbeDevice;

static void device_close(ProbeDevice *device)
{
    if (device->out)
        clReleaseMemObject(device->out);
    if (device->kernel)
        clReleaseKernel(device->kernel);
    if (device->program)
        clReleaseProgram(device->program);
    if (device->queue)
        clReleaseCommandQueue(device->queue);
    if (device->context)
        clReleaseContext(device->context);
}

static bool device_open(ProbeDevice *device, const OclDevice *of, const char *source, const char *options, Error *error)
{
    cl_int status;
    const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)of->platform, 0};
    device->name = of->info.name;
    device->context = clCreateContext(properties, 1, &of->id, NULL, NULL, &status);
    if (status == CL_SUCCESS)
        device->queue = clCreateCommandQueue(device->context, of->id, 0, &status);
    if (status == CL_SUCCESS)
        device->program = clCreateProgramWithSource(device->context, 1, &source, NULL, &status);
    if (status == CL_SUCCESS)
        status = clBuildProgram(device->program, 1, &of->id, options, NULL, NULL);
    if (status == CL_SUCCESS)
        device->kernel = clCreateKernel(device->program, "rounding_compute", &status);
    if (status == CL_SUCCESS)
        device->out = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, CHUNK_LAST * ROUNDING_WORDS * sizeof(cl_uint),
                                     NULL, &status);
    return status == CL_SUCCESS || ocl_fail(error, device->name, "building the probe of divisions", status);
}

static bool chunk_launch(const ProbeDevice *device, uint first, uint count, uint *theirs, Error *error)
{
    size_t items = count;
    cl_int status = clSetKernelArg(device->kernel, 0, sizeof first, &first);
    if (status == CL_SUCCESS)
        status = clSetKernelArg(device->kernel, 1, sizeof device->out, &device->out);
    if (status == CL_SUCCESS)
        status = clEnqueueNDRangeKernel(device->queue, device->kernel, 1, NULL, &items, NULL, 0, NULL, NULL);
    if (status == CL_SUCCESS)
        status = clEnqueueReadBuffer(device->queue, device->out, CL_TRUE, 0, items * ROUNDING_WORDS * sizeof *theirs,
                                     theirs, 0, NULL, NULL);
    return status == CL_SUCCESS || ocl_fail(error, device->name, "the probe of divisions", status);
}

/* The sign and payload of a NaN may differ. */
static bool same_result(uint a, uint b)
{
    return a == b || ((a & 0x7fffffffu) > 0x7f800000u && (b & 0x7fffffffu) > 0x7f800000u);
}

static void first_describe(RoundingProbe *probe, uint item, int word, uint ours, uint theirs)
{
    RoundingOperands x = rounding_operands(item);
    char what[64];
    if (word < 3)
        snprintf(what, sizeof what, "%a / %a", word == 1 ? 1.0 : (double)x.a, word == 2 ? 3.0 : (double)x.b);
    else
        snprintf(what, sizeof what, "%ssqrt(%a)", word == 4 ? "1 / " : "", (double)x.c);
    snprintf(probe->first, sizeof probe->first, "%s gives %a, not %a", what, (double)bits_float(theirs),
             (double)bits_float(ours));
}

static void chunk_compare(RoundingProbe *probe, uint first, uint count, const uint *theirs)
{
    for (uint i = 0; i < count; ++i) {
        uint ours[ROUNDING_WORDS];
        platform_item = 0;
        rounding_compute(first + i, ours);
        for (int word = 0; word < (int)ROUNDING_WORDS; ++word)
            if (!same_result(ours[word], theirs[ROUNDING_WORDS * i + (uint)word]) && probe->wrong++ == 0)
                first_describe(probe, first + i, word, ours[word], theirs[ROUNDING_WORDS * i + (uint)word]);
    }
    probe->compared += ROUNDING_OPERATIONS * (uint64_t)count;
}

/* The first chunk is small and not timed, because drivers may compile the kernel on first use. */
static bool chunks_run(const ProbeDevice *device, RoundingProbe *probe, Error *error)
{
    uint *theirs = calloc((size_t)CHUNK_LAST * ROUNDING_WORDS, sizeof *theirs);
    if (!theirs)
        return error_memory(error, CHUNK_LAST * ROUNDING_WORDS * sizeof *theirs, "the probe of divisions");
    uint first = 0, size = CHUNK_FIRST;
    uint64_t start = 0;
    bool done = true;
    while (done && first < ITEMS && (first == 0 || timeline_now() - start < TIME_LIMIT)) {
        uint count = ITEMS - first < size ? ITEMS - first : size;
        done = chunk_launch(device, first, count, theirs, error);
        if (done)
            chunk_compare(probe, first, count, theirs);
        start = first == 0 ? timeline_now() : start;
        first += count;
        size = size < CHUNK_LAST ? 2 * size : size;
    }
    free(theirs);
    return done;
}

/* ---- the cache --------------------------------------------------------------------------------------------------- */

static CacheKey probe_key(const OclDevice *device, const char *source, const char *options)
{
    const char *parts[] = {source, options, device->info.platform, device->info.name, device->info.version};
    return cache_key(parts, (int)(sizeof parts / sizeof parts[0]));
}

static bool probe_recall(CacheKey key, RoundingProbe *probe)
{
    size_t size = 0;
    unsigned char *kept = cache_read(key, &size);
    bool known = kept && size == sizeof *probe;
    if (known)
        memcpy(probe, kept, sizeof *probe);
    free(kept);
    return known;
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

bool rounding_probe_run(const OclDevice *device, bool anew, RoundingProbe *probe, Error *error)
{
    char options[OCL_OPTIONS_SIZE], path[PATH_MAX];
    ProbeDevice opened = {0};
    memset(probe, 0, sizeof *probe);
    char *source = program_source_read(program_source_folder(), "kernels/rounding.cl", error);
    if (!source)
        return false;
    ocl_program_options(device, 0, options, sizeof options);
    CacheKey key = probe_key(device, source, options);
    bool done = !anew && probe_recall(key, probe);
    if (!done) {
        done = device_open(&opened, device, source, options, error) && chunks_run(&opened, probe, error);
        if (done)
            cache_write(key, (const unsigned char *)probe, sizeof *probe, path);
        device_close(&opened);
    }
    free(source);
    return done;
}
