/* Scenes of geometry alone, random rays, and the brute-force closest hit. */
#ifndef TWINLIGHT_TESTS_SUPPORT_GEOMETRY_FIXTURE_H
#define TWINLIGHT_TESTS_SUPPORT_GEOMETRY_FIXTURE_H

#include "backend/backend.h"
#include "geometry/primitive.h"
#include "geometry/surface.h"
#include "math/rng.h"
#include "scene/scene.h"
#include "support/test_matrix.h"
#include "support/test_util.h"

/* A sequence from the program's own generator: (seed, next) determines each number. */
typedef struct TestRandom {
    uint seed, next;
} TestRandom;

float random_unit(TestRandom *random); /* (0, 1) */
float random_between(TestRandom *random, float low, float high);
Vec3 random_direction(TestRandom *random); /* uniform on the sphere */
uint random_below(TestRandom *random, uint n);

/* A triangle mesh under construction, of fixed capacity. */
typedef struct TestMesh {
    Vec3 *positions;
    uint *indices;
    size_t vertex_count, triangle_count;
} TestMesh;

TestMesh mesh_create(size_t vertices, size_t triangles);
void mesh_destroy(TestMesh *mesh);
uint mesh_vertex(TestMesh *mesh, Vec3 p);
void mesh_triangle(TestMesh *mesh, uint a, uint b, uint c);

/* A closed, star-shaped mesh around (0,0,0): rings x sectors quads of a unit sphere whose radius is scaled by a random
 * factor in [1 - rough, 1 + rough] per vertex. */
TestMesh mesh_star(uint rings, uint sectors, float rough, uint seed);
/* Triangles at random positions in the unit cube; the shortest edge has length `width`, the others `length`. */
TestMesh mesh_slivers(size_t count, float length, float width, uint seed);
/* `layers` coincident grids of side x side quads in the plane z = 0, each in a different order, in a closed box. */
TestMesh mesh_coplanar(uint side, uint layers, uint seed);
void mesh_map(TestMesh *mesh, float scale, Vec3 shift);

/* A finished scene and its view in kernels. */
typedef struct TestScene {
    Scene scene;
    BackendScene backend;
    SceneView view;
} TestScene;

void test_scene_init(TestScene *test);
void test_scene_mesh(TestScene *test, const TestMesh *mesh, uint flags);
void test_scene_quadric(TestScene *test, uint kind, Quadric quadric, const double world_from_object[16]);
/* Full and clipped spheres, disks and cylinders, `count` at random positions in the unit ball; instances of an object
 * in a larger one, with scales below `size`: some mirrored, all stretched. */
void test_scene_quadrics(TestScene *test, TestRandom *random, uint count);
/* Curves in 2^levels pieces each. */
void test_scene_curves(TestScene *test, const Curve *curves, size_t count, uint levels, uint type);
/* `count` at random places in the unit ball, some with loops and cusps, of both types. */
void test_scene_curves_random(TestScene *test, TestRandom *random, uint count);
void test_scene_instances(TestScene *test, TestRandom *random, uint object, uint count, float size);
void test_scene_finish(TestScene *test);
void test_scene_destroy(TestScene *test);

/* 4x4, row-major. Rotation about a random axis times scales in [low, high] (negative with probability 1/2 if `mirror`),
 * then a translation. */
void matrix_random(TestRandom *random, float low, float high, bool mirror, Vec3 shift, double out[16]);

/* The closest hit by testing every primitive of the world and of every instance. */
Hit brute_force(const TestScene *test, const Ray *ray);

/* triangle_query for a ray that is tested against a single triangle. */
bool triangle_intersect(Vec3 a, Vec3 b, Vec3 c, const Ray *ray, float *t, float *u, float *v);

/* Whether all members are bitwise equal. */
bool hit_same(const Hit *a, const Hit *b);

#endif
