/* NanoVDB files, made here byte by byte as the format's description has them (pbrt/nanovdb.h), and media of them. */
#include "pbrt/test_import.h"

#include "geometry/medium_grid.h"
#include "pbrt/nanovdb.h"
#include "support/test_files.h"

#include <zlib.h>

/* A grid with two leaves and a tile of the value 0.25 in front of them: x from -16 to -1, y from 8 to 15, z from 0 to
 * 15. */
enum {
    ROOT = 672 + 64,
    UPPER = ROOT + 96,
    LOWER = UPPER + 270400,
    LEAVES = LOWER + 33856,
    GRID_SIZE = LEAVES + 2 * 2144,
    META = 16,
    NAME = META + 176,
    DATA = NAME + 8
};

static char file_bytes[DATA + GRID_SIZE + 64];

/* The value that a leaf has at an index. */
static float leaf_value(const int index[3])
{
    uint hash = (uint)(index[0] * 73 + index[1] * 179 + index[2] * 283);
    return (float)(hash % 97u) * 0.01f - 0.1f;
}

/* What the file has at an index. */
static float value_at(const int index[3])
{
    if (index[0] < -16 || index[0] > -1 || index[1] < 8 || index[1] > 15 || index[2] < 0 || index[2] > 15)
        return 0.0f;
    if (index[2] < 8)
        return index[0] < -8 ? 0.25f : 0.0f;
    return leaf_value(index);
}

static void put32(size_t at, uint32_t word)
{
    memcpy(file_bytes + at, &word, sizeof word);
}

static void put64(size_t at, uint64_t word)
{
    memcpy(file_bytes + at, &word, sizeof word);
}

static void put_float(size_t at, float number)
{
    memcpy(file_bytes + at, &number, sizeof number);
}

static void put_double(size_t at, double number)
{
    memcpy(file_bytes + at, &number, sizeof number);
}

static void bit_set(size_t mask, uint i)
{
    file_bytes[mask + i / 8] = (char)(file_bytes[mask + i / 8] | 1 << i % 8);
}

static void leaf_put(size_t grid, uint number, int x)
{
    size_t lower = grid + LOWER, leaf = grid + LEAVES + 2144 * (size_t)number;
    uint child = ((uint)x & 127u) >> 3 << 8 | 1u << 4 | 1u;
    bit_set(lower + 32 + 512, child);
    put64(lower + 1088 + 8 * (size_t)child, leaf - lower);
    for (int i = 0; i < 512; ++i) {
        const int index[3] = {x + (i >> 6), 8 + (i >> 3 & 7), 8 + (i & 7)};
        put_float(leaf + 96 + 4 * (size_t)i, leaf_value(index));
    }
}

static void grid_put(size_t grid)
{
    put64(grid, 0x304244566f6e614eu);
    for (size_t i = 0; i < 3; ++i) {
        put_double(grid + 384 + 32 * i, 0.5); /* the map's diagonal, ... */
        put_double(grid + 528 + 8 * i, 10.0); /* and translation */
    }
    put_double(grid + 384 + 8, 0.25); /* x grows along y as well */
    put32(grid + 632, 2); /* fog volume */
    put32(grid + 636, 1); /* float */
    put64(grid + 672, LEAVES - 672);
    put64(grid + 680, LOWER - 672);
    put64(grid + 688, UPPER - 672);
    put64(grid + 696, ROOT - 672);
    put32(grid + 704, 2);
    put32(grid + 708, 1);
    put32(grid + 712, 1);
    const int bounds[6] = {-16, 8, 0, -1, 15, 15};
    memcpy(file_bytes + grid + ROOT, bounds, sizeof bounds);
    put32(grid + ROOT + 24, 1); /* tile: x block -1 of 4096 */
    put64(grid + ROOT + 64, (uint64_t)0xfffffu << 42);
    put64(grid + ROOT + 72, UPPER - ROOT);
    uint upper_child = 31u << 10;
    bit_set(grid + UPPER + 32 + 4096, upper_child);
    put64(grid + UPPER + 8256 + 8 * (size_t)upper_child, LOWER - UPPER);
    put_float(grid + LOWER + 1088 + 8 * (size_t)((112u >> 3) << 8 | 1u << 4), 0.25f);
    leaf_put(grid, 0, -16);
    leaf_put(grid, 1, -8);
}

/* Writes the file FOLDER/NAME with a grid called "density". */
static void nanovdb_write(const char *name, uint codec)
{
    static char packed[DATA + GRID_SIZE + 4096];
    size_t size = DATA + GRID_SIZE;
    uLongf stored = GRID_SIZE;
    memset(file_bytes, 0, sizeof file_bytes);
    put64(0, 0x304244566f6e614eu);
    put32(8, 32u << 21 | 4u << 10);
    put32(12, 1u | codec << 16);
    put64(META, GRID_SIZE);
    put64(META + 8, GRID_SIZE);
    put32(META + 136, 8);
    memcpy(file_bytes + NAME, "density", 8);
    grid_put(DATA);
    if (codec == 1) {
        stored = sizeof packed;
        ck_assert_int_eq(compress((Bytef *)packed, &stored, (const Bytef *)file_bytes + DATA, GRID_SIZE), Z_OK);
        put64(DATA, stored);
        memcpy(file_bytes + DATA + 8, packed, stored);
        put64(META + 8, stored + 8);
        size = DATA + 8 + stored;
    }
    test_file_write(test_path(name), file_bytes, size);
}

