/* Weights of actual paths: the weight that BDPT's kernels gave to each path that they made, against the weights of all
 * its strategies from densities computed here from the path's vertices alone. */
#include "path/bidirectional_path.h"
#include "support/bidirectional.h"
#include "support/verify_fixture.h"

#include "kernels/bd_connect.cl"
#include "layout/kernel_list.h"
#include "path/bd_walk.h"

#include <string.h>

enum { ITEMS = 4096, DEPTH = 5 };

/* The kernels' state words, `stride` items each. */
typedef struct Walks {
    VerifyPair *pair;
    FrameParams frame;
    BackendScene packed;
    SceneView view;
    uint *words[BUFFER_COUNT];
} Walks;

static void walks_sink(void *context, BufferId buffer, const uint *words, uint first, uint count, uint stride)
{
    const Walks *walks = context;
    for (uint field = 0; field < walks->pair->list.words_per_item[buffer]; ++field)
        memcpy(walks->words[buffer] + (size_t)field * ITEMS + first, words + (size_t)field * stride,
               count * sizeof *words);
}

/* Runs the first `steps` steps. */
static void walks_run(Walks *walks, size_t steps)
{
    Error error = {0};
    const BackendMember *side = &walks->pair->sides[0];
    StepList list = walks->pair->list;
    list.count = steps;
    ck_assert_msg(side->interface->inspect(side->backend, &walks->frame, &list, walks_sink, walks, &error), "%s",
                  error.message);
}

static void walks_open(Walks *walks, VerifyPair *pair, const BidirectionalScene *scene, bool balance)
{
    const RenderSetup setup = {.text = bidirectional_text(scene),
                               .max_depth = DEPTH,
                               .seed = 21,
                               .integrator = integrator_bdpt(),
                               .balance = balance};
    const RenderSetup setups[2] = {setup, setup};
    verify_pair_open(setups, pair);
    *walks = (Walks){.pair = pair, .frame = pair->frame};
    walks->frame.pass.item_count = ITEMS;
    walks->frame.pass.stride = ITEMS;
    walks->packed = scene_backend_view(&pair->scene);
    walks->view = scene_view(&walks->frame, walks->packed.geometry, walks->packed.tables, walks->packed.texels);
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id) {
        walks->words[id] = calloc((size_t)ITEMS * pair->list.words_per_item[id] + 1, sizeof(uint));
        ck_assert_ptr_nonnull(walks->words[id]);
    }
}

static void walks_close(Walks *walks)
{
    for (int id = BUFFER_PATHS; id < BUFFER_COUNT; ++id)
        free(walks->words[id]);
    verify_pair_close(walks->pair);
}

/* ---- a path ------------------------------------------------------------------------------------------------------ */

/* The vertices of one path; x_0 is on the lens and x_k on a light. */
typedef struct RealPath {
    uint k;
    Vertex vertices[DEPTH + 1]; /* complete for x_1 ... x_{k-1}; point and normal only for x_k */
    Surface end; /* x_k, if on an area light */
    uint light;
    bool infinite, delta_light;
    Vec3 ways[DEPTH + 1]; /* unit vectors from x_i to x_{i-1} */
    TestPath densities;
} RealPath;

/* Unit vector from x_i to its neighbour x_j, and the squared distance; 1 if x_j is at infinity. */
static Vec3 path_direction(const RealPath *path, uint i, uint j, float *distance2)
{
    const bool far = path->infinite && (i == path->k || j == path->k);
    *distance2 = far ? 1.0f : vec3_length_squared(vec3_sub(path->vertices[j].p, path->vertices[i].p));
    return j < i ? path->ways[i] : vec3_negate(path->ways[j]);
}

/* The cosine of a vertex for the direction w: a curve faces w, and ng is twice its tangent. */
static float cosine_at(const Walks *walks, Vec3 w, Vec3 ng)
{
    if (normal_is_fibre(&walks->view, ng))
        return 0.5f * vec3_length(vec3_cross(w, ng));
    return vec3_is_zero(ng) ? 1.0f : float_abs(vec3_dot(w, ng));
}

/* Density with which the vertex scatters from direction `back` to `on`. The frame of a vertex on a curve faces the walk
 * that made it: what a walk the other way draws is the reverse of what that one does. */
