#include "device_film.h"

bool device_film_check(const OclDevice *device, Error *error)
{
    if (device->info.atomics64)
        return true;
    error_set(error, "%s has no 64-bit integer atomics (cl_khr_int64_base_atomics), which --film=device needs",
              device->info.name);
    return error_fix(error, "use --film=host, which gives the same image");
}

bool device_film_begin(DeviceMemory *memory, size_t words, Error *error)
{
    static const cl_ulong ZERO = 0;
    if (!device_memory_reserve_film(memory, words * sizeof ZERO, error))
        return false;
    cl_int status =
        clEnqueueFillBuffer(memory->queue, memory->film, &ZERO, sizeof ZERO, 0, words * sizeof ZERO, 0, NULL, NULL);
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "clearing the film", status);
}

bool device_film_end(DeviceMemory *memory, const SplatSink *sink, Timeline *timeline, uint64_t batch, Error *error)
{
    cl_int status;
    cl_event copied;
    uint64_t *words = clEnqueueMapBuffer(memory->queue, memory->film, CL_TRUE, CL_MAP_READ, 0,
                                         sink->sum_words * sizeof *words, 0, NULL, &copied, &status);
    if (status != CL_SUCCESS)
        return ocl_fail(error, memory->device->info.name, "reading the film", status);
    timeline_add_event(timeline, copied, "copy sums", SPAN_COPY, batch);
    clReleaseEvent(copied);
    uint64_t begin = timeline_now();
    sink->sums(sink->context, words);
    timeline_add(timeline,
                 (BackendSpan){
                     .name = "add to film", .track = SPAN_FILM, .batch = batch, .begin = begin, .end = timeline_now()});
    status = clEnqueueUnmapMemObject(memory->queue, memory->film, words, 0, NULL, NULL);
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "reading the film", status);
}
