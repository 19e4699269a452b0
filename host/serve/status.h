/* How far a rendering is, for those who watch it. */
#ifndef TWINLIGHT_SERVE_STATUS_H
#define TWINLIGHT_SERVE_STATUS_H

#include "backend/group.h"
#include "render/run.h"

typedef struct DeviceStatus {
    char name[sizeof((BackendStatistics *)0)->device];
    uint64_t rays; /* since it was opened */
} DeviceStatus;

typedef struct RenderStatus {
    RenderProgress progress;
    double samples_per_pixel;
    double weights[CHAIN_WEIGHTS]; /* ChainStatistics.weights */
    size_t device_count;
    DeviceStatus devices[BACKEND_GROUP_MAX];
    bool ended;
} RenderStatus;

/* Call between passes. */
void status_make(RenderStatus *status, const RenderRun *run, const RenderProgress *progress);

#endif
