#include "backend_cpu.h"

const BackendInterface *backend_cpu(void)
{
    return NULL;
}
