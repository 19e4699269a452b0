/* PLY files in all variants yield the same mesh; damaged ones an error. */
#include "pbrt/test_import.h"
#include "support/test_files.h"

#include "pbrt/ply.h"

#include <string.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

/* Content of a file under construction. */
typedef struct Bytes {
    char data[4096];
    size_t size;
} Bytes;

static void text_add(Bytes *b, const char *text)
{
    size_t length = strlen(text);
    memcpy(b->data + b->size, text, length);
    b->size += length;
}

static void value_add(Bytes *b, const void *value, size_t size, bool big)
{
    for (size_t i = 0; i < size; ++i)
        b->data[b->size++] = ((const char *)value)[big ? size - 1 - i : i];
}

static const float VERTICES[4][8] = {
    {0, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0.5f, 0, 0, 1, 1, 0}, {1, 1, 0, 0, 0, 1, 1, 1}, {0, 1, -0.25f, 0, 0, 1, 0, 1}};

static void header_add(Bytes *b, const char *format, const char *uv, const char *index_type)
{
    char text[768];
    snprintf(
        text, sizeof text,
        "ply\r\nformat %s 1.0\ncomment a test\nobj_info none\nelement vertex 4\nproperty float x\nproperty float32 y\n"
        "property float z\nproperty uchar confidence\nproperty double nx\nproperty float ny\nproperty float nz\n"
        "property float %s\nproperty float %c\nelement edge 1\nproperty list uchar short ends\nelement face 2\n"
        "property list uchar %s vertex_indices\nend_header\n",
        format, uv, uv[strlen(uv) - 1] + 1, index_type);
    if (strncmp(uv, "texture_", 8) == 0) {
        char *second = strstr(text, "\nelement edge") - 1, last = *second;
        char tail[512];
        snprintf(tail, sizeof tail, "texture_%c%s", last, second + 1);
        strcpy(second, tail);
    }
    text_add(b, text);
}

static void binary_make(Bytes *b, bool big, const char *uv)
{
    b->size = 0;
    header_add(b, big ? "binary_big_endian" : "binary_little_endian", uv, "int");
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 8; ++k) {
            double d = (double)VERTICES[i][k];
            if (k == 3) {
                value_add(b, "\x7", 1, big);
                value_add(b, &d, sizeof d, big);
            } else {
                value_add(b, &VERTICES[i][k], 4, big);
            }
        }
    static const short ENDS[2] = {0, 3};
    static const int TRIANGLE[3] = {0, 1, 2}, QUAD[4] = {0, 1, 2, 3};
    value_add(b, "\x2", 1, big);
    for (int k = 0; k < 2; ++k)
        value_add(b, &ENDS[k], 2, big);
    value_add(b, "\x3", 1, big);
    for (int k = 0; k < 3; ++k)
        value_add(b, &TRIANGLE[k], 4, big);
    value_add(b, "\x4", 1, big);
    for (int k = 0; k < 4; ++k)
        value_add(b, &QUAD[k], 4, big);
}

static void ascii_make(Bytes *b, const char *uv)
{
    b->size = 0;
    header_add(b, "ascii", uv, "uint");
    for (int i = 0; i < 4; ++i) {
        char line[160];
        const float *v = VERTICES[i];
        snprintf(line, sizeof line, "%g %g %g 7 %g %g %g %g %g\r\n", (double)v[0], (double)v[1], (double)v[2],
                 (double)v[3], (double)v[4], (double)v[5], (double)v[6], (double)v[7]);
        text_add(b, line);
    }
    text_add(b, "2 0 3\n3 0 1 2\n4 0 1 2 3");
}

static void mesh_is_right(const PlyMesh *mesh)
{
    static const uint TRIANGLE[3] = {0, 1, 2}, QUAD[4] = {0, 1, 2, 3};
    ck_assert_uint_eq(mesh->vertex_count, 4);
    ck_assert_uint_eq(mesh->triangle_count, 1);
    ck_assert_uint_eq(mesh->quad_count, 1);
    ck_assert_uint_eq(mesh->small_count, 0);
    ck_assert_ptr_nonnull(mesh->normals);
    ck_assert_ptr_nonnull(mesh->uvs);
    for (int i = 0; i < 4; ++i) {
        ck_assert_mem_eq(mesh->positions + 3 * i, VERTICES[i], 12);
        ck_assert_mem_eq(mesh->normals + 3 * i, VERTICES[i] + 3, 12);
        ck_assert_mem_eq(mesh->uvs + 2 * i, VERTICES[i] + 6, 8);
    }
    ck_assert_mem_eq(mesh->triangles, TRIANGLE, sizeof TRIANGLE);
    ck_assert_mem_eq(mesh->quads, QUAD, sizeof QUAD);
}

