/* Rays per second of one thread, on the same rays, of
 *   shared   the query path of the CPU backend (clusters of triangles, the shared intersection test),
 *   user     bare Embree user geometry: one primitive per triangle and a minimal callback (Moeller and Trumbore),
 *   native   Embree's own triangles.
 * Output: one line per scene, kind of ray and path, tab-separated. `ratio` is time relative to `user`. Usage:
 * bench_rays [RAYS] */
#include "backend/backend.h"
#include "bench_util.h"
#include "geometry/ray.h"
#include "geometry/surface.h"
#include "layout/state.h"
#include "math/rng.h"
#include "math/warp.h"
#include "rays_embree.h"
#include "scene/scene.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <string.h>

#define REPEATS 5

/* ---- scenes ------------------------------------------------------------------------------------------------------ */

typedef struct BenchScene {
    const char *name;
    Vec3 *positions;
    uint *indices;
    uint vertex_count, triangle_count;
    Scene scene;
    BackendScene backend;
} BenchScene;

static float unit(uint seed, uint n)
{
    return random_float(random_four(n, seed, 0u, 0u, 1u, 2u).x[0]);
}

/* A closed bumpy sphere, seen from inside. */
static void scene_star(BenchScene *bench, uint rings, uint sectors, float rough)
{
    bench->positions = calloc((size_t)(rings + 1) * sectors, sizeof *bench->positions);
    bench->indices = calloc((size_t)rings * sectors * 6, sizeof *bench->indices);
    if (!bench->positions || !bench->indices)
        bench_fail("out of memory");
    for (uint i = 0; i <= rings; ++i)
        for (uint j = 0; j < sectors; ++j) {
            float theta = PI * (float)i / (float)rings, phi = 2.0f * PI * (float)j / (float)sectors;
            float r = 1.0f + rough * (unit(7u, i * sectors + j) - 0.5f) + 0.2f * sinf(5.0f * theta) * cosf(4.0f * phi);
            if (i == 0 || i == rings)
                r = 1.0f;
            bench->positions[bench->vertex_count++] =
                vec3(r * sinf(theta) * cosf(phi), r * sinf(theta) * sinf(phi), r * cosf(theta));
        }
    for (uint i = 0; i < rings; ++i)
        for (uint j = 0; j < sectors; ++j) {
            uint k = (j + 1) % sectors, a = i * sectors + j, b = i * sectors + k, c = a + sectors, d = b + sectors;
            const uint quad[6] = {a, c, b, b, c, d};
            memcpy(bench->indices + 3 * (size_t)bench->triangle_count, quad, sizeof quad);
            bench->triangle_count += 2;
        }
}

