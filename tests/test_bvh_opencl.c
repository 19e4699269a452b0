#include "test_bvh.h"
TCase *bvh_opencl_tcase(void)
{
    return tcase_create("OpenCL");
}
