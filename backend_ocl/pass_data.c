#include "pass_data.h"

#include "ocl_status.h"

/* Offsets and pitches, bytes: fields are pass_stride words apart on the host and item_count words on the device. */
typedef struct Region {
    size_t device[3], host[3], size[3];
    size_t device_row, host_row;
} Region;

static Region region_of(const FrameParams *frame, const StepList *list)
{
    return (Region){.host = {frame->pass.first_item * sizeof(uint), 0, 0},
                    .size = {frame->pass.item_count * sizeof(uint), list->pass_fields, 1},
                    .device_row = frame->pass.item_count * sizeof(uint),
                    .host_row = list->pass_stride * sizeof(uint)};
}

bool pass_data_begin(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error)
{
    cl_int status = CL_SUCCESS;
    if (list->guide)
        status = clEnqueueWriteBuffer(memory->queue, memory->guide, CL_TRUE, 0, sizeof *list->guide, list->guide, 0,
                                      NULL, NULL);
    if (status == CL_SUCCESS && !device_memory_photons(memory, list->photons, error))
        return false;
    if (status != CL_SUCCESS || !list->pass_words || frame->pass.item_count == 0)
        return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "copying a pass's guide", status);
    Region region = region_of(frame, list);
    cl_mem *buffer = &memory->state[BUFFER_PASS];
    *buffer = clCreateBuffer(memory->context, CL_MEM_READ_WRITE, region.size[0] * region.size[1], NULL, &status);
    if (status == CL_SUCCESS)
        status = clEnqueueWriteBufferRect(memory->queue, *buffer, CL_TRUE, region.device, region.host, region.size,
                                          region.device_row, 0, region.host_row, 0, list->pass_words, 0, NULL, NULL);
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "copying a pass's data", status);
}

bool pass_data_end(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error)
{
    cl_mem *buffer = &memory->state[BUFFER_PASS];
    if (!list->pass_words || !*buffer)
        return true;
    Region region = region_of(frame, list);
    cl_int status = clEnqueueReadBufferRect(memory->queue, *buffer, CL_TRUE, region.device, region.host, region.size,
                                            region.device_row, 0, region.host_row, 0, list->pass_words, 0, NULL, NULL);
    clReleaseMemObject(*buffer);
    *buffer = NULL;
    return status == CL_SUCCESS || ocl_fail(error, memory->device->info.name, "copying a pass's data back", status);
}