static void add_box(BenchScene *bench, Vec3 low, Vec3 high)
{
    static const uint faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    uint first = bench->vertex_count;
    for (uint k = 0; k < 8; ++k)
        bench->positions[bench->vertex_count++] =
            vec3(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
    for (uint f = 0; f < 6; ++f) {
        const uint *q = faces[f];
        const uint two[6] = {first + q[0], first + q[1], first + q[2], first + q[0], first + q[2], first + q[3]};
        memcpy(bench->indices + 3 * (size_t)bench->triangle_count, two, sizeof two);
        bench->triangle_count += 2;
    }
}

/* A closed room with two boxes: 36 triangles, as many as the Cornell box. */
static void scene_room(BenchScene *bench)
{
    bench->positions = calloc(24, sizeof *bench->positions);
    bench->indices = calloc(36 * 3, sizeof *bench->indices);
    if (!bench->positions || !bench->indices)
        bench_fail("out of memory");
    add_box(bench, vec3(-1.0f, -1.0f, -1.0f), vec3(1.0f, 1.0f, 1.0f));
    add_box(bench, vec3(-0.7f, -1.0f, -0.6f), vec3(-0.1f, 0.2f, 0.0f));
    add_box(bench, vec3(0.1f, -1.0f, 0.0f), vec3(0.7f, -0.4f, 0.6f));
}

static void scene_prepare(BenchScene *bench)
{
    Error error = {0};
    uint material;
    Material diffuse = {.kind = MATERIAL_DIFFUSE,
                        .color0.program = NONE,
                        .color1.program = NONE,
                        .roughness_u.program = NONE,
                        .roughness_v.program = NONE,
                        .amount.program = NONE,
                        .displacement.program = NONE,
                        .normal_map = NONE,
                        .coat_table = NONE};
    LightData light = {
        .kind = LIGHT_POINT, .emission = {1.0f, 1.0f, 1.0f}, .detail.image = NONE, .detail.distribution = NONE};
    MeshData mesh = {.positions = &bench->positions[0].x,
                     .vertex_count = bench->vertex_count,
                     .indices = bench->indices,
                     .triangle_count = bench->triangle_count};
    Scene *scene = &bench->scene;
    scene_init(scene);
    if (!scene_add_material(scene, &diffuse, &material, &error) || !scene_add_light(scene, &light, &error) ||
        !scene_add_mesh(scene, &mesh, (Shape){.alpha = NONE, .first_light = NONE}, NULL, 0, &error) ||
        !scene_finish(scene, &error))
        bench_fail(error.message);
    bench->backend = scene_backend_view(scene);
}

/* ---- the two bare paths ------------------------------------------------------------------------------------------ */

static void bare_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const BenchScene *bench = args->geometryUserPtr;
    const uint *v = bench->indices + 3 * (size_t)args->primID;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int k = 0; k < 3; ++k) {
        const float p[3] = {bench->positions[v[k]].x, bench->positions[v[k]].y, bench->positions[v[k]].z};
        for (int i = 0; i < 3; ++i) {
            low[i] = fminf(low[i], p[i]);
            high[i] = fmaxf(high[i], p[i]);
        }
    }
    *args->bounds_o = (struct RTCBounds){low[0], low[1], low[2], 0.0f, high[0], high[1], high[2], 0.0f};
}

/* Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997. */
static bool bare_test(const BenchScene *bench, uint primitive, const struct RTCRay *ray, float *t, float *u, float *v)
{
    const uint *index = bench->indices + 3 * (size_t)primitive;
    Vec3 a = bench->positions[index[0]];
    Vec3 e = vec3_sub(bench->positions[index[1]], a), f = vec3_sub(bench->positions[index[2]], a);
    Vec3 d = vec3(ray->dir_x, ray->dir_y, ray->dir_z), s = vec3_sub(vec3(ray->org_x, ray->org_y, ray->org_z), a);
    Vec3 p = vec3_cross(d, f);
    float determinant = vec3_dot(e, p);
    if (determinant == 0.0f)
        return false;
    float inverse = 1.0f / determinant;
    *u = vec3_dot(s, p) * inverse;
    if (*u < 0.0f || *u > 1.0f)
        return false;
    Vec3 q = vec3_cross(s, e);
    *v = vec3_dot(d, q) * inverse;
    if (*v < 0.0f || *u + *v > 1.0f)
        return false;
    *t = vec3_dot(f, q) * inverse;
    return *t > ray->tnear && *t < ray->tfar;
}

static void bare_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit;
    float t, u, v;
    if (!bare_test(args->geometryUserPtr, args->primID, &rayhit->ray, &t, &u, &v))
        return;
    rayhit->ray.tfar = t;
    rayhit->hit.u = u;
    rayhit->hit.v = v;
    rayhit->hit.primID = args->primID;
    rayhit->hit.geomID = args->geomID;
}

static void bare_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    float t, u, v;
    if (bare_test(args->geometryUserPtr, args->primID, ray, &t, &u, &v))
        ray->tfar = -INFINITY;
}

static RTCScene bare_scene(RTCDevice device, BenchScene *bench, bool native)
{
    RTCGeometry geometry = rtcNewGeometry(device, native ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
    if (native) {
        void *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                                 bench->vertex_count);
        void *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint),
                                                bench->triangle_count);
        memcpy(vertices, bench->positions, bench->vertex_count * sizeof(Vec3));
        memcpy(indices, bench->indices, 3 * sizeof(uint) * bench->triangle_count);
    } else {
        rtcSetGeometryUserPrimitiveCount(geometry, bench->triangle_count);
        rtcSetGeometryUserData(geometry, bench);
        rtcSetGeometryBoundsFunction(geometry, bare_bounds, NULL);
        rtcSetGeometryIntersectFunction(geometry, bare_intersect);
        rtcSetGeometryOccludedFunction(geometry, bare_occluded);
    }
    RTCScene scene = rtcNewScene(device);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

