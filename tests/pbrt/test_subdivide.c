/* Loop subdivision and the triangulation of polygons. */
#include "pbrt/polygon.h"
#include "pbrt/subdivide.h"
#include "pbrt/test_import.h"

#include <math.h>
#include <string.h>

static SubdividedMesh divide(const float *positions, size_t vertices, const uint *indices, size_t triangles,
                             unsigned levels)
{
    SubdividedMesh mesh;
    Error error = {0};
    ck_assert_msg(subdivide_loop(positions, vertices, indices, triangles, levels, &mesh, &error), "%s", error.message);
    return mesh;
}

/* An octahedron with one corner pulled out and a tetrahedron: valences 4 and 3. */
static const float OCTAHEDRON[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 2, 0, 0, -1};
static const uint OCTAHEDRON_FACES[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
static const float TETRAHEDRON[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
static const uint TETRAHEDRON_FACES[12] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};

/* Subdivision does not move the limit: the control mesh's vertices end where they would after any number of levels. */
START_TEST(limits_do_not_depend_on_levels)
{
    for (unsigned levels = 0; levels <= 5; ++levels) {
        SubdividedMesh coarse = divide(OCTAHEDRON, 6, OCTAHEDRON_FACES, 8, 0);
        SubdividedMesh fine = divide(OCTAHEDRON, 6, OCTAHEDRON_FACES, 8, levels);
        for (int i = 0; i < 18; ++i)
            ASSERT_NEAR(fine.positions[i], coarse.positions[i], 2e-6f);
        subdivided_destroy(&coarse);
        subdivided_destroy(&fine);
        coarse = divide(TETRAHEDRON, 4, TETRAHEDRON_FACES, 4, 0);
        fine = divide(TETRAHEDRON, 4, TETRAHEDRON_FACES, 4, levels);
        /* 1 / (3 + 3 / (8 * 3/16)) = 1/5: 2/5 of the corner, 1/5 of each other */
        ASSERT_NEAR(coarse.positions[0], 0.4f + 0.2f * (1 - 1 - 1), 1e-6f);
        for (int i = 0; i < 12; ++i)
            ASSERT_NEAR(fine.positions[i], coarse.positions[i], 2e-6f);
        subdivided_destroy(&coarse);
        subdivided_destroy(&fine);
    }
}
END_TEST

/* Euler's formula, and every edge of a closed surface once in either direction. */
START_TEST(closed_surfaces_stay_closed)
{
    SubdividedMesh mesh = divide(OCTAHEDRON, 6, OCTAHEDRON_FACES, 8, 3);
    ck_assert_uint_eq(mesh.triangle_count, 8 * 64);
    ck_assert_uint_eq(mesh.vertex_count, 2 + 8 * 64 / 2);
    static unsigned char seen[258][258];
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < mesh.triangle_count; ++i)
        for (size_t k = 0; k < 3; ++k) {
            uint a = mesh.indices[3 * i + k], b = mesh.indices[3 * i + (k + 1) % 3];
            ck_assert(a < 258 && b < 258 && a != b && !seen[a][b]);
            seen[a][b] = 1;
        }
    for (size_t a = 0; a < 258; ++a)
        for (size_t b = 0; b < 258; ++b)
            ck_assert_uint_eq(seen[a][b], seen[b][a]);
    subdivided_destroy(&mesh);
}
END_TEST

