/* OpenCL status codes as errors. */
#ifndef TWINLIGHT_OCL_STATUS_H
#define TWINLIGHT_OCL_STATUS_H

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif

#include "base/error.h"

#include <CL/cl.h>

/* "CL_OUT_OF_RESOURCES"; "status -1234" for codes unknown to OpenCL 1.2. */
const char *ocl_status_name(cl_int status, char *buffer, size_t size);

/* "error: DEVICE: WHAT failed: CL_..." with a fix for that status. Returns false. */
bool ocl_fail(Error *error, const char *device, const char *what, cl_int status);

#endif