static void read_memory(const Bytes *b, PlyMesh *mesh)
{
    Error error = {{0}, {0}};
    bool good = ply_read_memory("a.ply", (SourcePlace){0}, b->data, b->size, mesh, &error);
    ck_assert_msg(good, "%s", error.message);
}

START_TEST(every_format_gives_the_same_mesh)
{
    static const char *const UV[] = {"u", "s", "texture_u", "texture_s"};
    static Bytes bytes;
    for (int i = 0; i < 4; ++i)
        for (int format = 0; format < 3; ++format) {
            PlyMesh mesh;
            if (format == 0)
                ascii_make(&bytes, UV[i]);
            else
                binary_make(&bytes, format == 2, UV[i]);
            read_memory(&bytes, &mesh);
            mesh_is_right(&mesh);
            ply_destroy(&mesh);
            ply_destroy(&mesh);
        }
}
END_TEST

START_TEST(gzip)
{
    const char *path = test_path("a.ply.gz");
    static Bytes bytes;
    Error error = {{0}, {0}};
    PlyMesh mesh;
    binary_make(&bytes, false, "u");
    gzFile file = gzopen(path, "wb");
    ck_assert_int_eq(gzwrite(file, bytes.data, (unsigned)bytes.size), (int)bytes.size);
    gzclose(file);
    ck_assert_msg(ply_read(path, (SourcePlace){0}, &mesh, &error), "%s", error.message);
    mesh_is_right(&mesh);
    ply_destroy(&mesh);
    ck_assert_int_eq(truncate(path, 100), 0);
    ck_assert(!ply_read(path, (SourcePlace){"s.pbrt", 3, 4}, &mesh, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "s.pbrt:3:4: error: ./scratch-"));
    ck_assert_ptr_nonnull(strstr(error.message, "damaged or incomplete"));
    ck_assert_ptr_null(mesh.positions);
}
END_TEST

/* A file truncated at any length must be neither accepted nor read past its end (checked by the address sanitizer). */
START_TEST(truncation_at_every_byte)
{
    static Bytes bytes;
    for (int format = 0; format < 3; ++format) {
        if (format == 0)
            ascii_make(&bytes, "u");
        else
            binary_make(&bytes, format == 2, "u");
        for (size_t size = 0; size + 1 < bytes.size; ++size) {
            PlyMesh mesh;
            Error error = {{0}, {0}};
            char *copy = malloc(size + 1);
            memcpy(copy, bytes.data, size);
            char *exact = realloc(copy, size > 0 ? size : 1);
            ck_assert(!ply_read_memory("a.ply", (SourcePlace){0}, exact, size, &mesh, &error));
            ck_assert_ptr_null(mesh.positions);
            free(exact);
        }
    }
}
END_TEST

START_TEST(damaged_headers)
{
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"plyy\n", "not a PLY file"},
        {"ply\nformat ascii 1.0\nelement vertex 1\n", "no end_header"},
        {"ply\nformat pascii 1.0\nend_header\n", "line 2: unknown format"},
        {"ply\nend_header\n", "names no format"},
        {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "line 3: malformed property"},
        {"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "not a number below 2^32"},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n", "not a number below 2^32"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n", "unknown type"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\nend_header\n", "unknown type"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
         "no vertices"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty float x\nend_header\n", "lack a list"},
        {"ply\nformat ascii 1.0\nelement thing 1\nend_header\n", "lacks the element vertex or face"},
        {"ply\nformat ascii 1.0\nsomething\nend_header\n", "line 3: unknown keyword"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        PlyMesh mesh;
        Error error = {{0}, {0}};
        ck_assert(!ply_read_memory("a.ply", (SourcePlace){0}, cases[i].text, strlen(cases[i].text), &mesh, &error));
        ck_assert_msg(strstr(error.message, cases[i].message) != NULL, "%s", error.message);
    }
}
END_TEST

