/* `twinlight devices`: the backends and their devices. */
#include "command/command.h"

#include "base/json.h"

#include <stdlib.h>

#define DEVICES_MAX 64

static const OptionSpec SPECS[] = {{"json", 0, NULL, "print JSON"}};

static const OptionTable TABLE = {
    "devices",
    "devices [OPTION]...",
    "Lists the backends of this build and their devices, and whether each device rounds correctly.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "A device is chosen by render's --backend and --device.\nMore: man twinlight-devices.",
};

static bool option_set(void *context, int index, const char *value, Error *error)
{
    bool *json = context;
    (void)index;
    (void)value;
    (void)error;
    *json = true;
    return true;
}

static const char *yes_no(bool yes)
{
    return yes ? "yes" : "no";
}

static const char *same_bits(const BackendDevice *device)
{
    if (!device->same_bits)
        return "not expected";
    return device->promises_division ? "promised" : "expected, by the probe";
}

static double gibibytes(uint64_t bytes)
{
    return (double)bytes / 1073741824.0;
}

static void device_text(const BackendDevice *device, size_t index)
{
    printf("  %zu  %s (%s, %u compute units)\n", index, device->name, device->kind, device->units);
    printf("     platform                         %s\n", device->platform);
    printf("     version                          %s\n", device->version);
    printf("     memory                           %.2f GiB, largest buffer %.2f GiB\n", gibibytes(device->memory),
           gibibytes(device->allocation_limit));
    printf("     correctly rounded division, root %s", yes_no(device->rounds_division));
    if (device->promises_division && device->probed > 0)
        printf(device->rounds_division ? ", promised and" : ", though promised,");
    else if (device->probed > 0)
        printf(",");
    if (device->probed > 0)
        printf(" by a probe of %llu divisions and roots", (unsigned long long)device->probed);
    printf("\n");
    printf("     denormal numbers                 %s\n", yes_no(device->keeps_denormals));
    printf("     64-bit integer atomics           %s\n", yes_no(device->atomics64));
    printf("     the same image, bit for bit      %s\n", same_bits(device));
}

static void device_json(JsonWriter *json, const BackendDevice *device, size_t index)
{
    json_object_begin(json, NULL);
    json_unsigned(json, "index", index);
    json_text(json, "name", device->name);
    json_text(json, "kind", device->kind);
    json_text(json, "platform", device->platform);
    json_text(json, "version", device->version);
    json_unsigned(json, "compute_units", device->units);
    json_unsigned(json, "memory_bytes", device->memory);
    json_unsigned(json, "largest_buffer_bytes", device->allocation_limit);
    json_bool(json, "promises_division", device->promises_division);
    json_bool(json, "rounds_division", device->rounds_division);
    json_unsigned(json, "probed_divisions", device->probed);
    json_bool(json, "keeps_denormals", device->keeps_denormals);
    json_bool(json, "atomics64", device->atomics64);
    json_bool(json, "same_bits", device->same_bits);
    json_object_end(json);
}

static void backend_text(const BackendInterface *backend, const BackendDevice *devices, size_t count)
{
    printf("%s\n", backend->name);
    for (size_t i = 0; i < count; ++i)
        device_text(&devices[i], i);
    if (count == 0)
        printf("  no device; for one on the CPU: apt-get install pocl-opencl-icd\n");
}

static void left_out_print(const BackendTable *backends)
{
    for (const BackendLeftOut *lack = backends->left_out; lack && lack->name; ++lack)
        printf("%s\n  not in this build: %s\n  fix: %s\n", lack->name, lack->why, lack->fix);
}

static void devices_print(const BackendTable *backends, bool as_json, BackendDevice *devices)
{
    JsonWriter json;
    json_init(&json, stdout);
    if (as_json)
        json_object_begin(&json, NULL);
    for (int b = 0; b < backends->count; ++b) {
        const BackendInterface *backend = backends->backends[b];
        size_t count = backend->devices(devices, DEVICES_MAX, true);
        if (count > DEVICES_MAX)
            count = DEVICES_MAX;
        if (!as_json) {
            backend_text(backend, devices, count);
            continue;
        }
        json_array_begin(&json, backend->name);
        for (size_t i = 0; i < count; ++i)
            device_json(&json, &devices[i], i);
        json_array_end(&json);
    }
    if (as_json)
        json_object_end(&json);
    else
        left_out_print(backends);
}

int cmd_devices(const BackendTable *backends, int argc, char **argv, Error *error)
{
    bool json = false;
    int first = 0;
    OptionsEnd end = options_parse(&TABLE, argc, argv, option_set, &json, &first, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    if (first < argc) {
        error_set(error, "devices takes no file: %s", argv[first]);
        error_fix(error, "write twinlight devices");
        return EXIT_USAGE;
    }
    BackendDevice *devices = calloc(DEVICES_MAX, sizeof *devices);
    if (!devices) {
        error_memory(error, DEVICES_MAX * sizeof *devices, "the list of devices");
        return EXIT_FAILED;
    }
    devices_print(backends, json, devices);
    free(devices);
    return EXIT_OK;
}
