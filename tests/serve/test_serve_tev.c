/* The program's exchange with tev: a server that reads packets as tev does, one that never reads, one that goes away,
 * and none. */
#include "serve/test_serve.h"

#include "support/test_files.h"
#include "support/test_util.h"

#include "base/timing.h"
#include "image/read.h"

#include <arpa/inet.h>
#include <pthread.h>
#include <stdint.h>
#include <sys/socket.h>
#include <sys/wait.h>

#define PACKET_BYTES_MAX ((size_t)4 << 20)

/* A viewer. */
typedef struct Viewer {
    int listener;
    unsigned port;
    int leaves_after; /* the first connection is closed after so many packets; 0: never */
    pthread_t thread;
    /* What was received. */
    int connections, images, updates; /* updates: of the last row */
    char name[512];
    int width, height;
    float *rgb;
    const char *wrong; /* with a packet; NULL: nothing */
} Viewer;

/* ---- packets ----------------------------------------------------------------------------------------------------- */

/* A packet being read. */
typedef struct Reading {
    Viewer *viewer;
    const unsigned char *next, *end;
} Reading;

static void wrong(Reading *reading, const char *what)
{
    if (!reading->viewer->wrong)
        reading->viewer->wrong = what;
    reading->next = reading->end;
}

static int64_t number(Reading *reading, int bytes)
{
    uint64_t value = 0;
    if (reading->end - reading->next < bytes) {
        wrong(reading, "it is too short");
        return 0;
    }
    for (int i = 0; i < bytes; ++i)
        value |= (uint64_t)*reading->next++ << (8 * i);
    return bytes == 4 ? (int32_t)value : (int64_t)value;
}

static const char *text(Reading *reading)
{
    const char *start = (const char *)reading->next;
    const unsigned char *end = memchr(reading->next, 0, (size_t)(reading->end - reading->next));
    if (!end) {
        wrong(reading, "a name has no end");
        return "";
    }
    reading->next = end + 1;
    return start;
}

static void channels_read(Reading *reading)
{
    if (number(reading, 4) != 3)
        wrong(reading, "not three channels");
    for (int c = 0; c < 3; ++c)
        if (strcmp(text(reading), (const char *[]){"R", "G", "B"}[c]) != 0)
            wrong(reading, "another channel");
}

static void image_create(Reading *reading)
{
    Viewer *viewer = reading->viewer;
    snprintf(viewer->name, sizeof viewer->name, "%s", text(reading));
    viewer->width = (int)number(reading, 4);
    viewer->height = (int)number(reading, 4);
    channels_read(reading);
    if (viewer->width < 1 || viewer->height < 1 || viewer->width > 4096 || viewer->height > 4096) {
        wrong(reading, "the size");
        return;
    }
    ++viewer->images;
    free(viewer->rgb);
    viewer->rgb = calloc((size_t)(3 * viewer->width * viewer->height), sizeof *viewer->rgb);
}

static void pixels_read(Reading *reading, const int *rectangle, const int64_t *offsets, const int64_t *strides)
{
    Viewer *viewer = reading->viewer;
    int64_t values = (reading->end - reading->next) / 4, pixels = (int64_t)rectangle[2] * rectangle[3];
    for (int64_t i = 0; i < pixels; ++i) {
        int64_t x = rectangle[0] + i % rectangle[2], y = rectangle[1] + i / rectangle[2];
        for (int c = 0; c < 3; ++c) {
            int64_t from = offsets[c] + i * strides[c];
            if (from < 0 || from >= values) {
                wrong(reading, "a value is outside the packet");
                return;
            }
            memcpy(&viewer->rgb[3 * (y * viewer->width + x) + c], reading->next + 4 * from, 4);
        }
    }
    if (4 * 3 * pixels != reading->end - reading->next)
        wrong(reading, "it has more data than pixels");
    viewer->updates += rectangle[1] + rectangle[3] == viewer->height;
}