/* ---- rays -------------------------------------------------------------------------------------------------------- */

#define STRIDE 512u

typedef struct RaySet {
    uint count; /* a multiple of STRIDE */
    uint *closest; /* blocks of RAY_WORDS x STRIDE */
    uint *shadow; /* blocks of SHADOW_WORDS x STRIDE */
    uint *hits;
} RaySet;

/* Diffuse walks of eight segments from the middle, and a shadow ray from each vertex to a point under the ceiling. */
static RaySet rays_make(const BenchScene *bench, const RaysEmbree *rays, uint count)
{
    RaySet set = {.count = (count + STRIDE - 1) / STRIDE * STRIDE};
    set.closest = malloc((size_t)set.count * RAY_WORDS * sizeof(uint));
    set.shadow = malloc((size_t)set.count * SHADOW_WORDS * sizeof(uint));
    set.hits = malloc((size_t)set.count * HIT_WORDS * sizeof(uint));
    if (!set.closest || !set.shadow || !set.hits)
        bench_fail("out of memory");
    SceneView view = scene_view(bench->backend.frame, bench->backend.geometry, bench->backend.tables, NULL);
    Ray ray = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, FLOAT_MAX};
    Vec3 light = vec3(0.1f, 0.75f, -0.1f);
    for (uint i = 0; i < set.count; ++i) {
        uint block = i / STRIDE, t = i % STRIDE;
        Random4 random = random_four(i, 3u, 0u, 0u, 4u, 5u);
        Vec3 d = warp_sphere(vec2(random_float(random.x[0]), random_float(random.x[1])));
        if (i % 8 == 0)
            ray = (Ray){vec3(0.0f, 0.4f, 0.1f), d, FLOAT_MAX};
        ray_store(set.closest + (size_t)block * RAY_WORDS * STRIDE, STRIDE, t, ray);
        Hit hit = rays_embree_closest(rays, &ray);
        Vec3 p = vec3(0.0f, 0.4f, 0.1f), ng = vec3_splat(0.0f);
        if (hit.primitive != NONE) {
            Surface surface = surface_from_hit(&view, &ray, hit);
            p = surface.p;
            ng = ray_side(surface.ng, vec3_negate(ray.d));
            d = vec3_normalize(vec3_add(vec3_scale(ng, 1.0001f), d));
        }
        ray_store(set.shadow + (size_t)block * SHADOW_WORDS * STRIDE, STRIDE, t,
                  ray_between(p, ng, light, vec3_splat(0.0f)));
        ray = ray_spawn(p, ng, d);
    }
    return set;
}

static struct RTCRay embree_ray(Ray ray)
{
    return (struct RTCRay){.org_x = ray.o.x,
                           .org_y = ray.o.y,
                           .org_z = ray.o.z,
                           .dir_x = ray.d.x,
                           .dir_y = ray.d.y,
                           .dir_z = ray.d.z,
                           .tfar = ray.t_max,
                           .mask = 0xffffffffu};
}

static void trace_closest_bare(RTCScene scene, const uint *words, uint *hits)
{
    struct RTCIntersectContext context;
    for (uint t = 0; t < STRIDE; ++t) {
        rtcInitIntersectContext(&context);
        struct RTCRayHit rayhit = {.ray = embree_ray(ray_load(words, STRIDE, t)),
                                   .hit.geomID = RTC_INVALID_GEOMETRY_ID};
        rtcIntersect1(scene, &context, &rayhit);
        Hit hit = {rayhit.ray.tfar, rayhit.hit.primID, NONE, rayhit.hit.u, rayhit.hit.v};
        if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            hit.primitive = NONE;
        hit_store(hits, STRIDE, t, hit);
    }
}

