/* Path tracing along a path that a pool's sample has made: with its random numbers and, past the camera subpath, its
 * directions; and with its hits. */
#include "mmlt/test_partition_state.h"

#include "path/path_random.h"

#include <string.h>

/* Called by pt.cl for the functions of their names. */
static Random4 replay_random(const FrameParams *frame, uint pixel, uint sample, uint block);
static Vec2 replay_filter(const SceneView *scene, Vec2 u, float *weight);
static bool replay_scatter(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u, uint transport,
                           BsdfSample *sample);
static bool replay_light(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample);
#include "bsdf/bsdf.h"
#include "camera/pixel_filter.h"
#include "light/light.h"
#define path_random replay_random
#define pixel_filter_sample replay_filter
#define bsdf_sample replay_scatter
#define light_sample replay_light
#include "kernels/pt.cl"
#undef path_random
#undef pixel_filter_sample
#undef bsdf_sample
#undef light_sample

static Partition *replayed;

/* Numbers of vertex x_depth of the path, which the pool's sample has made from one side or the other. */
static Random4 vertex_numbers(const Partition *p, uint depth, uint what)
{
    uint side = depth < p->t ? SIDE_CAMERA : SIDE_LIGHT, i = depth < p->t ? depth : p->s + p->t - 1u - depth;
    return pool_random(&p->pool_frame, p->pool.paths, 0, bd_random_vertex(side, i, what));
}

/* Numbers with which path tracing chooses the light of the path: those of the pool's sample, or, where its light
 * subpath has another light, any that do. */
static Random4 light_numbers(const Partition *p)
{
    uint *paths = replayed->paths.paths;
    Vec3 x = state_load_vec3(paths, 1, PATH_POINT, 0), ng = state_load_vec3(paths, 1, PATH_NG, 0);
    Random4 random = connection_random_light(pool_random(&p->pool_frame, p->pool.paths, 0, BD_RANDOM_LIGHT),
                                             pool_random(&p->pool_frame, p->pool.paths, 0, BD_RANDOM_EMIT));
    for (uint i = 0; p->s > 1u && i < 4096u; ++i) {
        Vec2 u;
        float pdf;
        random.x[2] = i << 20;
        if (light_choose_point(&p->view, x, ng, random, &u, &pdf) == p->pool.paths[BD_EMITTER])
            break;
    }
    return random;
}

static Random4 replay_random(const FrameParams *frame, uint pixel, uint sample, uint block)
{
    const Partition *p = replayed;
    (void)frame, (void)pixel, (void)sample;
    if (block == RANDOM_CAMERA)
        return pool_random(&p->pool_frame, p->pool.paths, 0, BD_RANDOM_CAMERA);
    uint depth = (block - 1u) / RANDOM_BLOCKS_PER_VERTEX + 1u, what = (block - 1u) % RANDOM_BLOCKS_PER_VERTEX + 1u;
    if (what == RANDOM_LIGHT)
        return light_numbers(p);
    if (what == RANDOM_MIX)
        return vertex_numbers(p, depth, BD_RANDOM_MIX);
    Random4 random = vertex_numbers(p, depth, BD_RANDOM_SCATTER);
    random.x[3] = 0u; /* survives roulette */
    return random;
}

static Vec2 replay_filter(const SceneView *scene, Vec2 u, float *weight)
{
    uint pixel = state_load(replayed->pool.paths, 1, BD_PIXEL, 0), width = scene->frame->film.width;
    (void)u;
    *weight = 1.0f;
    return vec2(replayed->film.x - ((float)(pixel % width) + 0.5f), replayed->film.y - ((float)(pixel / width) + 0.5f));
}

/* Whether x_depth is y_0, on the light or at infinity. */
static bool at_emitter(const Partition *p, uint depth)
{
    return p->s > 0u && depth == p->s + p->t - 1u;
}

static Vec3 light_point(const Partition *p, uint depth)
{
    return state_load_vec3(p->pool.vertices, 1,
                           vertex_base(&p->pool_frame, SIDE_LIGHT, p->s + p->t - 1u - depth) + VERTEX_POINT, 0);
}

bool emitter_infinite(const Partition *p)
{
    return (p->pool.paths[BD_EMITTER_FLAGS] & EMITTER_INFINITE) != 0u;
}

/* Draws the light's point: of an invisible lamp, which the light subpath has left, y_0. */
static bool replay_light(const SceneView *scene, uint light, Vec3 ref, Vec2 u, LightSample *sample)
{
    const Partition *p = replayed;
    if (p->s < 2u || !light_is_invisible(scene, light))
        return light_sample(scene, light, ref, u, sample);
    uint base = vertex_base(&p->pool_frame, SIDE_LIGHT, 0);
    Surface at = {.p = light_point(p, p->s + p->t - 1u),
                  .ng = state_load_vec3(p->pool.vertices, 1, base + VERTEX_NG, 0)};
    Vec3 wi = vec3_normalize(vec3_sub(at.p, ref));
    *sample = (LightSample){.wi = wi,
                            .p = at.p,
                            .ng = at.ng,
                            .radiance = light_emitted(scene, light, at.ng, vec3_negate(wi)),
                            .pdf_w = light_pdf_w(scene, light, ref, wi, &at),
                            .delta = 1u};
    return sample->pdf_w > 0.0f && !vec3_is_zero(sample->radiance);
}