static void image_update(Reading *reading)
{
    Viewer *viewer = reading->viewer;
    int rectangle[4];
    int64_t offsets[3], strides[3];
    if (strcmp(text(reading), viewer->name) != 0)
        wrong(reading, "another image");
    channels_read(reading);
    for (int i = 0; i < 4; ++i)
        rectangle[i] = (int)number(reading, 4);
    for (int c = 0; c < 3; ++c)
        offsets[c] = number(reading, 8);
    for (int c = 0; c < 3; ++c)
        strides[c] = number(reading, 8);
    if (rectangle[0] < 0 || rectangle[1] < 0 || rectangle[2] < 1 || rectangle[3] < 1 ||
        rectangle[0] + rectangle[2] > viewer->width || rectangle[1] + rectangle[3] > viewer->height)
        wrong(reading, "the rectangle is not in the image");
    else if (!viewer->wrong)
        pixels_read(reading, rectangle, offsets, strides);
}

static void packet_read(Viewer *viewer, const unsigned char *bytes, size_t size)
{
    Reading reading = {viewer, bytes, bytes + size};
    int operation = (int)number(&reading, 1);
    number(&reading, 1); /* whether the image comes to the front */
    if (operation == 4)
        image_create(&reading);
    else if (operation == 6)
        image_update(&reading);
    else
        wrong(&reading, "an unknown operation");
}

/* ---- the viewer -------------------------------------------------------------------------------------------------- */

static bool bytes_read(int from, unsigned char *bytes, size_t size)
{
    return size == 0 || recv(from, bytes, size, MSG_WAITALL) == (ssize_t)size;
}

static void connection_serve(Viewer *viewer, int from, unsigned char *bytes)
{
    int packets = 0;
    while (!viewer->wrong && (viewer->connections > 1 || !viewer->leaves_after || packets < viewer->leaves_after)) {
        unsigned char length[4];
        if (!bytes_read(from, length, 4))
            return;
        Reading reading = {viewer, length, length + 4};
        size_t size = (size_t)number(&reading, 4);
        if (size < 6 || size > PACKET_BYTES_MAX || !bytes_read(from, bytes, size - 4)) {
            viewer->wrong = "its length";
            return;
        }
        packet_read(viewer, bytes, size - 4);
        ++packets;
    }
}

/* Ends when the listener is shut down. */
static void *viewer_run(void *argument)
{
    Viewer *viewer = argument;
    unsigned char *bytes = malloc(PACKET_BYTES_MAX);
    for (int from; (from = accept(viewer->listener, NULL, NULL)) >= 0;) {
        ++viewer->connections;
        connection_serve(viewer, from, bytes);
        close(from);
    }
    free(bytes);
    return NULL;
}

/* A socket that listens on a port of its own. Connections are accepted by the system even if nobody takes them. */
static void viewer_listen(Viewer *viewer)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof address;
    int small = 4096;
    viewer->listener = socket(AF_INET, SOCK_STREAM, 0);
    ck_assert_int_eq(bind(viewer->listener, (struct sockaddr *)&address, size), 0);
    ck_assert_int_eq(getsockname(viewer->listener, (struct sockaddr *)&address, &size), 0);
    setsockopt(viewer->listener, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    ck_assert_int_eq(listen(viewer->listener, 4), 0);
    viewer->port = ntohs(address.sin_port);
}

static void viewer_begin(Viewer *viewer)
{
    viewer_listen(viewer);
    ck_assert_int_eq(pthread_create(&viewer->thread, NULL, viewer_run, viewer), 0);
}

static void viewer_end(Viewer *viewer)
{
    shutdown(viewer->listener, SHUT_RDWR);
    pthread_join(viewer->thread, NULL);
    close(viewer->listener);
    ck_assert_msg(!viewer->wrong, "wrong with a packet: %s", viewer->wrong);
}

/* ---- renderings -------------------------------------------------------------------------------------------------- */