static bool grid_open(const char *file, const char *name, NanoVdb *grid, bool *found, Error *error)
{
    *error = (Error){{0}, {0}};
    return nanovdb_read(test_path(file), name, grid, found, error);
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

START_TEST(values)
{
    NanoVdb grid;
    Error error;
    bool found;
    nanovdb_write("grid.nvdb", _i == 0 ? 0 : 1);
    ck_assert_msg(grid_open("grid.nvdb", "density", &grid, &found, &error) && found, "%s", error.message);
    int index[3];
    for (index[0] = -40; index[0] < 20; ++index[0])
        for (index[1] = -10; index[1] < 30; ++index[1])
            for (index[2] = -10; index[2] < 40; ++index[2])
                TEST_TRUE(nanovdb_value(&grid, index) == value_at(index));
    const int low[3] = {-8, 8, 0}, high[3] = {-1, 15, 7}, leaf[3] = {-8, 8, 8}, tile[3] = {-9, 8, 7};
    ck_assert(nanovdb_empty(&grid, low, high));
    ck_assert(!nanovdb_empty(&grid, low, leaf));
    ck_assert(!nanovdb_empty(&grid, tile, high));
    nanovdb_destroy(&grid);
    ck_assert(grid_open("grid.nvdb", "temperature", &grid, &found, &error) && !found);
}
END_TEST

/* The medium has pbrt's box, from the lowest index to the one after the highest; negative densities count as 0. */
START_TEST(medium)
{
    Scene scene;
    nanovdb_write("grid.nvdb", 1);
    import_text_in(
        "WorldBegin Scale 2 2 2 MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"grid.nvdb\"\n"
        "\"float sigma_a\" 2 \"float sigma_s\" 3",
        test_folder, false, &scene);
    const MediumGrid *grid = &ELEMENT(&scene, grids, MediumGrid, 0);
    const SceneView view = {.grids = grid, .texels = scene.texels.data};
    float largest = 0.86f;
    ck_assert_uint_eq(grid->size_x, 16);
    ck_assert_uint_eq(grid->size_y, 8);
    ASSERT_FLOAT(grid->low, 1.0f);
    assert_vec3(ELEMENT(&scene, media, Medium, 1).extinction, 5.0f * largest, 5.0f * largest, 5.0f * largest, 1e-5f);
    assert_vec3(affine_point(grid->grid_from_world, vec3(2.0f * 4.0f, 2.0f * 14.0f, 2.0f * 10.0f)), 1.0f, 1.0f, 1.0f,
                1e-4f);
    int index[3];
    for (index[0] = -16; index[0] < 0; ++index[0])
        for (index[1] = 8; index[1] < 16; ++index[1])
            for (index[2] = 0; index[2] < 16; ++index[2]) {
                Vec3 p = vec3(20.0f + (float)index[0] + 0.5f * (float)index[1], 20.0f + (float)index[1],
                              20.0f + (float)index[2]);
                double expected = fmax((double)value_at(index) / (double)largest, 0.0);
                TEST_NEAR(grid_factors(&view, 0u, p, false).x, expected, 1e-4);
            }
    scene_destroy(&scene);
}
END_TEST

/* A grid of temperatures makes it emit, by its own map, unless Lescale is 0 or there is none. Older
 * files call it LeScale. */
START_TEST(temperature)
{
    static const char *const PARAMETERS[] = {"\"string temperaturename\" \"density\" \"float Lescale\" 4",
                                             "\"string temperaturename\" \"density\" \"float Lescale\" 0", "",
                                             "\"string temperaturename\" \"density\" \"float LeScale\" 4"};
    nanovdb_write("grid.nvdb", 1);
    for (int i = 0; i < 4; ++i) {
        bool hot = i % 3 == 0;
        char text[512];
        Scene scene;
        snprintf(text, sizeof text,
                 "WorldBegin MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"grid.nvdb\"\n"
                 "\"float sigma_a\" 2 \"float temperaturecutoff\" 0.1 \"float temperaturescale\" 1000 %s",
                 PARAMETERS[i]);
        import_text_in(text, test_folder, false, &scene);
        const MediumGrid *grid = &ELEMENT(&scene, grids, MediumGrid, 0);
        float emission = hot ? 2.0f * 0.86f * 4.0f : 0.0f;
        assert_vec3(ELEMENT(&scene, media, Medium, 1).emission, emission, emission, emission, 1e-5f);
        ck_assert_uint_eq(grid->emission, hot ? 2 : 0);
        ck_assert_uint_eq(scene.grids.count, hot ? 2 : 1);
        if (hot) {
            TEST_NEAR(grid[1].kelvin_scale, 860.0, 1e-3);
            TEST_NEAR(grid[1].kelvin_offset, -100.0, 1e-3);
            ck_assert_uint_eq(grid[1].aligned, 1);
        }
        scene_destroy(&scene);
    }
}
END_TEST

/* ---- bad files --------------------------------------------------------------------------------------------------- */

static void refused(const char *part)
{
    NanoVdb grid;
    Error error;
    bool found;
    test_file_write(test_path("bad.nvdb"), file_bytes, DATA + GRID_SIZE);
    ck_assert_msg(!grid_open("bad.nvdb", "density", &grid, &found, &error), "accepted: %s", part);
    ck_assert_msg(strstr(error.message, part) != NULL, "%s, not %s", error.message, part);
    ck_assert(error.fix[0] != '\0');
}

START_TEST(refusals)
{
    const struct {
        size_t at;
        uint32_t word;
        const char *part;
    } cases[] = {{0, 0, "not a NanoVDB file"},
                 {8, 31u << 21, "version 31, not 32"},
                 {12, 1u | 2u << 16, "Blosc"},
                 {DATA + 636, 2, "not of 32-bit floats"},
                 {DATA + 632, 1, "is a level set"},
                 {META, 100, "damaged"},
                 {META + 8, GRID_SIZE + 1, "damaged"},
                 {META + 136, 0, "damaged"},
                 {META + 136, 0xfffffff0u, "damaged"},
                 {DATA + 696, GRID_SIZE, "damaged"},
                 {DATA + ROOT + 24, 1u << 28, "damaged"},
                 {DATA + ROOT + 72, LOWER - ROOT, "damaged"},
                 {DATA + UPPER + 8256 + 8 * (31 << 10), LOWER - UPPER + 4, "damaged"},
                 {DATA + 704, 1, "damaged"},
                 {DATA + 708, 2, "damaged"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nanovdb_write("grid.nvdb", 0);
        put32(cases[i].at, cases[i].word);
        refused(cases[i].part);
    }
}
END_TEST

/* Files that end too early, and ones with wrong bytes in their headers and nodes: an error or a grid, whose values can
 * be asked for. */
START_TEST(damage)
{
    NanoVdb grid;
    Error error;
    bool found;
    uint state = 1;
    for (size_t size = 0; size < DATA + GRID_SIZE; size += size < 2000 ? 97 : 30011) {
        nanovdb_write("grid.nvdb", 0);
        test_file_write(test_path("bad.nvdb"), file_bytes, size);
        ck_assert(!grid_open("bad.nvdb", "density", &grid, &found, &error));
    }
    for (int i = 0; i < 400; ++i) {
        static const size_t BEGINS[4] = {0, DATA + 600, DATA + UPPER + 8256 + 8 * (31 << 10), DATA + LOWER + 32 + 512};
        nanovdb_write("grid.nvdb", (uint)i % 8 == 7);
        for (int k = 0; k < 3; ++k) {
            state = state * 1664525u + 1013904223u;
            file_bytes[BEGINS[i % 4] + (state >> 8) % 240u] = (char)(state >> 24);
        }
        test_file_write(test_path("bad.nvdb"), file_bytes, DATA + GRID_SIZE);
        if (!grid_open("bad.nvdb", "density", &grid, &found, &error) || !found)
            continue;
        int index[3] = {-16, 8, 0};
        for (; index[0] < 0; ++index[0])
            nanovdb_value(&grid, index);
        nanovdb_destroy(&grid);
    }
}
END_TEST

START_TEST(messages)
{
    static const char *const PARTS[][2] = {
        {"", "lacks \"string filename\""},
        {"\"string filename\" \"none.nvdb\"", "cannot read"},
        {"\"string filename\" \"grid.nvdb\" \"string gridname\" \"smoke\"", "has no grid \"smoke\""},
        {"\"string filename\" \"grid.nvdb\" \"float temperaturescale\" -1", "\"temperaturescale\" of the medium"},
        {"\"string filename\" \"grid.nvdb\" \"float temperaturescale\" 1e38 \"float temperatureoffset\" 9",
         "temperatures of the medium \"m\" overflow"}};
    nanovdb_write("grid.nvdb", 0);
    for (size_t i = 0; i < sizeof PARTS / sizeof *PARTS; ++i) {
        char text[256];
        Scene scene;
        Error error = {{0}, {0}};
        const ImportOptions options = {.lenient = false};
        snprintf(text, sizeof text, "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" %s\nWorldBegin", PARTS[i][0]);
        scene_init(&scene);
        ck_assert(!pbrt_import_text(text, strlen(text), "test", test_folder, &options, &scene, &error));
        scene_destroy(&scene);
        ck_assert_msg(strstr(error.message, PARTS[i][1]) && strstr(error.message, "test:1:"), "%s", error.message);
        ck_assert(error.fix[0] != '\0');
    }
}
END_TEST

TCase *import_nanovdb_case(void)
{
    TCase *tcase = tcase_create("nanovdb");
    tcase_set_timeout(tcase, 60);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_loop_test(tcase, values, 0, 2);
    tcase_add_test(tcase, medium);
    tcase_add_test(tcase, temperature);
    tcase_add_test(tcase, refusals);
    tcase_add_test(tcase, damage);
    tcase_add_test(tcase, messages);
    return tcase;
}
