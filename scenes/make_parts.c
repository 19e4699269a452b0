/* Makes what the scenes cannot say in a few lines of their own, in a folder's parts/: vessels turned on a lathe, rings,
 * a pane of uneven glass, the normals of hammered metal, and the sun. usage: make_parts FOLDER */
#include "image/color.h"
#include "image/exr.h"
#include "image/png_write.h"
#include "math/warp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TAU 6.283185307179586

typedef struct Vertex {
    double p[3], n[3], uv[2];
} Vertex;

/* Vertex (i, j) of a grid of columns x rows, both counted in quads. */
typedef struct Grid {
    int columns, rows;
    Vertex (*vertex)(const void *shape, int i, int j);
    const void *shape;
    bool tip_first, tip_last; /* the first, the last row is one point */
} Grid;

/* A profile turned about the y axis: a Catmull-Rom spline through points (r, y), from the outer side of the foot up;
 * the surface faces right of the way. */
typedef struct Lathe {
    const double (*points)[2];
    int count;
    double u_repeat, v_repeat; /* texture coordinates go from 0 to these */
    int first, last; /* only from point first to point last; last 0: to the end */
} Lathe;

enum { LATHE_SEGMENTS = 36, LATHE_STEPS = 2 };

#define POINTS(array) array, (int)(sizeof array / sizeof *array)

/* ---- the lathe --------------------------------------------------------------------------------------------------- */

/* Point i of the profile; beyond an end on the axis its mirror image, so that the tip is smooth, else a straight
 * way. */
static void profile_point(const Lathe *lathe, int i, double p[2])
{
    int end = i < 0 ? 0 : lathe->count - 1, next = i < 0 ? 1 : lathe->count - 2;
    const double(*points)[2] = lathe->points;
    if (i >= 0 && i < lathe->count) {
        p[0] = points[i][0];
        p[1] = points[i][1];
    } else if (points[end][0] == 0.0) {
        p[0] = -points[next][0];
        p[1] = points[next][1];
    } else {
        p[0] = 2.0 * points[end][0] - points[next][0];
        p[1] = 2.0 * points[end][1] - points[next][1];
    }
}

/* Point and tangent at step j. */
static void profile_at(const Lathe *lathe, int j, double p[2], double tangent[2])
{
    int span = j / LATHE_STEPS < lathe->count - 1 ? j / LATHE_STEPS : lathe->count - 2;
    double t = (double)(j - span * LATHE_STEPS) / LATHE_STEPS, k[4][2];
    for (int i = 0; i < 4; ++i)
        profile_point(lathe, span + i - 1, k[i]);
    for (int c = 0; c < 2; ++c) {
        double a = 2.0 * k[1][c], b = k[2][c] - k[0][c];
        double d = 2.0 * k[0][c] - 5.0 * k[1][c] + 4.0 * k[2][c] - k[3][c];
        double e = -k[0][c] + 3.0 * k[1][c] - 3.0 * k[2][c] + k[3][c];
        p[c] = 0.5 * (a + t * (b + t * (d + t * e)));
        tangent[c] = 0.5 * (b + t * (2.0 * d + t * 3.0 * e));
    }
}

static Vertex lathe_vertex(const void *shape, int i, int j)
{
    const Lathe *lathe = shape;
    double p[2], tangent[2], angle = TAU * (i % LATHE_SEGMENTS) / LATHE_SEGMENTS;
    profile_at(lathe, LATHE_STEPS * lathe->first + j, p, tangent);
    double r = p[0] > 1e-9 ? p[0] : 0.0, length = hypot(tangent[0], tangent[1]);
    double outward = tangent[1] / length, up = -tangent[0] / length;
    return (Vertex){.p = {r * cos(angle), p[1], r * sin(angle)},
                    .n = {outward * cos(angle), up, outward * sin(angle)},
                    .uv = {lathe->u_repeat * (LATHE_SEGMENTS - i) / LATHE_SEGMENTS,
                           lathe->v_repeat * j / (LATHE_STEPS * (lathe->last - lathe->first))}};
}

