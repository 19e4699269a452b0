#include "pbrt/context.h"

#include <stdio.h>
#include <string.h>

const char *import_path(PbrtImport *im, const char *name)
{
    size_t directory = strlen(im->directory), length = strlen(name);
    if (name[0] == '/' || directory == 0)
        return arena_text(&im->arena, name, length, im->error);
    char *path = arena_alloc(&im->arena, directory + length + 2, im->error);
    if (path)
        snprintf(path, directory + length + 2, "%s%s%s", im->directory, im->directory[directory - 1] == '/' ? "" : "/",
                 name);
    return path;
}

void import_list(PbrtImport *im, ParamList *list, const char *owner, int target)
{
    param_list_init(list, owner, im->place, im->error);
    param_list_add_buffer(list, &im->params);
    if (target >= 0)
        param_list_add_set(list, im->state.attributes[target], true);
}
