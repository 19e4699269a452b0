/* OpenCL devices of this machine: which there are, what they promise, which one is meant. */
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
    bool keeps_programs; /* its driver has a cache of its own, and builds a kernel when that is first used */
    size_t index; /* what --device counts */
} OclDevice;

/* Fills up to `capacity` devices in the order of platforms and of each platform's devices; returns how many were
 * filled. */
size_t ocl_devices_find(OclDevice *devices, size_t capacity);

/* Replaces what the driver promises of division and square roots by what a probe finds (rounding_probe.h), with a
 * warning where it is less. A probe takes a fraction of a second; unless `anew`, what an earlier one found is taken. */
void ocl_device_probe(OclDevice *device, bool anew);

/* The interface's list (backend/backend.h). */
size_t ocl_devices_list(BackendDevice *devices, size_t capacity, bool probe_all);

/* The device that --device=`choice` means: a number, or a part of the name in any case that fits one device; NULL: the
 * first. Otherwise an error that lists the devices. */
bool ocl_device_choose(const char *choice, OclDevice *device, Error *error);

/* The same, as the interface asks it. */
bool ocl_device_index(const char *choice, size_t *index, Error *error);

#endif
