/* Shifts among details finer than a thousandth of a segment: the vertices that a chain keeps must be the ones it
 * had. */
#include "support/bidirectional.h"
#include "support/test_files.h"

#include "chain/shift.h"

#include <stdlib.h>
#include <string.h>

/* A distant light shines upward through the floor at y = 0. A black triangle far away makes the scene large and light
 * tracing thereby rare, so that paths with one light vertex, whose z_2 shifts keep, have nearly all of the weight. */
static const char FLOOR[] = BD_FILM "LookAt -1 3 0  -1 0 0  0 0 1 Camera \"perspective\" \"float fov\" 36\n"
                                    "WorldBegin\n"
                                    "LightSource \"distant\" \"point3 from\" [ -.2 -.6 -1.5 ] \"point3 to\" [ 0 0 0 ]\n"
                                    "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                                    "Shape \"trianglemesh\" \"point3 P\" [ 30 0 0  30 1 0  30 0 1 ]\n" BD_GREY
                                    "Shape \"bilinearmesh\" \"point3 P\" [ -3 0 -1  2 0 -1  -3 0 1  2 0 1 ]\n"
                                    "Material \"diffuse\" \"rgb reflectance\" [ 0.2 0.2 0.2 ]\n"
                                    "Shape \"bilinearmesh\" \"point3 P\" [ .1 1 -.5  .3 1 -.5  .1 1 .5  .3 1 .5 ]\n";

/* Bright fins hang from the dark patch at y = 1, 0.0008 long and as far apart. The floor's pixels see the patch at
 * slants from 0.2 to 2.2, with more and more of the space between the fins occluded. */
#define FINS 250

static void fins_print(FILE *file)
{
    const double apart = 0.2 / FINS;
    fputs("Material \"diffuse\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\nShape \"trianglemesh\" \"point3 P\" [\n", file);
    for (int i = 0; i < FINS; ++i) {
        double x = 0.1 + i * apart, y = 1.0 - apart;
        fprintf(file, "%.9g 1 -.5  %.9g 1 .5  %.9g %.9g -.5  %.9g %.9g .5\n", x, x, x, y, x, y);
    }
    fputs("] \"integer indices\" [\n", file);
    for (int i = 0; i < 4 * FINS; i += 4)
        fprintf(file, "%d %d %d  %d %d %d\n", i, i + 1, i + 2, i + 1, i + 3, i + 2);
    fputs("]\n", file);
}

/* Quarters of the image by chains of 64 and of 2048 steps, against path tracing. */
START_TEST(test_fins)
{
    char *text;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(file);
    fputs(FLOOR, file);
    fins_print(file);
    fclose(file);
    PictureGroups expected, got;
    GroupSetup setup = {.groups = 16, .render = {.text = text, .samples = 512, .max_depth = 3, .threads = 2}};
    groups_render(&setup, &expected);
    setup.render.integrator = integrator_mmlt();
    setup.render.samples = 1536;
    setup.render.seed = 100;
    setup.render.chains = (ChainOptions){.chains = 64, .steps = _i == 0 ? 64 : 2048, .chains_only = true};
    groups_render(&setup, &got);
    for (int quarter = 0; quarter < 4; ++quarter) {
        double mean, error, other, other_error;
        int x = quarter % 2 * 8, y = quarter / 2 * 8;
        groups_block(&got, x, y, x + 8, y + 8, &mean, &error);
        groups_block(&expected, x, y, x + 8, y + 8, &other, &other_error);
        printf("fins, quarter %d %d: %.4g, by path tracing %.4g, ratio %.3f +- %.3f\n", quarter % 2, quarter / 2, mean,
               other, mean / other, hypot(error, other_error) / other);
    }
    fflush(stdout);
    groups_compare(_i == 0 ? "fins, 64 steps" : "fins, 2048 steps", &got, &expected, 2, false);
    groups_destroy(&got);
    groups_destroy(&expected);
    free(text);
}
END_TEST

/* ---- kept vertices ----------------------------------------------------------------------------------------------- */

/* One chain whose current path is in bank 0; its proposal, a shift or not, goes to bank 1. */
typedef struct Kept {
    FrameParams frame;
    uint paths[CHAIN_NUMBERS + 64], vertices[CHAIN_VERTEX_WORDS];
    WalkHit walk_hit; /* of z_2, then of z_3 */
} Kept;