static float vertex_density(const Walks *walks, const Vertex *vertex, Vec3 back, Vec3 on, uint transport)
{
    if (vec3_is_zero(vertex->ng)) { /* in a medium, whose phase function wants the frame along `back` */
        Vec3 to = frame_to_local(frame_from_normal(back), on);
        return bsdf_eval(&walks->view, &vertex->bsdf, vec3(0.0f, 0.0f, 1.0f), to, transport).pdf_w;
    }
    Vec3 wo = frame_to_local(vertex->frame, back), wi = frame_to_local(vertex->frame, on);
    bool reverse = normal_is_fibre(&walks->view, vertex->ng) && vec3_dot(wo, vertex->wo) < vec3_dot(wi, vertex->wo);
    uint other = transport == TRANSPORT_RADIANCE ? TRANSPORT_IMPORTANCE : TRANSPORT_RADIANCE;
    return reverse ? bsdf_eval(&walks->view, &vertex->bsdf, wi, wo, other).pdf_rev_w
                   : bsdf_eval(&walks->view, &vertex->bsdf, wo, wi, transport).pdf_w;
}

/* Density of the distance with which a ray from x_from arrives at x_to, in scenes whose camera's medium is a grid that
 * fills them: the mean over colours of the transmittance, which is a probability at a surface, and in the medium of its
 * product with extinction there. */
static float passed(const Walks *walks, const RealPath *path, uint from, uint to)
{
    float distance2;
    const uint medium = walks->view.frame->camera.medium;
    if ((walks->view.features & FEATURE_MEDIUM) == 0u)
        return 1.0f;
    const Medium *m = walks->view.media + medium;
    const Vertex *end = &path->vertices[to];
    Vec3 w = path_direction(path, from, to, &distance2);
    GridColumn column =
        grid_column(&walks->view, m->grid - 1u, path->vertices[from].p, w, float_sqrt(distance2), 0u, FLOAT_INFINITY);
    Vec3 left = transmittance(vec3_mul(m->extinction, column.sums));
    if (vec3_is_zero(end->ng))
        left = vec3_mul(left, vec3_mul(m->extinction, grid_factors(&walks->view, m->grid - 1u, end->p, false)));
    return vec3_mean(left);
}

/* Density of x_to with respect to area when x_at scatters light from x_from. */
static float scattered(const Walks *walks, const RealPath *path, uint from, uint at, uint to, uint transport)
{
    float ignored, distance2;
    const Vertex *vertex = &path->vertices[at];
    Vec3 back = path_direction(path, at, from, &ignored), on = path_direction(path, at, to, &distance2);
    float pdf = vertex_density(walks, vertex, back, on, transport);
    if (to == path->k && path->infinite)
        return pdf;
    return pdf * cosine_at(walks, on, path->vertices[to].ng) / distance2 * passed(walks, path, at, to);
}

/* Density of x_{k-1} with respect to area when emitted by the light. */
static float emitted(const Walks *walks, const RealPath *path)
{
    float distance2;
    Vec3 w = path_direction(path, path->k - 1, path->k, &distance2), ng = path->vertices[path->k - 1].ng;
    if (path->infinite)
        return light_aimed_pdf_disc(&walks->view, path->light, path->vertices[path->k - 1].p, vec3_negate(w)) *
               cosine_at(walks, w, ng);
    return light_aimed_pdf_w(&walks->view, path->light, path->vertices[path->k].p, path->vertices[path->k].ng,
                             vec3_negate(w)) *
           cosine_at(walks, w, ng) / distance2 * passed(walks, path, path->k, path->k - 1);
}

/* Whether x_k is on an area light. */
static bool on_area(const Walks *walks, const RealPath *path)
{
    return light_kind(&walks->view.lights[path->light]) == LIGHT_AREA;
}

/* Density of x_k as sampled on the light. */
static float light_point(const Walks *walks, const RealPath *path)
{
    const SceneView *view = &walks->view;
    float select = view->lights[path->light].select_pdf;
    if (path->delta_light && !on_area(walks, path))
        return select;
    return select * (path->infinite ? environment_pdf_w(view, path->light, vec3_negate(path->ways[path->k]))
                                    : light_emit_pdf_p(view, path->light, &path->end));
}

/* Computes all densities from the vertices, except those of delta lobes, which are mere ratios: `path->densities` keeps
 * the values stored by the walk that made them. */