/* ---- the pane ---------------------------------------------------------------------------------------------------- */

enum { PANE_COLUMNS = 24, PANE_ROWS = 28 };
static const double PANE_STEP = 0.025, PANE_THICKNESS = 0.004;

/* Waves of the uneven side: wave numbers along x and y, phase, and height in metres. Their curvatures bring sunlight
 * together 1 to 4 m behind the pane. */
static const double WAVES[][4] = {{52, 9, 0.3, 2.1e-4},  {31, -14, 1.9, 4.5e-4}, {-24, 38, 4.0, 3.0e-4},
                                  {12, 47, 2.2, 2.4e-4}, {18, 7, 5.1, 9.0e-4},   {66, -31, 0.9, 1.0e-4}};

static Vertex pane_vertex(const void *shape, int i, int j)
{
    (void)shape;
    double x = PANE_STEP * (PANE_COLUMNS - i), y = PANE_STEP * j, z = PANE_THICKNESS, slope_x = 0.0, slope_y = 0.0;
    for (size_t w = 0; w < sizeof WAVES / sizeof *WAVES; ++w) {
        double phase = WAVES[w][0] * x + WAVES[w][1] * y + WAVES[w][2];
        z += WAVES[w][3] * sin(phase);
        slope_x += WAVES[w][3] * WAVES[w][0] * cos(phase);
        slope_y += WAVES[w][3] * WAVES[w][1] * cos(phase);
    }
    double length = sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
    return (Vertex){.p = {x, y, z}, .n = {-slope_x / length, -slope_y / length, 1.0 / length}, .uv = {x, y}};
}

/* ---- rings ------------------------------------------------------------------------------------------------------- */

enum { RING_COLUMNS = 96, RING_ROWS = 32 };

/* An ellipse of half axes `across` and `up` turned about the y axis at a distance `radius`. */
typedef struct Ring {
    double radius, across, up;
} Ring;

static Vertex ring_vertex(const void *shape, int i, int j)
{
    const Ring *ring = shape;
    double around = TAU * (i % RING_COLUMNS) / RING_COLUMNS, angle = TAU * (j % RING_ROWS) / RING_ROWS;
    double r = ring->radius + ring->across * cos(angle), nr = ring->up * cos(angle), ny = ring->across * sin(angle);
    double length = hypot(nr, ny);
    return (Vertex){.p = {r * cos(around), ring->up * sin(angle), r * sin(around)},
                    .n = {nr / length * cos(around), ny / length, nr / length * sin(around)},
                    .uv = {(double)i / RING_COLUMNS, (double)j / RING_ROWS}};
}

static const Ring BAND = {0.01, 0.0008, 0.003}, TORUS = {0.022, 0.008, 0.008};

/* ---- files ------------------------------------------------------------------------------------------------------- */

static void grid_header_write(const Grid *grid, FILE *file)
{
    fprintf(file, "ply\nformat ascii 1.0\ncomment Drawn for Twinlight by scenes/make_parts.c; Apache-2.0\n");
    fprintf(file, "element vertex %d\n", (grid->columns + 1) * (grid->rows + 1));
    for (const char *name = "xyz"; *name; ++name)
        fprintf(file, "property float %c\n", *name);
    for (const char *name = "xyz"; *name; ++name)
        fprintf(file, "property float n%c\n", *name);
    fprintf(file, "property float u\nproperty float v\nelement face %d\nproperty list uchar int vertex_indices\n",
            grid->columns * (2 * grid->rows - grid->tip_first - grid->tip_last));
    fprintf(file, "end_header\n");
}

/* x in units of `unit`, without the sign of a zero. */
static void number_write(FILE *file, double x, double unit, char after)
{
    double rounded = round(x / unit) * unit;
    fprintf(file, "%.6g%c", rounded == 0.0 ? 0.0 : rounded, after);
}

