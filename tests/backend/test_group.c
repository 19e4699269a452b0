/* Groups of backends, and the meaning of --backend and --device, tested with fake backends that only record what they
 * are asked. */
#include "support/test_util.h"

#include "backend/choice.h"
#include "backend/shares.h"
#include "layout/diagnostics.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ITEMS_MAX 100000u

/* How often each item was processed; members' threads write disjoint items. */
static unsigned char items_seen[ITEMS_MAX];

struct Backend {
    double speed; /* simulated items per second */
    uint fails_at; /* items delivered before it fails; NONE: never fails */
    uint first, count; /* of the latest pass */
    int passes, closes;
    const char *name;
};

static bool play_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                     const atomic_int *stop, uint64_t *items_done, Error *error)
{
    (void)list, (void)sink;
    uint count = frame->pass.item_count < backend->fails_at ? frame->pass.item_count : backend->fails_at;
    backend->first = frame->pass.first_item;
    backend->count = frame->pass.item_count;
    ++backend->passes;
    for (uint i = 0; i < count && !*stop; ++i)
        ++items_seen[frame->pass.first_item + i];
    *items_done = *stop ? 0 : count;
    double seconds = (double)count / backend->speed;
    struct timespec pause = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&pause, NULL);
    return count == frame->pass.item_count || error_set(error, "%s is lost", backend->name);
}

static void play_close(Backend *backend)
{
    ++backend->closes;
}

static void play_diagnostics(Backend *backend, uint64_t *counters)
{
    counters[0] = (uint64_t)backend->passes;
}

static void play_statistics(Backend *backend, BackendStatistics *statistics)
{
    memset(statistics, 0, sizeof *statistics);
    statistics->closest_rays = 10;
    statistics->threads = 2;
    statistics->width = 3;
    snprintf(statistics->device, sizeof statistics->device, "%s", backend->name);
}

static const BackendInterface PLAY = {.name = "play",
                                      .close = play_close,
                                      .run = play_run,
                                      .diagnostics = play_diagnostics,
                                      .statistics = play_statistics};

static const atomic_int NEVER = 0;

static Backend *group_make(Backend *backends, size_t count)
{
    BackendMember members[BACKEND_GROUP_MAX];
    Error error = {0};
    for (size_t i = 0; i < count; ++i)
        members[i] = (BackendMember){&PLAY, &backends[i]};
    Backend *group = backend_group_create(members, count, &error);
    ck_assert_ptr_nonnull(group);
    return group;
}

static bool pass_run(Backend *group, uint first, uint count, const atomic_int *stop, uint64_t *done, Error *error)
{
    FrameParams frame;
    StepList list = {0};
    memset(&frame, 0, sizeof frame);
    memset(items_seen, 0, sizeof items_seen);
    frame.pass.first_item = first;
    frame.pass.item_count = count;
    return backend_group_interface()->run(group, &frame, &list, NULL, stop, done, error);
}

/* ---- a pass ------------------------------------------------------------------------------------------------------ */

/* Every item is processed exactly once, for any number of members and items, including fewer items than members and a
 * single one. */
START_TEST(test_items_once)
{
    static const uint COUNTS[] = {1, 2, 511, 512, 513, 5000, 77777};
    for (size_t members = 1; members <= BACKEND_GROUP_MAX; members += 5) {
        Backend backends[BACKEND_GROUP_MAX];
        for (size_t i = 0; i < members; ++i)
            backends[i] = (Backend){.speed = 1e7 * (double)(i + 1), .fails_at = NONE, .name = "member"};
        Backend *group = group_make(backends, members);
        for (size_t k = 0; k < 3 * sizeof COUNTS / sizeof COUNTS[0]; ++k) {
            uint count = COUNTS[k / 3], first = 1234;
            uint64_t done = 0;
            Error error = {0};
            ck_assert(pass_run(group, first, count, &NEVER, &done, &error));
            ck_assert_uint_eq(done, count);
            uint wrong = 0;
            for (uint i = 0; i < ITEMS_MAX; ++i)
                wrong += items_seen[i] != (i >= first && i < first + count);
            ck_assert_msg(wrong == 0, "%zu members, %u items: %u wrong", members, count, wrong);
        }
        backend_group_interface()->close(group);
        for (size_t i = 0; i < members; ++i)
            ck_assert_int_eq(backends[i].closes, 1);
    }
}
END_TEST