/* Normals agree with the triangles around: pbrt's point inward where triangles go around counterclockwise. */
START_TEST(normals_follow_the_surface)
{
    SubdividedMesh mesh = divide(OCTAHEDRON, 6, OCTAHEDRON_FACES, 8, 5);
    for (size_t i = 0; i < mesh.triangle_count; ++i) {
        Vec3 p[3];
        for (size_t k = 0; k < 3; ++k)
            memcpy(&p[k], mesh.positions + 3 * mesh.indices[3 * i + k], sizeof p[k]);
        Vec3 ng = vec3_normalize(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
        for (size_t k = 0; k < 3; ++k) {
            Vec3 n;
            memcpy(&n, mesh.normals + 3 * mesh.indices[3 * i + k], sizeof n);
            float cosine = vec3_dot(vec3_normalize(n), ng);
            ck_assert_msg(cosine < -0.9f, "cosine %g", (double)cosine);
        }
    }
    subdivided_destroy(&mesh);
}
END_TEST

/* A flat grid, shifted: stays flat, linear inside, with normals across; the boundary follows pbrt's weights. */
START_TEST(flat_grids_stay_flat)
{
    enum { SIDE = 5 };
    float positions[3 * SIDE * SIDE];
    uint indices[6 * (SIDE - 1) * (SIDE - 1)], *out = indices;
    for (uint i = 0; i < SIDE * SIDE; ++i) {
        positions[3 * i] = (float)(i % SIDE);
        positions[3 * i + 1] = (float)(i / SIDE);
        positions[3 * i + 2] = 7.0f;
    }
    for (uint y = 0; y + 1 < SIDE; ++y)
        for (uint x = 0; x + 1 < SIDE; ++x, out += 6) {
            uint a = y * SIDE + x;
            const uint quad[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
            memcpy(out, quad, sizeof quad);
        }
    for (unsigned levels = 0; levels < 4; ++levels) {
        SubdividedMesh mesh = divide(positions, SIDE * SIDE, indices, 2 * (SIDE - 1) * (SIDE - 1), levels);
        uint middle = 2 * SIDE + 2;
        ASSERT_NEAR(mesh.positions[3 * middle], 2.0f, 1e-6f);
        ASSERT_NEAR(mesh.positions[3 * middle + 1], 2.0f, 1e-6f);
        for (size_t v = 0; v < mesh.vertex_count; ++v) {
            ASSERT_NEAR(mesh.positions[3 * v + 2], 7.0f, 1e-5f);
            ASSERT_NEAR(mesh.normals[3 * v] / mesh.normals[3 * v + 2], 0.0f, 1e-4f);
            ASSERT_NEAR(mesh.normals[3 * v + 1] / mesh.normals[3 * v + 2], 0.0f, 1e-4f);
            ck_assert_msg(mesh.normals[3 * v + 2] < 0.0f, "level %u, vertex %zu of %zu at %g %g: normal %g", levels, v,
                          mesh.vertex_count, (double)mesh.positions[3 * v], (double)mesh.positions[3 * v + 1],
                          (double)mesh.normals[3 * v + 2]);
        }
        if (levels == 0) /* a corner: 3/5 of it and 1/5 of its neighbours along the boundary */
            ASSERT_NEAR(mesh.positions[0], 0.2f, 1e-6f);
        subdivided_destroy(&mesh);
    }
}
END_TEST

static void refused(const uint *indices, size_t triangles, unsigned levels, const char *text)
{
    SubdividedMesh mesh;
    Error error = {0};
    ck_assert(!subdivide_loop(OCTAHEDRON, 6, indices, triangles, levels, &mesh, &error));
    ck_assert_ptr_nonnull(strstr(error.message, text));
    ck_assert_ptr_null(mesh.positions);
}

START_TEST(surfaces_that_are_refused)
{
    static const uint THREE[9] = {0, 1, 2, 1, 0, 3, 0, 1, 4}, TURNED[6] = {0, 1, 2, 0, 1, 3}, TWICE[3] = {1, 1, 2};
    refused(THREE, 3, 1, "the edge between vertices 0 and 1 has more than two triangles");
    refused(TURNED, 2, 1, "triangles 0 and 1 have different orientations");
    refused(TWICE, 1, 1, "triangle 0 uses a vertex twice");
    refused(OCTAHEDRON_FACES, 8, 11, "11 levels of subdivision would make more than 16777216 triangles");
    refused(OCTAHEDRON_FACES, 8, 4000000000u, "levels of subdivision");
}
END_TEST

START_TEST(loopsubdiv_becomes_a_mesh)
{
    Scene scene;
    import_world("Scale 2 2 2 Shape \"loopsubdiv\" \"integer levels\" 2 \"string scheme\" \"loop\"\n"
                 "\"integer indices\" [ 0 1 2 0 3 1 0 2 3 1 3 2 ]\n"
                 "\"point3 P\" [ 1 1 1  1 -1 -1  -1 1 -1  -1 -1 1 ]",
                 &scene);
    ck_assert_uint_eq(scene.primitives.count, 64);
    ck_assert_uint_eq(scene.positions.count, 34);
    ck_assert_uint_eq(scene.normals.count, 34);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 0), 0.4f, 0.4f, 0.4f, 1e-5f);
    ASSERT_NEAR(vec3_length(ELEMENT(&scene, normals, Vec3, 20)), 1.0f, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

/* ---- polygons ---------------------------------------------------------------------------------------------------- */

static double triangle_area(const float *positions, const uint *t, int axis)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float *a = positions + 3 * t[0], *b = positions + 3 * t[1], *c = positions + 3 * t[2];
    return 0.5 * (((double)b[u] - (double)a[u]) * ((double)c[v] - (double)a[v]) -
                  ((double)b[v] - (double)a[v]) * ((double)c[u] - (double)a[u]));
}

/* Triangulates corners 0 ... count - 1; every triangle must have the orientation of the polygon, and their areas add up
 * to its area: together, they cover it once. */
static void polygon_check(const float *positions, size_t count, int axis, double area)
{
    uint corner[64] = {0}, triangles[3 * 64], scratch[3 * 64];
    double sum = 0.0;
    for (uint i = 0; i < count; ++i)
        corner[i] = i;
    ck_assert(polygon_triangulate(positions, corner, count, triangles, scratch));
    for (size_t i = 0; i + 2 < count; ++i) {
        double part = triangle_area(positions, triangles + 3 * i, axis);
        ck_assert_msg(part * area >= 0.0, "triangle %zu of %zu has area %g", i, count - 2, part);
        sum += part;
    }
    ck_assert_double_eq_tol(sum, area, 1e-5 * fabs(area));
}

START_TEST(polygons)
{
    static const float ARROW[15] = {0, 0, 5, 2, 2, 5, 0, 4, 5, 0.5f, 2.5f, 5, 0.5f, 1.5f, 5};
    static const float COMB[36] = {0, 0, 0, 5, 0, 0, 5, 3, 0, 4, 3, 0, 4, 1, 0, 3, 1, 0,
                                   3, 3, 0, 2, 3, 0, 2, 1, 0, 1, 1, 0, 1, 3, 0, 0, 3, 0};
    static const float PENTAGON[15] = {0, 0, 0, 1, 0, 0, 1.5f, 1, 0, 0.5f, 2, 0, -0.5f, 1, 0};
    float turned[36], reversed[36];
    polygon_check(PENTAGON, 5, 2, 2.5);
    polygon_check(ARROW, 5, 2, 2.75);
    polygon_check(COMB, 12, 2, 11.0);
    for (int i = 0; i < 36; ++i) {
        turned[i] = COMB[3 * (i / 3) + (i + 1) % 3]; /* x to z, seen along y */
        reversed[i] = COMB[3 * (11 - i / 3) + i % 3];
    }
    polygon_check(turned, 12, 1, 11.0);
    polygon_check(reversed, 12, 2, -11.0);
}
END_TEST

/* A spiral of many corners, and polygons that cross themselves or have no area: some triangles of their corners. */
START_TEST(odd_polygons)
{
    float spiral[3 * 64], crossed[15] = {0, 0, 0, 2, 2, 0, 2, 0, 0, 0, 2, 0, -1, 1, 0}, line[15] = {0};
    uint corner[5] = {0, 1, 2, 3, 4}, triangles[9], scratch[15];
    double area = 0.0;
    for (int i = 0; i < 64; ++i) {
        double turn = 0.3 * (i < 32 ? i : 63 - i), r = (i < 32 ? 1.2 : 1.0) * (1.0 + 0.2 * turn);
        spiral[3 * i] = (float)(r * cos(turn));
        spiral[3 * i + 1] = (float)(r * sin(turn));
        spiral[3 * i + 2] = 0.0f;
    }
    for (int i = 0; i < 64; ++i) {
        const float *p = spiral + 3 * i, *q = spiral + 3 * ((i + 1) % 64);
        area += 0.5 * ((double)p[0] * (double)q[1] - (double)p[1] * (double)q[0]);
    }
    polygon_check(spiral, 64, 2, area);
    for (int i = 0; i < 5; ++i)
        line[3 * i] = (float)(i % 3);
    ck_assert(polygon_triangulate(crossed, corner, 5, triangles, scratch));
    ck_assert(polygon_triangulate(line, corner, 5, triangles, scratch));
    for (int i = 0; i < 9; ++i)
        ck_assert_uint_lt(triangles[i], 5);
}
END_TEST

TCase *import_subdivide_case(void)
{
    TCase *tcase = tcase_create("subdivision and polygons");
    tcase_add_test(tcase, limits_do_not_depend_on_levels);
    tcase_add_test(tcase, closed_surfaces_stay_closed);
    tcase_add_test(tcase, normals_follow_the_surface);
    tcase_add_test(tcase, flat_grids_stay_flat);
    tcase_add_test(tcase, surfaces_that_are_refused);
    tcase_add_test(tcase, loopsubdiv_becomes_a_mesh);
    tcase_add_test(tcase, polygons);
    tcase_add_test(tcase, odd_polygons);
    return tcase;
}
