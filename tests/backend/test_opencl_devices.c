/* Listing devices and selecting one. */
#include "backend/test_opencl.h"

#include "backend_cpu.h"
#include "backend_ocl.h"
#include "rounding_probe.h"

#include "kernels/rounding.cl"

#include <ctype.h>
#include <math.h>
#include <string.h>

START_TEST(test_devices_say_what_they_are)
{
    BackendDevice devices[OCL_DEVICES_MAX];
    size_t count = backend_ocl()->devices(devices, OCL_DEVICES_MAX, true);
    ck_assert_uint_gt(count, 0);
    for (size_t i = 0; i < count; ++i) {
        const BackendDevice *device = &devices[i];
        ck_assert(device->platform[0] && device->name[0] && device->version[0] && device->kind[0]);
        ck_assert(device->memory >= device->allocation_limit && device->allocation_limit > 0 && device->units > 0);
        ck_assert(!device->same_bits || (device->rounds_division && device->keeps_denormals));
        ck_assert_uint_gt(device->probed, 0);
    }
    ck_assert_uint_eq(backend_cpu()->devices(devices, OCL_DEVICES_MAX, true), 1);
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
        return; /* several devices may have the same name */
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

/* ---- the probe of divisions -------------------------------------------------------------------------------------- */

START_TEST(test_probe_finds_what_is_promised)
{
    OclDevice device, again;
    RoundingProbe probe, kept;
    Error error = {0};
    test_device(&device);
    again = device;
    ck_assert_msg(rounding_probe_run(&device, true, &probe, &error), "%s", error.message);
    ck_assert_uint_gt(probe.compared, 5000000);
    ck_assert_msg(!device.info.promises_division || probe.wrong == 0, "%s", probe.first);
    ck_assert(rounding_probe_run(&device, false, &kept, &error));
    ck_assert_mem_eq(&probe, &kept, sizeof probe);
    ocl_device_probe(&again, false);
    ck_assert_uint_eq(again.info.probed, probe.compared);
    ck_assert(again.info.rounds_division == (probe.wrong == 0));
    ck_assert(!device.info.promises_division || again.info.same_bits == device.info.same_bits);
}
END_TEST

/* Distance from the nearest number of `bits` mantissa bits, in units of its last place. With 24, numbers halfway
 * between two floats are 0.5 away; with 25, they are 0 away. */
static long double distance_to_bits(long double x, int bits)
{
    int exponent;
    long double mantissa = ldexpl(frexpl(fabsl(x), &exponent), bits);
    return fabsl(mantissa - rintl(mantissa));
}

/* Many operands make common shortcuts fail that are right for most numbers. */
START_TEST(test_probe_operands_are_hard)
{
    enum { ITEMS = 1 << 16 };
    int products = 0, denormals = 0, close = 0, halves = 0, neighbours = 0;
    for (uint i = 0; i < ITEMS; ++i) {
        RoundingOperands x = rounding_operands(i);
        float quotient = x.a / x.b, product = x.a * (1.0f / x.b);
        products += isfinite(quotient) && product != quotient;
        denormals += quotient != 0.0f && fabsf(quotient) < 1.17549435e-38f;
        if (i % 8 < 6)
            continue;
        ck_assert(isnormal(x.a) && isnormal(x.b) && isnormal(x.c));
        long double ratio = (long double)x.a / (long double)x.b;
        close += distance_to_bits(ratio, 25) < 1e-5L;
        halves += distance_to_bits(ratio, 24) > 0.4L;
        neighbours += distance_to_bits(ratio, 24) < 0.1L;
        ck_assert(distance_to_bits(sqrtl((long double)x.c), 25) < 1e-4L);
        ck_assert(distance_to_bits(sqrtl((long double)x.c), 24) > 0.4L);
    }
    ck_assert_int_gt(products, ITEMS / 10);
    ck_assert_int_gt(denormals, ITEMS / 20);
    ck_assert_int_gt(close, ITEMS / 5);
    ck_assert_int_gt(halves, ITEMS / 10);
    ck_assert_int_gt(neighbours, ITEMS / 20);
}
END_TEST

TCase *opencl_devices_tests(void)
{
    TCase *devices = tcase_create("devices");
    tcase_set_timeout(devices, 60);
    tcase_add_test(devices, test_devices_say_what_they_are);
    tcase_add_test(devices, test_device_by_number_and_name);
    tcase_add_test(devices, test_device_that_is_not_there);
    tcase_add_test(devices, test_probe_finds_what_is_promised);
    tcase_add_test(devices, test_probe_operands_are_hard);
    return devices;
}
