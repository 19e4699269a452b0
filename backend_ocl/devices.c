#include "devices.h"

#include "base/log.h"
#include "rounding_probe.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLATFORMS_MAX 16

/* ---- properties of a device -------------------------------------------------------------------------------------- */

static void device_text(cl_device_id id, cl_device_info what, char *text, size_t size)
{
    text[0] = '\0';
    if (clGetDeviceInfo(id, what, size, text, NULL) != CL_SUCCESS)
        snprintf(text, size, "unknown");
    text[size - 1] = '\0';
}

static cl_ulong device_number(cl_device_id id, cl_device_info what, size_t size)
{
    cl_ulong wide = 0;
    cl_uint narrow = 0;
    if (size == sizeof wide)
        return clGetDeviceInfo(id, what, sizeof wide, &wide, NULL) == CL_SUCCESS ? wide : 0;
    return clGetDeviceInfo(id, what, sizeof narrow, &narrow, NULL) == CL_SUCCESS ? narrow : 0;
}

static bool device_has_extension(cl_device_id id, const char *name)
{
    size_t size = 0;
    bool found = false;
    if (clGetDeviceInfo(id, CL_DEVICE_EXTENSIONS, 0, NULL, &size) != CL_SUCCESS)
        return false;
    char *text = calloc(size + 1, 1);
    if (text && clGetDeviceInfo(id, CL_DEVICE_EXTENSIONS, size, text, NULL) == CL_SUCCESS)
        found = strstr(text, name) != NULL;
    free(text);
    return found;
}

static const char *device_kind(cl_device_id id)
{
    cl_ulong type = device_number(id, CL_DEVICE_TYPE, sizeof(cl_device_type));
    return type & CL_DEVICE_TYPE_GPU           ? "GPU"
           : type & CL_DEVICE_TYPE_CPU         ? "CPU"
           : type & CL_DEVICE_TYPE_ACCELERATOR ? "accelerator"
                                               : "device";
}

bool ocl_device_is_gpu(const OclDevice *device)
{
    return strcmp(device->info.kind, "GPU") == 0;
}

/* Kernels use only + - * / and sqrt in single precision (docs/NUMERICS.md): if these are correctly rounded and
 * denormals are kept, every device computes the same bits as the CPU. */
static bool device_same_bits(const OclDevice *device)
{
    return device->info.rounds_division && device->info.keeps_denormals && device->rounds_to_nearest;
}

static void device_promises(cl_device_id id, OclDevice *device)
{
    BackendDevice *info = &device->info;
    cl_ulong config = device_number(id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof(cl_device_fp_config));
    info->promises_division = (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    info->rounds_division = info->promises_division;
    info->keeps_denormals = (config & CL_FP_DENORM) != 0;
    device->rounds_to_nearest = (config & CL_FP_ROUND_TO_NEAREST) != 0;
    info->same_bits = device_same_bits(device);
    info->atomics64 = device_has_extension(id, "cl_khr_int64_base_atomics");
}

static void device_describe(cl_platform_id platform, OclDevice *device)
{
    BackendDevice *info = &device->info;
    cl_device_id id = device->id;
    char version[128] = "", driver[96];
    clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof info->platform - 1, info->platform, NULL);
    clGetPlatformInfo(platform, CL_PLATFORM_VERSION, sizeof version - 1, version, NULL);
    device_text(id, CL_DEVICE_NAME, info->name, sizeof info->name);
    device_text(id, CL_DRIVER_VERSION, driver, sizeof driver);
    snprintf(info->version, sizeof info->version, "%s, driver %s", version, driver);
    snprintf(info->kind, sizeof info->kind, "%s", device_kind(id));
    info->memory = device_number(id, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof(cl_ulong));
    info->allocation_limit = device_number(id, CL_DEVICE_MAX_MEM_ALLOC_SIZE, sizeof(cl_ulong));
    info->units = (unsigned)device_number(id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof(cl_uint));
    device->group_limit = 1;
    clGetDeviceInfo(id, CL_DEVICE_MAX_WORK_GROUP_SIZE, sizeof device->group_limit, &device->group_limit, NULL);
    /* PoCL: asking for a program's binary would make it compile every kernel, most of which no rendering uses. */
    device->keeps_programs = strcmp(info->platform, "Portable Computing Language") == 0;
    device_promises(id, device);
}

/* ---- enumeration ------------------------------------------------------------------------------------------------- */

size_t ocl_devices_find(OclDevice *devices, size_t capacity)
{
    cl_platform_id platforms[PLATFORMS_MAX];
    cl_uint platform_count = 0;
    size_t found = 0;
    if (clGetPlatformIDs(PLATFORMS_MAX, platforms, &platform_count) != CL_SUCCESS)
        return 0;
    for (cl_uint p = 0; p < platform_count && p < PLATFORMS_MAX; ++p) {
        cl_device_id ids[OCL_DEVICES_MAX];
        cl_uint count = 0;
        if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, OCL_DEVICES_MAX, ids, &count) != CL_SUCCESS)
            continue;
        for (cl_uint d = 0; d < count && d < OCL_DEVICES_MAX && found < capacity; ++d) {
            OclDevice *device = &devices[found];
            memset(device, 0, sizeof *device);
            device->platform = platforms[p];
            device->id = ids[d];
            device->index = found++;
            device_describe(platforms[p], device);
        }
    }
    return found;
}

