#include "ocl_status.h"

#include <stdio.h>

typedef struct StatusName {
    cl_int status;
    const char *name;
} StatusName;

#define STATUS(code)                                                                                                   \
    {                                                                                                                  \
        code, #code                                                                                                    \
    }
static const StatusName STATUS_NAMES[] = {
    STATUS(CL_DEVICE_NOT_FOUND),
    STATUS(CL_DEVICE_NOT_AVAILABLE),
    STATUS(CL_COMPILER_NOT_AVAILABLE),
    STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE),
    STATUS(CL_OUT_OF_RESOURCES),
    STATUS(CL_OUT_OF_HOST_MEMORY),
    STATUS(CL_PROFILING_INFO_NOT_AVAILABLE),
    STATUS(CL_MAP_FAILURE),
    STATUS(CL_BUILD_PROGRAM_FAILURE),
    STATUS(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
    STATUS(CL_INVALID_VALUE),
    STATUS(CL_INVALID_PLATFORM),
    STATUS(CL_INVALID_DEVICE),
    STATUS(CL_INVALID_CONTEXT),
    STATUS(CL_INVALID_COMMAND_QUEUE),
    STATUS(CL_INVALID_HOST_PTR),
    STATUS(CL_INVALID_MEM_OBJECT),
    STATUS(CL_INVALID_BINARY),
    STATUS(CL_INVALID_BUILD_OPTIONS),
    STATUS(CL_INVALID_PROGRAM),
    STATUS(CL_INVALID_PROGRAM_EXECUTABLE),
    STATUS(CL_INVALID_KERNEL_NAME),
    STATUS(CL_INVALID_KERNEL),
    STATUS(CL_INVALID_ARG_INDEX),
    STATUS(CL_INVALID_ARG_VALUE),
    STATUS(CL_INVALID_ARG_SIZE),
    STATUS(CL_INVALID_KERNEL_ARGS),
    STATUS(CL_INVALID_WORK_DIMENSION),
    STATUS(CL_INVALID_WORK_GROUP_SIZE),
    STATUS(CL_INVALID_WORK_ITEM_SIZE),
    STATUS(CL_INVALID_GLOBAL_OFFSET),
    STATUS(CL_INVALID_EVENT_WAIT_LIST),
    STATUS(CL_INVALID_EVENT),
    STATUS(CL_INVALID_OPERATION),
    STATUS(CL_INVALID_BUFFER_SIZE),
    STATUS(CL_INVALID_GLOBAL_WORK_SIZE),
    STATUS(CL_INVALID_PROPERTY),
};
#undef STATUS

const char *ocl_status_name(cl_int status, char *buffer, size_t size)
{
    for (size_t i = 0; i < sizeof STATUS_NAMES / sizeof STATUS_NAMES[0]; ++i)
        if (STATUS_NAMES[i].status == status)
            return STATUS_NAMES[i].name;
    snprintf(buffer, size, "status %d", status);
    return buffer;
}

bool ocl_fail(Error *error, const char *device, const char *what, cl_int status)
{
    char buffer[32];
    error_set(error, "%s: %s failed: %s", device, what, ocl_status_name(status, buffer, sizeof buffer));
    switch (status) {
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
    case CL_OUT_OF_RESOURCES:
    case CL_OUT_OF_HOST_MEMORY:
        return error_fix(error,
                         "try a smaller --batch=N, close other programs that use the device, or use --backend=cpu");
    case CL_COMPILER_NOT_AVAILABLE:
        return error_fix(error, "this device cannot build programs; choose another (see twinlight devices)");
    default:
        return error_fix(error, "choose another device (see twinlight devices) or --backend=cpu; if this happens "
                                "repeatedly, suspect the device's driver");
    }
}
