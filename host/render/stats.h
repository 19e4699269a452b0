/* The --stats file: what was rendered, how fast, and what was noticed. twinlight-render(1) documents the keys. Scripts
 * rely on them: add keys freely, but raise STATS_FORMAT when renaming or removing one. */
#ifndef TWINLIGHT_RENDER_STATS_H
#define TWINLIGHT_RENDER_STATS_H

#include "base/json.h"
#include "render/render.h"

#define STATS_FORMAT 1

typedef struct RenderStats {
    const char *scene_file;
    const Scene *scene;
    const Film *film;
    const char *integrator;
    const char *backend;
    uint64_t seed;
    const char *part; /* "": none, but an image */
    const char *exr;
    const char *png; /* "": none */
    const RenderResult *result;
    const ErrorGoal *error;
    /* Wall-clock seconds. */
    double load, build, render, write, total;
} RenderStats;

/* Whether the path is "-", standard output. */
bool stats_to_output(const char *path);

/* Writes the file, or prints to standard output if the path is "-". */
bool stats_write(const char *path, const RenderStats *stats, Error *error);

/* Name of a kind of mutation, 0 ... CHAIN_KINDS - 1. */
const char *stats_chain_kind(int kind);

/* Adds the chains' total counts and times to the open object. */
void stats_chain_counts(JsonWriter *json, const ChainStatistics *chains);

/* Adds measures of mixing by depth (runs of rejections, distinct starts, R-hat) to the open object. */
void stats_chain_health(JsonWriter *json, const ChainStatistics *chains);

#endif
