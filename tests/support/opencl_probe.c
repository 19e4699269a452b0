#define CL_TARGET_OPENCL_VERSION 120
#include "support/opencl_probe.h"

#include <CL/cl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct OpenclProbe {
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    char name[256];
};

/* What a device must have for the same bits. */
static bool device_suits(cl_device_id device)
{
    cl_device_fp_config config = 0;
    cl_device_fp_config needed = CL_FP_DENORM | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT | CL_FP_ROUND_TO_NEAREST;
    if (clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL) != CL_SUCCESS)
        return false;
    return (config & needed) == needed;
}

static bool device_find(cl_device_id *device)
{
    cl_platform_id platforms[16];
    cl_uint platform_count = 0;
    if (clGetPlatformIDs(16, platforms, &platform_count) != CL_SUCCESS)
        return false;
    for (cl_uint p = 0; p < platform_count && p < 16; ++p) {
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_CPU, 1, device, &count) == CL_SUCCESS && count > 0 &&
            device_suits(*device))
            return true;
    }
    return false;
}

static bool program_build(OpenclProbe *probe, const char *source, const char *options, char *message, size_t size)
{
    cl_int status;
    probe->program = clCreateProgramWithSource(probe->context, 1, &source, NULL, &status);
    if (status == CL_SUCCESS)
        status = clBuildProgram(probe->program, 1, &probe->device, options, NULL, NULL);
    if (status == CL_SUCCESS)
        return true;
    int used = snprintf(message, size, "the probe does not build (status %d): ", status);
    if (probe->program && used > 0 && (size_t)used < size)
        clGetProgramBuildInfo(probe->program, probe->device, CL_PROGRAM_BUILD_LOG, size - (size_t)used, message + used,
                              NULL);
    return false;
}

OpenclProbe *opencl_probe_open(const char *source, const char *options, char *message, size_t message_size,
                               bool *absent)
{
    OpenclProbe *probe = calloc(1, sizeof *probe);
    *absent = !probe || !device_find(&probe->device);
    if (*absent) {
        snprintf(message, message_size, "no OpenCL CPU device with denormals and correctly rounded division");
        free(probe);
        return NULL;
    }
    cl_int status;
    clGetDeviceInfo(probe->device, CL_DEVICE_NAME, sizeof probe->name, probe->name, NULL);
    probe->context = clCreateContext(NULL, 1, &probe->device, NULL, NULL, &status);
    if (status == CL_SUCCESS)
        probe->queue = clCreateCommandQueue(probe->context, probe->device, 0, &status);
    if (status != CL_SUCCESS)
        snprintf(message, message_size, "the device does not open (status %d)", status);
    else if (program_build(probe, source, options, message, message_size))
        return probe;
    opencl_probe_close(probe);
    return NULL;
}

void opencl_probe_close(OpenclProbe *probe)
{
    if (!probe)
        return;
    if (probe->program)
        clReleaseProgram(probe->program);
    if (probe->queue)
        clReleaseCommandQueue(probe->queue);
    if (probe->context)
        clReleaseContext(probe->context);
    free(probe);
}

const char *opencl_probe_device(const OpenclProbe *probe)
{
    return probe->name;
}

static cl_mem buffer_make(OpenclProbe *probe, const uint32_t *words, size_t count)
{
    return clCreateBuffer(probe->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, count * sizeof *words,
                          (void *)(uintptr_t)words, NULL);
}

static bool kernel_run(OpenclProbe *probe, cl_kernel kernel, cl_mem *buffers, uint32_t *out, size_t out_words,
                       size_t items)
{
    bool ok = true;
    for (cl_uint i = 0; i < 3; ++i)
        ok = ok && buffers[i] && clSetKernelArg(kernel, i, sizeof buffers[i], &buffers[i]) == CL_SUCCESS;
    ok = ok && clEnqueueNDRangeKernel(probe->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL) == CL_SUCCESS;
    return ok && clEnqueueReadBuffer(probe->queue, buffers[2], CL_TRUE, 0, out_words * sizeof *out, out, 0, NULL,
                                     NULL) == CL_SUCCESS;
}

bool opencl_probe_run(OpenclProbe *probe, const char *name, const uint32_t *in, size_t in_words, const uint32_t *table,
                      size_t table_words, uint32_t *out, size_t out_words, size_t items)
{
    memset(out, 0, out_words * sizeof *out);
    cl_kernel kernel = clCreateKernel(probe->program, name, NULL);
    if (!kernel)
        return false;
    cl_mem buffers[3] = {buffer_make(probe, in, in_words), buffer_make(probe, table, table_words),
                         buffer_make(probe, out, out_words)};
    bool ok = kernel_run(probe, kernel, buffers, out, out_words, items);
    for (int i = 0; i < 3; ++i)
        if (buffers[i])
            clReleaseMemObject(buffers[i]);
    clReleaseKernel(kernel);
    return ok;
}

/* ---- persistent buffers ------------------------------------------------------------------------------------------ */

OpenclBuffer *opencl_buffer_create(OpenclProbe *probe, const uint32_t *words, size_t count)
{
    return (OpenclBuffer *)buffer_make(probe, words, count);
}

void opencl_buffer_destroy(OpenclBuffer *buffer)
{
    if (buffer)
        clReleaseMemObject((cl_mem)buffer);
}

bool opencl_buffer_write(OpenclProbe *probe, OpenclBuffer *buffer, const uint32_t *words, size_t count)
{
    return clEnqueueWriteBuffer(probe->queue, (cl_mem)buffer, CL_TRUE, 0, count * sizeof *words, words, 0, NULL,
                                NULL) == CL_SUCCESS;
}

bool opencl_buffer_read(OpenclProbe *probe, OpenclBuffer *buffer, uint32_t *words, size_t count)
{
    return clEnqueueReadBuffer(probe->queue, (cl_mem)buffer, CL_TRUE, 0, count * sizeof *words, words, 0, NULL, NULL) ==
           CL_SUCCESS;
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool opencl_probe_launch(OpenclProbe *probe, const char *name, OpenclBuffer *const *buffers, size_t count, size_t items,
                         double *seconds)
{
    cl_kernel kernel = clCreateKernel(probe->program, name, NULL);
    bool ok = kernel != NULL;
    for (cl_uint i = 0; ok && i < count; ++i) {
        cl_mem buffer = (cl_mem)buffers[i];
        ok = buffer && clSetKernelArg(kernel, i, sizeof buffer, &buffer) == CL_SUCCESS;
    }
    double begin = seconds_now();
    ok = ok && clEnqueueNDRangeKernel(probe->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL) == CL_SUCCESS;
    ok = ok && clFinish(probe->queue) == CL_SUCCESS;
    *seconds = seconds_now() - begin;
    if (kernel)
        clReleaseKernel(kernel);
    return ok;
}
