/* The OpenCL backend: devices, programs and their cache, the pipeline, and above all that images are bitwise the
 * CPU's. */
#include "backend/test_opencl.h"

#include <sys/wait.h>

/* Queried in a separate process: a device that runs on threads of this process would not survive Check's forks. */
static bool device_exists(void)
{
    OclDevice device;
    int status = 0;
    pid_t child = fork();
    if (child == 0)
        _exit(ocl_devices_find(&device, 1) > 0 ? 0 : 1);
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

int main(void)
{
    if (!device_exists()) {
        puts("skipped: there is no OpenCL device; fix: apt-get install pocl-opencl-icd");
        return 77;
    }
    Suite *suite = suite_create("opencl");
    suite_add_tcase(suite, opencl_devices_tests());
    suite_add_tcase(suite, opencl_program_tests());
    suite_add_tcase(suite, opencl_bits_tests());
    suite_add_tcase(suite, opencl_bidirectional_tests());
    suite_add_tcase(suite, opencl_inspect_tests());
    suite_add_tcase(suite, opencl_pipeline_tests());
    return test_run(suite);
}
