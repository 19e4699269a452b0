/* The page of a rendering: requests to the program, good and hostile, and the parts that answers are made of. */
#include "serve/served.h"
#include "serve/test_serve.h"

#include "support/test_files.h"
#include "support/test_util.h"

#include "base/timing.h"
#include "image/read.h"
#include "render/halves_error.h"
#include "serve/error_curve.h"
#include "serve/pixels.h"
#include "serve/request.h"
#include "serve/server.h"

#include <signal.h>
#include <sys/socket.h>

#define TOKEN "0123456789abcdef0123456789abcdef"

/* ---- parts of requests ------------------------------------------------------------------------------------------- */

START_TEST(paths)
{
    static const char *const FORBIDDEN[] = {"",
                                            "/",
                                            "//",
                                            "/status.json",
                                            "/picture",
                                            "/" TOKEN,
                                            "/" TOKEN "0/",
                                            "/0123456789abcdef0123456789abcdee/",
                                            "/1123456789abcdef0123456789abcdef/",
                                            "/0123456789abcdef/",
                                            "/" TOKEN "x",
                                            "/../" TOKEN "/"};
    static const char *const UNKNOWN[] = {"/" TOKEN "//", "/" TOKEN "/../", "/" TOKEN "/page.html",
                                          "/" TOKEN "/picture/"};
    ck_assert_int_eq(request_kind("/" TOKEN "/", TOKEN), REQUEST_PAGE);
    ck_assert_int_eq(request_kind("/" TOKEN "/status.json", TOKEN), REQUEST_STATUS);
    ck_assert_int_eq(request_kind("/" TOKEN "/picture", TOKEN), REQUEST_PICTURE);
    for (size_t i = 0; i < sizeof FORBIDDEN / sizeof *FORBIDDEN; ++i)
        ck_assert_msg(request_kind(FORBIDDEN[i], TOKEN) == REQUEST_FORBIDDEN, "%s", FORBIDDEN[i]);
    for (size_t i = 0; i < sizeof UNKNOWN / sizeof *UNKNOWN; ++i)
        ck_assert_msg(request_kind(UNKNOWN[i], TOKEN) == REQUEST_UNKNOWN, "%s", UNKNOWN[i]);
}
END_TEST

START_TEST(hosts)
{
    static const char *const GOOD[] = {"localhost", "LOCALHOST:80", "127.0.0.1",  "192.168.1.5:8080",
                                       "[::1]",     "[::1]:80",     "render-box", "render-box:8080"};
    static const char *const BAD[] = {
        "",           ":80",           "evil.example", "evil.example:80",   "127.0.0.1.evil.example",
        "localhost.", "localhost.x.y", "[evil]:80",    "127.0.0.1@evil:80", "render-box.evil"};
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; ++i)
        ck_assert_msg(host_allowed(GOOD[i], "render-box"), "%s", GOOD[i]);
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!host_allowed(BAD[i], "render-box"), "%s", BAD[i]);
    ck_assert(!host_allowed(NULL, "render-box"));
}
END_TEST

START_TEST(tokens)
{
    char a[TOKEN_DIGITS + 1], b[TOKEN_DIGITS + 1];
    Error error;
    ck_assert(token_make(a, &error) && token_make(b, &error));
    ck_assert_uint_eq(strlen(a), TOKEN_DIGITS);
    ck_assert_uint_eq(strspn(a, "0123456789abcdef"), TOKEN_DIGITS);
    ck_assert_str_ne(a, b);
}
END_TEST

/* ---- pixels ------------------------------------------------------------------------------------------------------ */

/* The number whose bits are at bytes[2 * i]. */
static float half_at(const Pixels *pixels, size_t i)
{
    unsigned bits = pixels->bytes[2 * i] | (unsigned)pixels->bytes[2 * i + 1] << 8;
    int exponent = (int)(bits >> 10 & 31), fraction = (int)(bits & 1023);
    double value = exponent ? ldexp(1024 + fraction, exponent - 25) : ldexp(fraction, -24);
    return (float)(bits & 0x8000 ? -value : value);
}

/* 16-bit floats have 11 bits from 2^-14 on, and a unit of 2^-24 below. */
START_TEST(halves_are_nearest)
{
    static const float EXACT[] = {0.0f, 1.0f, -2.5f, 65504.0f, 6.103515625e-5f, 5.9604644775390625e-8f};
    unsigned state = 3;
    for (int i = 0; i < 20000; ++i) {
        float rgb[3] = {(float)ldexp(test_random_unit(&state) - 0.5, (int)(test_random(&state) % 42) - 25),
                        EXACT[i % 6], i % 2 ? 1e9f : -INFINITY};
        Pixels pixels;
        ck_assert(pixels_make(&pixels, rgb, NULL, 1, 1, 0, true));
        TEST_NEAR(half_at(&pixels, 0), rgb[0], fmax(fabs((double)rgb[0]) * 0x1p-11, 0x1p-25));
        TEST_TRUE(half_at(&pixels, 1) == rgb[1]);
        TEST_TRUE(half_at(&pixels, 2) == (i % 2 ? 65504.0f : -65504.0f));
        free(pixels.bytes);
    }
}
END_TEST

