/* The CPU backend: a pool of threads that runs the kernels as C and queries Embree for rays. */
#ifndef TWINLIGHT_BACKEND_CPU_H
#define TWINLIGHT_BACKEND_CPU_H

#include "backend/backend.h"

const BackendInterface *backend_cpu(void);

#endif
