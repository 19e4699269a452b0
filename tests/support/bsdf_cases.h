/* Shared by the BSDF tests: a scene that has every feature, BSDFs in it, directions, random numbers. */
#ifndef TWINLIGHT_TESTS_SUPPORT_BSDF_CASES_H
#define TWINLIGHT_TESTS_SUPPORT_BSDF_CASES_H

#include "scene/coat_base_table.h"
#include "scene/coat_table.h"
#include "support/test_util.h"

#include "bsdf/bsdf.h"

/* ck_assert for loops of millions: Check records every assertion that holds. */
#define REQUIRE(condition) REQUIRE_MSG(condition, "%s", #condition)
#define REQUIRE_MSG(condition, ...)                                                                                    \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            ck_abort_msg(__VA_ARGS__);                                                                                 \
    } while (0)

#define TEST_PI 3.14159265358979323846

TCase *bsdf_coated_tests(void);
TCase *bsdf_coated_conductor_tests(void);
TCase *bsdf_coat_medium_tests(void);
TCase *bsdf_energy_tests(void);
TCase *bsdf_formula_tests(void);
TCase *bsdf_hair_tests(void);
TCase *bsdf_identity_tests(void);
TCase *bsdf_inverse_tests(void);
TCase *bsdf_mix_tests(void);
TCase *bsdf_phase_tests(void);
TCase *bsdf_sampling_tests(void);

/* SplitMix64 (Steele, Lea and Flood 2014). */
typedef struct TestRandom {
    uint64_t state;
} TestRandom;

