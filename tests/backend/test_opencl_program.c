/* Kernel source assembly, the cache of built programs, and error messages of failed builds. */
#include "backend/test_opencl.h"

#include "base/log.h"
#include "program.h"
#include "program_cache.h"
#include "program_source.h"

#include <ftw.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- scratch folders, absolute as required for caches ------------------------------------------------------------ */

static void scratch_make(char *folder, size_t size)
{
    ck_assert_ptr_nonnull(getcwd(folder, size - 32));
    strcat(folder, "/scratch-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void scratch_write(const char *folder, const char *name, const char *text)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    ck_assert_int_eq(fclose(file), 0);
}

static int entry_remove(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

static void scratch_remove(const char *folder)
{
    ck_assert_int_eq(nftw(folder, entry_remove, 8, FTW_DEPTH | FTW_PHYS), 0);
}

/* ---- the text ---------------------------------------------------------------------------------------------------- */

static char *sources_folder(char *path, size_t size)
{
    snprintf(path, size, "%s/shared", test_source_folder());
    return path;
}

static int occurrences(const char *text, const char *what)
{
    int count = 0;
    for (const char *p = strstr(text, what); p; p = strstr(p + 1, what))
        ++count;
    return count;
}

static char *text_read(const char *folder, const char *name)
{
    Error error = {0};
    char *text = program_source_read(folder, name, &error);
    ck_assert_msg(text != NULL, "%s", error.message);
    return text;
}

START_TEST(test_text_is_whole)
{
    char folder[PATH_MAX];
    char *text = text_read(sources_folder(folder, sizeof folder), "kernels.cl");
    ck_assert_int_eq(occurrences(text, "#include \""), 0);
    ck_assert_int_eq(occurrences(text, "#line 1 \"shared/math/vec.h\"\n"), 1);
    ck_assert_int_eq(occurrences(text, "__kernel void pt_start_paths("), 1);
    free(text);
}
END_TEST

/* Every kernel is a kernel in one program and a function in the others, at the same place. */
START_TEST(test_text_of_programs)
{
    char folder[PATH_MAX], begin[80];
    int found[KERNEL_COUNT] = {0};
    char *whole = text_read(sources_folder(folder, sizeof folder), "kernels.cl");
    for (int which = 0; which < OCL_PROGRAMS; ++which) {
        char *text = ocl_program_text(whole, which);
        ck_assert_ptr_nonnull(text);
        ck_assert_uint_eq(strlen(text), strlen(whole));
        for (unsigned kernel = 0; kernel < KERNEL_COUNT; ++kernel) {
            snprintf(begin, sizeof begin, "__kernel void %s(", ocl_kernel_name(kernel));
            found[kernel] += occurrences(text, begin);
        }
        free(text);
    }
    for (unsigned kernel = 0; kernel < KERNEL_COUNT; ++kernel)
        ck_assert_msg(found[kernel] == 1, "%s is in %d programs", ocl_kernel_name(kernel), found[kernel]);
    free(whole);
}
END_TEST

/* A line after an include has its original number. */
START_TEST(test_text_keeps_lines)
{
    char folder[PATH_MAX];
    scratch_make(folder, sizeof folder);
    scratch_write(folder, "a.cl", "one\n  #  include \"b.h\"\nthree\n#include \"b.h\"\n#include <math.h>\nlast");
    scratch_write(folder, "b.h", "inside\n");
    char *text = text_read(folder, "a.cl");
    ck_assert_str_eq(text, "#line 1 \"shared/a.cl\"\none\n#line 1 \"shared/b.h\"\ninside\n#line 3 \"shared/a.cl\"\n"
                           "three\n#line 5 \"shared/a.cl\"\n#include <math.h>\nlast");
    free(text);
    scratch_remove(folder);
}
END_TEST

START_TEST(test_text_missing)
{
    char folder[PATH_MAX];
    Error error = {0};
    scratch_make(folder, sizeof folder);
    scratch_write(folder, "a.cl", "#include \"gone.h\"\n");
    ck_assert_ptr_null(program_source_read(folder, "a.cl", &error));
    ck_assert_ptr_nonnull(strstr(error.message, "gone.h"));
    ck_assert_ptr_nonnull(strstr(error.fix, "TWINLIGHT_KERNELS"));
    scratch_remove(folder);
}
END_TEST

/* ---- the cache --------------------------------------------------------------------------------------------------- */

static CacheKey key_of(const char *a, const char *b)
{
    const char *const strings[] = {a, b};
    return cache_key(strings, 2);
}

START_TEST(test_cache_keys_differ)
{
    CacheKey keys[] = {key_of("a", "b"), key_of("b", "a"), key_of("ab", ""), key_of("", "ab"), key_of("a", "c")};
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < i; ++j)
            ck_assert(keys[i].hash[0] != keys[j].hash[0] && keys[i].hash[1] != keys[j].hash[1]);
    ck_assert(key_of("a", "b").hash[0] == keys[0].hash[0]);
}
END_TEST

/* The cache file of a key, below `folder`. */
static void cache_file(const char *folder, CacheKey key, char *path, size_t size)
{
    snprintf(path, size, "%s/twinlight/%016llx%016llx.program", folder, (unsigned long long)key.hash[0],
             (unsigned long long)key.hash[1]);
}

START_TEST(test_cache_gives_back_or_nothing)
{
    char folder[PATH_MAX / 2], path[PATH_MAX];
    unsigned char binary[1000], *back;
    size_t size = 0;
    CacheKey key = key_of("one", "two");
    scratch_make(folder, sizeof folder);
    setenv("XDG_CACHE_HOME", folder, 1);
    for (size_t i = 0; i < sizeof binary; ++i)
        binary[i] = (unsigned char)(i * 7);
    ck_assert_ptr_null(cache_read(key, &size));
    ck_assert(cache_write(key, binary, sizeof binary, path));
    back = cache_read(key, &size);
    ck_assert(back && size == sizeof binary && memcmp(back, binary, size) == 0);
    free(back);
    ck_assert_ptr_null(cache_read(key_of("one", "three"), &size));
    cache_file(folder, key, path, sizeof path);
    ck_assert_int_eq(chmod(path, 0600), 0);
    for (long place = 0; place < 1000; place += 37) { /* changes one byte, at various places */
        FILE *file = fopen(path, "r+b");
        ck_assert_ptr_nonnull(file);
        fseek(file, place, SEEK_SET);
        int byte = fgetc(file);
        fseek(file, place, SEEK_SET);
        fputc(byte ^ 0x20, file);
        fclose(file);
        ck_assert_msg(cache_read(key, &size) == NULL, "byte %ld may be changed", place);
        ck_assert(cache_write(key, binary, sizeof binary, path));
    }
    ck_assert_int_eq(truncate(path, 700), 0);
    ck_assert_ptr_null(cache_read(key, &size));
    scratch_remove(folder);
}
END_TEST

START_TEST(test_cache_without_a_place)
{
    char folder[PATH_MAX], path[PATH_MAX];
    const unsigned char binary[4] = {1, 2, 3, 4};
    scratch_make(folder, sizeof folder);
    scratch_write(folder, "file", "not a folder");
    strcat(folder, "/file");
    setenv("XDG_CACHE_HOME", folder, 1);
    ck_assert(!cache_write(key_of("a", "b"), binary, sizeof binary, path));
    ck_assert_ptr_nonnull(strstr(path, folder));
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    ck_assert(!cache_write(key_of("a", "b"), binary, sizeof binary, path));
    ck_assert_str_eq(path, "");
    *strrchr(folder, '/') = '\0';
    scratch_remove(folder);
}
END_TEST

/* ---- building ---------------------------------------------------------------------------------------------------- */

static char messages[8192];

static void message_keep(const char *line, void *context)
{
    (void)context;
    strncat(messages, line, sizeof messages - strlen(messages) - 1);
}

static bool driver_keeps = false; /* whether programs are left to the driver's own cache */

/* Builds the one-kernel program in `folder`; returns whether it built, *cached whether it came from the cache. */
static bool small_build(const char *folder, bool *cached, Error *error)
{
    OclDevice device;
    OclProgram program;
    cl_int status;
    test_device(&device);
    device.keeps_programs = driver_keeps;
    setenv("TWINLIGHT_KERNELS", folder, 1);
    cl_context context = clCreateContext(NULL, 1, &device.id, NULL, NULL, &status);
    ck_assert_int_eq(status, CL_SUCCESS);
    bool built = ocl_program_init(&program, context, &device, 1u, error);
    *cached = program.cached;
    ocl_program_destroy(&program);
    clReleaseContext(context);
    return built;
}

/* Makes a folder with this kernel source and places both caches in it. */
static void folder_with_cache(char *folder, size_t size, const char *kernels)
{
    scratch_make(folder, size);
    scratch_write(folder, "kernels.cl", kernels);
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("POCL_CACHE_DIR", folder, 1);
}

START_TEST(test_program_comes_from_the_cache)
{
    char folder[PATH_MAX];
    bool cached = true;
    Error error = {0};
    folder_with_cache(folder, sizeof folder, "__kernel void k(__global int *a) { a[0] = 1; }\n");
    ck_assert_msg(small_build(folder, &cached, &error), "%s", error.message);
    ck_assert(!cached);
    ck_assert(small_build(folder, &cached, &error));
    ck_assert(cached);
    /* a different source is a different program */
    scratch_write(folder, "kernels.cl", "__kernel void k(__global int *a) { a[0] = 2; }\n");
    ck_assert(small_build(folder, &cached, &error));
    ck_assert(!cached);
    scratch_remove(folder);
}
END_TEST

/* A program is built when one of its kernels is first wanted, and kept like the first. */
START_TEST(test_program_built_on_demand)
{
    char folder[PATH_MAX];
    OclDevice device;
    Error error = {0};
    cl_int status;
    folder_with_cache(folder, sizeof folder,
                      "__kernel void pt_splat(__global int *a) { a[0] = 1; }\n"
                      "__kernel void mlt_end(__global int *a) { a[0] = 2; }\n");
    setenv("TWINLIGHT_KERNELS", folder, 1);
    test_device(&device);
    device.keeps_programs = false;
    cl_context context = clCreateContext(NULL, 1, &device.id, NULL, NULL, &status);
    ck_assert_int_eq(status, CL_SUCCESS);
    for (int i = 0; i < 2; ++i) {
        OclProgram program;
        ck_assert_msg(ocl_program_init(&program, context, &device, 1u, &error), "%s", error.message);
        ck_assert_ptr_nonnull(program.programs[PROGRAM_PATHS]);
        ck_assert_ptr_null(program.programs[PROGRAM_CHAINS]);
        cl_kernel kernel = ocl_program_kernel(&program, KERNEL_mlt_end, &error);
        ck_assert_msg(kernel != NULL, "%s", error.message);
        ck_assert_ptr_eq(ocl_program_kernel(&program, KERNEL_mlt_end, &error), kernel);
        ck_assert_ptr_nonnull(program.programs[PROGRAM_CHAINS]);
        ck_assert_int_eq(program.cached, i == 1);
        ck_assert_ptr_null(ocl_program_kernel(&program, KERNEL_bd_splat, &error)); /* the source has none */
        ocl_program_destroy(&program);
    }
    clReleaseContext(context);
    scratch_remove(folder);
}
END_TEST

START_TEST(test_program_without_a_cache)
{
    char folder[PATH_MAX];
    bool cached = true;
    Error error = {0};
    folder_with_cache(folder, sizeof folder, "__kernel void k(__global int *a) { a[0] = 5; }\n");
    unsetenv("HOME");
    unsetenv("XDG_CACHE_HOME");
    log_sink_set(message_keep, NULL);
    ck_assert_msg(small_build(folder, &cached, &error), "%s", error.message);
    log_sink_set(NULL, NULL);
    ck_assert(!cached);
    ck_assert_ptr_nonnull(strstr(messages, "neither XDG_CACHE_HOME nor HOME is set"));
    scratch_remove(folder);
}
END_TEST

START_TEST(test_program_left_to_the_driver)
{
    char folder[PATH_MAX], path[PATH_MAX + 16];
    bool cached = true;
    Error error = {0};
    folder_with_cache(folder, sizeof folder, "__kernel void k(__global int *a) { a[0] = 4; }\n");
    driver_keeps = true;
    for (int i = 0; i < 2; ++i) {
        ck_assert_msg(small_build(folder, &cached, &error), "%s", error.message);
        ck_assert(!cached);
    }
    driver_keeps = false;
    snprintf(path, sizeof path, "%s/twinlight", folder);
    ck_assert_msg(access(path, F_OK) != 0, "a program is kept twice");
    scratch_remove(folder);
}
END_TEST

/* A well-formed cache entry that is not a program for this device. */
START_TEST(test_program_that_the_device_refuses)
{
    static const char TEXT[] = "#line 1 \"shared/kernels.cl\"\n__kernel void k(__global int *a) { a[0] = 3; }\n";
    char folder[PATH_MAX], path[PATH_MAX], options[OCL_OPTIONS_SIZE];
    const unsigned char nonsense[] = "this is no program";
    bool cached = true;
    OclDevice device;
    Error error = {0};
    folder_with_cache(folder, sizeof folder, strchr(TEXT, '\n') + 1);
    test_device(&device);
    ocl_program_options(&device, 1u, options, sizeof options);
    const char *parts[] = {TEXT, options, device.info.platform, device.info.name, device.info.version};
    ck_assert(cache_write(cache_key(parts, 5), nonsense, sizeof nonsense, path));
    ck_assert_msg(small_build(folder, &cached, &error), "%s", error.message);
    ck_assert(!cached);
    ck_assert(small_build(folder, &cached, &error));
    ck_assert_msg(cached, "the good program did not replace the bad one");
    scratch_remove(folder);
}
END_TEST

START_TEST(test_build_log_names_file_and_line)
{
    char folder[PATH_MAX];
    bool cached;
    Error error = {0};
    folder_with_cache(folder, sizeof folder,
                      "// one\n#include \"part.h\"\n__kernel void k(__global int *a) { f(a); }\n");
    scratch_write(folder, "part.h", "// one\n// two\nvoid f(__global int *a) { *a = unknown_name; }\n");
    log_sink_set(message_keep, NULL);
    ck_assert(!small_build(folder, &cached, &error));
    log_sink_set(NULL, NULL);
    ck_assert_msg(strstr(error.message, "shared/part.h:3") || strstr(messages, "shared/part.h:3"), "%s\n%s",
                  error.message, messages);
    ck_assert_ptr_nonnull(strstr(messages, "unknown_name"));
    scratch_remove(folder);
}
END_TEST

TCase *opencl_program_tests(void)
{
    TCase *program = tcase_create("program");
    tcase_set_timeout(program, 60);
    tcase_add_test(program, test_text_is_whole);
    tcase_add_test(program, test_text_of_programs);
    tcase_add_test(program, test_text_keeps_lines);
    tcase_add_test(program, test_text_missing);
    tcase_add_test(program, test_cache_keys_differ);
    tcase_add_test(program, test_cache_gives_back_or_nothing);
    tcase_add_test(program, test_cache_without_a_place);
    tcase_add_test(program, test_program_comes_from_the_cache);
    tcase_add_test(program, test_program_built_on_demand);
    tcase_add_test(program, test_program_without_a_cache);
    tcase_add_test(program, test_program_left_to_the_driver);
    tcase_add_test(program, test_program_that_the_device_refuses);
    tcase_add_test(program, test_build_log_names_file_and_line);
    return program;
}