static bool grid_write(const Grid *grid, const char *folder, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/parts/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    grid_header_write(grid, file);
    for (int j = 0; j <= grid->rows; ++j)
        for (int i = 0; i <= grid->columns; ++i) {
            Vertex v = grid->vertex(grid->shape, i, j);
            const double *numbers[] = {v.p, v.n, v.uv};
            for (int k = 0; k < 8; ++k)
                number_write(file, numbers[k / 3][k % 3], k < 3 ? 1e-5 : 1e-4, k < 7 ? ' ' : '\n');
        }
    for (int j = 0; j < grid->rows; ++j)
        for (int i = 0; i < grid->columns; ++i) {
            int a = j * (grid->columns + 1) + i, b = a + grid->columns + 1;
            if (j < grid->rows - 1 || !grid->tip_last)
                fprintf(file, "3 %d %d %d\n", a, b, b + 1);
            if (j > 0 || !grid->tip_first)
                fprintf(file, "3 %d %d %d\n", a, b + 1, a + 1);
        }
    return fclose(file) == 0;
}

static bool lathe_write(Lathe lathe, const char *folder, const char *name)
{
    lathe.last = lathe.last > 0 ? lathe.last : lathe.count - 1;
    Grid grid = {.columns = LATHE_SEGMENTS,
                 .rows = LATHE_STEPS * (lathe.last - lathe.first),
                 .vertex = lathe_vertex,
                 .shape = &lathe,
                 .tip_first = lathe.points[lathe.first][0] == 0.0,
                 .tip_last = lathe.points[lathe.last][0] == 0.0};
    return grid_write(&grid, folder, name);
}

/* ---- vessels: points (r, y) in metres ---------------------------------------------------------------------------- */

/* A jar with its lid and a knob, closed. */
static const double JAR[][2] = {{0, 0},         {0.05, 0},      {0.066, 0.001}, {0.072, 0.006}, {0.1, 0.035},
                                {0.135, 0.1},   {0.14, 0.16},   {0.118, 0.215}, {0.088, 0.242}, {0.083, 0.247},
                                {0.089, 0.251}, {0.087, 0.258}, {0.06, 0.275},  {0.025, 0.287}, {0.013, 0.296},
                                {0.021, 0.309}, {0.017, 0.322}, {0, 0.327}};

/* A tall vase of solid section as far as light is concerned: its inside is a dark hole of a finger's depth. */
static const double VASE[][2] = {{0, 0},         {0.05, 0},     {0.063, 0.001}, {0.068, 0.006}, {0.064, 0.03},
                                 {0.074, 0.1},   {0.105, 0.2},  {0.122, 0.29},  {0.112, 0.37},  {0.07, 0.44},
                                 {0.042, 0.49},  {0.039, 0.53}, {0.052, 0.565}, {0.055, 0.57},  {0.052, 0.573},
                                 {0.046, 0.565}, {0.034, 0.53}, {0.03, 0.5},    {0, 0.49}};

/* A bottle of glass, outside and inside. */
static const double BOTTLE[][2] = {{0, 0},          {0.035, 0},      {0.041, 0.002},  {0.0435, 0.008}, {0.044, 0.05},
                                   {0.044, 0.12},   {0.043, 0.165},  {0.034, 0.195},  {0.02, 0.222},   {0.0155, 0.26},
                                   {0.0155, 0.295}, {0.018, 0.3},    {0.0182, 0.308}, {0.0155, 0.311}, {0.0125, 0.308},
                                   {0.0122, 0.29},  {0.0122, 0.258}, {0.0165, 0.222}, {0.029, 0.195},  {0.0375, 0.165},
                                   {0.0385, 0.12},  {0.0385, 0.05},  {0.038, 0.014},  {0.034, 0.009},  {0, 0.008}};