static void path_densities(const Walks *walks, RealPath *path)
{
    TestPath *d = &path->densities;
    uint k = path->k;
    float distance2;
    Vec3 from_lens = path_direction(path, 0, 1, &distance2);
    d->camera[1] = view_pdf(&walks->view, path->vertices[0].p, from_lens, float_sqrt(distance2)) *
                   cosine_at(walks, from_lens, path->vertices[1].ng) * passed(walks, path, 0, 1);
    for (uint i = 2; i <= k; ++i)
        if (!d->delta[i - 1])
            d->camera[i] = scattered(walks, path, i - 2, i - 1, i, TRANSPORT_RADIANCE);
    if (path->delta_light)
        d->camera[k] = 0.0f;
    d->light[k] = light_point(walks, path);
    d->light[k - 1] = emitted(walks, path);
    for (uint i = 1; i + 2 <= k; ++i)
        if (!d->delta[i + 1])
            d->light[i] = scattered(walks, path, i + 2, i + 1, i, TRANSPORT_IMPORTANCE);
    d->connect = light_choice_ratio(&walks->view, path->light, path->vertices[k - 1].p, path->vertices[k - 1].ng);
    if (path->infinite && !path->delta_light)
        d->connect *=
            environment_connect_ratio(&walks->view, path->light, path->vertices[k - 1].p, vec3_negate(path->ways[k]));
    if (on_area(walks, path)) {
        Vec3 w = path_direction(path, k - 1, k, &distance2);
        d->connect *= light_connect_ratio(&walks->view, path->light, path->vertices[k - 1].p, w, distance2, &path->end);
    }
}

/* ---- paths from the kernels' state ------------------------------------------------------------------------------- */

/* The origin of the camera ray that made z_1 = p, in direction `back` from it: a point on the lens, or on the film of
 * an orthographic camera. */
static Vec3 lens_point(const Walks *walks, Vec3 p, Vec3 back)
{
    const Camera *camera = &walks->frame.camera;
    if (camera->kind >= CAMERA_EQUAL_AREA)
        return affine_point(camera->world_from_camera, vec3_splat(0.0f));
    float depth = affine_point(camera->camera_from_world, p).z;
    return vec3_mad(p, -depth / affine_vector(camera->camera_from_world, back).z, back);
}

/* Loads the camera subpath of strategy (s, t) into `path`: vertices, and the densities around delta vertices, except at
 * the ends of the connection. */
static void camera_part(const Walks *walks, uint item, uint s, uint t, RealPath *path)
{
    const DensityView view =
        bd_density_view(&walks->frame, walks->words[BUFFER_PATHS], walks->words[BUFFER_DENSITIES], item);
    TestPath *d = &path->densities;
    for (uint i = 1; i < (s == 0 ? path->k : t); ++i) {
        Vertex *z = &path->vertices[i];
        *z = vertex_load(&walks->view, walks->words[BUFFER_VERTICES], ITEMS, vertex_base(&walks->frame, SIDE_CAMERA, i),
                         item);
        path->ways[i] = frame_to_world(z->frame, z->wo);
    }
    for (uint i = 1; i + 2 <= t; ++i)
        if ((view.camera_delta >> i & 1u) != 0u) {
            d->delta[i] = true;
            d->camera[i + 1] = density_own(&view, SIDE_CAMERA, i + 1);
            if (i > 1)
                d->light[i - 1] = density_other(&view, SIDE_CAMERA, i - 1);
        }
    if (t > 1)
        path->vertices[0].p = lens_point(walks, path->vertices[1].p, path->ways[1]);
}

static void light_part(const Walks *walks, uint item, uint s, RealPath *path)
{
    const uint *paths = walks->words[BUFFER_PATHS];
    const DensityView view = bd_density_view(&walks->frame, paths, walks->words[BUFFER_DENSITIES], item);
    uint k = path->k, flags = state_load(paths, ITEMS, BD_EMITTER_FLAGS, item);
    for (uint i = 0; i < s; ++i) {
        Vertex *y = &path->vertices[k - i];
        *y = vertex_load(&walks->view, walks->words[BUFFER_VERTICES], ITEMS, vertex_base(&walks->frame, SIDE_LIGHT, i),
                         item);
        if (i > 0)
            path->ways[k - i + 1] = vec3_negate(frame_to_world(y->frame, y->wo));
    }
    for (uint i = 1; i + 2 <= s; ++i)
        if ((view.light_delta >> i & 1u) != 0u) {
            path->densities.delta[k - i] = true;
            path->densities.light[k - i - 1] = density_own(&view, SIDE_LIGHT, i + 1);
            path->densities.camera[k - i + 1] = density_other(&view, SIDE_LIGHT, i - 1);
        }
    path->light = state_load(paths, ITEMS, BD_EMITTER, item);
    path->infinite = (flags & EMITTER_INFINITE) != 0u;
    path->delta_light = (flags & EMITTER_DELTA) != 0u;
}

