/* The --stats file: what was rendered, how fast, and what was noticed. twinlight-render(1) documents the keys; they
 * are a promise to scripts: add keys, never rename or remove one without raising STATS_FORMAT. */
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
    const char *exr;
    const char *png; /* "": none */
    const RenderResult *result;
    /* Seconds of wall-clock time. */
    double load, build, render, write, total;
} RenderStats;

/* Whether the path means standard output: "-". */
bool stats_to_output(const char *path);

bool stats_write(const char *path, const RenderStats *stats, Error *error);

/* The name of a kind of mutation, 0 ... CHAIN_KINDS - 1. */
const char *stats_chain_kind(int kind);

/* What chains did in all, into the object that is open. */
void stats_chain_counts(JsonWriter *json, const ChainStatistics *chains);

/* Whether they have got about, by depth. */
void stats_chain_health(JsonWriter *json, const ChainStatistics *chains);

#endif