static inline uint64_t random_next(TestRandom *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* In (0,1), 53 bits. */
static inline double random_double(TestRandom *random)
{
    return ((double)(random_next(random) >> 11) + 0.5) * 0x1p-53;
}

/* In [0,1), on the grid of floats in [0.5,1), of 24 bits. */
static inline float random_float24(TestRandom *random)
{
    return (float)(random_next(random) >> 40) * 0x1p-24f;
}

static inline Vec2 random_vec2(TestRandom *random)
{
    float x = random_float24(random);
    return vec2(x, random_float24(random));
}

/* A scene with every feature whose only data is the coats' tables. */
typedef struct TestScene {
    SceneView view;
    Array lookup;
} TestScene;

static inline void test_scene_init(TestScene *scene)
{
    *scene = (TestScene){0};
    array_init(&scene->lookup, sizeof(float));
    scene->view.features = ~(ulong)0;
}

static inline void test_scene_destroy(TestScene *scene)
{
    array_destroy(&scene->lookup);
}

/* Gives a coated conductor its record. thickness: of the coat. */
static inline void test_record_make(TestScene *scene, Bsdf *bsdf, float thickness)
{
    Error error;
    uint32_t interface;
    bool rough = (bsdf->flags & BSDF_ROUGH) != 0u;
    REQUIRE(coat_base_build(bsdf->eta, thickness, rough, &scene->lookup, &bsdf->coat_table, &error));
    if (rough)
        REQUIRE(coat_table_build(bsdf->alpha_x, bsdf->alpha_y, bsdf->eta, &scene->lookup, &interface, &error));
    scene->view.lookup = scene->lookup.data;
}

/* Added to MATERIAL_COATED_CONDUCTOR: alphas are those of the conductor, the coat is smooth; without it, both have
 * them. */
#define TEST_SMOOTH_COAT 0x100u

/* A complete Bsdf with grey colours; a rough coat gets its table. */
static inline Bsdf test_bsdf(TestScene *scene, uint kind, float alpha_x, float alpha_y, float eta, float color0,
                             float color1)
{
    Bsdf bsdf = {0};
    bool smooth_coat = (kind & TEST_SMOOTH_COAT) != 0u;
    kind &= ~TEST_SMOOTH_COAT;
    bsdf.kind = kind;
    bsdf.color0 = vec3_splat(color0);
    bsdf.color1 = vec3_splat(color1);
    bsdf.alpha_x = smooth_coat ? 0.0f : alpha_x;
    bsdf.alpha_y = smooth_coat ? 0.0f : alpha_y;
    if (kind == MATERIAL_COATED_CONDUCTOR)
        bsdf.flags = bsdf_base_pack(alpha_x, alpha_y);
    bsdf.eta = eta;
    bsdf.coat_table = NONE;
    bsdf_flags_set(&bsdf);
    if (kind == MATERIAL_COATED_DIFFUSE && (bsdf.flags & BSDF_ROUGH) != 0u) {
        Error error;
        REQUIRE(coat_table_build(alpha_x, alpha_y, eta, &scene->lookup, &bsdf.coat_table, &error));
        scene->view.lookup = scene->lookup.data;
    }
    if (kind == MATERIAL_COATED_CONDUCTOR)
        test_record_make(scene, &bsdf, 0.01f);
    return bsdf;
}

/* A unit direction `degrees` from the normal at azimuth phi (radians). */
static inline Vec3 test_direction(double degrees, double phi)
{
    double theta = degrees * TEST_PI / 180.0;
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

static inline Vec3 random_direction(TestRandom *random, double cosine)
{
    double sine = sqrt(fmax(0.0, 1.0 - cosine * cosine)), phi = 2.0 * TEST_PI * random_double(random);
    return vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
}

static const struct TestAlpha {
    float x, y;
} TEST_ALPHAS[] = {{1e-4f, 1e-4f}, {1e-3f, 1e-3f}, {0.01f, 0.01f}, {0.1f, 0.1f},
                   {0.3f, 0.3f},   {1.0f, 1.0f},   {0.05f, 0.4f}};
#define TEST_ALPHA_COUNT 7

/* Along the normal, at 45, 80 and 89.9 degrees, and below the surface. The one at 89.9 degrees lies in the xz plane,
 * where float32 directions resolve lobes of 1e-6 radians. */
static inline Vec3 test_wo(int index)
{
    static const double DEGREES[] = {0.0, 45.0, 80.0, 89.9, 180.0 - 35.0, 180.0 - 70.0};
    static const double PHI[] = {0.0, 0.7, -2.0, 0.0, 2.5, 0.3};
    return test_direction(DEGREES[index], PHI[index]);
}
#define TEST_WO_COUNT 6

/* Every material with a non-delta lobe. */
static const struct TestMaterial {
    const char *name;
    uint kind;
    float eta, color0, color1;
    int alphas; /* how many of TEST_ALPHAS, starting at the second; 1: no roughness, or the delta one */
} TEST_MATERIALS[] = {
    {"diffuse", MATERIAL_DIFFUSE, 1.0f, 0.5f, 0.0f, 1},
    {"diffuse transmission", MATERIAL_DIFFUSE_TRANSMISSION, 1.0f, 0.3f, 0.6f, 1},
    {"smooth coat", MATERIAL_COATED_DIFFUSE, 1.5f, 0.5f, 0.0f, 1},
    {"conductor", MATERIAL_CONDUCTOR, 1.0f, 0.2f, 3.9f, TEST_ALPHA_COUNT},
    {"dielectric", MATERIAL_DIELECTRIC, 1.5f, 0.0f, 0.0f, TEST_ALPHA_COUNT},
    {"dielectric 0.7", MATERIAL_DIELECTRIC, 0.7f, 0.0f, 0.0f, TEST_ALPHA_COUNT},
    {"coated", MATERIAL_COATED_DIFFUSE, 1.5f, 0.5f, 0.0f, TEST_ALPHA_COUNT},
    {"coated conductor", MATERIAL_COATED_CONDUCTOR, 1.5f, 0.2f, 3.9f, TEST_ALPHA_COUNT},
    {"smooth coat on a conductor", MATERIAL_COATED_CONDUCTOR | TEST_SMOOTH_COAT, 1.5f, 0.2f, 3.9f, TEST_ALPHA_COUNT}};
#define TEST_MATERIAL_COUNT ((int)(sizeof TEST_MATERIALS / sizeof TEST_MATERIALS[0]))

#endif
