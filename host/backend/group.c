#include "backend/group.h"

#include "backend/shares.h"
#include "base/timing.h"
#include "layout/diagnostics.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

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

static void member_learn(GroupMember *member)
{
    if (!member->done || member->delivered < member->frame.pass.item_count || member->delivered == 0)
        return; /* stopped or failed, so its speed is unknown */
    shares_learn(&member->speed, member->delivered, member->seconds);
}

/* Runs the first member on the calling thread, each other one on a thread of its own. A member whose thread cannot be
 * started also runs on the calling thread, one after the other. */
static bool group_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                      const atomic_int *stop, uint64_t *items_done, Error *error)
{
    Group *group = group_of(backend);
    const GroupRun run = {list, sink, stop};
    double speeds[BACKEND_GROUP_MAX];
    uint starts[BACKEND_GROUP_MAX + 1];
    pthread_t threads[BACKEND_GROUP_MAX];
    bool started[BACKEND_GROUP_MAX] = {false};
    for (size_t i = 0; i < group->count; ++i)
        speeds[i] = group->members[i].speed;
    shares_make(speeds, group->count, frame->pass.item_count, starts);
    for (size_t i = 0; i < group->count; ++i) {
        GroupMember *member = &group->members[i];
        member->frame = *frame;
        member->frame.pass.first_item += starts[i];
        member->frame.pass.item_count = starts[i + 1] - starts[i];
        member->run = &run;
        member->delivered = 0;
        member->done = true;
        member->error = (Error){0};
    }
    for (size_t i = 1; i < group->count; ++i)
        if (starts[i + 1] > starts[i])
            started[i] = pthread_create(&threads[i], NULL, member_run, &group->members[i]) == 0;
    bool done = true;
    uint64_t delivered = 0;
    for (size_t i = 0; i < group->count; ++i) {
        GroupMember *member = &group->members[i];
        if (started[i])
            pthread_join(threads[i], NULL);
        else if (starts[i + 1] > starts[i])
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

void backend_statistics_add(BackendStatistics *sum, const BackendStatistics *own)
{
    sum->closest_rays += own->closest_rays;
    sum->shadow_rays += own->shadow_rays;
    sum->ray_seconds += own->ray_seconds;
    sum->build_seconds += own->build_seconds;
    sum->bytes += own->bytes;
    sum->threads += own->threads;
    sum->width += own->width;
    device_append(sum->device, sizeof sum->device, own->device);
}

static void group_statistics(Backend *backend, BackendStatistics *statistics)
{
    const Group *group = group_of(backend);
    memset(statistics, 0, sizeof *statistics);
    for (size_t i = 0; i < group->count; ++i) {
        BackendStatistics own;
        group->members[i].member.interface->statistics(group->members[i].member.backend, &own);
        backend_statistics_add(statistics, &own);
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