/* A member four times as fast gets about four times as many items; a very slow one still gets some. */
START_TEST(test_shares_by_speed)
{
    Backend backends[3] = {{.speed = 4e5, .fails_at = NONE, .name = "fast"},
                           {.speed = 1e5, .fails_at = NONE, .name = "slow"},
                           {.speed = 5e3, .fails_at = NONE, .name = "crawling"}};
    Backend *group = group_make(backends, 3);
    Error error = {0};
    for (int pass = 0; pass < 8; ++pass)
        ck_assert(pass_run(group, 0, pass == 0 ? 1536 : 60000, &NEVER, NULL, &error));
    double ratio = (double)backends[0].count / (double)backends[1].count;
    ck_assert_msg(ratio > 2.0 && ratio < 8.0, "%u and %u items", backends[0].count, backends[1].count);
    ck_assert_uint_lt(backends[2].count, backends[1].count / 4);
    ck_assert_int_eq(backends[2].passes, 8);
    backend_group_interface()->close(group);
}
END_TEST

/* With fewer grains of items than members, shares differ by no more than one grain. */
START_TEST(test_shares_of_many)
{
    enum { MEMBERS = 1000 };
    double speeds[MEMBERS];
    uint starts[MEMBERS + 1];
    for (int i = 0; i < MEMBERS; ++i)
        speeds[i] = 1.0 + 1e-3 * (double)(i % 7);
    for (uint grains = 1; grains < 3 * MEMBERS; grains += 500) {
        shares_make(speeds, MEMBERS, grains * SHARE_GRAIN + 5, starts);
        ck_assert_uint_eq(starts[0], 0);
        ck_assert_uint_eq(starts[MEMBERS], grains * SHARE_GRAIN + 5);
        for (int i = 0; i < MEMBERS; ++i)
            ck_assert_uint_le(starts[i + 1] - starts[i], (grains / MEMBERS + 2) * SHARE_GRAIN);
    }
}
END_TEST

START_TEST(test_failure)
{
    Backend backends[3] = {{.speed = 1e7, .fails_at = NONE, .name = "first"},
                           {.speed = 1e7, .fails_at = 100, .name = "second"},
                           {.speed = 1e7, .fails_at = NONE, .name = "third"}};
    Backend *group = group_make(backends, 3);
    Error error = {0};
    uint64_t done = 0;
    ck_assert(!pass_run(group, 0, 9216, &NEVER, &done, &error));
    ck_assert_str_eq(error.message, "error: second is lost");
    ck_assert_uint_eq(done, 9216 - backends[1].count + 100); /* items of the other members count */
    backend_group_interface()->close(group);
}
END_TEST

START_TEST(test_stop)
{
    static const atomic_int stopped = 1;
    Backend backends[2] = {{.speed = 1e7, .fails_at = NONE, .name = "a"},
                           {.speed = 1e7, .fails_at = NONE, .name = "b"}};
    Backend *group = group_make(backends, 2);
    Error error = {0};
    uint64_t done = 1;
    ck_assert(pass_run(group, 0, 5000, &stopped, &done, &error));
    ck_assert_uint_eq(done, 0);
    backend_group_interface()->close(group);
}
END_TEST

START_TEST(test_sums)
{
    Backend backends[2] = {{.speed = 1e7, .fails_at = NONE, .name = "a"},
                           {.speed = 1e7, .fails_at = NONE, .name = "b"}};
    Backend *group = group_make(backends, 2);
    BackendMember out[BACKEND_GROUP_MAX], member = {backend_group_interface(), group};
    BackendStatistics statistics;
    uint64_t counters[DIAGNOSTIC_COUNT];
    Error error = {0};
    ck_assert(pass_run(group, 0, 5000, &NEVER, NULL, &error));
    backend_group_interface()->statistics(group, &statistics);
    backend_group_interface()->diagnostics(group, counters);
    ck_assert_str_eq(statistics.device, "a + b");
    ck_assert_uint_eq(statistics.closest_rays, 20);
    ck_assert_int_eq(statistics.threads, 4);
    ck_assert_uint_eq(statistics.width, 6);
    ck_assert_uint_eq(counters[0], 2);
    ck_assert_uint_eq(backend_group_members(member, out), 2);
    ck_assert_ptr_eq(out[1].backend, &backends[1]);
    ck_assert_uint_eq(backend_group_members(out[0], out), 1);
    backend_group_interface()->close(group);
}
END_TEST

/* ---- --backend and --device -------------------------------------------------------------------------------------- */

static size_t device_count = 3;

static size_t play_devices(BackendDevice *devices, size_t capacity, bool probe_all)
{
    ck_assert(!probe_all);
    for (size_t i = 0; i < device_count && i < capacity; ++i) {
        memset(&devices[i], 0, sizeof devices[i]);
        snprintf(devices[i].name, sizeof devices[i].name, "device %zu", i);
        devices[i].same_bits = i != 1;
    }
    return device_count;
}

