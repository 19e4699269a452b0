/* Parsing of command-line values and options, and the formatting of numbers in JSON and in the progress line. */
#include "support/test_util.h"

#include "base/json.h"
#include "base/option_values.h"
#include "base/options.h"
#include "render/progress.h"

#include <inttypes.h>
#include <string.h>

/* ---- values ------------------------------------------------------------------------------------------------------ */

START_TEST(test_whole_accepts)
{
    Error error = {0};
    uint64_t value = 0;
    ck_assert(option_whole("samples", "1", 1, 10, &value, &error));
    ck_assert_uint_eq(value, 1);
    ck_assert(option_whole("samples", "0010", 1, 10, &value, &error));
    ck_assert_uint_eq(value, 10);
    ck_assert(option_whole("seed", "18446744073709551615", 0, UINT64_MAX, &value, &error));
    ck_assert(value == UINT64_MAX);
}
END_TEST

static const char *const BAD_WHOLES[] = {"",
                                         "-1",
                                         "+1",
                                         " 1",
                                         "1 ",
                                         "1.0",
                                         "1e3",
                                         "0x1",
                                         "abc",
                                         "1,",
                                         "11",
                                         "0",
                                         "99999999999999999999",
                                         "18446744073709551616"};

START_TEST(test_whole_refuses)
{
    Error error = {0};
    uint64_t value;
    ck_assert(!option_whole("samples", BAD_WHOLES[_i], 1, 10, &value, &error));
    char start[64];
    snprintf(start, sizeof start, "error: --samples=%s: ", BAD_WHOLES[_i]);
    ck_assert_msg(strncmp(error.message, start, strlen(start)) == 0, "%s", error.message);
    ck_assert_str_eq(error.fix, "give a whole number from 1 to 10");
}
END_TEST

START_TEST(test_whole_overflow_is_not_the_maximum)
{
    Error error = {0};
    uint64_t value;
    ck_assert(!option_whole("seed", "18446744073709551616", 0, UINT64_MAX, &value, &error));
}
END_TEST

START_TEST(test_number)
{
    static const struct {
        const char *text;
        double value;
    } GOOD[] = {{"0", 0.0}, {"-1.5", -1.5}, {"+2", 2.0}, {".25", 0.25}, {"1e1", 10.0}, {"3.", 3.0}};
    static const char *const BAD[] = {"", "nan", "inf", "0x1p3", "1,5", " 1", "1 ", "-", ".", "e1", "1e400", "65"};
    Error error = {0};
    double value;
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; ++i) {
        ck_assert_msg(option_number("exposure", GOOD[i].text, -64, 64, &value, &error), "%s", GOOD[i].text);
        ck_assert_double_eq(value, GOOD[i].value);
    }
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!option_number("exposure", BAD[i], -64, 64, &value, &error), "%s", BAD[i]);
}
END_TEST

START_TEST(test_seconds)
{
    static const struct {
        const char *text;
        double value;
    } GOOD[] = {{"30s", 30.0}, {"10m", 600.0}, {"2h", 7200.0}, {"0.5s", 0.5}, {"1.5h", 5400.0}, {"8760h", 31536000.0}};
    static const char *const BAD[] = {"",     "30",  "s",     "0s",   "-1s",   "30sec",
                                      "30 s", "30S", "1h30m", "infs", "8761h", "1d"};
    Error error = {0};
    double value;
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; ++i) {
        ck_assert_msg(option_seconds("time", GOOD[i].text, &value, &error), "%s", GOOD[i].text);
        ck_assert_double_eq(value, GOOD[i].value);
    }
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i) {
        memset(&error, 0, sizeof error);
        ck_assert_msg(!option_seconds("time", BAD[i], &value, &error), "%s", BAD[i]);
        ck_assert_ptr_nonnull(strstr(error.message, "--time="));
        ck_assert_int_ne(error.fix[0], 0);
    }
}
END_TEST

START_TEST(test_resolution)
{
    static const char *const BAD[] = {"",      "640",   "640x", "x480",      "640X480", "640x480x3",
                                      "0x480", "640x0", "-1x4", "640 x 480", "65536x1", "99999999999999999999x1",
                                      "4.0x4"};
    Error error = {0};
    int size[2];
    ck_assert(option_resolution("resolution", "640x480", size, &error));
    ck_assert_int_eq(size[0], 640);
    ck_assert_int_eq(size[1], 480);
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!option_resolution("resolution", BAD[i], size, &error), "%s", BAD[i]);
}
END_TEST

