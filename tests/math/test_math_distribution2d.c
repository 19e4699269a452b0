/* Piecewise-constant densities over the square. */
#include "math/test_math.h"

#include "layout/distribution.h"
#include "math/rng.h"
#include "scene/distribution_build.h"

typedef struct Table {
    Array lookup;
    Distribution2D d;
} Table;

static void table_build(Table *table, const float *weights, uint width, uint height)
{
    Error error;
    array_init(&table->lookup, sizeof(float));
    test_require(array_grow(&table->lookup, 13, &error) != NULL, "memory"); /* tables need not start at 0 */
    test_require(distribution2d_build(weights, width, height, &table->lookup, &table->d, &error), "%s", error.message);
}

static const float *table_floats(const Table *table)
{
    return table->lookup.data;
}

/* An image like a sky's: smooth, a sun a million times brighter, black rows, columns and scattered pixels. */
static void sky_fill(float *weights, uint width, uint height)
{
    uint64_t state = 40;
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x) {
            float u = test_uniform(&state);
            bool black = y % 7 == 3 || x == width - 1 || x == 0 || u < 0.1f;
            weights[y * width + x] = black ? 0.0f : 0.2f + u * (float)y / (float)height;
        }
    if (width > 5 && height > 4)
        weights[4 * width + 5] = 1e6f;
}

/* The density sums to 1, is proportional to the weights except for the 2^-23 granted to each cell, and is 0 where they
 * are 0. */
static void table_check_density(const Table *table, const float *weights)
{
    uint width = table->d.width, height = table->d.height;
    double sum = 0.0, total = 0.0, cells = (double)width * height;
    for (uint i = 0; i < width * height; ++i)
        total += (double)weights[i];
    for (uint y = 0; y < height; ++y) {
        double row = 0.0;
        for (uint x = 0; x < width; ++x)
            row += (double)weights[y * width + x];
        for (uint x = 0; x < width; ++x) {
            double probability = (double)distribution2d_cell_pdf(table_floats(table), table->d, x, y) / cells;
            double exact = (double)weights[y * width + x] / total;
            double slack = 0x1p-23 * (width * row / total + height * (row > 0.0 ? exact / (row / total) : 0.0) + 4.0);
            test_require((probability > 0.0) == (exact > 0.0), "cell (%u, %u) is lost", x, y);
            test_require(fabs(probability - exact) <= slack + 1e-6 * exact, "cell (%u, %u): %g, not %g", x, y,
                         probability, exact);
            sum += probability;
        }
    }
    test_require(fabs(sum - 1.0) < 1e-6, "the density integrates to %.9g", sum);
}

static const uint SHAPES[][2] = {{1, 1}, {1, 7}, {9, 1}, {16, 8}, {37, 23}, {64, 64}, {640, 320}};
#define SHAPE_COUNT 7

static float *shape_weights(int shape)
{
    float *weights = malloc(SHAPES[shape][0] * SHAPES[shape][1] * sizeof *weights);
    if (shape < 3)
        for (uint i = 0; i < SHAPES[shape][0] * SHAPES[shape][1]; ++i)
            weights[i] = (float)(i % 5 == 3 ? 0 : i + 1);
    else
        sky_fill(weights, SHAPES[shape][0], SHAPES[shape][1]);
    return weights;
}

START_TEST(test_density)
{
    Table table;
    float *weights = shape_weights(_i);
    table_build(&table, weights, SHAPES[_i][0], SHAPES[_i][1]);
    table_check_density(&table, weights);
    array_destroy(&table.lookup);
    free(weights);
}
END_TEST