static const char PLY_SCENE[] = "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"";

static bool million_write(const char *path)
{
    enum { SIDE = 708 };
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty "
            "float z\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n",
            SIDE * SIDE, 2 * (SIDE - 1) * (SIDE - 1));
    for (int i = 0; i < SIDE * SIDE; ++i) {
        float v[3] = {(float)(i % SIDE), (float)(i / SIDE), 0.0f};
        fwrite(v, sizeof v, 1, file);
    }
    for (int i = 0; i < (SIDE - 1) * (SIDE - 1); ++i) {
        int a = i / (SIDE - 1) * SIDE + i % (SIDE - 1);
        int indices[2][3] = {{a, a + 1, a + SIDE}, {a + 1, a + SIDE + 1, a + SIDE}};
        for (int k = 0; k < 2; ++k) {
            fputc(3, file);
            fwrite(indices[k], sizeof indices[k], 1, file);
        }
    }
    return fclose(file) == 0;
}

/* A million triangles from file to scene. */
START_TEST(a_million_triangles)
{
    ck_assert(million_write(test_path("a.ply")));
    Scene scene;
    clock_t begin = clock();
    import_text_in(PLY_SCENE, test_folder, false, &scene);
    double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    printf("# a million triangles: %.2f s\n", seconds);
    ck_assert_uint_eq(scene.primitives.count, 999698);
    scene_destroy(&scene);
}
END_TEST

START_TEST(quads_become_patches)
{
    static Bytes bytes;
    binary_make(&bytes, false, "u");
    test_file_write(test_path("a.ply"), bytes.data, bytes.size);
    Scene scene;
    import_text_in(PLY_SCENE, test_folder, false, &scene);
    ck_assert_uint_eq(scene.shapes.count, 2);
    ck_assert_uint_eq(scene.primitives.count, 2);
    /* In order around the face: 0 1 2 3; as a patch: p00 p10 p01 p11. */
    static const uint WANTED[4] = {0, 1, 3, 2};
    ck_assert_mem_eq(ELEMENT(&scene, patches, Patch, 0).v, WANTED, sizeof WANTED);
    scene_destroy(&scene);
}
END_TEST

/* A concave face of five corners and a square of six, before the vertices, with a face of two corners left out. */
START_TEST(polygons_become_triangles)
{
    static const char TEXT[] = "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int vertex_indices\n"
                               "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                               "5 0 1 2 3 4\n2 0 1\n6 0 1 5 2 3 4\n"
                               "0 0 0\n2 2 0\n0 4 0\n0.5 2.5 0\n0.5 1.5 0\n1 3 0\n";
    Bytes bytes = {.size = sizeof TEXT - 1};
    memcpy(bytes.data, TEXT, bytes.size);
    PlyMesh mesh;
    read_memory(&bytes, &mesh);
    ck_assert_uint_eq(mesh.triangle_count, 3 + 4);
    ck_assert_uint_eq(mesh.quad_count, 0);
    ck_assert_uint_eq(mesh.small_count, 1);
    double area = 0.0;
    for (size_t i = 0; i < mesh.triangle_count; ++i) {
        const float *p[3];
        for (size_t k = 0; k < 3; ++k)
            p[k] = mesh.positions + 3 * mesh.triangles[3 * i + k];
        double part =
            0.5 * (double)((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
        ck_assert(part >= 0.0);
        area += part;
    }
    ck_assert_double_eq_tol(area, 2 * 2.75, 1e-6);
    ply_destroy(&mesh);
}
END_TEST

TCase *import_ply_case(void)
{
    TCase *tcase = tcase_create("ply");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, every_format_gives_the_same_mesh);
    tcase_add_test(tcase, gzip);
    tcase_add_test(tcase, truncation_at_every_byte);
    tcase_add_test(tcase, damaged_headers);
    tcase_add_test(tcase, a_million_triangles);
    tcase_add_test(tcase, quads_become_patches);
    tcase_add_test(tcase, polygons_become_triangles);
    return tcase;
}