START_TEST(test_crop)
{
    static const char *const BAD[] = {"",        "1,2,3",   "1,2,3,4,5", "1,2,3,",  "1, 2,3,4", "-1,0,3,4",
                                      "3,0,3,4", "0,4,3,4", "4,0,3,4",   "a,b,c,d", "0;0;1;1",  "0,0,1,65536"};
    Error error = {0};
    int crop[4];
    ck_assert(option_crop("crop", "1,2,3,4", crop, &error));
    for (int i = 0; i < 4; ++i)
        ck_assert_int_eq(crop[i], i + 1);
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!option_crop("crop", BAD[i], crop, &error), "%s", BAD[i]);
}
END_TEST

START_TEST(test_address)
{
    static const char *const BAD[] = {"",    "host",   ":80",   "host:", "host:0",  "host:65536", "host:8x",
                                      "::1", "::1:80", "[::1]", "[]:80", "host:-1", "[::1]80",    "host:80:90"};
    Error error = {0};
    OptionAddress address;
    ck_assert(option_address("tev", "localhost:14158", 1, &address, &error));
    ck_assert_str_eq(address.host, "localhost");
    ck_assert_uint_eq(address.port, 14158);
    ck_assert(option_address("serve", "[::1]:0", 0, &address, &error));
    ck_assert_str_eq(address.host, "::1");
    ck_assert_uint_eq(address.port, 0);
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; ++i)
        ck_assert_msg(!option_address("tev", BAD[i], 1, &address, &error), "%s", BAD[i]);
}
END_TEST

/* ---- options ----------------------------------------------------------------------------------------------------- */

enum { OUTPUT, SAMPLES, SAVE, SEED, PNG, QUIET, SAMPLER };

static const OptionSpec SPECS[] = {{"output", 'o', "FILE", "file"},   {"samples", 0, "N", "samples"},
                                   {"save-every", 0, "TIME", "time"}, {"seed", 0, "N", "seed"},
                                   {"png", 0, "[FILE]", "png"},       {"quiet", 'q', NULL, "quiet"},
                                   {"sampler", 0, "NAME", NULL}};
static const OptionTable TABLE = {"render", "render", "summary", SPECS, 7, NULL};

/* The options that were set, as text: "samples=4 quiet ". */
static bool record(void *context, int index, const char *value, Error *error)
{
    char *text = context;
    if (index == SAMPLES && strcmp(value, "bad") == 0)
        return error_set(error, "refused");
    strcat(text, SPECS[index].name);
    if (value)
        strcat(strcat(text, "="), value);
    strcat(text, " ");
    return true;
}

/* Splits `line` at blanks into argv after "render" and parses it. */
static bool parse_line(const char *line, char *words, char *text, char **operand, int *operands, Error *error)
{
    char *argv[16] = {(char *)"render"};
    int argc = 1, first = 0;
    strcpy(words, line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc] = NULL;
    text[0] = '\0';
    memset(error, 0, sizeof *error);
    if (!options_parse(&TABLE, argc, argv, record, text, &first, error))
        return false;
    *operand = argv[first];
    *operands = argc - first;
    return true;
}

static const struct {
    const char *line, *set, *operand;
} GOOD_LINES[] = {
    {"a.pbrt", "", "a.pbrt"},
    {"--samples=4 a.pbrt --quiet", "samples=4 quiet ", "a.pbrt"},
    {"a.pbrt --samples 4", "samples=4 ", "a.pbrt"},
    {"-o x.exr -q a.pbrt", "output=x.exr quiet ", "a.pbrt"},
    {"-ox.exr a.pbrt", "output=x.exr ", "a.pbrt"},
    {"-qo x.exr a.pbrt", "quiet output=x.exr ", "a.pbrt"},
    {"--png a.pbrt", "png ", "a.pbrt"},
    {"--png=b.png a.pbrt", "png=b.png ", "a.pbrt"},
    {"--qui a.pbrt", "quiet ", "a.pbrt"},
    {"--spp=4 --outfile x.exr a.pbrt", "samples=4 output=x.exr ", "a.pbrt"},
    {"--sp 4 a.pbrt", "samples=4 ", "a.pbrt"},
    {"--samples=1 --samples=2 a.pbrt", "samples=1 samples=2 ", "a.pbrt"},
    {"-- --samples=4", "", "--samples=4"},
    {"--sampler=x a.pbrt", "sampler=x ", "a.pbrt"}, /* not listed, but accepted */
};