/* Means of blocks, at the edges of fewer pixels, and of a difference. */
START_TEST(levels)
{
    enum { WIDTH = 5, HEIGHT = 3 };
    float a[3 * WIDTH * HEIGHT], b[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) {
        a[i] = (float)(i / 3 + i % 3 * 100);
        b[i] = (float)(i % 3 * 100);
    }
    Pixels pixels;
    ck_assert(pixels_make(&pixels, a, b, WIDTH, HEIGHT, 1, true));
    ck_assert_int_eq(pixels.width, 3);
    ck_assert_int_eq(pixels.height, 2);
    ck_assert_uint_eq(pixels.size, 2 * 3 * 6);
    const float means[6] = {3.0f, 5.0f, 6.5f, 10.5f, 12.5f, 14.0f};
    for (size_t i = 0; i < 18; ++i)
        TEST_NEAR(half_at(&pixels, i), means[i / 3], 0.0);
    free(pixels.bytes);
}
END_TEST

/* Halves m + d and m - d have the relative error d / sqrt(m^2 + 0.01), whatever varies within tiles. */
START_TEST(error_of_halves)
{
    enum { WIDTH = 19, HEIGHT = 9 };
    static float a[3 * WIDTH * HEIGHT], b[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) {
        a[i] = 2.1f;
        b[i] = 1.9f;
    }
    const float *const halves[2] = {a, b};
    const ErrorGoal blocks = {.blocks = true};
    HalvesError found;
    Error error = {0};
    ck_assert(halves_error_of_images(halves, WIDTH, HEIGHT, &blocks, &found, &error));
    TEST_NEAR(found.value, 0.1 / sqrt(4.01), 1e-6);
    a[0] += 1.0f;
    a[3] -= 1.0f; /* the same tile */
    ck_assert(halves_error_of_images(halves, WIDTH, HEIGHT, &blocks, &found, &error));
    TEST_NEAR(found.value, 0.1 / sqrt(4.01), 1e-6);
    ErrorCurve curve = {0};
    for (int i = 1; i <= 1000; ++i)
        error_curve_add(&curve, i, 1.0 / i);
    ck_assert_uint_le(curve.count, ERROR_CURVE_POINTS);
    for (size_t i = 1; i < curve.count; ++i)
        ck_assert(curve.points[i].seconds > curve.points[i - 1].seconds);
    ck_assert(!error_curve_due(&curve, 1001.0) && error_curve_due(&curve, 1051.0));
}
END_TEST

/* ---- the program ------------------------------------------------------------------------------------------------- */

/* Whether the status says that the rendering has ended; false if there is no answer. */
static bool ended(const Served *served, bool *answered)
{
    Reply reply = get(served, "status.json");
    *answered = reply.status == 200;
    bool is = *answered && strstr((char *)reply.body, "\"ended\": true");
    free(reply.head);
    return is;
}

START_TEST(page)
{
    Served served = {0};
    served_begin(&served, "64x48", "--time=2s");
    Reply reply = get(&served, "");
    ck_assert_int_eq(reply.status, 200);
    ck_assert_ptr_nonnull(strstr((char *)reply.body, "<canvas"));
    ck_assert_ptr_nonnull(strstr((char *)reply.body, "</html>"));
    ck_assert_ptr_null(strstr((char *)reply.body, "@page"));
    ck_assert_ptr_null(strstr((char *)reply.body, "//fonts"));
    ck_assert_ptr_nonnull(strstr(reply.head, "Content-Security-Policy: default-src 'none'"));
    free(reply.head);
    reply = get(&served, "status.json");
    ck_assert_int_eq(reply.status, 200);
    ck_assert_ptr_nonnull(strstr((char *)reply.body, "\"scene\": \"cornell.pbrt\""));
    free(reply.head);
    ck_assert_int_eq(get_status(&served, "nothing"), 404);
    kill(served.process, SIGINT);
    ck_assert(served_end(&served) < 4.0);
    served_remove();
}
END_TEST

