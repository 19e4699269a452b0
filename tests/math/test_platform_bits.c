/* The same source as C and as OpenCL C yields the same layouts and the same bits: math/platform_probe.cl is compiled
 * into this program and built for an OpenCL CPU device, and both run on the same inputs. Skipped (exit 77) if there is
 * no such device. */
#include "math/test_math.h"

#include "layout/frame_params.h"
#include "scene/distribution_build.h"
#include "support/opencl_probe.h"

#include "math/platform_probe.cl"

#define ITEMS (1u << 20)
#define CHUNK (1u << 16) /* items that are run and compared at a time */

static OpenclProbe *probe;

typedef void (*ProbeKernel)(const uint *in, const uint *table, uint *out);

/* ---- layouts ---------------------------------------------------------------------------------------------------- */

typedef struct LayoutEntry {
    const char *type;
    const char *member; /* NULL: the struct itself */
} LayoutEntry;

#define STRUCT(type) {#type, NULL},
#define MEMBER(type, member) {#type, #member},
static const LayoutEntry LAYOUT[] = {STRUCT_MEMBERS(STRUCT, MEMBER)};
#undef STRUCT
#undef MEMBER
#define LAYOUT_COUNT (sizeof LAYOUT / sizeof LAYOUT[0])

START_TEST(test_layout)
{
    static uint ours[4 * LAYOUT_COUNT], theirs[4 * LAYOUT_COUNT];
    uint nothing[4] = {0};
    platform_item = 0;
    probe_layout(nothing, nothing, ours);
    ck_assert(opencl_probe_run(probe, "probe_layout", nothing, 4, nothing, 4, theirs, 4 * LAYOUT_COUNT, 1));
    size_t n = 0;
    for (size_t i = 0; i < LAYOUT_COUNT; ++i)
        for (int word = 0; word < (LAYOUT[i].member ? 2 : 1); ++word, ++n)
            ck_assert_msg(ours[n] == theirs[n], "%s of %s.%s: %u in C, %u in OpenCL", word ? "size" : "size or offset",
                          LAYOUT[i].type, LAYOUT[i].member ? LAYOUT[i].member : "", ours[n], theirs[n]);
    ck_assert_uint_gt(n, 300);
}
END_TEST

/* Members are 4-byte words and structs of them, so a struct without padding is as large as the sum of its members: this
 * finds a member missing in layout/struct_members.h as well as padding. */
START_TEST(test_layout_complete)
{
    static uint words[4 * LAYOUT_COUNT];
    uint nothing[4] = {0}, size = 0, members = 0;
    platform_item = 0;
    probe_layout(nothing, nothing, words);
    size_t n = 0;
    for (size_t i = 0; i < LAYOUT_COUNT; ++i) {
        if (!LAYOUT[i].member) {
            size = words[n++];
            members = 0;
        } else {
            ck_assert_msg(words[n] == members, "%s.%s is out of order", LAYOUT[i].type, LAYOUT[i].member);
            members += words[n + 1];
            n += 2;
        }
        if (i + 1 == LAYOUT_COUNT || !LAYOUT[i + 1].member)
            ck_assert_msg(members == size, "%s: members of %u bytes, struct of %u", LAYOUT[i].type, members, size);
    }
}
END_TEST

static bool layout_lists(const char *type)
{
    for (size_t i = 0; i < LAYOUT_COUNT; ++i)
        if (!LAYOUT[i].member && strcmp(LAYOUT[i].type, type) == 0)
            return true;
    return false;
}

/* Every struct of the header is listed in layout/struct_members.h; returns how many it has. */
static int header_check(const char *header)
{
    char path[4096], line[512], type[64];
    snprintf(path, sizeof path, "%s/shared/layout/%s", test_source_folder(), header);
    FILE *file = fopen(path, "r");
    ck_assert_msg(file != NULL, "cannot read %s", path);
    int count = 0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "typedef struct %63[A-Za-z0-9_]", type) == 1) {
            ck_assert_msg(layout_lists(type), "layout/struct_members.h lacks %s", type);
            ++count;
        }
    fclose(file);
    return count;
}