/* The z_{t-1} that connect_light samples. */
static void light_drawn(const Walks *walks, uint item, uint t, RealPath *path)
{
    LightSample sample = {0};
    Random4 random = bd_random_connection(&walks->frame, walks->words[BUFFER_PATHS], item, 1, t);
    Vec2 u;
    float pdf;
    const Vertex *z = &path->vertices[t - 1];
    path->light = light_choose_point(&walks->view, z->p, z->ng, random, &u, &pdf);
    TEST_TRUE(light_sample(&walks->view, path->light, path->vertices[t - 1].p, u, &sample));
    path->infinite = sample.infinite != 0u;
    path->delta_light = sample.delta != 0u;
    path->ways[path->k] = vec3_negate(sample.wi);
    path->vertices[path->k].p = sample.p;
    path->vertices[path->k].ng = sample.ng;
}

/* The lens point that connect_camera samples for y_{s-1}. */
static Vec3 lens_drawn(const Walks *walks, uint item, uint s, Vec3 p)
{
    CameraConnection camera;
    Random4 random = bd_random_connection(&walks->frame, walks->words[BUFFER_PATHS], item, s, 1);
    TEST_TRUE(view_connect(&walks->view, p, vec2(random_float(random.x[0]), random_float(random.x[1])), &camera));
    return camera.p;
}

/* The light hit by the camera subpath's last ray; returns false if that is more than one. */
static bool light_met(const Walks *walks, uint item, RealPath *path)
{
    const SceneView *view = &walks->view;
    const Ray ray =
        ray_last_part(view, walks->words[BUFFER_HITS], ITEMS, item, ray_load(walks->words[BUFFER_RAYS], ITEMS, item));
    Hit hit = hit_load(walks->words[BUFFER_HITS], ITEMS, item);
    path->infinite = hit.primitive == NONE;
    path->ways[path->k] = vec3_negate(ray.d);
    if (path->infinite) {
        path->light = view->infinite_lights[0];
        return walks->frame.scene.infinite_light_count == 1;
    }
    path->end = surface_from_hit(view, &ray, hit);
    const Shape *shape = &view->shapes[path->end.shape];
    path->light = shape->first_light + hit.primitive - shape->first_primitive;
    path->vertices[path->k].p = path->end.p;
    path->vertices[path->k].ng = path->end.ng;
    return true;
}

/* The path that strategy (s, t) made for the item; returns false if that is not a single path. */
static bool path_gather(const Walks *walks, uint item, uint s, uint t, RealPath *path)
{
    memset(path, 0, sizeof *path);
    path->k = path->densities.k = s + t - 1;
    camera_part(walks, item, s, t, path);
    if (s >= 2)
        light_part(walks, item, s, path);
    else if (s == 1)
        light_drawn(walks, item, t, path);
    else if (!light_met(walks, item, path))
        return false;
    if (s > 0) { /* lamps are parallelograms, disks and triangles: (u, v) does not matter */
        path->end.p = path->vertices[path->k].p;
        path->end.ng = path->vertices[path->k].ng;
    }
    if (t == 1)
        path->vertices[0].p = lens_drawn(walks, item, s, path->vertices[1].p);
    if (s > 1)
        path->ways[t] = vec3_normalize(vec3_sub(path->vertices[t - 1].p, path->vertices[t].p));
    path->densities.hittable = !path->delta_light;
    path_densities(walks, path);
    return true;
}

/* ---- the test ---------------------------------------------------------------------------------------------------- */

typedef struct Tally {
    uint paths[DEPTH + 1]; /* by s */
    uint rounded; /* paths for which rounding alone may exceed 1e-4 */
    double worst;
} Tally;

/* A ray leaves its surface slightly off the vertex (geometry/ray.h). Kernels compute one direction's density along the
 * ray and the other's between the vertices; their directions, hence cosines and densities, differ by this fraction. */
