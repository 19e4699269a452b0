/* Which devices there are and which one is meant. */
#include "test_opencl.h"

#include "backend_cpu.h"
#include "backend_ocl.h"

#include <ctype.h>
#include <string.h>

START_TEST(test_devices_say_what_they_are)
{
    BackendDevice devices[OCL_DEVICES_MAX];
    size_t count = backend_ocl()->devices(devices, OCL_DEVICES_MAX);
    ck_assert_uint_gt(count, 0);
    for (size_t i = 0; i < count; ++i) {
        const BackendDevice *device = &devices[i];
        ck_assert(device->platform[0] && device->name[0] && device->version[0] && device->kind[0]);
        ck_assert(device->memory >= device->allocation_limit && device->allocation_limit > 0 && device->units > 0);
        ck_assert(!device->same_bits || (device->rounds_division && device->keeps_denormals));
    }
    ck_assert_uint_eq(backend_cpu()->devices(devices, OCL_DEVICES_MAX), 1);
    ck_assert(devices[0].same_bits);
}
END_TEST

START_TEST(test_device_by_number_and_name)
{
    OclDevice device, other;
    char name[256];
    Error error = {0};
    ck_assert(ocl_device_choose(NULL, &device, &error));
    ck_assert_uint_eq(device.index, 0);
    ck_assert(ocl_device_choose("0", &other, &error));
    ck_assert_ptr_eq(device.id, other.id);
    if (ocl_devices_find(&other, 1) != 1 || ocl_device_choose("1", &other, &error))
        return; /* names of several devices may be the same */
    for (size_t i = 0; i <= strlen(device.info.name); ++i)
        name[i] = (char)(i % 2 == 0 ? toupper((unsigned char)device.info.name[i])
                                    : tolower((unsigned char)device.info.name[i]));
    ck_assert_msg(ocl_device_choose(name + 1, &other, &error), "%s: %s", name + 1, error.message);
    ck_assert_ptr_eq(device.id, other.id);
}
END_TEST

START_TEST(test_device_that_is_not_there)
{
    static const char *const NAMES[] = {"4711", "no such device", "99999999999999999999"};
    OclDevice device, first;
    test_device(&first);
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; ++i) {
        Error error = {0};
        ck_assert(!ocl_device_choose(NAMES[i], &device, &error));
        ck_assert_ptr_nonnull(strstr(error.message, NAMES[i]));
        ck_assert_ptr_nonnull(strstr(error.fix, "0 ("));
    }
}
END_TEST

TCase *opencl_devices_tests(void)
{
    TCase *devices = tcase_create("devices");
    tcase_set_timeout(devices, 60);
    tcase_add_test(devices, test_devices_say_what_they_are);
    tcase_add_test(devices, test_device_by_number_and_name);
    tcase_add_test(devices, test_device_that_is_not_there);
    return devices;
}