static void kept_init(Kept *kept, uint shift)
{
    memset(kept, 0, sizeof *kept);
    kept->frame.pass.stride = 1;
    kept->paths[CHAIN_MOVE] = SUBPATH_CAMERA << MOVE_CHANGED | shift << MOVE_SHIFT;
}

/* The walk samples a direction with density pdf_w and goes from o to p, on a primitive with normal ng. */
static void kept_walk(Kept *kept, Vec3 o, Vec3 p, Vec3 ng, float pdf_w)
{
    WalkHit *walk_hit = &kept->walk_hit;
    Vec3 d = vec3_sub(p, o);
    *walk_hit = (WalkHit){.from = o, .light = NONE, .instance = 7, .primitive = 9};
    walk_hit->ray.o = o;
    walk_hit->ray.d = vec3_normalize(d);
    walk_hit->distance2 = vec3_length_squared(d);
    walk_hit->surface.p = p;
    walk_hit->surface.ng = ng;
    kept->paths[BD_SHIFT_DENSITY] = float_bits(pdf_w);
}

static bool kept_hit(Kept *kept, uint depth)
{
    const SceneView view = {.frame = &kept->frame};
    return shift_hit(&view, kept->paths, kept->vertices, 0, depth, &kept->walk_hit);
}

/* Density per area by the definition. */
static double area_density(const Kept *kept, double pdf_w)
{
    const WalkHit *walk_hit = &kept->walk_hit;
    return pdf_w * fabs((double)vec3_dot(walk_hit->ray.d, walk_hit->surface.ng)) / (double)walk_hit->distance2;
}

/* The stored density is the product of those of z_2 and z_3 with respect to area, and shift_ratio is the proposal's
 * over the current path's. A path that cannot be shifted has density 0, and none that can be shifted is proposed from
 * it. */
START_TEST(test_kept_density)
{
    Kept kept;
    double expected[2];
    for (uint path = 0; path < 2; ++path) {
        if (path == 0)
            kept_init(&kept, 0);
        /* as if the first path had been accepted */
        kept.paths[CHAIN_MOVE] = SUBPATH_CAMERA << MOVE_CHANGED | (path == 0 ? 0u : SUBPATH_CAMERA) << MOVE_BANKS;
        kept_walk(&kept, vec3((float)path, 0.0f, 0.0f), vec3(1.0f, 2.0f, 3.0f), vec3(0.0f, 0.6f, 0.8f), 0.7f);
        expected[path] = area_density(&kept, (double)0.7f);
        ck_assert(kept_hit(&kept, 2));
        kept_walk(&kept, vec3(1.0f, 2.0f, 3.0f), vec3(-1.0f, 5.0f, (float)path), vec3(1.0f, 0.0f, 0.0f),
                  4.0f + (float)path);
        expected[path] *= area_density(&kept, 4.0 + path);
        ck_assert(kept_hit(&kept, 3));
        TEST_NEAR(shift_density(kept.vertices, 1, 1u - path, 0) / expected[path], 1.0, 1e-6);
    }
    /* An infinite density counts as none. */
    Kept again = kept;
    kept_walk(&again, vec3_splat(0.0f), vec3(1.0f, 2.0f, 3.0f), vec3(0.0f, 0.6f, 0.8f), FLOAT_INFINITY);
    kept_hit(&again, 2);
    ck_assert_float_eq(shift_density(again.vertices, 1, 0, 0), 0.0f);
    /* The current path again: both of its vertices are where they are kept. */
    again = kept;
    again.paths[CHAIN_MOVE] =
        SUBPATH_CAMERA << MOVE_CHANGED | SUBPATH_CAMERA << MOVE_BANKS | (SHIFT_STEP | SHIFT_KEEPS) << MOVE_SHIFT;
    kept_walk(&again, vec3(0.0f, 0.0f, 0.0f), vec3(1.0f, 2.0f, 3.0f), vec3(0.0f, 0.6f, 0.8f), 0.7f);
    ck_assert(kept_hit(&again, 2));
    kept_walk(&again, vec3(1.0f, 2.0f, 3.0f), vec3(-1.0f, 5.0f, 0.0f), vec3(1.0f, 0.0f, 0.0f), 4.0f);
    ck_assert(kept_hit(&again, 3));
    TEST_NEAR(shift_ratio(again.paths, again.vertices, 1, 0), 1.0, 1e-6);
    /* Now the path in bank 0 is proposed, and that in bank 1 is current. */
    kept.paths[CHAIN_MOVE] |= (SHIFT_STEP | SHIFT_KEEPS) << MOVE_SHIFT;
    TEST_NEAR(shift_ratio(kept.paths, kept.vertices, 1, 0) / (expected[1] / expected[0]), 1.0, 1e-6);
    kept.paths[CHAIN_MOVE] ^= SHIFT_KEEPS << MOVE_SHIFT;
    ck_assert_float_eq(shift_ratio(kept.paths, kept.vertices, 1, 0), 0.0f);
    kept.walk_hit.missed = true;
    kept_hit(&kept, 3);
    ck_assert_float_eq(shift_density(kept.vertices, 1, 0, 0), 0.0f);
    ck_assert_float_eq(shift_ratio(kept.paths, kept.vertices, 1, 0), 1.0f);
    ck_assert_uint_eq(shift_kind(kept.paths, kept.vertices, 1, 0), SHIFT_STEP | SHIFT_KEEPS);
    shift_density_set(kept.vertices, 1, 1, 0, 0.0f);
    ck_assert_uint_eq(shift_kind(kept.paths, kept.vertices, 1, 0), SHIFT_STEP);
    kept.paths[CHAIN_MOVE] &= ~(SHIFT_STEP << MOVE_SHIFT);
    ck_assert_float_eq(shift_ratio(kept.paths, kept.vertices, 1, 0), 1.0f);
}
END_TEST

