/* The parameters of kernels, grouped by who reads them: the scene and the camera, the film, paths and their MIS
 * weights, the partition among the estimators of an image, pools, chains, and the pass. Plain data of 4-byte members,
 * as all structs of layout/scene_types.h. */
#ifndef TWINLIGHT_LAYOUT_FRAME_PARAMS_H
#define TWINLIGHT_LAYOUT_FRAME_PARAMS_H

#include "layout/openings.h"
#include "layout/photon_map.h"
#include "layout/scene_types.h"

/* ---- what the parameters name ----------------------------------------------------------------------------------- */

/* Which integrator a random number is for (math/rng.h, counter word 3). */
#define PATH_STREAM_PT 0u
#define PATH_STREAM_BD 1u
#define PATH_STREAM_POOL 2u /* samples that chains start from */
#define PATH_STREAM_CHAIN 3u /* what a chain draws at each step */
#define PATH_STREAM_MUTATION 4u /* the choice of a chain's mutation */
#define PATH_STREAM_PHOTON 5u /* light subpaths of which photons are made */
#define PATH_STREAM_CAUSTIC 6u /* directions drawn by photons */
#define PATH_STREAM_OPENING 7u /* camera subpaths by which openings are found */

/* Largest number of light guides. */
#define LIGHT_GUIDES_MAX 8u

/* Cells of the target importance, per side. */
#define IMPORTANCE_SIDE 32u
#define IMPORTANCE_CELLS (IMPORTANCE_SIDE * IMPORTANCE_SIDE)

/* A pool visits any pixel at most this many times as often as the one that it visits least. */
#define VISITS_MOST 32u

/* ---- the frame --------------------------------------------------------------------------------------------------- */

typedef struct SceneParams {
    SceneLayout layout;
    uint features[2]; /* the feature mask: low, high (frame_features) */
    uint light_count;
    uint infinite_light_count;
    uint aim_count; /* of light subpaths (light/aim.h) */
    uint guide_count; /* light guides of chains and their pools (light/light_guide.h); 0 for other integrators */
    Vec3 world_center; /* bounding sphere of the scene */
    float world_radius;
    float ray_reach; /* no coordinate of a ray's origin is larger: boxes are widened for it (geometry/box.h) */
} SceneParams;

/* A splat goes to one pixel, or is spread over the pixels whose filter covers it (camera/film_spread.h). */
#define RECONSTRUCTION_SAMPLE 0u
#define RECONSTRUCTION_SPLAT 1u

typedef struct FilmParams {
    uint width, height; /* of the whole film, pixels */
    uint crop_x0, crop_y0, crop_x1, crop_y1; /* pixels rendered: x0 <= x < x1 */
    PixelFilter filter;
    int exponent; /* one unit of the film's sums, the quantum, is 2^exponent (camera/film_sum.h) */
    uint split_depths; /* kinds of sums that the film has per depth (camera/film_sum.h); 0: splats carry no depth */
    uint reconstruction; /* RECONSTRUCTION_* */
} FilmParams;

/* Paths of any integrator, and MIS. */
typedef struct PathParams {
    uint max_depth; /* largest depth of a path, >= 1 */
    uint min_depth; /* smallest depth for bidirectional integrators: shorter paths are left to another */
    uint roulette_depth; /* Russian roulette from this segment of a walk on; NONE: never */
    float roulette_scale; /* a walk survives with this times its throughput, relative to that with which it began */
    uint strategies; /* STRATEGIES_* (path/mis.h) of bidirectional integrators */
    uint mis_exponent; /* 1: balance heuristic, 2: power heuristic */
    uint only_s, only_t; /* the one strategy to show; only_s NONE: all */
    uint unweighted; /* 1: all MIS weights are 1 */
    /* 1 + b: random numbers of a pixel's samples from b on are stratified (math/sobol.h), independently of those from
     * another b on; 0: all are independent */
    uint sobol;
} PathParams;

/* How the estimators of MMLT divide a path's contribution (path/partition.h). */
typedef struct PartitionParams {
    uint split_direct; /* 1: paths of up to two segments are splatted separately (kernels/pt.cl, bd_connect.cl) */
    float own_more; /* with split_direct: other light that path tracing alone shows counts 1 + own_more times */
    float clamp_threshold; /* of a path's luminance times importance: pools show up to it, chains the excess */
} PartitionParams;

typedef struct PoolParams {
    uint enabled; /* 1: bidirectional samples are a pool for chains (chain/pool.h) */
    uint items; /* number of its items */
    uint lights, lights_first; /* this many of them, from lights_first on, have a light walk */
    float lights_weight; /* items over lights */
    uint visits; /* visits to all pixels together (Guide.visits); 0: one to each pixel */
} PoolParams;

#define MUTATION_GROUPED 0x80000000u /* all chains make the same kind of mutation at a step */

typedef struct ChainParams {
    uint mutations; /* MUTATION_GROUPED, and bit MUTATION_*: the kinds of small steps (chain/chain_numbers.h) */
    float shifts; /* fraction of the camera subpath's mutations that are shifts (chain/shift.h) */
    float large_step; /* probability of a large step */
    uint keep; /* 1: a pass hands the chains' coordinates on to the next */
    float brightness; /* weight of a chain's step on the film: mean contribution weight of the pool's samples */
} ChainParams;

typedef struct PassParams {
    uint seed_low, seed_high;
    uint aovs; /* bits 1 << AOV_*: the variables that a pass of kernels/aov.cl is for */
    uint sample_index; /* item k of the pass is sample sample_index + k / (crop pixels) ... */
    uint pixel_stride; /* ... of crop pixel (k * pixel_stride) mod (crop pixels); 1 except for pilots and pools */
    uint pixel_first; /* added to k in both; 0 except for pools */
    uint first_item; /* item i of a launch is item first_item + i of the pass */
    uint item_count;
    uint stride; /* items that the state buffers hold: field f of an item is at f * stride + item */
    uint data_first, data_stride; /* BUFFER_PASS: field f of pass item k is at f * data_stride + k - data_first */
} PassParams;

/* `scene` comes first: backend_cpu/kernel_scene_double.c reads the host's layout from there. */
typedef struct FrameParams {
    SceneParams scene;
    Camera camera;
    FilmParams film;
    PathParams path;
    PhotonParams photons;
    OpeningParams openings;
    PartitionParams partition;
    PoolParams pool;
    ChainParams chains;
    PassParams pass;
} FrameParams;

/* What the scene uses, as a mask of FEATURE_*. */
SHARED_FUNCTION ulong frame_features(__global const FrameParams *frame)
{
    return (ulong)frame->scene.features[1] << 32 | frame->scene.features[0];
}

/* What guides chains and pools. In a buffer of its own (BUFFER_GUIDE), because FrameParams are copied for every chunk
 * of items. */
typedef struct Guide {
    Vec3 lights[LIGHT_GUIDES_MAX]; /* SceneParams.guide_count positions, or directions (light/light_guide.h) */
    float lights_near[LIGHT_GUIDES_MAX]; /* 1: a position, 0: a direction */
    float lights_power[LIGHT_GUIDES_MAX]; /* what arrives, times the squared length of the vector to the guide */
    float importance[IMPORTANCE_CELLS]; /* target importance of the cells of the crop window, row by row */
    uint visits[IMPORTANCE_CELLS + 1u]; /* of a pool: visits to all pixels before each cell, and to all */
} Guide;

#endif
