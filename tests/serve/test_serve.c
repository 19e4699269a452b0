/* Snapshots of a film that changes: what readers see of it is whole, and they never make the rendering wait. */
#include "serve/test_serve.h"

#include "support/test_util.h"

#include "base/timing.h"
#include "render/layers.h"
#include "serve/snapshot.h"

#include <fcntl.h>
#include <spawn.h>
#include <string.h>

extern char **environ;

pid_t program_start(const char *const arguments[4], const char *messages)
{
    char scene[512], *all[16] = {"./twinlight", "render", "--integrator=pt", "--no-png", scene};
    int count = 5;
    pid_t process;
    posix_spawn_file_actions_t actions;
    snprintf(scene, sizeof scene, "%s/scenes/cornell.pbrt", test_source_folder());
    for (int i = 0; i < 4; ++i)
        if (arguments[i])
            all[count++] = (char *)(uintptr_t)arguments[i];
    posix_spawn_file_actions_init(&actions);
    if (messages)
        posix_spawn_file_actions_addopen(&actions, 2, messages, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ck_assert_int_eq(posix_spawn(&process, all[0], &actions, NULL, all, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return process;
}

#define WIDTH 333
#define HEIGHT 211
#define PIXELS (WIDTH * HEIGHT)

/* A film and its layers that are published, in the constant colour `value`. */
typedef struct Scenery {
    Film film;
    PictureSettings settings;
    PictureMemory memory;
    Snapshot snapshot;
} Scenery;

static void scenery_init(Scenery *scenery)
{
    const int crop[4] = {3, 5, 3 + WIDTH, 5 + HEIGHT};
    Error error;
    memset(scenery, 0, sizeof *scenery);
    scenery->settings.scale = 1.0f;
    ck_assert(film_init(&scenery->film, WIDTH + 9, HEIGHT + 9, crop, &error));
    ck_assert(picture_memory_init(&scenery->memory, &scenery->settings, WIDTH, HEIGHT, 5, 2, &error));
    snapshot_init(&scenery->snapshot, WIDTH, HEIGHT);
}

static void scenery_destroy(Scenery *scenery)
{
    film_destroy(&scenery->film);
    picture_memory_destroy(&scenery->memory);
    snapshot_destroy(&scenery->snapshot);
}

/* Pixel i becomes value + i * step. */
static void film_fill(Film *film, int value, int step)
{
    for (int i = 0; i < 3 * PIXELS; ++i)
        film->sums[i] = (int64_t)(value + i / 3 * step) << -film->quantum_exponent;
    for (int i = 0; i < PIXELS; ++i)
        film->counts[i] = 1;
}

static void publish(Scenery *scenery)
{
    const RenderStatus status = {.ended = false};
    const SnapshotSource source = {&scenery->film, &scenery->settings, &scenery->memory, &status};
    pthread_mutex_lock(&scenery->snapshot.lock);
    snapshot_ask(snapshot_find(&scenery->snapshot, SNAPSHOT_PICTURE));
    snapshot_publish(&scenery->snapshot, &source);
    pthread_mutex_unlock(&scenery->snapshot.lock);
}

START_TEST(pixels_are_in_order)
{
    static float rgb[3 * PIXELS];
    Scenery scenery;
    uint64_t version = 0;
    scenery_init(&scenery);
    film_fill(&scenery.film, 1, 1);
    publish(&scenery);
    ck_assert(snapshot_copy(&scenery.snapshot, SNAPSHOT_PICTURE, &version, rgb));
    float unit = rgb[0]; /* of one sample */
    ck_assert(unit > 0.0f);
    for (int i = 0; i < 3 * PIXELS; ++i)
        TEST_NEAR(rgb[i], unit * (float)(1 + i / 3), 1e-3);
    ck_assert(!snapshot_copy(&scenery.snapshot, SNAPSHOT_PICTURE, &version, rgb)); /* nothing newer */
    scenery_destroy(&scenery);
}
END_TEST

/* A thread that reads until it has seen `last`. */
typedef struct Reader {
    Snapshot *snapshot;
    uint64_t last;
    int torn;
} Reader;

static void *reader_run(void *argument)
{
    static float rgb[3 * PIXELS];
    Reader *reader = argument;
    uint64_t version = 0;
    while (version < reader->last) {
        if (!snapshot_copy(reader->snapshot, SNAPSHOT_PICTURE, &version, rgb))
            continue;
        for (int i = 1; i < 3 * PIXELS; ++i)
            if (rgb[i] != rgb[0]) {
                ++reader->torn;
                break;
            }
    }
    return NULL;
}

START_TEST(snapshots_are_whole)
{
    Scenery scenery;
    pthread_t thread;
    scenery_init(&scenery);
    Reader reader = {.snapshot = &scenery.snapshot, .last = 200};
    ck_assert_int_eq(pthread_create(&thread, NULL, reader_run, &reader), 0);
    for (int i = 1; i <= 200; ++i) {
        film_fill(&scenery.film, i, 0);
        publish(&scenery);
    }
    pthread_join(thread, NULL);
    ck_assert_int_eq(reader.torn, 0);
    scenery_destroy(&scenery);
}
END_TEST

static void *copy_run(void *argument)
{
    static float rgb[3 * PIXELS];
    uint64_t version = 0;
    ck_assert(snapshot_copy(argument, SNAPSHOT_PICTURE, &version, rgb));
    ck_assert(rgb[0] == rgb[3 * PIXELS - 1]);
    return NULL;
}

/* A reader waits for a publication to end. */
START_TEST(publication_is_waited_for)
{
    Scenery scenery;
    pthread_t thread;
    scenery_init(&scenery);
    film_fill(&scenery.film, 1, 0);
    publish(&scenery);
    pthread_mutex_lock(&scenery.snapshot.lock);
    float *rgb = scenery.snapshot.layers[0].rgb, last = rgb[3 * PIXELS - 1];
    rgb[3 * PIXELS - 1] = 0.0f; /* as in the middle of a publication */
    ck_assert_int_eq(pthread_create(&thread, NULL, copy_run, &scenery.snapshot), 0);
    usleep(200000);
    rgb[3 * PIXELS - 1] = last;
    pthread_mutex_unlock(&scenery.snapshot.lock);
    pthread_join(thread, NULL);
    scenery_destroy(&scenery);
}
END_TEST

/* Whether a publication is due; if so it is not made. */
static bool due(Snapshot *snapshot)
{
    bool is = snapshot_due(snapshot);
    if (is)
        pthread_mutex_unlock(&snapshot->lock);
    return is;
}

START_TEST(nobody_is_waited_for)
{
    Scenery scenery;
    Snapshot *snapshot = &scenery.snapshot;
    scenery_init(&scenery);
    ck_assert(!due(snapshot)); /* nobody asks */
    snapshot_ask(snapshot_find(snapshot, SNAPSHOT_PICTURE));
    ck_assert(due(snapshot));
    pthread_mutex_lock(&snapshot->lock);
    ck_assert(!due(snapshot)); /* somebody reads; to wait for this very thread would be without end */
    pthread_mutex_unlock(&snapshot->lock);
    publish(&scenery);
    ck_assert(!due(snapshot)); /* too soon */
    scenery_destroy(&scenery);
}
END_TEST

/* Whether a publication is due `age` seconds after the latest one. Asked again if the processor was busy meanwhile. */
static bool due_at(Snapshot *snapshot, double age)
{
    for (;;) {
        double begin = timing_now();
        snapshot->published = begin - age;
        bool is = due(snapshot);
        if (timing_now() - begin < 0.1)
            return is;
    }
}

/* What readers use counts as what a publication takes: the next one waits until both are a small part of the threads'
 * time. */
START_TEST(readers_are_counted)
{
    Scenery scenery;
    Snapshot *snapshot = &scenery.snapshot;
    scenery_init(&scenery);
    snapshot_ask(snapshot_find(snapshot, SNAPSHOT_PICTURE));
    publish(&scenery);
    ck_assert_int_eq(snapshot->threads, 2);
    double cost = 3.0 * SNAPSHOT_TIME_PART * snapshot->threads; /* of three seconds */
    double first = timing_thread(), counted = first;
    snapshot->cost = 0.5 * cost;
    while (timing_thread() < first + 0.5 * cost)
        continue;
    double least = timing_thread() - first;
    snapshot_reader_count(snapshot, &counted);
    double most = timing_thread() - first;
    ck_assert_double_ge(snapshot->cost, 0.5 * cost + 0.999 * least);
    ck_assert_double_le(snapshot->cost, 0.5 * cost + 1.001 * most);
    ck_assert_double_ge(counted, first + 0.999 * least);
    ck_assert_double_le(counted, first + 1.001 * most);
    snapshot->cost = cost;
    const double ages[] = {0.0, SNAPSHOT_SECONDS, 2.5, 4.0, SNAPSHOT_SECONDS_MOST};
    for (int i = 0; i < 5; ++i)
        ck_assert(due_at(snapshot, ages[i]) == (ages[i] > 3.0));
    snapshot->cost = 1e6; /* of clients that ask without end */
    ck_assert(due_at(snapshot, SNAPSHOT_SECONDS_MOST));
    snapshot->cost = 0.0; /* of cheap ones */
    ck_assert(!due_at(snapshot, 0.5 * SNAPSHOT_SECONDS));
    ck_assert(due_at(snapshot, SNAPSHOT_SECONDS));
    scenery_destroy(&scenery);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("serve");
    TCase *snapshots = tcase_create("snapshots");
    tcase_set_timeout(snapshots, 60.0);
    tcase_add_test(snapshots, pixels_are_in_order);
    tcase_add_test(snapshots, snapshots_are_whole);
    tcase_add_test(snapshots, publication_is_waited_for);
    tcase_add_test(snapshots, nobody_is_waited_for);
    tcase_add_test(snapshots, readers_are_counted);
    suite_add_tcase(suite, snapshots);
    suite_add_tcase(suite, tev_case());
    suite_add_tcase(suite, page_case());
    suite_add_tcase(suite, clients_case());
    return test_run(suite);
}