START_TEST(test_layout_structs)
{
    ck_assert_int_ge(header_check("scene_types.h"), 15);
    ck_assert_int_ge(header_check("frame_params.h"), 9);
}
END_TEST

/* ---- bits -------------------------------------------------------------------------------------------------------- */

typedef struct BitsCase {
    const char *name;
    ProbeKernel kernel;
    bool nan_payloads; /* a NaN's sign and payload must agree too; C and OpenCL do not specify them for + - * / */
} BitsCase;

static const BitsCase CASES[] = {
    {"probe_arithmetic", probe_arithmetic, false},
    {"probe_elementary", probe_elementary, true},
    {"probe_random", probe_random, true},
    {"probe_warp", probe_warp, true},
    {"probe_distribution", probe_distribution, true},
};
#define CASE_COUNT ((int)(sizeof CASES / sizeof CASES[0]))

/* Arbitrary bits; often denormals, infinities, NaNs and zeros; floats next to breakpoints. */
static uint input_word(uint64_t *state)
{
    static const uint SPECIALS[] = {0x00000000u, 0x80000000u, 0x00000001u, 0x80000001u, 0x007fffffu, 0x00800000u,
                                    0x7f7fffffu, 0xff7fffffu, 0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00001u,
                                    0x7f800001u, 0x3f800000u, 0xbf800000u, 0x3f000000u, 0x3f3504f3u, 0x3f490fdbu,
                                    0x3fc90fdbu, 0x40490fdbu, 0x42b17218u, 0xc2aeac50u, 0xc2cff1b5u, 0x43480000u};
    uint64_t r = test_random(state);
    uint bits = (uint)r, choice = (uint)(r >> 32) % 16;
    if (choice == 0)
        return SPECIALS[bits % (sizeof SPECIALS / sizeof SPECIALS[0])];
    if (choice == 1)
        return bits & 0x807fffffu;
    if (choice == 2)
        return SPECIALS[bits % (sizeof SPECIALS / sizeof SPECIALS[0])] + (uint)(r >> 60) - 8u;
    if (choice < 8)
        return (bits & 0x87ffffffu) | 0x38000000u; /* 3e-5 ... 2 */
    return bits;
}

static bool same_bits(uint a, uint b, bool nan_payloads)
{
    bool nans = (a & 0x7fffffffu) > 0x7f800000u && (b & 0x7fffffffu) > 0x7f800000u;
    return a == b || (nans && !nan_payloads);
}

/* Words of `table` in the layout of probe_distribution: an image with black cells and a bright one, and 1000
 * buckets. */
static uint *table_make(size_t *words)
{
    enum { WIDTH = 61, HEIGHT = 40, BUCKETS = 1000, HEADER = 6 };
    static float weights[WIDTH * HEIGHT];
    static double alias_weights[BUCKETS];
    uint64_t state = 51;
    Error error;
    Array lookup;
    Distribution2D d;
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        weights[i] = i % 5 == 0 ? 0.0f : i == 777 ? 1e5f : test_uniform(&state);
    for (int i = 0; i < BUCKETS; ++i)
        alias_weights[i] = i % 7 == 0 ? 0.0 : (double)test_uniform(&state);
    array_init(&lookup, sizeof(float));
    uint *header = array_grow(&lookup, HEADER, &error);
    ck_assert(header && distribution2d_build(weights, WIDTH, HEIGHT, &lookup, &d, &error));
    size_t first_bucket = lookup.count;
    AliasBucket *buckets = array_grow(&lookup, 2 * BUCKETS, &error);
    ck_assert(buckets && alias_build(alias_weights, BUCKETS, buckets, &error));
    uint values[HEADER] = {d.width, d.height, d.first_marginal, d.first_conditional, BUCKETS, (uint)first_bucket};
    memcpy(lookup.data, values, sizeof values);
    *words = lookup.count;
    return lookup.data;
}