/* A shallow bowl of beaten metal, outside and inside. */
static const double BOWL[][2] = {{0, 0},         {0.06, 0},      {0.085, 0.001}, {0.1, 0.006},   {0.15, 0.035},
                                 {0.2, 0.085},   {0.228, 0.135}, {0.24, 0.16},   {0.242, 0.164}, {0.239, 0.1655},
                                 {0.234, 0.162}, {0.222, 0.137}, {0.194, 0.089}, {0.146, 0.041}, {0.095, 0.013},
                                 {0.05, 0.007},  {0, 0.006}};

/* Vessels with water: outside, and inside down to the water and below it. The glass's surface in air ends at the point
 * of the waterline, its surface in water begins there, and so does the water's, which the glass draws up a little. */
static const double GOBLET[][2] = {
    {0, 0},           {0.028, 0},       {0.0355, 0.0006}, {0.0375, 0.002},  {0.0355, 0.0034}, {0.021, 0.0056},
    {0.0095, 0.0095}, {0.0055, 0.017},  {0.0043, 0.032},  {0.0042, 0.055},  {0.005, 0.077},   {0.0095, 0.09},
    {0.0225, 0.1005}, {0.035, 0.118},   {0.0405, 0.139},  {0.0405, 0.158},  {0.0375, 0.182},  {0.0352, 0.198},
    {0.0347, 0.2004}, {0.034, 0.2008},  {0.0335, 0.1998}, {0.0338, 0.196},  {0.0359, 0.182},  {0.0389, 0.158},
    {0.0389, 0.14},   {0.0336, 0.1195}, {0.0213, 0.1026}, {0.0095, 0.0957}, {0, 0.094}};
enum { GOBLET_WATERLINE = 24 };
static const double GOBLET_WATER[][2] = {
    {0.0389, 0.14}, {0.0379, 0.1389}, {0.0364, 0.1382}, {0.033, 0.138}, {0, 0.138}};

static const double TUMBLER[][2] = {{0, 0},           {0.027, 0},       {0.0305, 0.0008}, {0.032, 0.0035},
                                    {0.0332, 0.02},   {0.0354, 0.05},   {0.0376, 0.08},   {0.0388, 0.096},
                                    {0.0387, 0.0982}, {0.0377, 0.0991}, {0.0367, 0.0982}, {0.0364, 0.0955},
                                    {0.0353, 0.08},   {0.0344, 0.068},  {0.0331, 0.05},   {0.0312, 0.023},
                                    {0.0295, 0.0165}, {0.025, 0.0142},  {0, 0.0138}};
enum { TUMBLER_WATERLINE = 13 };
static const double TUMBLER_WATER[][2] = {
    {0.0344, 0.068}, {0.0334, 0.0669}, {0.0319, 0.0662}, {0.029, 0.066}, {0, 0.066}};

static const double CARAFE[][2] = {
    {0, 0},          {0.043, 0},       {0.0515, 0.001},  {0.0555, 0.006},  {0.0575, 0.03},  {0.057, 0.06},
    {0.0515, 0.1},   {0.037, 0.14},    {0.0235, 0.17},   {0.0182, 0.195},  {0.0185, 0.22},  {0.0225, 0.243},
    {0.0282, 0.257}, {0.0287, 0.2593}, {0.0277, 0.2602}, {0.0266, 0.2588}, {0.0207, 0.243}, {0.0167, 0.22},
    {0.0164, 0.195}, {0.0215, 0.17},   {0.0345, 0.14},   {0.0416, 0.122},  {0.0492, 0.1},   {0.0546, 0.06},
    {0.055, 0.03},   {0.0525, 0.013},  {0.045, 0.0095},  {0, 0.009}};
enum { CARAFE_WATERLINE = 21 };
static const double CARAFE_WATER[][2] = {{0.0416, 0.122}, {0.041, 0.1209}, {0.0396, 0.1202}, {0.036, 0.12}, {0, 0.12}};

static const double LEMON[][2] = {{0, 0},          {0.0045, 0.001}, {0.0085, 0.0065}, {0.0135, 0.013},
                                  {0.0235, 0.025}, {0.029, 0.042},  {0.0285, 0.055},  {0.0225, 0.069},
                                  {0.0125, 0.078}, {0.006, 0.0825}, {0, 0.084}};