/* shift_found accepts a point on the same primitive of the same instance, near the old one. Random numbers are 2^-23
 * apart, which moves a direction of density p by up to 2^-23 / p: a point that far away is accepted. One farther away
 * than a thousandth of the segment is not. */
START_TEST(test_kept_point)
{
    static const struct {
        float pdf_w, away; /* across the ray */
        uint instance, primitive;
        bool found;
    } CASES[] = {{1.0f, 0.0f, 7, 9, true},
                 {1.0f, 0.0f, 8, 9, false},
                 {1.0f, 0.0f, 7, 8, false},
                 {1.0f, 0.5e-6f, 7, 9, true},
                 {1.0f, 0.01f, 7, 9, false},
                 {1e-3f, 0x1p-23f * 1e3f, 7, 9, true},
                 {1.0f, 0x1p-23f * 1e3f, 7, 9, false},
                 {1e-3f, 0x1p-23f * 1e4f, 7, 9, false}};
    const struct {
        Vec3 o, p;
    } WALKS[] = {{vec3_splat(0.0f), vec3(0.0f, 0.0f, 1.0f)}, {vec3(0.0f, 0.0f, -2.0f), vec3(0.0f, 0.0f, 2.0f)}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; ++i)
        for (size_t k = 0; k < 2; ++k) {
            Kept kept;
            Vec3 o = WALKS[k].o, p = WALKS[k].p;
            float distance = p.z - o.z;
            uint point = shift_point(0, 2);
            kept_init(&kept, SHIFT_STEP | SHIFT_KEEPS);
            kept_walk(&kept, o, vec3(CASES[i].away * distance, 0.0f, p.z), vec3(0.0f, 0.0f, -1.0f), CASES[i].pdf_w);
            state_store_vec3(kept.vertices, 1, point, 0, p);
            kept.vertices[point + SHIFT_INSTANCE] = CASES[i].instance;
            kept.vertices[point + SHIFT_PRIMITIVE] = CASES[i].primitive;
            ck_assert_msg(kept_hit(&kept, 2) == CASES[i].found, "case %zu, distance %g", i, (double)distance);
        }
}
END_TEST

/* With the numbers that shift_guide finds, walk_scatter samples the direction to the next vertex, also if
 * numbers are relative to a light guide (second run). shift_drawn stores the density of the diffuse lobe, cosine /
 * pi. */
