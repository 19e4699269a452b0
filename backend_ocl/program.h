/* The kernels as a program for one device: built from source, or taken from Twinlight's cache, or from the driver's own
 * if it has one. */
#ifndef TWINLIGHT_PROGRAM_H
#define TWINLIGHT_PROGRAM_H

#include "devices.h"

#include "layout/kernel_list.h"
#include "layout/scene_types.h"

#include <stdbool.h>

typedef struct OclProgram {
    cl_context context;
    const OclDevice *device;
    cl_program program;
    cl_kernel kernels[KERNEL_COUNT]; /* created on first use */
    bool cached; /* taken from Twinlight's cache (program_cache.h) */
} OclProgram;

#define OCL_OPTIONS_SIZE 160

/* Compiler options. Correctly rounded division is requested only from devices that claim it, because other drivers
 * reject the option. */
void ocl_program_options(const OclDevice *device, uint features, char *options, size_t size);

/* Builds the kernels for scenes with these features (FEATURE_*). `context` and `device` are borrowed. On failure the
 * error has the compiler's first error message, and the log has all of them. */
bool ocl_program_init(OclProgram *program, cl_context context, const OclDevice *device, uint features, Error *error);
void ocl_program_destroy(OclProgram *program);

/* Kernel by its number (layout/kernel_list.h); NULL with `error` filled on failure. */
cl_kernel ocl_program_kernel(OclProgram *program, unsigned kernel, Error *error);

const char *ocl_kernel_name(unsigned kernel);

#endif