/* ---- hammered metal ---------------------------------------------------------------------------------------------- */

enum { HAMMERED_SIDE = 192, HAMMERED_CELLS = 7 };

/* Fractional part of a number that depends on cell (x, y), the map going round. */
static double cell_random(int x, int y, int which)
{
    int cell = (y + HAMMERED_CELLS) % HAMMERED_CELLS * HAMMERED_CELLS + (x + HAMMERED_CELLS) % HAMMERED_CELLS;
    double product = 0.6180339887498949 * (3 * cell + 1) * (which + 2.3) + 0.37 * cell * cell;
    return product - floor(product);
}

/* From the nearest blow to (x, y), counted in cells. */
static void blow_nearest(double x, double y, double offset[2])
{
    int x0 = (int)floor(x), y0 = (int)floor(y);
    double least = HUGE_VAL;
    for (int j = y0 - 1; j <= y0 + 1; ++j)
        for (int i = x0 - 1; i <= x0 + 1; ++i) {
            double dx = x - (i + 0.15 + 0.7 * cell_random(i, j, 0)), dy = y - (j + 0.15 + 0.7 * cell_random(i, j, 1));
            if (dx * dx + dy * dy >= least)
                continue;
            least = dx * dx + dy * dy;
            offset[0] = dx;
            offset[1] = dy;
        }
}

/* Every blow leaves a paraboloid, and they meet in edges. Texels are (n + 1) / 2 with y up; the PNG's rows go down. */
static bool hammered_write(const char *folder, Error *error)
{
    static float rgb[3 * HAMMERED_SIDE * HAMMERED_SIDE];
    char path[1024];
    for (int y = 0; y < HAMMERED_SIDE; ++y)
        for (int x = 0; x < HAMMERED_SIDE; ++x) {
            float *texel = rgb + 3 * (y * HAMMERED_SIDE + x);
            double d[2] = {0.0, 0.0}, cells = (double)HAMMERED_CELLS / HAMMERED_SIDE, steepness = 0.1;
            blow_nearest((x + 0.5) * cells, (HAMMERED_SIDE - y - 0.5) * cells, d);
            double n[3] = {-steepness * d[0], -steepness * d[1], 1.0}, length = sqrt(n[0] * n[0] + n[1] * n[1] + 1.0);
            for (int c = 0; c < 3; ++c) /* png_write encodes as sRGB, and the map's bytes are linear */
                texel[c] = (float)color_srgb_decode(0.5 * n[c] / length + 0.5);
        }
    snprintf(path, sizeof path, "%s/parts/hammered.png", folder);
    return png_write(path, rgb, HAMMERED_SIDE, HAMMERED_SIDE, 0.0f, error);
}

/* ---- the sun ----------------------------------------------------------------------------------------------------- */

/* 0.5 degrees across are 2.5 texels of the equal-area octahedral map. */
enum { SUN_SIDE = 1024, SUN_SAMPLES = 16 };
static const double SUN_RADIUS = TAU / 360.0 * 0.25, SUN_COLOR[3] = {1.0, 0.88, 0.7};

/* What part of a texel the sun covers. */
static double sun_part(int x, int y)
{
    Vec3 sun = vec3(0.0f, 0.0f, 1.0f);
    int inside = 0;
    for (int k = 0; k < SUN_SAMPLES * SUN_SAMPLES; ++k) {
        double u = x + (k % SUN_SAMPLES + 0.5) / SUN_SAMPLES, v = y + (k / SUN_SAMPLES + 0.5) / SUN_SAMPLES;
        Vec3 w = octahedral_to_sphere(vec2((float)(u / SUN_SIDE), (float)(v / SUN_SIDE)));
        double cross = (double)vec3_length(vec3_cross(w, sun));
        inside += vec3_dot(w, sun) > 0.0f && cross < sin(SUN_RADIUS);
    }
    return (double)inside / (SUN_SAMPLES * SUN_SAMPLES);
}