void ocl_device_probe(OclDevice *device, bool anew)
{
    BackendDevice *info = &device->info;
    RoundingProbe probe;
    Error error = {0};
    if (!rounding_probe_run(device, anew, &probe, &error)) {
        log_message(LOG_WARNING, "cannot probe the divisions and square roots of %s: %s", info->name,
                    error_text(&error));
        return;
    }
    info->probed = probe.compared;
    info->rounds_division = probe.wrong == 0;
    info->same_bits = device_same_bits(device);
    if (info->promises_division && probe.wrong > 0)
        log_message(LOG_WARNING,
                    "%s promises correctly rounded division and square roots, but %llu of %llu results are wrong: %s",
                    info->name, (unsigned long long)probe.wrong, (unsigned long long)probe.compared, probe.first);
}

size_t ocl_devices_list(BackendDevice *devices, size_t capacity, bool probe_all)
{
    OclDevice *all = calloc(OCL_DEVICES_MAX, sizeof *all);
    size_t count = all ? ocl_devices_find(all, OCL_DEVICES_MAX) : 0;
    for (size_t i = 0; i < count && i < capacity; ++i) {
        if (probe_all || !all[i].info.promises_division)
            ocl_device_probe(&all[i], probe_all);
        devices[i] = all[i].info;
    }
    free(all);
    return count;
}

/* ---- the selected one -------------------------------------------------------------------------------------------- */

static bool fix_with_list(const OclDevice *devices, size_t count, Error *error)
{
    char list[400] = "";
    for (size_t i = 0; i < count; ++i) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%zu (%s)", i > 0 ? ", " : "", i, devices[i].info.name);
    }
    return error_fix(error, "use one of: %s; see twinlight devices", list);
}

static bool is_number(const char *text)
{
    return text[0] != '\0' && text[strspn(text, "0123456789")] == '\0' && strlen(text) < 9;
}

static bool name_contains(const char *name, const char *part)
{
    return part[0] != '\0' && strcasestr(name, part) != NULL;
}

static bool device_pick(const OclDevice *devices, size_t count, const char *choice, size_t *picked, Error *error)
{
    size_t matches = 0;
    *picked = 0;
    if (!choice)
        return true;
    if (is_number(choice)) {
        *picked = strtoul(choice, NULL, 10);
        if (*picked < count)
            return true;
        error_set(error, "--device=%s: there is no OpenCL device with that number", choice);
        return fix_with_list(devices, count, error);
    }
    for (size_t i = count; i-- > 0;)
        if (name_contains(devices[i].info.name, choice)) {
            *picked = i;
            ++matches;
        }
    if (matches == 1)
        return true;
    error_set(error,
              matches == 0 ? "--device=%s: no OpenCL device has that in its name"
                           : "--device=%s: more than one OpenCL device has that in its name",
              choice);
    return fix_with_list(devices, count, error);
}

/* An error for no devices. A platform without devices means that its driver failed; PoCL does so if it cannot write its
 * cache. */
static bool no_device(Error *error)
{
    cl_platform_id platform;
    char name[128] = "";
    if (clGetPlatformIDs(1, &platform, NULL) != CL_SUCCESS) {
        error_set(error, "there is no OpenCL device");
        return error_fix(error, "install the driver of the machine's GPU, or PoCL, which computes on the CPU (apt-get "
                                "install pocl-opencl-icd), or use --backend=cpu");
    }
    clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
    error_set(error, "there is no OpenCL device, although a driver is installed (%s)", name);
    return error_fix(error, "PoCL offers none if it cannot write its cache folder: set XDG_CACHE_HOME or "
                            "POCL_CACHE_DIR to a writable folder, or use --backend=cpu");
}

bool ocl_device_choose(const char *choice, OclDevice *device, Error *error)
{
    OclDevice *all = calloc(OCL_DEVICES_MAX, sizeof *all);
    if (!all)
        return error_memory(error, OCL_DEVICES_MAX * sizeof *all, "the list of devices");
    size_t picked, count = ocl_devices_find(all, OCL_DEVICES_MAX);
    bool chosen = false;
    if (count == 0)
        no_device(error);
    else
        chosen = device_pick(all, count, choice, &picked, error);
    if (chosen)
        *device = all[picked];
    free(all);
    return chosen;
}

bool ocl_device_index(const char *choice, size_t *index, Error *error)
{
    OclDevice device = {.index = 0};
    if (!ocl_device_choose(choice, &device, error))
        return false;
    *index = device.index;
    return true;
}
