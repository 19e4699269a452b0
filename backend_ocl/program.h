/* The kernels as a program of one device: built from source, or taken from the cache, which is the driver's own where
 * that has one. */
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
    cl_kernel kernels[KERNEL_COUNT]; /* made when first asked for */
    bool cached; /* it came from Twinlight's cache (program_cache.h) */
} OclProgram;

#define OCL_OPTIONS_SIZE 160

/* The options of a build. A driver refuses the one that asks for correctly rounded division where it does not promise
 * that. */
void ocl_program_options(const OclDevice *device, uint features, char *options, size_t size);

/* Builds the kernels for scenes with these features (FEATURE_*). `context` and `device` are borrowed. On failure the
 * error holds the compiler's first message and the log has all of them. */
bool ocl_program_init(OclProgram *program, cl_context context, const OclDevice *device, uint features, Error *error);
void ocl_program_destroy(OclProgram *program);

/* The kernel of this number (layout/kernel_list.h); NULL on failure. */
cl_kernel ocl_program_kernel(OclProgram *program, unsigned kernel, Error *error);

const char *ocl_kernel_name(unsigned kernel);

#endif
