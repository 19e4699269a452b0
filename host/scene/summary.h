/* Counts of what a finished scene holds, for people and for scripts. */
#ifndef TWINLIGHT_SCENE_SUMMARY_H
#define TWINLIGHT_SCENE_SUMMARY_H

#include "scene/scene.h"

#include <stdio.h>

#define PRIMITIVE_KINDS 4

typedef struct SceneSummary {
    size_t primitives[PRIMITIVE_KINDS]; /* by PRIMITIVE_*; those of objects once, however often they are instanced */
    size_t materials[MATERIAL_KINDS]; /* by MATERIAL_* */
    size_t lights[LIGHT_KINDS]; /* by LIGHT_* */
    size_t textures; /* texture programs */
    size_t images;
    size_t objects; /* object definitions, without the world */
    size_t instances;
} SceneSummary;

void scene_summary(const Scene *scene, SceneSummary *summary);

void scene_summary_text(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream);
void scene_summary_json(const Scene *scene, const SceneSummary *summary, const char *path, FILE *stream);

#endif
