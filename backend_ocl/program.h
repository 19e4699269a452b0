/* The kernels as programs for one device: built from source, or taken from Twinlight's cache, or from the driver's own
 * if it has one. NVIDIA's takes .7 s for a kernel, so there is a program for each list of kernels that belong
 * together, which is built when one of them is wanted. Drivers that build each kernel on first use get one program. */
#ifndef TWINLIGHT_PROGRAM_H
#define TWINLIGHT_PROGRAM_H

#include "devices.h"

#include "layout/kernel_list.h"
#include "layout/scene_types.h"

#include <stdbool.h>

#define OCL_OPTIONS_SIZE 160

/* Programs by the lists of layout/kernel_list.h. The first has what every rendering needs. */
enum {
    PROGRAM_PATHS,
    PROGRAM_BIDIRECTIONAL,
    PROGRAM_IBPT,
    PROGRAM_CAUSTICS,
    PROGRAM_OPENINGS,
    PROGRAM_CHAINS,
    OCL_PROGRAMS
};

typedef struct OclProgram {
    cl_context context;
    const OclDevice *device;
    char *source;
    char options[OCL_OPTIONS_SIZE];
    cl_program programs[OCL_PROGRAMS]; /* built on first use */
    cl_kernel kernels[KERNEL_COUNT]; /* created on first use */
    bool cached; /* all so far were taken from Twinlight's cache (program_cache.h) */
} OclProgram;

/* Compiler options. Correctly rounded division is requested only from devices that claim it, because other drivers
 * reject the option. */
void ocl_program_options(const OclDevice *device, ulong features, char *options, size_t size);

/* For scenes with these features (FEATURE_*). Builds the first program; the others follow in ocl_program_kernel.
 * `context` and `device` are borrowed. On failure the error has the compiler's first error message, and the log has all
 * of them. */
bool ocl_program_init(OclProgram *program, cl_context context, const OclDevice *device, ulong features, Error *error);
void ocl_program_destroy(OclProgram *program);

/* The source of program `which`: kernels that belong to another one become functions. NULL if there is no memory. */
char *ocl_program_text(const char *source, int which);

/* Kernel by its number (layout/kernel_list.h); NULL with `error` filled on failure. */
cl_kernel ocl_program_kernel(OclProgram *program, unsigned kernel, Error *error);

const char *ocl_kernel_name(unsigned kernel);

#endif