/* The sun straight above (+z); its red is 1 where it covers a texel. */
static bool sun_write(const char *folder, Error *error)
{
    char path[1024];
    float *sun = calloc((size_t)SUN_SIDE * SUN_SIDE * 3, sizeof *sun);
    if (!sun)
        return error_set(error, "not enough memory for the sun");
    for (int y = SUN_SIDE / 2 - 4; y < SUN_SIDE / 2 + 4; ++y)
        for (int x = SUN_SIDE / 2 - 4; x < SUN_SIDE / 2 + 4; ++x)
            for (int c = 0; c < 3; ++c)
                sun[3 * (y * SUN_SIDE + x) + c] = (float)(SUN_COLOR[c] * sun_part(x, y));
    ExrChannel channels[] = {{"R", sun, 3, true}, {"G", sun + 1, 3, true}, {"B", sun + 2, 3, true}};
    snprintf(path, sizeof path, "%s/parts/sun.exr", folder);
    bool good = exr_write(path, channels, 3, SUN_SIDE, SUN_SIDE, error);
    free(sun);
    return good;
}

typedef struct Part {
    const char *name;
    Lathe lathe;
} Part;

static const Part PARTS[] = {
    {"jar.ply", {POINTS(JAR), 1, 1, 0, 0}},
    {"vase.ply", {POINTS(VASE), 1, 1, 0, 0}},
    {"bottle.ply", {POINTS(BOTTLE), 1, 1, 0, 0}},
    {"bowl.ply", {POINTS(BOWL), 5, 4, 0, 0}},
    {"lemon.ply", {POINTS(LEMON), 1, 1, 0, 0}},
    {"goblet.ply", {POINTS(GOBLET), 1, 1, 0, GOBLET_WATERLINE}},
    {"goblet-wet.ply", {POINTS(GOBLET), 1, 1, GOBLET_WATERLINE, 0}},
    {"goblet-water.ply", {POINTS(GOBLET_WATER), 1, 1, 0, 0}},
    {"tumbler.ply", {POINTS(TUMBLER), 1, 1, 0, TUMBLER_WATERLINE}},
    {"tumbler-wet.ply", {POINTS(TUMBLER), 1, 1, TUMBLER_WATERLINE, 0}},
    {"tumbler-water.ply", {POINTS(TUMBLER_WATER), 1, 1, 0, 0}},
    {"carafe.ply", {POINTS(CARAFE), 1, 1, 0, CARAFE_WATERLINE}},
    {"carafe-wet.ply", {POINTS(CARAFE), 1, 1, CARAFE_WATERLINE, 0}},
    {"carafe-water.ply", {POINTS(CARAFE_WATER), 1, 1, 0, 0}},
};

static bool parts_write(const char *folder)
{
    Grid pane = {PANE_COLUMNS, PANE_ROWS, pane_vertex, NULL, false, false};
    Grid band = {RING_COLUMNS, RING_ROWS, ring_vertex, &BAND, false, false};
    Grid torus = {RING_COLUMNS, RING_ROWS, ring_vertex, &TORUS, false, false};
    bool good = grid_write(&pane, folder, "pane.ply") && grid_write(&band, folder, "band.ply") &&
                grid_write(&torus, folder, "torus.ply");
    for (size_t i = 0; i < sizeof PARTS / sizeof *PARTS && good; ++i)
        good = lathe_write(PARTS[i].lathe, folder, PARTS[i].name);
    return good;
}

int main(int argc, char **argv)
{
    Error error = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: make_parts FOLDER\n");
        return 2;
    }
    if (!parts_write(argv[1])) {
        fprintf(stderr, "make_parts: cannot write %s/parts\n", argv[1]);
        return 1;
    }
    if (!hammered_write(argv[1], &error) || !sun_write(argv[1], &error)) {
        fprintf(stderr, "make_parts: %s\n", error.message);
        return 1;
    }
    return 0;
}
