/* The OpenCL devices of this machine: enumeration, properties, selection. */
#ifndef TWINLIGHT_DEVICES_H
#define TWINLIGHT_DEVICES_H

#include "ocl_status.h"

#include "backend/backend.h"

#define OCL_DEVICES_MAX 64

typedef struct OclDevice {
    cl_platform_id platform;
    cl_device_id id;
    BackendDevice info;
    bool rounds_to_nearest;
    size_t group_limit; /* work-items of the largest work-group */
    bool keeps_programs; /* the driver has its own program cache and compiles kernels on first use */
    size_t index; /* number for --device */
} OclDevice;

/* Fills up to `capacity` devices, in the order of platforms and of each platform's devices; returns how many. */
size_t ocl_devices_find(OclDevice *devices, size_t capacity);

/* Replaces what the driver claims about division and square roots by the result of a probe (rounding_probe.h), with a
 * warning if the claim is false. A probe takes a fraction of a second; unless `anew`, a stored result is used. */
void ocl_device_probe(OclDevice *device, bool anew);

bool ocl_device_is_gpu(const OclDevice *device);

/* BackendInterface.devices (backend/backend.h). */
size_t ocl_devices_list(BackendDevice *devices, size_t capacity, bool probe_all);

/* Selects the device for --device=`choice`: a number, or a part of the name (ignoring case) that matches exactly one
 * device; NULL: the first. Otherwise sets an error that lists the devices. */
bool ocl_device_choose(const char *choice, OclDevice *device, Error *error);

/* BackendInterface.device_index (backend/backend.h). */
bool ocl_device_index(const char *choice, size_t *index, Error *error);

#endif