/* Renders for `time` with a viewer expected at the port (0: none); returns the seconds that it took. */
static double render(unsigned port, const char *size, const char *time, const char *exr)
{
    char tev[64], output[600], limit[32], resolution[32];
    int status;
    snprintf(tev, sizeof tev, "--tev=127.0.0.1:%u", port);
    snprintf(output, sizeof output, "--output=%s", exr);
    snprintf(limit, sizeof limit, "--time=%s", time);
    snprintf(resolution, sizeof resolution, "--resolution=%s", size);
    double begin = timing_now();
    pid_t process = program_start((const char *[]){output, limit, resolution, port ? tev : NULL}, NULL);
    ck_assert_int_eq(waitpid(process, &status, 0), process);
    ck_assert_int_eq(status, 0);
    return timing_now() - begin;
}

/* The viewer shows the pixels of the file. */
static void picture_check(const Viewer *viewer, const char *exr)
{
    float *rgb;
    int width, height;
    Error error;
    ck_assert_msg(image_read_rgb(exr, &rgb, &width, &height, &error), "%s", error.message);
    ck_assert_str_eq(viewer->name, exr);
    ck_assert_int_eq(viewer->width, width);
    ck_assert_int_eq(viewer->height, height);
    for (int i = 0; i < 3 * width * height; ++i)
        if (memcmp(&rgb[i], &viewer->rgb[i], sizeof *rgb) != 0)
            ck_abort_msg("value %d is %g, in the file %g", i, viewer->rgb[i], rgb[i]);
    free(rgb);
}

START_TEST(exchange)
{
    Viewer viewer = {0};
    test_folder_make();
    viewer_begin(&viewer);
    render(viewer.port, "331x207", "3s", test_path("a.exr"));
    viewer_end(&viewer);
    ck_assert_int_eq(viewer.connections, 1);
    ck_assert_int_eq(viewer.images, 1);
    ck_assert_int_ge(viewer.updates, 2); /* as it converges */
    ck_assert_int_le(viewer.updates, 5);
    picture_check(&viewer, test_path("a.exr"));
    free(viewer.rgb);
    test_folder_remove();
}
END_TEST

/* The last picture is sent even if the rendering is done sooner than the viewer could ask for one. */
START_TEST(short_rendering)
{
    Viewer viewer = {0};
    test_folder_make();
    viewer_begin(&viewer);
    render(viewer.port, "20x10", "0.1s", test_path("a.exr"));
    viewer_end(&viewer);
    picture_check(&viewer, test_path("a.exr"));
    free(viewer.rgb);
    test_folder_remove();
}
END_TEST

START_TEST(viewer_never_reads)
{
    Viewer viewer = {0};
    test_folder_make();
    viewer_listen(&viewer);
    double without = render(0, "640x480", "3s", test_path("a.exr"));
    double with = render(viewer.port, "640x480", "3s", test_path("b.exr"));
    close(viewer.listener);
    ck_assert_msg(with < without + 2.5, "%g s, without a viewer %g s", with, without);
    test_folder_remove();
}
END_TEST

START_TEST(viewer_goes_and_returns)
{
    Viewer viewer = {.leaves_after = 2};
    test_folder_make();
    viewer_begin(&viewer);
    render(viewer.port, "331x207", "7s", test_path("a.exr"));
    viewer_end(&viewer);
    ck_assert_int_eq(viewer.connections, 2);
    ck_assert_int_eq(viewer.images, 2);
    picture_check(&viewer, test_path("a.exr"));
    free(viewer.rgb);
    test_folder_remove();
}
END_TEST

START_TEST(no_viewer)
{
    Viewer viewer = {0};
    test_folder_make();
    viewer_listen(&viewer);
    close(viewer.listener); /* nobody listens there now */
    double with = render(viewer.port, "64x48", "1s", test_path("a.exr"));
    ck_assert_msg(with < 4.0, "%g s", with);
    ck_assert_int_eq(test_folder_entries(), 1);
    test_folder_remove();
}
END_TEST

TCase *tev_case(void)
{
    TCase *tev = tcase_create("tev");
    tcase_set_timeout(tev, 60.0);
    tcase_add_test(tev, exchange);
    tcase_add_test(tev, short_rendering);
    tcase_add_test(tev, viewer_never_reads);
    tcase_add_test(tev, viewer_goes_and_returns);
    tcase_add_test(tev, no_viewer);
    return tev;
}
