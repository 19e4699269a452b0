/* The state of one path in the kernels of each estimator, for the parts of test_partition. Records what partition_shown
 * is asked: to be included before any kernel. */
#ifndef TWINLIGHT_TESTS_MMLT_TEST_PARTITION_STATE_H
#define TWINLIGHT_TESTS_MMLT_TEST_PARTITION_STATE_H

#include "mmlt/test_partition.h"

#include "backend/bvh.h"
#include "path/partition.h"
#include "scene/scene.h"
#include "support/test_util.h"

/* ---- what the partition is asked --------------------------------------------------------------------------------- */

typedef struct Seen {
    float carried, threshold, part;
} Seen;

typedef struct SeenCalls {
    uint count;
    Seen calls[PARTITION_LIGHTS];
} SeenCalls;

extern SeenCalls seen;

float partition_seen(float carried, float threshold);
#define partition_shown(carried, threshold) partition_seen(carried, threshold)

#include "chain/chain_numbers.h"
#include "layout/diagnostics.h"
#include "path/path_state.h"

/* ---- state ------------------------------------------------------------------------------------------------------- */

#define PATHS_WORDS (CHAIN_NUMBERS + NUMBER_VERTICES + 4u * PARTITION_DEPTH + PATH_WORDS)

/* The buffers of one item. */
typedef struct Item {
    uint paths[PATHS_WORDS], rays[RAY_WORDS], hits[HIT_WORDS], shadows[SHADOW_WORDS], splats[SPLAT_WORDS];
    uint vertices[2 * PARTITION_DEPTH * VERTEX_WORDS], densities[2 * PARTITION_DEPTH * DENSITY_WORDS];
    uint pass[CHAIN_PASS_NUMBERS], diagnostics[DIAGNOSTIC_COUNT];
} Item;
_Static_assert(CHAIN_VERTEX_WORDS <= 2 * PARTITION_DEPTH * VERTEX_WORDS, "chains' vertices fit");

struct Partition {
    Scene scene;
    Bvh bvh;
    Guide guide;
    FrameParams pool_frame, chain_frame, paths_frame;
    const uint *geometry, *tables, *texels;
    SceneView view;
    Item pool, chain, paths;
    double paths_rare; /* the part of what path tracing has gathered last that is rare; NAN: nothing */
    Hit hits[2][PARTITION_DEPTH + 1]; /* by side: those of y_1 ..., of z_1 ... */
    Seen shown[PARTITION_DEPTH + 2][PARTITION_DEPTH + 2]; /* what the pool shows of (s, t); threshold 0: no path */
    uint sample;
    /* The path under way. */
    uint s, t;
    Vec2 film;
};

#define SCENE_OF(p) (p)->geometry, (p)->tables, (p)->texels

/* The strategy (s, t) that has made the path under way is that of the pool's sample. Runs path tracing along the path
 * and records what it asks for the last segment; seen.count 0: it cannot make the path. met: its ray hits the light;
 * else the light is drawn. */
void paths_run(Partition *partition, bool met);

/* Whether y_0 of the pool's sample is a direction. */
bool emitter_infinite(const Partition *partition);

#endif
