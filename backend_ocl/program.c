#include "program.h"

#include "base/log.h"
#include "program_cache.h"
#include "program_source.h"
#include "timeline.h"

#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KERNEL_NAME(name, count, ...) #name,
static const char *const KERNEL_NAMES[KERNEL_COUNT] = {KERNEL_LIST(KERNEL_NAME)};
#undef KERNEL_NAME

#define OF_PATHS(...) PROGRAM_PATHS,
#define OF_BIDIRECTIONAL(...) PROGRAM_BIDIRECTIONAL,
#define OF_IBPT(...) PROGRAM_IBPT,
#define OF_CAUSTICS(...) PROGRAM_CAUSTICS,
#define OF_OPENINGS(...) PROGRAM_OPENINGS,
#define OF_CHAINS(...) PROGRAM_CHAINS,
static const unsigned char PROGRAM_OF[KERNEL_COUNT] = {
    KERNEL_LIST_PATHS(OF_PATHS) KERNEL_LIST_OTHERS(OF_PATHS) KERNEL_LIST_BIDIRECTIONAL(OF_BIDIRECTIONAL)
        KERNEL_LIST_IBPT(OF_IBPT) KERNEL_LIST_CAUSTICS(OF_CAUSTICS) KERNEL_LIST_OPENINGS(OF_OPENINGS)
            KERNEL_LIST_CHAINS(OF_CHAINS)};

const char *ocl_kernel_name(unsigned kernel)
{
    return KERNEL_NAMES[kernel];
}

/* None of these options changes results: OpenCL's fast-math options are off by default, and contraction to fused
 * multiply-add is disabled in math/platform.h. */
void ocl_program_options(const OclDevice *device, ulong features, char *options, size_t size)
{
    snprintf(options, size, "-cl-std=CL1.2 -D TWINLIGHT_FEATURES=0x%" PRIx64 "ul%s", features,
             device->info.promises_division ? " -cl-fp32-correctly-rounded-divide-sqrt" : "");
}

/* Nanoseconds: if a build took longer, the driver's own cache did not have the program. */
#define SLOW_BUILD 1000000000u

/* ---- the text ---------------------------------------------------------------------------------------------------- */

#define KERNEL_BEGIN "__kernel void "
#define FUNCTION_BEGIN "  static void "

/* Whether the kernel whose name begins at `name` is one of another program's. */
static bool of_another(const char *name, int which)
{
    size_t length = strcspn(name, "( \n");
    for (unsigned kernel = 0; kernel < KERNEL_COUNT; ++kernel)
        if (strlen(KERNEL_NAMES[kernel]) == length && strncmp(KERNEL_NAMES[kernel], name, length) == 0)
            return PROGRAM_OF[kernel] != which;
    return false;
}

char *ocl_program_text(const char *source, int which)
{
    _Static_assert(sizeof KERNEL_BEGIN == sizeof FUNCTION_BEGIN, "replaced in place");
    char *text = strdup(source);
    for (char *p = text; p && (p = strstr(p, KERNEL_BEGIN)) != NULL; p += sizeof KERNEL_BEGIN - 1)
        if (of_another(p + sizeof KERNEL_BEGIN - 1, which))
            memcpy(p, FUNCTION_BEGIN, sizeof FUNCTION_BEGIN - 1);
    return text;
}

/* ---- building ---------------------------------------------------------------------------------------------------- */

static char *build_log(cl_program program, cl_device_id device)
{
    size_t size = 0;
    if (clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, NULL, &size) != CL_SUCCESS)
        return NULL;
    char *log = calloc(size + 1, 1);
    if (log)
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, log, NULL);
    return log;
}

/* The first line with an error in the compiler's log, else its first line. */
static const char *log_first_error(const char *log, int *length)
{
    const char *line = strstr(log, "error:");
    if (!line)
        line = log + strspn(log, " \n");
    while (line > log && line[-1] != '\n')
        --line;
    *length = (int)strcspn(line, "\n");
    return line;
}

