/* The kernels of pool and chain for single paths, and the parts that each estimator has of them. */
#include "mmlt/test_partition_state.h"

#include "support/render_fixture.h"
#include "support/test_files.h"

#include "kernels/bd_connect.cl"
#include "kernels/bd_walk.cl"
#include "kernels/mlt.cl"
#include "kernels/trace.cl"

#include <string.h>

SeenCalls seen;

float partition_seen(float carried, float threshold)
{
    float part = (partition_shown)(carried, threshold);
    TEST_TRUE(seen.count < PARTITION_LIGHTS);
    seen.calls[seen.count++] = (Seen){carried, threshold, part};
    return part;
}

Partition *partition_open(const char *text)
{
    Error error = {0};
    const RenderSetup setup = {.text = text};
    Partition *p = calloc(1, sizeof *p);
    unsigned state = 3;
    ck_assert_ptr_nonnull(p);
    fixture_scene(&setup, &p->scene);
    BackendScene packed = scene_backend_view(&p->scene);
    ck_assert_msg(bvh_build(&packed, &p->bvh, &error), "%s", error.message);
    p->geometry = packed.geometry;
    p->tables = packed.tables;
    p->texels = packed.texels;
    const RenderOptions options = {.max_depth = (int)PARTITION_DEPTH, .seed = 7};
    FrameParams *frame = &p->paths_frame;
    render_frame(integrator_pt(), &p->scene, &options, frame);
    frame->pass.stride = frame->pass.item_count = frame->pass.data_stride = 1;
    frame->partition.split_direct = 1;
    p->chain_frame = *frame;
    p->chain_frame.path.strategies = STRATEGIES_BDPT;
    p->chain_frame.path.min_depth = CHAIN_DEPTH_MIN;
    p->chain_frame.path.mis_exponent = 1;
    p->pool_frame = p->chain_frame;
    p->pool_frame.pool.enabled = 1;
    p->pool_frame.pool.items = p->pool_frame.pool.lights = 1u << 30;
    p->pool_frame.pool.lights_weight = 4.0f;
    p->chain_frame.path.roulette_depth = NONE;
    p->view = scene_view(&p->chain_frame, SCENE_OF(p));
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        p->guide.importance[i] = (float)exp2(2.0 * test_random_unit(&state) - 1.0);
    p->view.guide = &p->guide;
    return p;
}

void partition_close(Partition *p)
{
    bvh_destroy(&p->bvh);
    scene_destroy(&p->scene);
    free(p);
}

static void closest_trace(Partition *p, const FrameParams *frame, Item *item)
{
    trace_closest(frame, SCENE_OF(p), p->bvh.words, item->rays, item->hits, NULL);
}

/* ---- the pool ---------------------------------------------------------------------------------------------------- */

static void pool_walk(Partition *p, uint side, uint segments)
{
    Item *pool = &p->pool;
    for (uint i = 1; i <= segments && pool->paths[BD_DEPTH] != 0u; ++i) {
        closest_trace(p, &p->pool_frame, pool);
        p->hits[side][i] = hit_load(pool->hits, 1, 0);
        seen.count = 0;
        bd_shade_hits(&p->pool_frame, &p->guide, NULL, SCENE_OF(p), pool->paths, pool->rays, pool->hits, pool->vertices,
                      pool->densities);
        if (seen.count > 0)
            p->shown[0][i + 1] = seen.calls[0];
        if (i < segments)
            bd_extend_walks(&p->pool_frame, &p->guide, SCENE_OF(p), pool->paths, pool->rays, pool->vertices,
                            pool->densities, pool->diagnostics);
    }
}

void partition_sample(Partition *p, uint item, float clamp_threshold)
{
    Item *pool = &p->pool;
    FrameParams *frame = &p->pool_frame;
    memset(pool, 0, sizeof *pool);
    memset(p->shown, 0, sizeof p->shown);
    p->sample = item;
    frame->pass.first_item = p->paths_frame.pass.first_item = item;
    frame->partition.clamp_threshold = p->paths_frame.partition.clamp_threshold =
        p->chain_frame.partition.clamp_threshold = clamp_threshold;
    bd_start_light(frame, &p->guide, SCENE_OF(p), pool->paths, pool->rays, pool->shadows, pool->vertices,
                   pool->densities, pool->diagnostics);
    pool_walk(p, SIDE_LIGHT, PARTITION_DEPTH - 1u);
    bd_start_camera(frame, &p->guide, SCENE_OF(p), pool->paths, pool->rays, pool->diagnostics);
    pool_walk(p, SIDE_CAMERA, PARTITION_DEPTH);
    while (pool->paths[BD_T] <= PARTITION_DEPTH) {
        uint s = pool->paths[BD_S], t = pool->paths[BD_T];
        bd_connect(frame, &p->guide, SCENE_OF(p), pool->paths, pool->shadows, pool->vertices, pool->densities);
        trace_shadow(frame, SCENE_OF(p), p->bvh.words, pool->shadows, NULL);
        seen.count = 0;
        bd_add_connections(frame, &p->guide, pool->paths, pool->shadows, pool->splats, pool->diagnostics);
        if (seen.count > 0)
            p->shown[s][t] = seen.calls[0];
    }
}

