#include "backend/choice.h"

#include "base/log.h"

#include <stdio.h>
#include <string.h>

#define DEVICES_MAX 64

static const BackendInterface *table_find(const BackendTable *table, const char *name)
{
    for (int i = 0; i < table->count; ++i)
        if (strcmp(table->backends[i]->name, name) == 0)
            return table->backends[i];
    return NULL;
}

static bool unknown_backend(const BackendTable *table, const char *name, Error *error)
{
    char names[256] = "";
    for (const BackendLeftOut *lack = table->left_out; lack && lack->name; ++lack)
        if (strcmp(lack->name, name) == 0) {
            error_set(error, "--backend=%s: this build has no such backend: %s", name, lack->why);
            return error_fix(error, "%s", lack->fix);
        }
    for (int i = 0; i < table->count; ++i) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s, ", table->backends[i]->name);
    }
    error_set(error, "--backend=%s: there is no such backend", name);
    return error_fix(error, "use one of: %sall", names);
}

static bool choice_add(BackendChoices *choices, const BackendInterface *interface, const char *device, size_t length,
                       Error *error)
{
    if (choices->count == BACKEND_GROUP_MAX) {
        error_set(error, "more than %d devices at a time", BACKEND_GROUP_MAX);
        return error_fix(error, "choose fewer with --device");
    }
    BackendChoice *choice = &choices->items[choices->count++];
    choice->interface = interface;
    if (length >= sizeof choice->device) {
        error_set(error, "--device: a name of %zu characters is too long", length);
        return error_fix(error, "write a shorter part of it, or the device's number");
    }
    memcpy(choice->device, device, length);
    choice->device[length] = '\0';
    if (!strstr(choices->name, interface->name)) {
        size_t used = strlen(choices->name);
        snprintf(choices->name + used, sizeof choices->name - used, "%s%s", used > 0 ? " + " : "", interface->name);
    }
    return true;
}

/* Adds one choice for each part of a list like "0,2,radeon". */
static bool devices_add(BackendChoices *choices, const BackendInterface *interface, const char *devices, Error *error)
{
    for (const char *word = devices;;) {
        size_t length = strcspn(word, ",");
        if (length == 0) {
            error_set(error, "--device=%s: a device is missing between the commas", devices);
            return error_fix(error, "write numbers or parts of names as twinlight devices lists them, e.g. 0,1");
        }
        if (!choice_add(choices, interface, word, length, error))
            return false;
        if (word[length] == '\0')
            return true;
        word += length + 1;
    }
}

/* Adds all devices expected to give the same bits: with others, the image would depend on how work is divided. */
static bool all_devices_add(BackendChoices *choices, const BackendInterface *interface, Error *error)
{
    static BackendDevice devices[DEVICES_MAX];
    size_t found = interface->devices ? interface->devices(devices, DEVICES_MAX, false) : 0;
    for (size_t i = 0; i < found; ++i) {
        char number[24];
        int length = snprintf(number, sizeof number, "%zu", i);
        if (!devices[i].same_bits)
            log_message(LOG_WARNING, "%s is left out: it is not expected to give the same bits", devices[i].name);
        else if (!choice_add(choices, interface, number, (size_t)length, error))
            return false;
    }
    if (found == 0)
        log_message(LOG_WARNING, "%s has no device on this machine, so --backend=all leaves it out", interface->name);
    return true;
}

/* Rejects choices that are textually equal: a device must not be opened twice. devices_distinct also finds a number and
 * a name that mean the same device, once drivers can be asked. */
static bool choices_distinct(const BackendChoices *choices, Error *error)
{
    for (size_t i = 0; i < choices->count; ++i)
        for (size_t k = 0; k < i; ++k)
            if (choices->items[i].interface == choices->items[k].interface &&
                strcmp(choices->items[i].device, choices->items[k].device) == 0) {
                error_set(error, "--device names %s twice", choices->items[i].device);
                return error_fix(error, "name each device once");
            }
    return true;
}

bool backend_choices_make(BackendChoices *choices, const BackendTable *table, const char *backend, const char *devices,
                          Error *error)
{
    memset(choices, 0, sizeof *choices);
    if (backend && strcmp(backend, "all") == 0) {
        for (int i = 0; i < table->count; ++i) {
            const BackendInterface *interface = table->backends[i];
            bool added = !interface->spans ? choice_add(choices, interface, "", 0, error)
                         : devices         ? devices_add(choices, interface, devices, error)
                                           : all_devices_add(choices, interface, error);
            if (!added)
                return false;
        }
        return choices_distinct(choices, error);
    }
    const BackendInterface *interface = table->backends[0];
    if (backend) {
        interface = table_find(table, backend);
        if (!interface)
            return unknown_backend(table, backend, error);
    }
    if (!devices || !interface->spans) /* --device for a backend without devices is rejected by the caller */
        return choice_add(choices, interface, "", 0, error);
    return devices_add(choices, interface, devices, error) && choices_distinct(choices, error);
}

bool backend_choices_have_devices(const BackendChoices *choices)
{
    for (size_t i = 0; i < choices->count; ++i)
        if (choices->items[i].interface->spans)
            return true;
    return false;
}

static bool devices_distinct(const BackendChoices *choices, Error *error)
{
    size_t indices[BACKEND_GROUP_MAX] = {0};
    for (size_t i = 0; i < choices->count; ++i) {
        const BackendChoice *choice = &choices->items[i];
        if (!choice->interface->device_index || !choice->device[0])
            continue;
        if (!choice->interface->device_index(choice->device, &indices[i], error))
            return false;
        for (size_t k = 0; k < i; ++k)
            if (choices->items[k].interface == choice->interface && indices[k] == indices[i]) {
                error_set(error, "--device: %s and %s are the same device, number %zu", choices->items[k].device,
                          choice->device, indices[i]);
                return error_fix(error, "name each device once");
            }
    }
    return true;
}

bool backend_choices_open(const BackendChoices *choices, const BackendScene *scene, const BackendOptions *options,
                          BackendMember *opened, Error *error)
{
    BackendMember members[BACKEND_GROUP_MAX] = {{NULL, NULL}};
    if (choices->count > 1 && !devices_distinct(choices, error))
        return false;
    for (size_t i = 0; i < choices->count; ++i) {
        BackendOptions own = *options;
        own.device = choices->items[i].device[0] ? choices->items[i].device : NULL;
        members[i].interface = choices->items[i].interface;
        members[i].backend = members[i].interface->open(scene, &own, error);
        if (!members[i].backend) {
            while (i-- > 0)
                members[i].interface->close(members[i].backend);
            return false;
        }
    }
    *opened = members[0];
    if (choices->count == 1)
        return true;
    opened->interface = backend_group_interface();
    opened->backend = backend_group_create(members, choices->count, error);
    return opened->backend != NULL;
}
