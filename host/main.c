/* The program `twinlight`: runs a command, prints its error, and sets the exit status. The only file that names
 * backends. */
#include "config.h"

#include "base/build_info.h"
#include "base/name_table.h"
#include "base/startup.h"
#include "command/cmd_compare.h"
#include "command/command.h"
#include "ranks/launcher.h"
#include "ranks/ranks.h"

#ifdef HAVE_EMBREE
#include "backend_cpu.h"
#endif
#ifdef HAVE_OPENCL
#include "backend_ocl.h"
#endif

#include <stdio.h>
#include <string.h>

#define BACKENDS_MAX 4

typedef struct Command {
    const char *name;
    const char *summary;
    int (*run)(const BackendTable *backends, int argc, char **argv, Error *error);
} Command;

static int compare_run(const BackendTable *backends, int argc, char **argv, Error *error)
{
    (void)backends;
    return cmd_compare(argc, argv, error);
}

static const Command COMMANDS[] = {
    {"render", "render a scene to OpenEXR and PNG", cmd_render},
    {"merge", "make an image of the parts that several machines have rendered", cmd_merge},
    {"compare", "measure how far an image is from a reference", compare_run},
    {"bench", "measure error against time and write a report", cmd_bench},
    {"convert", "write a glTF scene as a pbrt scene", cmd_convert},
    {"info", "print what a scene contains", cmd_info},
    {"devices", "list backends and devices for rendering", cmd_devices},
    {"pyramid", "show the contribution of every bidirectional strategy", cmd_pyramid},
};

#define COMMAND_COUNT (int)(sizeof COMMANDS / sizeof COMMANDS[0])

/* Backends missing from this build, and why. */
static const BackendLeftOut LEFT_OUT[] = {
#ifndef HAVE_OPENCL
    {"opencl", "it was configured without OpenCL",
     "apt-get install ocl-icd-opencl-dev pocl-opencl-icd, then configure without --without-opencl and make again"},
#endif
    {NULL, NULL, NULL}};

static int backends_fill(const BackendInterface **backends)
{
    int count = 0;
#ifdef HAVE_EMBREE
    backends[count++] = backend_cpu();
#endif
#ifdef HAVE_OPENCL
    backends[count++] = backend_ocl();
#endif
    return count;
}

static void help_print(FILE *stream)
{
    fputs("Usage: twinlight COMMAND [OPTION]... [FILE]...\n"
          "A physically based renderer for light transport that is hard to sample.\n\n",
          stream);
    for (int i = 0; i < COMMAND_COUNT; ++i)
        fprintf(stream, "  %-8s  %s\n", COMMANDS[i].name, COMMANDS[i].summary);
    fputs("\n"
          "  -h, --help     print this and exit; after a command, its own help\n"
          "  -V, --version  print the version and exit\n"
          "\n"
          "Exit status: 0 success; 1 failure, with an error; 2 invalid command line; 130 ended by a signal.\n"
          "More: man twinlight.\n",
          stream);
}

static void version_print(FILE *stream, const BackendTable *backends)
{
    fprintf(stream, PACKAGE_NAME " " PACKAGE_VERSION " (commit %s)\nBackends:", build_commit());
    for (int i = 0; i < backends->count; ++i)
        fprintf(stream, " %s", backends->backends[i]->name);
    const char *ranks = ranks_library();
    fprintf(stream, "\nSeveral processes: %s\nLicence: Apache-2.0\n", ranks ? ranks : "no, it was built without MPI");
}

static int usage_fail(Error *error, const char *word)
{
    if (word)
        error_set(error, "unknown %s %s", word[0] == '-' ? "option" : "command", word);
    else
        error_set(error, "no command is given");
    const char *names[COMMAND_COUNT];
    for (int i = 0; i < COMMAND_COUNT; ++i)
        names[i] = COMMANDS[i].name;
    const char *nearest = word && word[0] != '-' ? name_nearest(word, names, COMMAND_COUNT) : NULL;
    if (nearest)
        error_fix(error, "did you mean %s? twinlight --help lists all", nearest);
    else
        error_fix(error, "use render, merge, compare, bench, convert, info, devices or pyramid; see twinlight --help");
    return EXIT_USAGE;
}

static int command_run(const BackendTable *backends, int argc, char **argv, Error *error)
{
    const char *word = argc > 1 ? argv[1] : NULL;
    if (launcher_rank() > 0 && (!word || strcmp(word, "render") != 0))
        return EXIT_OK; /* rank 0 alone does it */
    if (!word)
        return usage_fail(error, NULL);
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0) {
        help_print(stdout);
        return EXIT_OK;
    }
    if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) {
        version_print(stdout, backends);
        return EXIT_OK;
    }
    for (int i = 0; i < COMMAND_COUNT; ++i)
        if (strcmp(word, COMMANDS[i].name) == 0)
            return COMMANDS[i].run(backends, argc - 1, argv + 1, error);
    return usage_fail(error, word);
}

/* Output that did not reach its file (a full disk, a closed pipe) is a failure, too. */
static int output_close(int status, Error *error)
{
    bool failed = ferror(stdout) != 0;
    if (fclose(stdout) == 0 && !failed)
        return status;
    if (status == EXIT_OK) {
        error_errno(error, "write", "standard output");
        return EXIT_FAILED;
    }
    return status;
}

int main(int argc, char **argv)
{
    const BackendInterface *backends[BACKENDS_MAX];
    BackendTable table = {backends, backends_fill(backends), LEFT_OUT};
    Error error = {0};
    bool ready = startup_prepare(&error);
    int status = output_close(ready ? command_run(&table, argc, argv, &error) : EXIT_FAILED, &error);
    if (error.message[0])
        error_print(&error, stderr);
    return status;
}