/* The unit vector from `from` to x_depth, a vertex of the light's side. */
static Vec3 light_direction(const Partition *p, uint depth, Vec3 from)
{
    if (at_emitter(p, depth) && emitter_infinite(p))
        return vec3_negate(light_point(p, depth));
    return vec3_normalize(vec3_sub(light_point(p, depth), from));
}

/* Draws the direction of the path: on the camera subpath by the same numbers; past it by its value and density, or of
 * the delta lobes the one that has it. */
static bool replay_scatter(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u, uint transport,
                           BsdfSample *sample)
{
    const Partition *p = replayed;
    const uint *paths = p->paths.paths;
    uint depth = state_load(paths, 1, PATH_DEPTH, 0), i = p->s + p->t - 1u - depth;
    if (depth + 1u < p->t)
        return bsdf_sample(scene, bsdf, wo, u_lobe, u, transport, sample);
    Vec3 to = light_direction(p, depth + 1u, state_load_vec3(paths, 1, PATH_POINT, 0));
    Vec3 wi = frame_to_local(frame_load(paths, 1, PATH_FRAME, 0), to);
    if (depth >= p->t && (p->pool.paths[BD_LIGHT_DELTA] >> i & 1u) != 0u) {
        for (uint k = 0; k < 1024; ++k)
            if (bsdf_sample(scene, bsdf, wo, ((float)k + 0.5f) / 1024.0f, u, transport, sample) &&
                sample->delta != 0u && vec3_dot(sample->wi, wi) > 0.9999f)
                return true;
        return false;
    }
    BsdfValue value = bsdf_eval(scene, bsdf, wo, wi, transport);
    if (vec3_is_zero(value.f_cos) || !(value.pdf_w > 0.0f))
        return false;
    *sample = (BsdfSample){.wi = wi,
                           .weight = vec3_scale(value.f_cos, 1.0f / value.pdf_w),
                           .pdf_w = value.pdf_w,
                           .pdf_rev_w = value.pdf_rev_w,
                           .eta = 1.0f};
    return true;
}

/* The hit of the ray with the light at y_0, whatever its alpha texture lets through. */
static Hit emitter_hit(const Partition *p, const Ray *ray, float distance)
{
    uint id = p->view.lights[p->pool.paths[BD_EMITTER]].primitive;
    Primitive primitive = p->view.primitives[id];
    RayQuery query = ray_query(*ray);
    Hit hit = hit_none(FLOAT_MAX);
    if (primitive.shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_TRIANGLE)
        triangle_query(p->view.positions[primitive.a], p->view.positions[primitive.b], p->view.positions[primitive.c],
                       &query, &hit);
    else if (primitive_curved_from(&p->view, &primitive, &query, 0.0f, &hit) &&
             float_abs(hit.t - distance) > 1e-3f * distance)
        primitive_curved_from(&p->view, &primitive, &query, hit.t, &hit);
    if (float_abs(hit.t - distance) < 1e-3f * distance)
        hit.primitive = id;
    return hit;
}

/* The hit of path tracing's ray at x_depth. */
static Hit replay_hit(const Partition *p, uint depth)
{
    if (depth < p->t)
        return p->hits[SIDE_CAMERA][depth];
    Ray ray = ray_load(p->paths.rays, 1, 0);
    if (at_emitter(p, depth) && emitter_infinite(p))
        return hit_none(FLOAT_MAX);
    float distance = vec3_length(vec3_sub(light_point(p, depth), ray.o));
    if (at_emitter(p, depth))
        return emitter_hit(p, &ray, distance);
    Hit hit = p->hits[SIDE_LIGHT][p->s + p->t - 1u - depth];
    hit.t = distance;
    return hit;
}

/* Forgets what the path has gathered so far. */
static void gathered_clear(Item *item)
{
    state_store_vec3(item->paths, 1, PATH_RADIANCE, 0, vec3_splat(0.0f));
    state_store_vec3(item->paths, 1, PATH_RARE, 0, vec3_splat(0.0f));
}

void paths_run(Partition *p, bool met)
{
    Item *item = &p->paths;
    const FrameParams *frame = &p->paths_frame;
    uint d = p->s + p->t - 1u;
    bool made = false;
    replayed = p;
    memset(item, 0, sizeof *item);
    pt_start_paths(frame, &p->guide, SCENE_OF(p), item->paths, item->rays, item->shadows, item->diagnostics);
    for (uint depth = 1; !made && item->paths[PATH_DEPTH] == depth; ++depth) {
        hit_store(item->hits, 1, 0, replay_hit(p, depth));
        seen.count = 0;
        gathered_clear(item);
        pt_shade_hits(frame, NULL, SCENE_OF(p), item->paths, item->rays, item->hits);
        made = depth == d;
        if (!made && depth + 1u == d && !met) {
            seen.count = 0;
            gathered_clear(item);
            pt_sample_lights(frame, SCENE_OF(p), item->paths, item->shadows);
            state_store(item->shadows, 1, SHADOW_OCCLUDED, 0, 0u);
            pt_add_lights(frame, SCENE_OF(p), item->paths, item->shadows);
            made = true;
        }
        if (!made)
            pt_extend_paths(frame, SCENE_OF(p), item->paths, item->rays, item->diagnostics);
    }
    double shown = (double)rgb_luminance(state_load_vec3(item->paths, 1, PATH_RADIANCE, 0)),
           rare = (double)rgb_luminance(state_load_vec3(item->paths, 1, PATH_RARE, 0));
    p->paths_rare = rare / (shown + rare);
    if (!made)
        seen.count = 0;
}
