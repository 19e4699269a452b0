/* What a file that is no scene of pbrt-v4's looks like. */
#ifndef TWINLIGHT_SCENE_FORMAT_H
#define TWINLIGHT_SCENE_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

/* By the first bytes of a file: "a glTF file", with what to do about it in *fix; NULL: it may be a scene. */
const char *scene_format_other(const char *head, size_t size, const char **fix);

/* Whether this is a material, film or shape of pbrt-v3 that pbrt-v4 calls otherwise or has no more. */
bool scene_format_is_v3(const char *kind, const char *name);

#endif
