#include "ranks/launcher.h"

#include <stdlib.h>

/* The value of the first of the variables that is set to a number; -1: none is. */
static int first_number(const char *const *names)
{
    for (; *names; ++names) {
        const char *text = getenv(*names);
        char *end = NULL;
        long value = text && text[0] ? strtol(text, &end, 10) : -1;
        if (end && *end == '\0' && value >= 0 && value < 1 << 24)
            return (int)value;
    }
    return -1;
}

int launcher_rank(void)
{
    static const char *const RANK[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", NULL};
    int rank = first_number(RANK);
    return rank < 0 ? 0 : rank;
}

int launcher_processes(void)
{
    static const char *const SIZE[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", NULL};
    static const char *const RANK[] = {"PMIX_RANK", "PMI_RANK", NULL};
    static const char *const TASKS[] = {"SLURM_STEP_NUM_TASKS", NULL};
    int size = first_number(SIZE);
    if (size < 0 && first_number(RANK) >= 0) {
        size = first_number(TASKS);
        size = size < 0 ? 0 : size;
    }
    return size < 0 ? 1 : size;
}