START_TEST(test_options_good)
{
    char words[256], text[256], *operand = NULL;
    int operands = 0;
    Error error;
    ck_assert_msg(parse_line(GOOD_LINES[_i].line, words, text, &operand, &operands, &error), "%s", error.message);
    ck_assert_str_eq(text, GOOD_LINES[_i].set);
    ck_assert_int_eq(operands, 1);
    ck_assert_str_eq(operand, GOOD_LINES[_i].operand);
}
END_TEST

static const struct {
    const char *line, *message;
} BAD_LINES[] = {
    {"--sample-count=4 a", "error: unknown option --sample-count"},
    {"--s=4 a", "error: option --s is ambiguous: it may stand for --samples, --save-every, --seed"},
    {"--sample=4 a", "error: unknown option --sample"},
    {"-z a", "error: unknown option -z"},
    {"--nthreads=4 a", "error: unknown option --nthreads"},
    {"a --samples", "error: option --samples needs a value"},
    {"a -o", "error: option --output needs a value"},
    {"--quiet=yes a", "error: option --quiet takes no value: --quiet=yes"},
    {"--samples= a", "error: option --samples has an empty value"},
    {"--samples=bad a", "error: refused"},
};

START_TEST(test_options_bad)
{
    char words[256], text[256], *operand = NULL;
    int operands = 0;
    Error error;
    ck_assert(!parse_line(BAD_LINES[_i].line, words, text, &operand, &operands, &error));
    ck_assert_str_eq(error.message, BAD_LINES[_i].message);
}
END_TEST

/* ---- text -------------------------------------------------------------------------------------------------------- */

START_TEST(test_json)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    JsonWriter json;
    json_init(&json, stream);
    json_object_begin(&json, NULL);
    json_text(&json, "a", "q\"b\\n\n\xc3\xa9\xff\xed\xa0\x80");
    json_array_begin(&json, "list");
    json_signed(&json, NULL, -3);
    json_number(&json, NULL, NAN);
    json_number(&json, NULL, 0.5);
    json_array_end(&json);
    json_array_begin(&json, "none");
    json_array_end(&json);
    json_bool(&json, "yes", true);
    json_text(&json, "nil", NULL);
    json_unsigned(&json, "big", UINT64_MAX);
    json_object_end(&json);
    fclose(stream);
    ck_assert_str_eq(text,
                     "{\n  \"a\": \"q\\\"b\\\\n\\u000a\xc3\xa9\\ufffd\\ufffd\\ufffd\\ufffd\",\n  \"list\": [\n    -3,\n"
                     "    null,\n    0.5\n  ],\n  \"none\": [],\n  \"yes\": true,\n  \"nil\": null,\n"
                     "  \"big\": 18446744073709551615\n}\n");
    free(text);
}
END_TEST

START_TEST(test_progress_text)
{
    char text[320];
    progress_time(12.34, text, sizeof text);
    ck_assert_str_eq(text, "12.3 s");
    progress_time(59.99, text, sizeof text);
    ck_assert_str_eq(text, "1:00");
    progress_time(245.0, text, sizeof text);
    ck_assert_str_eq(text, "4:05");
    progress_time(7390.0, text, sizeof text);
    ck_assert_str_eq(text, "2:03:10");
    progress_rate(0.0, text, sizeof text);
    ck_assert_str_eq(text, "0.00 ");
    progress_rate(999.9, text, sizeof text);
    ck_assert_str_eq(text, "1.00 k");
    progress_rate(12345678.0, text, sizeof text);
    ck_assert_str_eq(text, "12.3 M");
    progress_rate(1e20, text, sizeof text);
    ck_assert_str_eq(text, "100000000 T");
}
END_TEST