/* The point lies in a cell of positive weight, and the density at the point is bitwise the one returned with it. */
static void sample_check(const Table *table, const float *weights, Vec2 u, double *observed)
{
    float pdf;
    Vec2 uv = distribution2d_sample(table_floats(table), table->d, u, &pdf);
    uint x = distribution_cell_of(uv.x, table->d.width), y = distribution_cell_of(uv.y, table->d.height);
    test_require(uv.x >= 0.0f && uv.x < 1.0f && uv.y >= 0.0f && uv.y < 1.0f, "(%a, %a)", (double)uv.x, (double)uv.y);
    test_require(weights[y * table->d.width + x] > 0.0f, "u (%a, %a) gives the black cell (%u, %u)", (double)u.x,
                 (double)u.y, x, y);
    float again = distribution2d_pdf(table_floats(table), table->d, uv);
    test_require(pdf > 0.0f && float_bits(pdf) == float_bits(again), "densities %a and %a", (double)pdf, (double)again);
    if (observed)
        observed[y * table->d.width + x] += 1.0;
}

START_TEST(test_samples)
{
    enum { SAMPLES = 500000 };
    uint width = SHAPES[_i][0], height = SHAPES[_i][1];
    Table table;
    float *weights = shape_weights(_i);
    table_build(&table, weights, width, height);
    double *observed = calloc(width * height, sizeof(double)), *expected = calloc(width * height, sizeof(double));
    for (uint i = 0; i < width * height; ++i)
        expected[i] = (double)distribution2d_cell_pdf(table_floats(&table), table.d, i % width, i / width) /
                      ((double)width * height) * SAMPLES;
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, (uint)_i, 8u);
        sample_check(&table, weights, vec2(random_float(r.x[0]), random_float(r.x[1])), observed);
    }
    double p = test_chi_square(observed, expected, (int)(width * height));
    test_require(p > 1e-4, "%u x %u: p = %g", width, height, p); /* 7 tests: 1e-3 after Sidak */
    static const float EDGES[] = {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f, 1.0f, -1.0f, 2.0f};
    for (int i = 0; i < 49; ++i)
        sample_check(&table, weights, vec2(EDGES[i / 7], EDGES[i % 7]), NULL);
    free(observed);
    free(expected);
    free(weights);
    array_destroy(&table.lookup);
}
END_TEST

/* Uniformity within a cell: the fractional positions of points inside the cells of a small table. */
START_TEST(test_inside_cells)
{
    enum { SIDE = 16, SAMPLES = 300000 };
    static const float WEIGHTS[] = {1.0f, 0.0f, 2.0f, 3.0f, 0.5f, 0.25f};
    static double observed[SIDE * SIDE], expected[SIDE * SIDE];
    Table table;
    table_build(&table, WEIGHTS, 3, 2);
    for (int i = 0; i < SIDE * SIDE; ++i)
        expected[i] = (double)SAMPLES / (SIDE * SIDE);
    for (uint n = 0; n < SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, 0u, 9u);
        float pdf;
        Vec2 uv = distribution2d_sample(table_floats(&table), table.d, vec2(random_float(r.x[0]), random_float(r.x[1])),
                                        &pdf);
        double x = fmod((double)uv.x * 3.0, 1.0), y = fmod((double)uv.y * 2.0, 1.0);
        observed[(int)(y * SIDE) * SIDE + (int)(x * SIDE)] += 1.0;
    }
    ck_assert(test_chi_square(observed, expected, SIDE * SIDE) > 1e-3);
    array_destroy(&table.lookup);
}
END_TEST

/* Over all 2^23 values of random_float, the fraction that falls into a cell is exactly its probability. */
START_TEST(test_exact)
{
    enum { WIDTH = 4099 };
    static float weights[WIDTH];
    static uint counts[WIDTH];
    Table table;
    uint64_t state = 41;
    for (uint x = 0; x < WIDTH; ++x)
        weights[x] = x % 3 == 0 ? 0.0f : powf(10.0f, -9.0f * test_uniform(&state));
    table_build(&table, weights, WIDTH, 1);
    for (uint k = 0; k < 1u << 23; ++k)
        ++counts[distribution_cell(table_floats(&table), table.d.first_conditional, WIDTH, random_float(k << 9))];
    for (uint x = 0; x < WIDTH; ++x) {
        const float *cdf = table_floats(&table) + table.d.first_conditional;
        test_require((cdf[x + 1] - cdf[x]) * 0x1p23f == (float)counts[x], "cell %u", x);
    }
    array_destroy(&table.lookup);
}
END_TEST

