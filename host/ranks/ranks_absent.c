/* In a program built without MPI. */
#include "ranks/ranks.h"

#include "ranks/launcher.h"

const char *ranks_library(void)
{
    return NULL;
}

bool ranks_begin(Error *error)
{
    if (launcher_processes() == 1)
        return true;
    if (launcher_rank() > 0)
        return false; /* rank 0 says why */
    error_set(error, "the launcher has started several processes, but this program was built without MPI");
    return error_fix(error, "install libopenmpi-dev and configure again, or render a part on each with --shard");
}

int ranks_count(void)
{
    return 1;
}

int ranks_number(void)
{
    return 0;
}

void ranks_serve(const RankSetup *setup)
{
    (void)setup;
}

bool ranks_greet(int *status, Error *error)
{
    (void)status, (void)error;
    return true;
}

bool ranks_open(const BackendScene *scene, const RankSetup *setup, BackendMember *opened, Error *error)
{
    return backend_choices_open(setup->choices, scene, setup->options, opened, error);
}

void ranks_end(void)
{
}