START_TEST(test_progress_line_fits_its_terminal)
{
    char text[320];
    const RenderProgress now = {
        .elapsed = 100.0, .fraction = 0.25, .samples = 100000000, .rays = 900000000, .left = 300.0};
    progress_line(&now, 0, text, sizeof text);
    ck_assert_str_eq(text, " 25 %  rendering: 1:40, 5:00 left  1.00 Msamples/s  9.00 Mrays/s");
    for (int columns = 80; columns < 200; ++columns) {
        progress_line(&now, columns, text, sizeof text);
        ck_assert_int_eq(text[0], '[');
        ck_assert_int_lt((int)strlen(text), columns);
    }
    const RenderProgress late = {
        .elapsed = 100.0, .fraction = 1.0, .samples = 100, .rays = 100, .left = 2.5, .finishing = true};
    progress_line(&late, 0, text, sizeof text);
    ck_assert_str_eq(text, " 99 %  finishing a pass: 1:40, 2.5 s left  1.00 samples/s  1.00 rays/s");
    const RenderProgress over = {
        .elapsed = 100.0, .fraction = 1.0, .samples = 100, .rays = 100, .left = 0.04, .finishing = true};
    progress_line(&over, 0, text, sizeof text);
    ck_assert_str_eq(text, " 99 %  finishing a pass: 1:40  1.00 samples/s  1.00 rays/s");
    /* What earlier runs made does not count as speed. */
    const RenderProgress resumed = {
        .elapsed = 100.0, .fraction = 0.75, .samples = 300, .rays = 100, .samples_before = 200, .left = 100.0};
    progress_line(&resumed, 0, text, sizeof text);
    ck_assert_str_eq(text, " 75 %  rendering: 1:40, 1:40 left  1.00 samples/s  1.00 rays/s");
    const RenderProgress start = {.left = -1.0};
    progress_line(&start, 0, text, sizeof text);
    ck_assert_str_eq(text, "  0 %  rendering: 0.0 s, ? left  0.00 samples/s  0.00 rays/s");
}
END_TEST

/* Gives what is shown on a terminal as text to be freed. */
static Progress progress_to_text(char **text, size_t *size)
{
    Progress progress;
    progress_init(&progress, open_memstream(text, size), false);
    progress.terminal = true;
    return progress;
}

START_TEST(test_progress_counts_writing)
{
    char *text = NULL;
    size_t size = 0;
    Progress progress = progress_to_text(&text, &size);
    const RenderProgress now = {.elapsed = 10.0, .fraction = 0.5, .left = 10.0}, start = {.left = -1.0};
    progress.writing_seconds = 2.5;
    progress_update(&progress, &now);
    fflush(progress.stream);
    ck_assert_ptr_nonnull(strstr(text, " rendering: 10.0 s, 12.5 s left "));
    progress_update(&progress, &start);
    fflush(progress.stream);
    ck_assert_ptr_nonnull(strstr(text, " rendering: 0.0 s, ? left "));
    fclose(progress.stream);
    free(text);
}
END_TEST

START_TEST(test_progress_of_writing)
{
    char *text = NULL;
    size_t size = 0;
    Progress progress = progress_to_text(&text, &size);
    progress_writing(&progress, "a.exr", 0.0);
    fflush(progress.stream);
    ck_assert_uint_eq(size, 0);
    progress.writing_since -= 1000.0;
    progress_writing(&progress, "a.exr", 0.25);
    fflush(progress.stream);
    ck_assert_ptr_nonnull(strstr(text, "writing a.exr:  25 %, 50:0")); /* and a few seconds, if the machine is busy */
    fclose(progress.stream);
    free(text);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("options");
    TCase *values = tcase_create("values");
    tcase_add_test(values, test_whole_accepts);
    tcase_add_loop_test(values, test_whole_refuses, 0, sizeof BAD_WHOLES / sizeof *BAD_WHOLES);
    tcase_add_test(values, test_whole_overflow_is_not_the_maximum);
    tcase_add_test(values, test_number);
    tcase_add_test(values, test_seconds);
    tcase_add_test(values, test_resolution);
    tcase_add_test(values, test_crop);
    tcase_add_test(values, test_address);
    suite_add_tcase(suite, values);
    TCase *options = tcase_create("options");
    tcase_add_loop_test(options, test_options_good, 0, sizeof GOOD_LINES / sizeof *GOOD_LINES);
    tcase_add_loop_test(options, test_options_bad, 0, sizeof BAD_LINES / sizeof *BAD_LINES);
    suite_add_tcase(suite, options);
    TCase *text = tcase_create("text");
    tcase_add_test(text, test_json);
    tcase_add_test(text, test_progress_text);
    tcase_add_test(text, test_progress_line_fits_its_terminal);
    tcase_add_test(text, test_progress_counts_writing);
    tcase_add_test(text, test_progress_of_writing);
    suite_add_tcase(suite, text);
    return test_run(suite);
}