static void trace_shadow_bare(RTCScene scene, uint *words)
{
    struct RTCIntersectContext context;
    for (uint t = 0; t < STRIDE; ++t) {
        rtcInitIntersectContext(&context);
        struct RTCRay ray = embree_ray(ray_load(words, STRIDE, t));
        rtcOccluded1(scene, &context, &ray);
        state_store(words, STRIDE, SHADOW_OCCLUDED, t, ray.tfar < 0.0f);
    }
}

/* Thread CPU seconds for the whole set: by the shared path if `rays` is not NULL, otherwise by the bare `scene`. */
static double set_trace(const RaySet *set, const RaysEmbree *rays, RTCScene scene, bool shadow)
{
    double begin = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (uint block = 0; block < set->count / STRIDE; ++block) {
        uint *closest = set->closest + (size_t)block * RAY_WORDS * STRIDE;
        uint *shadows = set->shadow + (size_t)block * SHADOW_WORDS * STRIDE;
        uint *hits = set->hits + (size_t)block * HIT_WORDS * STRIDE;
        if (rays && shadow)
            rays_embree_trace_shadow(rays, shadows, NULL, STRIDE, STRIDE);
        else if (rays)
            rays_embree_trace_closest(rays, closest, hits, NULL, NULL, STRIDE, STRIDE);
        else if (shadow)
            trace_shadow_bare(scene, shadows);
        else
            trace_closest_bare(scene, closest, hits);
    }
    return bench_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
}

static void scene_bench(BenchScene *bench, uint count)
{
    Error error = {0};
    scene_prepare(bench);
    double begin = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    RaysEmbree *rays = rays_embree_create(&bench->backend, 2, &error);
    double build = bench_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    if (!rays)
        bench_fail(error.message);
    RTCDevice device = rtcNewDevice("threads=2,set_affinity=0");
    begin = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    RTCScene user = bare_scene(device, bench, false);
    double build_user = bench_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    begin = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    RTCScene native = bare_scene(device, bench, true);
    double build_native = bench_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
    RaySet set = rays_make(bench, rays, count);
    const char *names[3] = {"shared", "user", "native"};
    const double builds[3] = {build, build_user, build_native};
    for (int shadow = 0; shadow < 2; ++shadow) {
        double best[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
        for (int repeat = 0; repeat < REPEATS; ++repeat)
            for (int path = 0; path < 3; ++path)
                best[path] =
                    fmin(best[path], set_trace(&set, path == 0 ? rays : NULL, path == 1 ? user : native, shadow != 0));
        for (int path = 0; path < 3; ++path)
            printf("%s\t%u\t%s\t%s\t%.3f\t%.3f\t%.3f\n", bench->name, bench->triangle_count,
                   shadow ? "shadow" : "closest", names[path], 1e-6 * set.count / best[path], best[path] / best[1],
                   builds[path]);
        fflush(stdout);
    }
    rtcReleaseScene(user);
    rtcReleaseScene(native);
    rtcReleaseDevice(device);
    rays_embree_destroy(rays);
    scene_destroy(&bench->scene);
    free(set.closest);
    free(set.shadow);
    free(set.hits);
    free(bench->positions);
    free(bench->indices);
}

static void cpu_print(void)
{
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0) {
            printf("# cpu\t%s", strchr(line, ':') + 2);
            break;
        }
    if (file)
        fclose(file);
    printf("# compiler\t%s\n", __VERSION__);
}

int main(int argc, char **argv)
{
    uint count = argc > 1 ? (uint)strtoul(argv[1], NULL, 10) : 500000u;
    cpu_print();
    printf("scene\ttriangles\trays\tpath\tMrays/s\tratio\tbuild_s\n");
    BenchScene room = {.name = "room"}, small = {.name = "star_10k"}, large = {.name = "star_1M"};
    scene_room(&room);
    scene_bench(&room, count);
    scene_star(&small, 50, 100, 0.02f);
    scene_bench(&small, count);
    scene_star(&large, 500, 1000, 0.002f);
    scene_bench(&large, count);
    return EXIT_SUCCESS;
}
