/* Counts of the contents of a finished scene, as text and as JSON. */
#ifndef TWINLIGHT_SCENE_SUMMARY_H
#define TWINLIGHT_SCENE_SUMMARY_H

#include "scene/scene.h"

#include <stdio.h>

typedef struct SceneSummary {
    size_t primitives[PRIMITIVE_KINDS]; /* by PRIMITIVE_*; those of an object count once, not per instance */
    size_t materials[MATERIAL_KINDS]; /* by MATERIAL_* */
    size_t lights[LIGHT_KINDS]; /* by LIGHT_* */
    size_t textures; /* texture programs */
    size_t images;
    size_t media; /* that MakeNamedMedium has defined */
    size_t objects; /* object definitions, without the world */
    size_t instances;
} SceneSummary;

void scene_summary(const Scene *scene, SceneSummary *summary);

/* Print the summary; `path` is the scene's name. */
void scene_summary_text(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream);
void scene_summary_json(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream);

#endif