static double path_rounding(const RealPath *path)
{
    double sum = 0.0;
    for (uint i = 2; i <= path->k; ++i) {
        float distance2;
        Vec3 w = path_direction(path, i, i - 1, &distance2);
        Vec3 between = vec3_sub(path->vertices[i - 1].p, path->vertices[i].p);
        if (i == path->k && path->infinite)
            continue;
        double off = (double)vec3_length(vec3_sub(vec3_scale(between, 1.0f / float_sqrt(distance2)), w));
        Vec3 from = path->vertices[i].ng, to = path->vertices[i - 1].ng;
        double cosine = vec3_is_zero(to) ? 1.0 : (double)float_abs(vec3_dot(w, to));
        if ((i < path->k || !path->delta_light) && !vec3_is_zero(from))
            cosine = fmin(cosine, (double)float_abs(vec3_dot(w, from)));
        sum += off / fmax(cosine, 1e-9);
    }
    return sum;
}

/* The same for vertices on curves: a path that hits a curve goes on from its axis, up to half a width away, seen from
 * its neighbours under this angle. Lobes of the scenes' BSDFs change by up to ten times as much. */
static double path_axis_rounding(const Walks *walks, const RealPath *path)
{
    const double half = 0.06, slope = 10.0; /* of the scenes' curves */
    double sum = 0.0;
    for (uint i = 1; i < path->k; ++i) {
        if (!normal_is_fibre(&walks->view, path->vertices[i].ng))
            continue;
        sum += slope * half / (double)vec3_length(vec3_sub(path->vertices[i].p, path->vertices[i - 1].p));
        if (i + 1 < path->k || !path->infinite)
            sum += slope * half / (double)vec3_length(vec3_sub(path->vertices[i].p, path->vertices[i + 1].p));
    }
    return sum;
}

/* `contribution`: [0] weighted, [1] unweighted. */
static void weight_check(const Walks *walks, const char *name, uint item, uint s, uint t, const Vec3 contribution[2],
                         Tally *tally)
{
    RealPath path;
    const float plain = vec3_max_component(contribution[1]);
    const uint set = walks->frame.path.strategies, exponent = walks->frame.path.mis_exponent;
    if (!(plain > 0.0f) || !path_gather(walks, item, s, t, &path))
        return;
    TEST_TRUE(test_path_possible(&path.densities, set, s));
    const double weight = (double)vec3_max_component(contribution[0]) / (double)plain;
    double sum = weight;
    for (uint other = 0; other <= path.k; ++other)
        if (other != s && test_path_possible(&path.densities, set, other))
            sum += (double)test_path_weight(&path.densities, set, exponent, other);
    const double axis = path_axis_rounding(walks, &path), rounding = path_rounding(&path) + axis;
    if (!(fabs(sum - 1.0) <= 1e-4 + rounding))
        ck_abort_msg("%s, item %u, (%u,%u): the weights sum to %.7f, that of the kernel is %.7f; rounding %.2g", name,
                     item, s, t, sum, weight, rounding);
    tally->rounded += axis == 0.0 && rounding > 1e-4;
    tally->worst = fmax(tally->worst, rounding > 1e-4 ? 0.0 : fabs(sum - 1.0));
    ++tally->paths[s];
}

/* All connections, computed by the kernel itself. */
static void connections_check(Walks *walks, const char *name, Tally *tally)
{
    uint *paths = walks->words[BUFFER_PATHS], *shadows = walks->words[BUFFER_SHADOWS];
    walks->frame.path.only_s = walks->frame.path.only_t = NONE;
    walks_run(walks, walks->pair->list.count);
    for (uint item = 0; item < ITEMS; ++item)
        for (uint s = 1; s <= DEPTH; ++s)
            for (uint t = s == 1 ? 2 : 1; s + t <= DEPTH + 1; ++t) {
                Vec3 contribution[2] = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
                platform_item = item;
                for (int i = 0; i < 2; ++i) {
                    walks->frame.path.unweighted = i == 1;
                    state_store(paths, ITEMS, BD_S, item, s);
                    state_store(paths, ITEMS, BD_T, item, t);
                    state_store_float(shadows, ITEMS, RAY_T_MAX, item, 0.0f);
                    bd_connect(&walks->frame, NULL, walks->packed.geometry, walks->packed.tables, walks->packed.texels,
                               paths, shadows, walks->words[BUFFER_VERTICES], walks->words[BUFFER_DENSITIES]);
                    if (state_load_float(shadows, ITEMS, RAY_T_MAX, item) > 0.0f)
                        contribution[i] = state_load_vec3(paths, ITEMS, BD_CONTRIBUTION, item);
                }
                weight_check(walks, name, item, s, t, contribution, tally);
            }
}

