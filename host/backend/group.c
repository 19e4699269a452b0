#include "backend/group.h"

#include "base/timing.h"
#include "layout/diagnostics.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Weight of the latest pass in a member's measured speed: averages over a few passes, so that one outlier has little
 * effect. */
#define SPEED_BLEND 0.3

/* Least share of a member, relative to the mean: a member that was slow once must be measured again. */
#define SHARE_MIN 0.02

/* Shares are multiples of this many items, to keep members' batches and chunks full. */
#define SHARE_GRAIN 512u

typedef struct GroupMember {
    BackendMember member;
    double speed; /* items per second; 0: not measured yet */
    /* State of the current pass. */
    FrameParams frame;
    const struct GroupRun *run;
    uint64_t delivered;
    double seconds;
    bool done;
    Error error;
} GroupMember;

/* Arguments of `run`, common to all members. */
typedef struct GroupRun {
    const StepList *list;
    const SplatSink *sink;
    const atomic_int *stop;
} GroupRun;

/* The Backend of a group; only this file knows the type. */
typedef struct Group {
    size_t count;
    GroupMember members[BACKEND_GROUP_MAX];
} Group;

static Group *group_of(Backend *backend)
{
    return (Group *)(void *)backend;
}

/* ---- a pass ------------------------------------------------------------------------------------------------------ */

static void *member_run(void *argument)
{
    GroupMember *member = argument;
    const GroupRun *run = member->run;
    double begin = timing_now();
    member->done = member->member.interface->run(member->member.backend, &member->frame, run->list, run->sink,
                                                 run->stop, &member->delivered, &member->error);
    member->seconds = timing_now() - begin;
    return NULL;
}

/* Divides `items` in proportion to speed; members not yet measured count with the mean of the others. */
static void shares_make(const Group *group, uint items, uint shares[BACKEND_GROUP_MAX])
{
    double known = 0.0, sum = 0.0, speeds[BACKEND_GROUP_MAX];
    size_t measured = 0;
    for (size_t i = 0; i < group->count; ++i) {
        known += group->members[i].speed;
        measured += group->members[i].speed > 0.0;
    }
    double mean = measured > 0 ? known / (double)measured : 1.0;
    for (size_t i = 0; i < group->count; ++i) {
        double speed = group->members[i].speed > 0.0 ? group->members[i].speed : mean;
        speeds[i] = fmax(speed, SHARE_MIN * mean);
        sum += speeds[i];
    }
    uint left = items;
    for (size_t i = 0; i + 1 < group->count; ++i) {
        double exact = (double)items * speeds[i] / sum;
        uint share = (uint)(exact / SHARE_GRAIN + 0.5) * SHARE_GRAIN;
        shares[i] = share < left ? share : left;
        left -= shares[i];
    }
    shares[group->count - 1] = left;
}

static void member_learn(GroupMember *member)
{
    if (!member->done || member->delivered < member->frame.pass.item_count || member->delivered == 0)
        return; /* stopped or failed, so its speed is unknown */
    double speed = (double)member->delivered / fmax(member->seconds, 1e-6);
    member->speed = member->speed > 0.0 ? member->speed + SPEED_BLEND * (speed - member->speed) : speed;
}

/* Runs the first member on the calling thread, each other one on a thread of its own. A member whose thread cannot be
 * started also runs on the calling thread, one after the other. */