/* "a" is another name of device 2. */
static bool play_device_index(const char *device, size_t *index, Error *error)
{
    (void)error;
    *index = strcmp(device, "a") == 0 ? 2 : strtoul(device, NULL, 10);
    return true;
}

static Backend *play_open(const BackendScene *scene, const BackendOptions *options, Error *error)
{
    (void)scene;
    if (options->device && strcmp(options->device, "9") == 0) {
        error_set(error, "no device 9");
        return NULL;
    }
    static Backend opened[BACKEND_GROUP_MAX];
    static int next;
    return &opened[next++ % BACKEND_GROUP_MAX];
}

static size_t play_spans(Backend *backend, const BackendSpan **spans, uint64_t *dropped)
{
    (void)backend, (void)spans, (void)dropped;
    return 0;
}

static const BackendInterface HOST = {.name = "host", .open = play_open, .close = play_close};
static const BackendInterface DEVICES = {.name = "gpu",
                                         .devices = play_devices,
                                         .device_index = play_device_index,
                                         .open = play_open,
                                         .close = play_close,
                                         .spans = play_spans};
static const BackendInterface *const BACKENDS[] = {&HOST, &DEVICES};
static const BackendTable TABLE = {BACKENDS, 2, NULL};

/* Returns "host gpu:0 gpu:a" or "error: ...". */
static const char *choices_text(const char *backend, const char *devices)
{
    static char text[512];
    BackendChoices choices;
    Error error = {0};
    text[0] = '\0';
    if (!backend_choices_make(&choices, &TABLE, backend, devices, &error))
        snprintf(text, sizeof text, "%.400s", error.message);
    else
        for (size_t i = 0; i < choices.count; ++i) {
            size_t used = strlen(text);
            snprintf(text + used, sizeof text - used, "%s%s%s%s", i > 0 ? " " : "", choices.items[i].interface->name,
                     choices.items[i].device[0] ? ":" : "", choices.items[i].device);
        }
    return text;
}

START_TEST(test_choices)
{
    ck_assert_str_eq(choices_text(NULL, NULL), "host");
    ck_assert_str_eq(choices_text("gpu", NULL), "gpu");
    ck_assert_str_eq(choices_text("gpu", "2"), "gpu:2");
    ck_assert_str_eq(choices_text("gpu", "2,a,0"), "gpu:2 gpu:a gpu:0");
    ck_assert_str_eq(choices_text("all", "1"), "host gpu:1");
    ck_assert_str_eq(choices_text("all", NULL), "host gpu:0 gpu:2"); /* device 1 does not promise the same bits */
    ck_assert_str_eq(choices_text("gpu", "0,,1"), "error: --device=0,,1: a device is missing between the commas");
    ck_assert_str_eq(choices_text("gpu", "0,1,0"), "error: --device names 0 twice");
    ck_assert_str_eq(choices_text("none", NULL), "error: --backend=none: there is no such backend");
    ck_assert_str_eq(choices_text("gpu", "0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16"),
                     "error: more than 16 devices at a time");
    device_count = 0;
    ck_assert_str_eq(choices_text("all", NULL), "host");
    device_count = 3;
}
END_TEST

START_TEST(test_choices_open)
{
    static const struct {
        const char *backend, *devices, *error;
    } cases[] = {{"gpu", "0,1,2", NULL},
                 {"all", NULL, NULL},
                 {"gpu", "2,1,a", "2 and a are the same device"},
                 {"all", "0,00", "0 and 00 are the same device"},
                 {"gpu", "0,9", "no device 9"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        BackendChoices choices;
        BackendOptions options = {0};
        BackendMember opened = {NULL, NULL};
        Error error = {0};
        ck_assert(backend_choices_make(&choices, &TABLE, cases[i].backend, cases[i].devices, &error));
        ck_assert(backend_choices_have_devices(&choices));
        bool done = backend_choices_open(&choices, NULL, &options, &opened, &error);
        ck_assert_msg(done == !cases[i].error && (done || strstr(error.message, cases[i].error)), "case %zu: %s", i,
                      error.message);
        if (done)
            opened.interface->close(opened.backend);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("group");
    TCase *tcase = tcase_create("group");
    tcase_set_timeout(tcase, 60.0);
    tcase_add_test(tcase, test_items_once);
    tcase_add_test(tcase, test_shares_by_speed);
    tcase_add_test(tcase, test_shares_of_many);
    tcase_add_test(tcase, test_failure);
    tcase_add_test(tcase, test_stop);
    tcase_add_test(tcase, test_sums);
    tcase_add_test(tcase, test_choices);
    tcase_add_test(tcase, test_choices_open);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