/* The last picture that a client gets has the pixels of the file, as 32-bit floats bit for bit. */
START_TEST(picture_is_the_file)
{
    Served served = {0};
    Reply last = {0};
    float *rgb;
    int width, height, pictures = 0;
    Error error;
    bool answered = true, done = false;
    served_begin(&served, "331x207", "--time=3s");
    while (answered && !done) {
        /* The program ends when it has sent the last picture, which may be before it is asked for its status again. */
        done = ended(&served, &answered) || (!answered && pictures > 0);
        Reply reply = answered ? get(&served, "picture?layer=picture&format=float") : (Reply){0};
        pictures += reply.status == 200;
        free(reply.status == 200 ? last.head : reply.head);
        last = reply.status == 200 ? reply : last;
        usleep(100000);
    }
    ck_assert(done);
    ck_assert(served_end(&served) < 3.0);
    ck_assert_int_ge(pictures, 2);
    ck_assert_msg(image_read_rgb(served.exr, &rgb, &width, &height, &error), "%s", error.message);
    ck_assert_int_eq(header(&last, "X-Width"), width);
    ck_assert_int_eq(header(&last, "X-Height"), height);
    ck_assert_uint_eq(last.size, 12 * (size_t)(width * height));
    ck_assert_int_eq(memcmp(last.body, rgb, last.size), 0);
    free(rgb);
    free(last.head);
    served_remove();
}
END_TEST

START_TEST(hostile_requests)
{
    Served served = {0};
    char request[512], *large = malloc(1 << 20);
    served_begin(&served, "64x48", "--time=5s");
    static const char *const REFUSED[] = {
        "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
        "GET /status.json HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
        "GET /" TOKEN "/ HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n",
        "GET /../../etc/passwd HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"};
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; ++i) {
        Reply reply = request_send(&served, REFUSED[i]);
        ck_assert_int_eq(reply.status, 403);
        free(reply.head);
    }
    snprintf(request, sizeof request, "GET /%s/ HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n",
             served.token);
    Reply reply = request_send(&served, request);
    ck_assert_int_eq(reply.status, 403);
    free(reply.head);
    snprintf(request, sizeof request,
             "POST /%s/ HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: 0\r\n\r\n", served.token);
    reply = request_send(&served, request);
    ck_assert_int_eq(reply.status, 405);
    free(reply.head);
    static const char *const BAD[] = {"picture?layer=nothing", "picture?level=99",   "picture?level=-1",
                                      "picture?level=1x",      "picture?format=png", "picture?layer=difference",
                                      "picture?after=-1",      "picture?level=",     "picture?layer=%00%ff%2e%2e"};
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(get_status(&served, BAD[i]) == 404, "%s", BAD[i]);
    memset(large, 'a', (1 << 20) - 1);
    large[(1 << 20) - 1] = '\0';
    memcpy(large, "GET /", 5);
    reply = request_send(&served, large); /* refused, or closed */
    ck_assert_int_ne(reply.status, 200);
    free(reply.head);
    free(large);
    ck_assert_int_eq(get_status(&served, "status.json"), 200);
    kill(served.process, SIGINT);
    served_end(&served);
    served_remove();
}
END_TEST

/* Connections on which half a request or no request comes, as many as there may be and more, and one whose client does
 * not read: the rendering ends when it should. */
START_TEST(hanging_clients)
{
    enum { CLIENTS = 60 };
    int clients[CLIENTS];
    char request[512];
    Served served = {0};
    served_begin(&served, "640x480", "--time=4s");
    double begin = timing_now();
    snprintf(request, sizeof request, "GET /%s/picture?format=float HTTP/1.1\r\nHost: localhost\r\n\r\n", served.token);
    for (int i = 0; i < CLIENTS; ++i) {
        clients[i] = served_connect(&served);
        ck_assert_int_ge(clients[i], 0);
        size_t size = i % 3 == 0 ? 0 : i % 3 == 1 ? strlen(request) / 2 : strlen(request);
        send(clients[i], request, size, MSG_NOSIGNAL);
    }
    served_end(&served);
    ck_assert_msg(timing_now() - begin < 4.0 + 3.5, "%g s", timing_now() - begin);
    for (int i = 0; i < CLIENTS; ++i)
        close(clients[i]);
    ck_assert_int_eq(access(served.exr, R_OK), 0);
    served_remove();
}
END_TEST

TCase *page_case(void)
{
    Error error;
    TCase *tests = tcase_create("page");
    tcase_set_timeout(tests, 60.0);
    tcase_add_test(tests, paths);
    tcase_add_test(tests, hosts);
    tcase_add_test(tests, tokens);
    tcase_add_test(tests, halves_are_nearest);
    tcase_add_test(tests, levels);
    tcase_add_test(tests, error_of_halves);
    if (!server_available(&error))
        return tests;
    tcase_add_test(tests, page);
    tcase_add_test(tests, picture_is_the_file);
    tcase_add_test(tests, hostile_requests);
    tcase_add_test(tests, hanging_clients);
    return tests;
}