/* The number of steps until the camera subpath has `segments` segments. */
static size_t steps_to_segment(const StepList *list, uint segments)
{
    size_t i = 0;
    while (list->steps[i].kind != STEP_KERNEL || list->steps[i].kernel != KERNEL_bd_start_camera)
        ++i;
    for (uint found = 0; found < segments; ++i)
        found += list->steps[i].kind == STEP_KERNEL && list->steps[i].kernel == KERNEL_bd_shade_hits;
    return i;
}

/* Lights hit by the camera subpath (s = 0). */
static void hits_check(Walks *walks, const char *name, Tally *tally)
{
    Vec3 met[ITEMS];
    for (uint k = 2; k <= DEPTH; ++k) {
        const size_t steps = steps_to_segment(&walks->pair->list, k);
        walks->frame.path.only_s = 0;
        walks->frame.path.only_t = k + 1;
        walks->frame.path.unweighted = 0;
        walks_run(walks, steps);
        for (uint item = 0; item < ITEMS; ++item)
            met[item] = state_load_vec3(walks->words[BUFFER_PATHS], ITEMS, BD_RADIANCE, item);
        walks->frame.path.unweighted = 1;
        walks_run(walks, steps);
        for (uint item = 0; item < ITEMS; ++item) {
            const Vec3 contribution[2] = {met[item],
                                          state_load_vec3(walks->words[BUFFER_PATHS], ITEMS, BD_RADIANCE, item)};
            weight_check(walks, name, item, 0, k + 1, contribution, tally);
        }
    }
}

/* The weights of all strategies of a path sum to 1, where the weight of the strategy that made the path is the
 * kernel's. */
START_TEST(test_real_walks)
{
    const BidirectionalScene *scene = &BIDIRECTIONAL_SCENES[_i / 2];
    VerifyPair pair;
    Walks walks;
    Tally tally = {.worst = 0.0};
    if (strstr(scene->text, "MakeNamedMedium")) /* test_walks_in_smoke */
        return;
    walks_open(&walks, &pair, scene, _i % 2 == 1);
    connections_check(&walks, scene->name, &tally);
    hits_check(&walks, scene->name, &tally);
    printf("%-28s paths by s:", scene->name);
    uint all = 0;
    for (uint s = 0; s <= DEPTH; ++s) {
        printf(" %u", tally.paths[s]);
        all += tally.paths[s];
    }
    printf("; sums of weights differ from 1 by up to %.1e, %u paths rounded\n", tally.worst, tally.rounded);
    ck_assert_uint_gt(all, 2000);
    ck_assert_uint_lt(tally.rounded, all / 20);
    walks_close(&walks);
}
END_TEST

/* Connections whose weight depends on what their shadow ray goes through. */
static void traced_connections_check(Walks *walks, const char *name, Tally *tally)
{
    static Vec3 made[2][ITEMS];
    for (uint s = 1; s < DEPTH; ++s)
        for (uint t = 2; s + t <= DEPTH + 1; ++t) {
            walks->frame.path.only_s = s;
            walks->frame.path.only_t = t;
            for (uint i = 0; i < 2; ++i) {
                walks->frame.path.unweighted = i;
                walks_run(walks, walks->pair->list.count);
                for (uint item = 0; item < ITEMS; ++item)
                    made[i][item] = state_load_vec3(walks->words[BUFFER_PATHS], ITEMS, BD_RADIANCE, item);
            }
            for (uint item = 0; item < ITEMS; ++item) {
                const Vec3 contribution[2] = {made[0][item], made[1][item]};
                weight_check(walks, name, item, s, t, contribution, tally);
            }
        }
}

/* A grid that fills the scene, with samples of 0 beside dense ones: a density taken at the wrong end of a segment is
 * off by a large factor. */