START_TEST(test_kept_numbers)
{
    static Scene scene;
    static Kept kept;
    unsigned state = 5;
    scene_init(&scene);
    scene.frame.scene.guide_count = (uint)_i;
    scene.guide.lights[0] = vec3(1.0f, 3.0f, -2.0f);
    scene.guide.lights_near[0] = scene.guide.lights_power[0] = 1.0f;
    scene.frame.pass.stride = 1;
    scene.frame.path.max_depth = 5;
    scene.frame.path.roulette_depth = 100;
    SceneView view = {.frame = &scene.frame, .guide = &scene.guide, .features = ~(ulong)0};
    Vertex vertex = {.p = vec3(0.5f, -0.25f, 1.0f), .beta = vec3_splat(1.0f), .back = 1.0f};
    vertex.ng = vec3_normalize(vec3(1.0f, 2.0f, 0.5f));
    vertex.frame = frame_from_normal(vertex.ng);
    vertex.wo = vec3_normalize(vec3(0.3f, 0.1f, 0.7f));
    vertex.bsdf = (Bsdf){.kind = MATERIAL_DIFFUSE, .color0 = vec3_splat(0.5f)};
    bsdf_flags_set(&vertex.bsdf);
    for (uint n = 0; n < 4000; ++n) {
        uint i = 1 + n % 2, d = 4;
        float u[6];
        WalkStep step;
        for (int k = 0; k < 6; ++k)
            u[k] = (float)test_random_unit(&state);
        Vec3 w = frame_to_world(vertex.frame, warp_cosine_hemisphere(vec2(u[0], u[1])));
        Random4 numbers = {{(uint)(u[2] * 4e9f), (uint)(u[3] * 4e9f), (uint)(u[4] * 4e9f), 0u}};
        kept_init(&kept, SHIFT_STEP | SHIFT_KEEPS);
        state_store_vec3(kept.vertices, 1, shift_point(0, i + 1), 0, vec3_mad(vertex.p, 1.0f + 3.0f * u[5], w));
        ck_assert(shift_guide(&view, kept.paths, kept.vertices, 0, i, &vertex, &numbers));
        shift_numbers_store(&scene.frame, kept.paths, 0, d, i, numbers);
        for (uint k = 0; k < 2; ++k)
            TEST_TRUE(state_load(kept.paths, 1, shift_number(&scene.frame, d, i, k), 0) == numbers.x[1 + k]);
        TEST_TRUE(walk_scatter(&view, &vertex, SIDE_CAMERA, (Roulette){1, 1.0f, 0.0f}, numbers, &step));
        TEST_NEAR(vec3_length(vec3_sub(step.ray.d, w)), 0.0, 1e-4);
        shift_drawn(&view, kept.paths, 0, &vertex, numbers, w);
        TEST_NEAR(bits_float(kept.paths[BD_SHIFT_DENSITY]), (double)vec3_dot(w, vertex.ng) / 3.14159265358979, 1e-5);
    }
    scene_destroy(&scene);
}
END_TEST

/* On a surface hit at a slant, one step of the numbers moves the point by 1 / cosine as far. */
START_TEST(test_kept_slanted)
{
    const float cosine = 1e-3f, away = 0x1p-23f / cosine; /* ten times the distance allowed across the ray */
    Kept kept;
    uint point = shift_point(0, 2);
    kept_init(&kept, SHIFT_STEP | SHIFT_KEEPS);
    kept_walk(&kept, vec3_splat(0.0f), vec3(0.0f, 0.0f, 1.0f), vec3(sqrtf(1.0f - cosine * cosine), 0.0f, cosine), 1.0f);
    state_store_vec3(kept.vertices, 1, point, 0, vec3(0.0f, 0.0f, 1.0f + away));
    kept.vertices[point + SHIFT_INSTANCE] = 7;
    kept.vertices[point + SHIFT_PRIMITIVE] = 9;
    ck_assert(kept_hit(&kept, 2));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shift");
    TCase *kept = tcase_create("kept");
    tcase_add_test(kept, test_kept_density);
    tcase_add_test(kept, test_kept_point);
    tcase_add_test(kept, test_kept_slanted);
    tcase_add_loop_test(kept, test_kept_numbers, 0, 2);
    suite_add_tcase(suite, kept);
    TCase *fins = tcase_create("fins");
    tcase_set_timeout(fins, 600);
    tcase_add_loop_test(fins, test_fins, 0, 2);
    suite_add_tcase(suite, fins);
    return test_run(suite);
}
