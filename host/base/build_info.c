#include "base/build_info.h"

#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

/* The build makes this file; tools that only look at the sources go without. */
#ifdef __has_include
#if __has_include("build_commit.h")
#include "build_commit.h"
#endif
#endif
#ifndef BUILD_COMMIT
#define BUILD_COMMIT "unknown"
#endif

#ifdef NDEBUG
#define ASSERTIONS ""
#else
#define ASSERTIONS ", with assertions"
#endif

const char *build_commit(void)
{
    return BUILD_COMMIT;
}

const char *build_compiler(void)
{
#ifdef __clang__
    return "Clang " __clang_version__ ASSERTIONS;
#else
    return "GCC " __VERSION__ ASSERTIONS;
#endif
}

/* The processor's name as Linux has it; "unknown processor" elsewhere. */
static void processor_name(char *name, size_t size)
{
    char line[256];
    snprintf(name, size, "unknown processor");
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        line[strcspn(line, "\n")] = '\0';
        snprintf(name, size, "%s", colon + 1 + strspn(colon + 1, " "));
        break;
    }
    if (file)
        fclose(file);
}

void build_machine(char *text, size_t size)
{
    char processor[160];
    struct utsname system;
    processor_name(processor, sizeof processor);
    if (uname(&system) != 0)
        memset(&system, 0, sizeof system);
    double gib = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE) / 1073741824.0;
    snprintf(text, size, "%s, %ld processors, %.0f GiB, %s %s", processor, sysconf(_SC_NPROCESSORS_ONLN), gib,
             system.sysname, system.release);
}