/* ---- a chain ----------------------------------------------------------------------------------------------------- */

static void chain_walk(Partition *p, uint segments)
{
    Item *chain = &p->chain;
    for (uint i = 0; i < segments; ++i) {
        closest_trace(p, &p->chain_frame, chain);
        mlt_walk(&p->chain_frame, &p->guide, NULL, SCENE_OF(p), chain->paths, chain->rays, chain->hits, chain->vertices,
                 chain->densities, chain->diagnostics);
    }
}

/* Starts a chain on the path. select: its number for the choice among infinite lights; 0: that of the pool. */
static void chain_start(Partition *p, uint select)
{
    Item *chain = &p->chain;
    const FrameParams *frame = &p->chain_frame;
    memset(chain, 0, sizeof *chain);
    chain->pass[CHAIN_PASS_KEY] = chain_key(p->s + p->t - 1u, p->s);
    chain->pass[CHAIN_PASS_ITEM] = p->sample;
    mlt_begin(frame, &p->guide, SCENE_OF(p), chain->pass, chain->paths, chain->rays, chain->shadows);
    if (select != 0u)
        chain->paths[CHAIN_NUMBERS + NUMBER_SELECT] = select;
    mlt_propose(frame, &p->guide, SCENE_OF(p), chain->paths, chain->rays, chain->vertices, chain->densities,
                chain->diagnostics);
    seen.count = 0;
    chain_walk(p, PARTITION_DEPTH - 1u);
    mlt_start_camera(frame, &p->guide, SCENE_OF(p), chain->paths, chain->rays, chain->vertices, chain->diagnostics);
    chain_walk(p, PARTITION_DEPTH);
    mlt_connect(frame, &p->guide, SCENE_OF(p), chain->paths, chain->shadows, chain->vertices, chain->densities);
    trace_shadow(frame, SCENE_OF(p), p->bvh.words, chain->shadows, NULL);
    mlt_accept(frame, &p->guide, SCENE_OF(p), chain->paths, chain->shadows, chain->vertices, chain->splats,
               chain->diagnostics);
}

/* The part of all random numbers u for which a splat of the chain's path is in the layer. The layers depend on u by a
 * threshold each. */
static double layer_part(const Partition *p, uint key, float f, uint layer)
{
    uint low = 0, high = 1u << 24;
    bool first = (chain_splat_layers(&p->chain_frame, key, f, 0.0f) & layer) != 0u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        float u = (float)middle * 0x1p-24f;
        if (((chain_splat_layers(&p->chain_frame, key, f, u) & layer) != 0u) == first)
            low = middle + 1u;
        else
            high = middle;
    }
    return first ? low * 0x1p-24 : 1.0 - low * 0x1p-24;
}

