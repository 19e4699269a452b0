#include "serve/status.h"

#include <string.h>

static void device_make(DeviceStatus *device, const BackendMember *member)
{
    BackendStatistics statistics;
    member->interface->statistics(member->backend, &statistics);
    memcpy(device->name, statistics.device, sizeof device->name);
    device->rays = statistics.closest_rays + statistics.shadow_rays;
}

void status_make(RenderStatus *status, const RenderRun *run, const RenderProgress *progress)
{
    BackendMember members[BACKEND_GROUP_MAX];
    const BackendMember all = {run->interface, run->backend};
    *status = (RenderStatus){.progress = *progress,
                             .samples_per_pixel = (double)run->done / (double)run->crop_pixels,
                             .device_count = backend_group_members(all, members)};
    memcpy(status->weights, run->chains.weights, sizeof status->weights);
    for (size_t i = 0; i < status->device_count; ++i)
        device_make(&status->devices[i], &members[i]);
}