static const BidirectionalScene STEEP_SMOKE = {
    "steep smoke",
    "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 3 \"integer ny\" 4 \"integer nz\" 5\n"
    "\"point3 p0\" [ -9 -9 -9 ] \"point3 p1\" [ 9 9 9 ] \"rgb sigma_a\" [ 0.02 0.03 0.05 ]\n"
    "\"rgb sigma_s\" [ 0.2 0.3 0.4 ] \"float g\" 0.4 \"float density\" [\n"
    "1 0 1  2 0.1 0  0 1 0  1 2 0   0 1 2  1 0.1 0.2  0 0.5 3  2 0 1   1 0 0  0.2 2 0  3 0.1 0.2  0 1 0\n"
    "1 0 2  0 2 0.2  1 0 0.1  0 3 1   0 0 1  1 2 0  0.5 0 1  2 0 1 ]\n"
    "MediumInterface \"smoke\"\n" BD_ROOM BD_BALL,
    SUPPORT_ALL, 4, 3};

/* The same where the medium differs from place to place. */
START_TEST(test_walks_in_smoke)
{
    VerifyPair pair;
    Walks walks;
    Tally tally = {.worst = 0.0};
    walks_open(&walks, &pair, &STEEP_SMOKE, _i == 1);
    traced_connections_check(&walks, STEEP_SMOKE.name, &tally);
    uint connected = tally.paths[1] + tally.paths[2] + tally.paths[3];
    hits_check(&walks, STEEP_SMOKE.name, &tally);
    printf("%-28s %u connections, %u hits; sums of weights differ from 1 by up to %.1e, %u paths rounded\n",
           STEEP_SMOKE.name, connected, tally.paths[0], tally.worst, tally.rounded);
    ck_assert_uint_gt(connected, 2000);
    ck_assert_uint_gt(tally.paths[0], 100);
    ck_assert_uint_lt(tally.rounded, connected / 20);
    walks_close(&walks);
}
END_TEST

/* Whether a walk survives at a vertex of albedo 0.25 if roulette's random number is u; the walk began with 1 / relative
 * times the throughput that it has now. */
static bool survives(const FrameParams *frame, uint depth, float relative, float u, WalkStep *step)
{
    const SceneView view = {.frame = frame, .features = ~(ulong)0};
    Vertex vertex = {
        .beta = vec3_splat(3.0f), .wo = vec3(0.0f, 0.6f, 0.8f), .ng = vec3(0.0f, 0.0f, 1.0f), .back = 1.0f};
    vertex.frame = frame_from_normal(vertex.ng);
    vertex.bsdf = (Bsdf){.kind = MATERIAL_DIFFUSE, .color0 = vec3_splat(0.25f)};
    bsdf_flags_set(&vertex.bsdf);
    const Random4 random = {{1u << 30, 1u << 30, 3u << 29, (uint)((double)u * 0x1p32)}};
    return walk_scatter(&view, &vertex, SIDE_CAMERA, (Roulette){depth, relative / 3.0f, 0.0f}, random, step);
}

/* Roulette's probability is the relative throughput times roulette_scale, and survivors weigh so much the more. */
START_TEST(test_roulette)
{
    static const float SCALES[] = {0.5f, 1.0f, 2.0f, 3.9f, 5.0f};
    FrameParams frame = {.path = {.roulette_depth = 3, .max_depth = 10}};
    WalkStep step;
    for (size_t i = 0; i < sizeof SCALES / sizeof *SCALES; ++i)
        for (float relative = 0.125f; relative <= 1.0f; relative *= 2.0f) {
            float survival = fminf(SCALES[i] * relative * 0.25f, 1.0f);
            frame.path.roulette_scale = SCALES[i];
            ck_assert(survives(&frame, 2, relative, 0.999f, &step)); /* too early */
            ck_assert_float_eq(step.survival, 1.0f);
            ck_assert(survives(&frame, 3, relative, 0.999f * survival, &step));
            ck_assert_float_eq_tol(step.survival, survival, 1e-6f);
            ck_assert_float_eq_tol(step.beta.x * survival, 0.75f, 1e-6f);
            ck_assert(survival >= 1.0f || !survives(&frame, 3, relative, 1.001f * survival, &step));
        }
}
END_TEST

TCase *bidirectional_walks_case(void)
{
    TCase *tcase = tcase_create("walks");
    tcase_set_timeout(tcase, 600);
    tcase_add_unchecked_fixture(tcase, bidirectional_files_make, bidirectional_files_remove);
    tcase_add_loop_test(tcase, test_real_walks, 0, 2 * BIDIRECTIONAL_SCENE_COUNT);
    tcase_add_loop_test(tcase, test_walks_in_smoke, 0, 2);
    tcase_add_test(tcase, test_roulette);
    return tcase;
}