static bool group_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                      const atomic_int *stop, uint64_t *items_done, Error *error)
{
    Group *group = group_of(backend);
    const GroupRun run = {list, sink, stop};
    uint shares[BACKEND_GROUP_MAX] = {0}, first = frame->pass.first_item;
    pthread_t threads[BACKEND_GROUP_MAX];
    bool started[BACKEND_GROUP_MAX] = {false};
    shares_make(group, frame->pass.item_count, shares);
    for (size_t i = 0; i < group->count; ++i) {
        GroupMember *member = &group->members[i];
        member->frame = *frame;
        member->frame.pass.first_item = first;
        member->frame.pass.item_count = shares[i];
        member->run = &run;
        member->delivered = 0;
        member->done = true;
        member->error = (Error){0};
        first += shares[i];
    }
    for (size_t i = 1; i < group->count; ++i)
        if (shares[i] > 0)
            started[i] = pthread_create(&threads[i], NULL, member_run, &group->members[i]) == 0;
    bool done = true;
    uint64_t delivered = 0;
    for (size_t i = 0; i < group->count; ++i) {
        GroupMember *member = &group->members[i];
        if (started[i])
            pthread_join(threads[i], NULL);
        else if (shares[i] > 0)
            member_run(member);
        member_learn(member);
        delivered += member->delivered;
        if (!member->done && done) {
            done = false;
            *error = member->error;
        }
    }
    if (items_done)
        *items_done = delivered;
    return done;
}

/* ---- diagnostics and statistics ---------------------------------------------------------------------------------- */

static void group_diagnostics(Backend *backend, uint64_t *counters)
{
    Group *group = group_of(backend);
    memset(counters, 0, DIAGNOSTIC_COUNT * sizeof *counters);
    for (size_t i = 0; i < group->count; ++i) {
        uint64_t own[DIAGNOSTIC_COUNT] = {0};
        group->members[i].member.interface->diagnostics(group->members[i].member.backend, own);
        for (int k = 0; k < DIAGNOSTIC_COUNT; ++k)
            counters[k] += own[k];
    }
}

/* Appends " + NAME", or NAME if `out` is empty; parts that do not fit are dropped. */
static void device_append(char *out, size_t size, const char *name)
{
    size_t used = strlen(out);
    const char *parts[2] = {used > 0 ? " + " : "", name};
    for (int i = 0; i < 2; ++i) {
        size_t length = strlen(parts[i]), room = size - 1 - used;
        length = length < room ? length : room;
        memcpy(out + used, parts[i], length);
        used += length;
        out[used] = '\0';
    }
}

static void group_statistics(Backend *backend, BackendStatistics *statistics)
{
    const Group *group = group_of(backend);
    memset(statistics, 0, sizeof *statistics);
    for (size_t i = 0; i < group->count; ++i) {
        BackendStatistics own;
        group->members[i].member.interface->statistics(group->members[i].member.backend, &own);
        statistics->closest_rays += own.closest_rays;
        statistics->shadow_rays += own.shadow_rays;
        statistics->ray_seconds += own.ray_seconds;
        statistics->build_seconds += own.build_seconds;
        statistics->bytes += own.bytes;
        statistics->threads += own.threads;
        statistics->width += own.width;
        device_append(statistics->device, sizeof statistics->device, own.device);
    }
}

static void group_close(Backend *backend)
{
    Group *group = group_of(backend);
    if (!group)
        return;
    for (size_t i = 0; i < group->count; ++i)
        group->members[i].member.interface->close(group->members[i].member.backend);
    free(group);
}

const BackendInterface *backend_group_interface(void)
{
    static const BackendInterface interface = {.name = "group",
                                               .close = group_close,
                                               .run = group_run,
                                               .diagnostics = group_diagnostics,
                                               .statistics = group_statistics};
    return &interface;
}

Backend *backend_group_create(const BackendMember *members, size_t count, Error *error)
{
    assert(count >= 1 && count <= BACKEND_GROUP_MAX);
    Group *group = calloc(1, sizeof *group);
    if (!group) {
        error_memory(error, sizeof *group, "a group of backends");
        for (size_t i = 0; i < count; ++i)
            members[i].interface->close(members[i].backend);
        return NULL;
    }
    group->count = count;
    for (size_t i = 0; i < count; ++i)
        group->members[i].member = members[i];
    return (Backend *)(void *)group;
}

size_t backend_group_members(BackendMember of, BackendMember *out)
{
    if (of.interface != backend_group_interface()) {
        out[0] = of;
        return 1;
    }
    const Group *group = group_of(of.backend);
    for (size_t i = 0; i < group->count; ++i)
        out[i] = group->members[i].member;
    return group->count;
}