/* Every cell of tables up to the largest size: points at both ends of its interval stay within the cell. */
START_TEST(test_place)
{
    static const uint COUNTS[] = {1, 2, 3, 5, 7, 10, 97, 1000, 4095, 4096, 8191, 16384, 99991, 1048575, 1048576};
    static const float FRACTIONS[] = {0.0f, 0x1p-24f, 0.3f, 0.5f, 0x1.fffffep-1f, 1.0f};
    for (size_t c = 0; c < sizeof COUNTS / sizeof COUNTS[0]; ++c)
        for (uint cell = 0; cell < COUNTS[c]; ++cell)
            for (int f = 0; f < 6; ++f) {
                float x = distribution_place(cell, FRACTIONS[f], COUNTS[c]);
                test_require(distribution_cell_of(x, COUNTS[c]) == cell && x >= 0.0f && x < 1.0f, "%u of %u at %g: %a",
                             cell, COUNTS[c], (double)FRACTIONS[f], (double)x);
            }
}
END_TEST

START_TEST(test_cell_of_outside)
{
    ck_assert_uint_eq(distribution_cell_of(-1.0f, 5u), 0u);
    ck_assert_uint_eq(distribution_cell_of(FLOAT_INFINITY, 5u), 4u);
    ck_assert_uint_eq(distribution_cell_of(bits_float(0x7fc00000u), 5u), 0u);
    ck_assert_uint_eq(distribution_cell_of(1.0f, 5u), 4u);
}
END_TEST

START_TEST(test_all_zero)
{
    static const float ZEROS[12];
    Table table;
    table_build(&table, ZEROS, 4, 3);
    float pdf = 1.0f;
    Vec2 uv = distribution2d_sample(table_floats(&table), table.d, vec2(0.3f, 0.7f), &pdf);
    ck_assert(pdf == 0.0f && uv.x >= 0.0f && uv.x < 1.0f && uv.y >= 0.0f && uv.y < 1.0f);
    ck_assert(distribution2d_pdf(table_floats(&table), table.d, vec2(0.3f, 0.7f)) == 0.0f);
    array_destroy(&table.lookup);
}
END_TEST

START_TEST(test_refusals)
{
    static const float BAD[][2] = {{1.0f, -1.0f}, {1.0f, NAN}, {INFINITY, 1.0f}};
    Array lookup;
    Distribution2D d;
    Error error;
    array_init(&lookup, sizeof(float));
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; ++i) {
        error.message[0] = '\0';
        ck_assert(!distribution2d_build(BAD[i], 2, 1, &lookup, &d, &error));
        ck_assert(error.message[0] != '\0');
        ck_assert_uint_eq(lookup.count, 0);
    }
    ck_assert(!distribution2d_build(BAD[0], 0, 1, &lookup, &d, &error));
    ck_assert(!distribution2d_build(BAD[0], 1, 2000000, &lookup, &d, &error));
    array_destroy(&lookup);
}
END_TEST

TCase *test_math_distribution2d(void)
{
    TCase *tcase = tcase_create("distribution2d");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_loop_test(tcase, test_density, 0, SHAPE_COUNT);
    tcase_add_loop_test(tcase, test_samples, 0, SHAPE_COUNT);
    tcase_add_test(tcase, test_inside_cells);
    tcase_add_test(tcase, test_exact);
    tcase_add_test(tcase, test_place);
    tcase_add_test(tcase, test_cell_of_outside);
    tcase_add_test(tcase, test_all_zero);
    tcase_add_test(tcase, test_refusals);
    return tcase;
}
