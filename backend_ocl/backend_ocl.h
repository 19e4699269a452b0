/* The OpenCL backend: kernels and ray queries on one device, step by step over batches of items. */
#ifndef TWINLIGHT_BACKEND_OCL_H
#define TWINLIGHT_BACKEND_OCL_H

#include "backend/backend.h"

const BackendInterface *backend_ocl(void);

#endif
