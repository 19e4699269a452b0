/* Writes a wavy height field of 1,000,000 triangles as binary PLY, whose loading bench_render.sh times. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { COLUMNS = 1000, ROWS = 500 };

static void vertices_write(FILE *file)
{
    for (int j = 0; j <= ROWS; ++j)
        for (int i = 0; i <= COLUMNS; ++i) {
            float x = (float)i / COLUMNS, y = (float)j / ROWS;
            float p[3] = {x, y, 0.02f * sinf(40.0f * x) * cosf(30.0f * y)};
            fwrite(p, sizeof p, 1, file);
        }
}

static void face_write(FILE *file, int32_t a, int32_t b, int32_t c)
{
    uint8_t count = 3;
    int32_t indices[3] = {a, b, c};
    fwrite(&count, 1, 1, file);
    fwrite(indices, sizeof indices, 1, file);
}

static void faces_write(FILE *file)
{
    for (int32_t j = 0; j < ROWS; ++j)
        for (int32_t i = 0; i < COLUMNS; ++i) {
            int32_t a = j * (COLUMNS + 1) + i, b = a + COLUMNS + 1;
            face_write(file, a, a + 1, b + 1);
            face_write(file, a, b + 1, b);
        }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "wb") : NULL;
    if (!file) {
        fprintf(stderr, "usage: make_ply FILE\n");
        return 2;
    }
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
            "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n",
            (COLUMNS + 1) * (ROWS + 1), 2 * COLUMNS * ROWS);
    vertices_write(file);
    faces_write(file);
    return fclose(file) == 0 ? 0 : 1;
}