/* Logs line by line, because a message is one line. */
static void log_show(const OclProgram *program, char *log)
{
    char *rest = NULL;
    log_message(LOG_WARNING, "the compiler of %s says:", program->device->info.name);
    for (char *line = strtok_r(log, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        log_message(LOG_WARNING, "%s", line);
}

static bool build_fail(const OclProgram *program, cl_program built, cl_int status, Error *error)
{
    const char *folder = program_source_folder();
    char *log = build_log(built, program->device->id);
    if (!log || log[strspn(log, " \n")] == '\0') {
        free(log);
        return ocl_fail(error, program->device->info.name, "building the kernels", status);
    }
    int length;
    const char *line = log_first_error(log, &length);
    error_set(error, "%s cannot build the kernels of %s: %.*s", program->device->info.name, folder,
              length > 400 ? 400 : length, line);
    bool has_reason = strstr(log, "error:") != NULL;
    log_show(program, log);
    free(log);
    if (!has_reason)
        return error_fix(error, "the driver gives no reason; PoCL must be able to write to its cache folder: set "
                                "POCL_CACHE_DIR to a writable folder, or choose another device or --backend=cpu");
    return error_fix(error, "the sources must be those of this version of Twinlight (TWINLIGHT_KERNELS selects another "
                            "folder); otherwise choose another device, or --backend=cpu");
}

static bool build_from_source(const OclProgram *program, const char *source, cl_program *built, Error *error)
{
    cl_int status;
    const char *device = program->device->info.name;
    bool driver_keeps = program->device->keeps_programs;
    uint64_t start = timeline_now();
    *built = clCreateProgramWithSource(program->context, 1, &source, NULL, &status);
    if (status != CL_SUCCESS)
        return ocl_fail(error, device, "making a program", status);
    status = clBuildProgram(*built, 1, &program->device->id, program->options, NULL, NULL);
    if (status == CL_SUCCESS && driver_keeps && timeline_now() - start > SLOW_BUILD)
        log_message(LOG_INFO, "%s builds each kernel on first use, and keeps it for later runs", device);
    return status == CL_SUCCESS || build_fail(program, *built, status, error);
}

/* ---- the cache --------------------------------------------------------------------------------------------------- */

/* False if there is no entry or the device rejects it; the program is then built from source. */
static bool build_from_cache(const OclProgram *program, CacheKey key, cl_program *built)
{
    size_t size = 0;
    unsigned char *binary = cache_read(key, &size);
    if (!binary)
        return false;
    const unsigned char *binaries[1] = {binary};
    cl_int status, loaded = CL_INVALID_BINARY;
    *built = clCreateProgramWithBinary(program->context, 1, &program->device->id, &size, binaries, &loaded, &status);
    free(binary);
    if (status == CL_SUCCESS && loaded == CL_SUCCESS &&
        clBuildProgram(*built, 1, &program->device->id, program->options, NULL, NULL) == CL_SUCCESS)
        return true;
    if (*built)
        clReleaseProgram(*built);
    *built = NULL;
    return false;
}

static unsigned char *program_binary(cl_program program, size_t *size)
{
    *size = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof *size, size, NULL) != CL_SUCCESS || *size == 0)
        return NULL;
    unsigned char *binary = malloc(*size);
    if (binary && clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) != CL_SUCCESS) {
        free(binary);
        binary = NULL;
    }
    return binary;
}

static void save_to_cache(cl_program built, CacheKey key)
{
    char path[PATH_MAX];
    size_t size;
    unsigned char *binary = program_binary(built, &size);
    if (binary && !cache_write(key, binary, size, path))
        log_message(LOG_INFO, "cannot keep the built kernels in %s; the next run will build them again",
                    path[0] ? path : "a cache (neither XDG_CACHE_HOME nor HOME is set)");
    free(binary);
}

/* ---- a program --------------------------------------------------------------------------------------------------- */

static bool text_build(OclProgram *program, const char *text, cl_program *built, Error *error)
{
    const BackendDevice *info = &program->device->info;
    const char *parts[] = {text, program->options, info->platform, info->name, info->version};
    CacheKey key = cache_key(parts, (int)(sizeof parts / sizeof parts[0]));
    if (program->device->keeps_programs)
        return build_from_source(program, text, built, error);
    if (build_from_cache(program, key, built))
        return true;
    if (program->cached) /* the first that is built */
        log_message(LOG_INFO, "building kernels for %s; they are kept for later runs", info->name);
    program->cached = false;
    if (!build_from_source(program, text, built, error))
        return false;
    save_to_cache(*built, key);
    return true;
}

static bool program_build(OclProgram *program, int which, Error *error)
{
    if (program->programs[which])
        return true;
    if (program->device->keeps_programs)
        return text_build(program, program->source, &program->programs[which], error);
    char *text = ocl_program_text(program->source, which);
    if (!text)
        return error_memory(error, strlen(program->source), "the kernels' text");
    bool built = text_build(program, text, &program->programs[which], error);
    free(text);
    return built;
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

bool ocl_program_init(OclProgram *program, cl_context context, const OclDevice *device, ulong features, Error *error)
{
    memset(program, 0, sizeof *program);
    program->context = context;
    program->device = device;
    program->cached = !device->keeps_programs;
    ocl_program_options(device, features, program->options, sizeof program->options);
    program->source = program_source_read(program_source_folder(), "kernels.cl", error);
    return program->source && program_build(program, PROGRAM_PATHS, error);
}

void ocl_program_destroy(OclProgram *program)
{
    for (int i = 0; i < KERNEL_COUNT; ++i)
        if (program->kernels[i])
            clReleaseKernel(program->kernels[i]);
    for (int which = 0; which < OCL_PROGRAMS; ++which)
        if (program->programs[which])
            clReleaseProgram(program->programs[which]);
    free(program->source);
    memset(program, 0, sizeof *program);
}

static bool kernel_create(OclProgram *program, unsigned kernel, Error *error)
{
    int which = program->device->keeps_programs ? PROGRAM_PATHS : PROGRAM_OF[kernel];
    cl_int status;
    if (!program_build(program, which, error))
        return false;
    program->kernels[kernel] = clCreateKernel(program->programs[which], KERNEL_NAMES[kernel], &status);
    if (status == CL_SUCCESS)
        return true;
    char what[128];
    snprintf(what, sizeof what, "making kernel %s", KERNEL_NAMES[kernel]);
    return ocl_fail(error, program->device->info.name, what, status);
}

cl_kernel ocl_program_kernel(OclProgram *program, unsigned kernel, Error *error)
{
    return program->kernels[kernel] || kernel_create(program, kernel, error) ? program->kernels[kernel] : NULL;
}