static void chunk_compare(const BitsCase *test, const uint *in, const uint *table, size_t table_words, uint *ours,
                          uint *theirs)
{
    memset(ours, 0, CHUNK * PROBE_WORDS * sizeof *ours);
    for (uint i = 0; i < CHUNK; ++i) {
        platform_item = i;
        test->kernel(in, table, ours);
    }
    ck_assert(
        opencl_probe_run(probe, test->name, in, 4 * CHUNK, table, table_words, theirs, CHUNK * PROBE_WORDS, CHUNK));
    for (size_t n = 0; n < CHUNK * PROBE_WORDS; ++n)
        if (!same_bits(ours[n], theirs[n], test->nan_payloads)) {
            const uint *words = in + 4 * (n / PROBE_WORDS);
            ck_abort_msg("%s result %zu of (%08x %08x %08x %08x): %08x in C, %08x in OpenCL", test->name,
                         n % PROBE_WORDS, words[0], words[1], words[2], words[3], ours[n], theirs[n]);
        }
}

START_TEST(test_bits)
{
    uint *in = malloc(4 * CHUNK * sizeof *in), *ours = malloc(CHUNK * PROBE_WORDS * sizeof *ours);
    uint *theirs = malloc(CHUNK * PROBE_WORDS * sizeof *theirs);
    size_t table_words;
    uint *table = table_make(&table_words);
    uint64_t state = 50;
    ck_assert(in && ours && theirs);
    for (uint first = 0; first < ITEMS; first += CHUNK) {
        for (uint i = 0; i < 4 * CHUNK; ++i)
            in[i] = input_word(&state);
        chunk_compare(&CASES[_i], in, table, table_words, ours, theirs);
    }
    free(in);
    free(ours);
    free(theirs);
    free(table);
}
END_TEST

/* The comparison must be able to fail: a flipped bit, the sign of zero and, with NaN payloads compared, the sign of a
 * NaN count as differences. */
START_TEST(test_comparison_sees)
{
    ck_assert(!same_bits(0x3f800000u, 0x3f800001u, false));
    ck_assert(!same_bits(0x00000000u, 0x80000000u, false));
    ck_assert(!same_bits(0x7fc00000u, 0xffc00000u, true));
    ck_assert(same_bits(0x7fc00000u, 0xffc00000u, false));
    ck_assert(!same_bits(0x7fc00000u, 0x7f800000u, false));
}
END_TEST

int main(void)
{
    char message[8192] = "", options[4096];
    bool absent;
    setenv("POCL_KERNEL_CACHE", "0", 0); /* the cache does not notice changed include files */
    snprintf(options, sizeof options, "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -I%s/shared -I%s/tests",
             test_source_folder(), test_source_folder());
    probe = opencl_probe_open("#include \"math/platform_probe.cl\"\n", options, message, sizeof message, &absent);
    if (!probe) {
        fprintf(stderr, "%s: %s\n", absent ? "skipped" : "failed", message);
        return absent ? 77 : EXIT_FAILURE;
    }
    printf("OpenCL device: %s\n", opencl_probe_device(probe));
    Suite *suite = suite_create("platform bits");
    TCase *tcase = tcase_create("C against OpenCL");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_test(tcase, test_layout);
    tcase_add_test(tcase, test_layout_complete);
    tcase_add_test(tcase, test_layout_structs);
    tcase_add_loop_test(tcase, test_bits, 0, CASE_COUNT);
    tcase_add_test(tcase, test_comparison_sees);
    suite_add_tcase(suite, tcase);
    setenv("CK_FORK", "no", 0); /* the device's threads do not survive a fork */
    int status = test_run(suite);
    opencl_probe_close(probe);
    return status;
}