static void chain_parts(const Partition *p, PathParts *parts)
{
    float f = state_load_float(p->chain.paths, 1, CHAIN_LUMINANCE, 0);
    uint key = p->chain.paths[CHAIN_KEY];
    parts->chain_carried = (double)f;
    parts->excess = 1.0 - layer_part(p, key, f, SPLAT_LIGHT);
    parts->rare = layer_part(p, key, f, SPLAT_RARE);
    parts->told = seen.count > 0 ? (double)seen.calls[0].carried / (double)seen.calls[0].threshold : (double)NAN;
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

/* s = 0 at infinity: the part of a chain's visits that stands for each light, by its definition: its weighted
 * luminance. */
static double light_visits(const Partition *p, uint light, uint d)
{
    const Item *item = &p->paths;
    Ray ray = ray_load(item->rays, 1, 0);
    Vec3 ng = state_load_vec3(item->paths, 1, PATH_NG, 0);
    Vec3 beta = state_load_vec3(item->paths, 1, PATH_BETA, 0);
    WalkHit miss = {.ray = ray, .from_ng = ng, .missed = true, .passage_back = 1.0f};
    DensityView view = bd_density_view(&p->pool_frame, p->pool.paths, p->pool.densities, 0);
    double all = 0.0, own = 0.0;
    for (uint i = 0; i < p->chain_frame.scene.infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 radiance = environment_met(&p->view, p->view.infinite_lights[i], &miss, &ends);
        double part = (double)rgb_luminance(vec3_mul(beta, radiance)) *
                      (double)bd_weight(&p->chain_frame, 0u, d + 1u, &view, &ends);
        all += part;
        own += i == light ? part : 0.0;
    }
    return own / all;
}

#define SELECT_TRIES 64u

/* Starts the chain so that it stands for the infinite light for which path tracing has `carried` over its threshold:
 * with the one of many numbers for which what the chain is told comes nearest. A path below the threshold is not
 * divided by it, and nothing is recorded. */
static void chain_start_for(Partition *p, double carried)
{
    double nearest = (double)FLOAT_MAX;
    uint best = 0;
    for (uint k = 0; k < SELECT_TRIES; ++k) {
        uint select = k * (0x80000000u / SELECT_TRIES * 2u) + 0x40000000u / SELECT_TRIES;
        chain_start(p, select);
        double told = seen.count > 0 ? (double)seen.calls[0].carried / (double)seen.calls[0].threshold : 1.0;
        double away = fabs(told - (carried < 1.0 ? 1.0 : carried));
        if (away < nearest) {
            nearest = away;
            best = select;
        }
    }
    chain_start(p, best);
}

/* Index of the infinite light y_0. */
static uint emitter_place(const Partition *p)
{
    uint place = 0;
    while (p->view.infinite_lights[place] != p->pool.paths[BD_EMITTER])
        ++place;
    return place;
}

/* Whether infinite light number `place` is seen along path tracing's last ray, past its portal if it has one. */
static bool light_reaches(const Partition *p, uint place)
{
    Ray ray = ray_load(p->paths.rays, 1, 0);
    return environment_reaches(&p->view, p->view.infinite_lights[place], ray.o, ray.d);
}

/* How many infinite lights path tracing adds before number `place`. */
static uint lights_before(const Partition *p, uint place)
{
    uint count = 0;
    for (uint i = 0; i < place; ++i)
        count += light_reaches(p, i) ? 1u : 0u;
    return count;
}

PathFound partition_path(Partition *p, uint s, uint t, uint light, PathParts *parts)
{
    const Seen pool = p->shown[s][t];
    uint d = s + t - 1u, lights = p->chain_frame.scene.infinite_light_count;
    if (d < CHAIN_DEPTH_MIN || !(pool.threshold > 0.0f))
        return PATH_NONE;
    p->s = s;
    p->t = t;
    bool missed = s == 0u && p->hits[SIDE_CAMERA][d].primitive == NONE, infinite = s > 1u && emitter_infinite(p);
    bool met = s == 0u || (s > 1u && (p->pool.paths[BD_EMITTER_FLAGS] & EMITTER_DELTA) == 0u);
    if (s == 0u && light >= (missed ? lights : 1u))
        return PATH_NONE;
    chain_start(p, 0u);
    TEST_TRUE(p->chain.paths[CHAIN_KEY] != 0u && p->chain.diagnostics[DIAGNOSTIC_LOST_CHAIN] == 0u);
    p->film = chain_film_load(p->chain.paths, 1, CHAIN_FILM, 0);
    chain_parts(p, parts);
    parts->pool = (double)pool.part;
    parts->pool_carried = (double)pool.carried;
    paths_run(p, met);
    uint place = missed ? light : infinite && met ? emitter_place(p) : 0u;
    if (missed && !light_reaches(p, light))
        return PATH_NONE;
    place = lights_before(p, place);
    if (seen.count <= place)
        return PATH_UNFOUND;
    parts->paths = (double)seen.calls[place].part;
    parts->paths_rare = seen.count == 1 ? p->paths_rare : (double)NAN;
    parts->paths_carried = (double)seen.calls[place].carried / (double)seen.calls[place].threshold;
    if (missed && lights > 1u) {
        if (light_visits(p, light, d) < 2.0 / SELECT_TRIES)
            return PATH_NONE;
        chain_start_for(p, parts->paths_carried);
        chain_parts(p, parts);
    }
    return PATH_FOUND;
}
