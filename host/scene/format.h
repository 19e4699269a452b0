/* Recognises files that are not pbrt-v4 scenes. */
#ifndef TWINLIGHT_SCENE_FORMAT_H
#define TWINLIGHT_SCENE_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

/* Name of the format of a file with these first bytes, such as "a glTF file", with a suggestion in *fix; NULL if it may
 * be a scene. */
const char *scene_format_other(const char *head, size_t size, const char **fix);

/* The same by the end of the file's name. */
const char *scene_format_named(const char *name, const char **fix);

/* Whether this material, film, shape or type of texture of pbrt-v3 was renamed or removed in pbrt-v4. */
bool scene_format_is_v3(const char *kind, const char *name);

#endif
