/* Irradiance on a diffuse plane from area lights of every shape. */
#include "support/analytic.h"

#define SAMPLES 4096
#define RADIANCE "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] "

/* `irradiance` is for radiance 1; the factors L = 2 and reflectance 1/2 cancel. */
static void check_light(const char *name, const char *light, double irradiance)
{
    double got = analytic_mean(SAMPLES, 2, ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE "AttributeBegin\n%s\n%s\n",
                               light, "AttributeEnd");
    analytic_check(name, got, irradiance / M_PI, ANALYTIC_TOLERANCE);
}

/* ---- disks ------------------------------------------------------------------------------------------------------- */

/* A parallel disk off the axis: Howell's catalogue of view factors, B-13. */
START_TEST(test_parallel_disk)
{
    double h = 1.2, radius = 0.8, a = 0.9, height = h / a, r = radius / a, z = 1.0 + height * height + r * r;
    double factor = 0.5 * (1.0 - (1.0 + height * height - r * r) / sqrt(z * z - 4.0 * r * r));
    check_light("parallel disk off its axis",
                RADIANCE "Translate -0.9 0 1.2 ReverseOrientation Shape \"disk\" \"float radius\" 0.8", M_PI * factor);
    check_light("the same by a half turn of the disk",
                RADIANCE "Translate -0.9 0 1.2 Rotate 180 1 0 0 Shape \"disk\" \"float radius\" 0.8", M_PI * factor);
    check_light("disk that shines the other way", RADIANCE "Translate -0.9 0 1.2 Shape \"disk\" \"float radius\" 0.8",
                0.0);
}
END_TEST

typedef struct Disk {
    double inner, outer, phi_max, tilt, center[3];
} Disk;

/* u: angle, v: radius, rotated about y. With dp/du x dp/dv, the normal points to the disk's -z. */
static void disk_point(const void *context, double u, double v, double p[3])
{
    const Disk *d = context;
    double r = d->inner + v * (d->outer - d->inner), x = r * cos(u * d->phi_max);
    p[0] = d->center[0] + cos(d->tilt) * x;
    p[1] = d->center[1] + r * sin(u * d->phi_max);
    p[2] = d->center[2] - sin(d->tilt) * x;
}

START_TEST(test_tilted_disks)
{
    Disk whole = {0.0, 0.7, 2.0 * M_PI, 40.0 * M_PI / 180.0, {-0.3, 0.2, 1.5}};
    check_light("tilted disk",
                RADIANCE
                "Translate -0.3 0.2 1.5 Rotate 40 0 1 0 ReverseOrientation Shape \"disk\" \"float radius\" 0.7",
                analytic_irradiance(disk_point, &whole, 1));
    Disk ring = {0.4, 1.0, 200.0 * M_PI / 180.0, -30.0 * M_PI / 180.0, {-0.3, 0.2, 1.3}};
    check_light("part of a tilted ring, two-sided",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true Translate -0.3 0.2 1.3 "
                "Rotate -30 0 1 0 Shape \"disk\" \"float radius\" 1 \"float innerradius\" 0.4 \"float phimax\" 200",
                analytic_irradiance(disk_point, &ring, 0));
    Disk low = {0.0, 1.0, 2.0 * M_PI, 80.0 * M_PI / 180.0, {-1.1, 0.0, 0.3}};
    check_light("disk partly below the horizon",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true Translate -1.1 0 0.3 "
                "Rotate 80 0 1 0 Shape \"disk\"",
                analytic_irradiance(disk_point, &low, 0));
}
END_TEST

/* ---- polygons ---------------------------------------------------------------------------------------------------- */

START_TEST(test_rectangles)
{
    const double tilted[4][3] = {{-1.0, -0.5, 1.0}, {0.4, -0.5, 1.8}, {0.4, 0.7, 1.8}, {-1.0, 0.7, 1.0}};
    check_light("tilted rectangle, bilinear",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true\n"
                "Shape \"bilinearmesh\" \"point3 P\" [ -1 -0.5 1  0.4 -0.5 1.8  -1 0.7 1  0.4 0.7 1.8 ]",
                analytic_polygon(tilted, 4));
    check_light("tilted rectangle, two triangles",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true\nShape \"trianglemesh\" "
                "\"point3 P\" [ -1 -0.5 1  0.4 -0.5 1.8  0.4 0.7 1.8  -1 0.7 1 ] \"integer indices\" [ 0 1 2 0 2 3 ]",
                analytic_polygon(tilted, 4));
    const double wall[4][3] = {{-1.0, -0.8, -0.5}, {-1.0, 0.9, -0.5}, {-1.0, 0.9, 1.5}, {-1.0, -0.8, 1.5}};
    check_light("wall through the plane",
                RADIANCE "Shape \"bilinearmesh\" \"point3 P\" [ -1 -0.8 -0.5  -1 0.9 -0.5  -1 -0.8 1.5  -1 0.9 1.5 ]",
                analytic_polygon(wall, 4));
}
END_TEST

/* An octahedron of one-sided faces: those that face the plane count. */
START_TEST(test_mesh)
{
    static const double v[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const int faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const double center[3] = {-0.7, 0.3, 1.4}, scale = 0.8;
    double expected = 0.0;
    for (int i = 0; i < 8; ++i) {
        double p[3][3], out = 0.0;
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                p[k][c] = center[c] + scale * v[faces[i][k]][c];
        for (int c = 0; c < 3; ++c) /* the face's normal is the sum of its vertices */
            out -= p[0][c] * (v[faces[i][0]][c] + v[faces[i][1]][c] + v[faces[i][2]][c]);
        expected += out > 0.0 ? analytic_polygon((const double(*)[3])p, 3) : 0.0;
    }
    check_light("octahedron of eight lights",
                RADIANCE "Translate -0.7 0.3 1.4 Scale 0.8 0.8 0.8\nShape \"trianglemesh\" "
                         "\"point3 P\" [ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ] "
                         "\"integer indices\" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5 ]",
                expected);
}
END_TEST

static void patch_point(const void *context, double u, double v, double p[3])
{
    const double(*corners)[3] = context;
    for (int k = 0; k < 3; ++k)
        p[k] =
            (1 - v) * ((1 - u) * corners[0][k] + u * corners[1][k]) + v * ((1 - u) * corners[2][k] + u * corners[3][k]);
}

START_TEST(test_bent_patch)
{
    static const double corners[4][3] = {{-1.2, -0.6, 1.0}, {0.3, -0.5, 1.7}, {-1.0, 0.9, 1.9}, {0.5, 0.6, 1.1}};
    check_light("bent bilinear patch",
                "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true\nShape \"bilinearmesh\" "
                "\"point3 P\" [ -1.2 -0.6 1  0.3 -0.5 1.7  -1 0.9 1.9  0.5 0.6 1.1 ]",
                analytic_irradiance(patch_point, corners, 0));
}
END_TEST

/* ---- spheres ----------------------------------------------------------------------------------------------------- */

typedef struct Ball {
    double z_min, z_max, phi_max; /* of the unit sphere */
    double axes[3], turn, center[3]; /* radii, rotated about y */
} Ball;

/* u: azimuth, v: height; dp/du x dp/dv points outwards. */
static void ball_point(const void *context, double u, double v, double p[3])
{
    const Ball *b = context;
    double z = b->z_min + v * (b->z_max - b->z_min), r = sqrt(fmax(0.0, 1.0 - z * z)), phi = u * b->phi_max;
    double x = b->axes[0] * r * cos(phi), y = b->axes[1] * r * sin(phi);
    z *= b->axes[2];
    p[0] = b->center[0] + cos(b->turn) * x + sin(b->turn) * z;
    p[1] = b->center[1] + y;
    p[2] = b->center[2] - sin(b->turn) * x + cos(b->turn) * z;
}

START_TEST(test_spheres)
{
    double square = 0.49 + 0.09 + 1.69;
    check_light("sphere", RADIANCE "Translate -0.7 0.3 1.3 Shape \"sphere\" \"float radius\" 0.6",
                M_PI * 0.36 / square * 1.3 / sqrt(square));
    Ball low = {-1.0, 1.0, 2.0 * M_PI, {0.8, 0.8, 0.8}, 0.0, {-1.5, 0.2, 0.3}};
    check_light("sphere partly below the horizon",
                RADIANCE "Translate -1.5 0.2 0.3 Shape \"sphere\" \"float radius\" 0.8",
                analytic_irradiance(ball_point, &low, 1));
    Ball stretched = {-1.0, 1.0, 2.0 * M_PI, {1.0, 0.5, 0.3}, 35.0 * M_PI / 180.0, {-0.6, 0.2, 1.5}};
    check_light("ellipsoid", RADIANCE "Translate -0.6 0.2 1.5 Rotate 35 0 1 0 Scale 1 0.5 0.3 Shape \"sphere\"",
                analytic_irradiance(ball_point, &stretched, 1));
    Ball part = {-0.5, 0.75, 250.0 * M_PI / 180.0, {0.8, 0.8, 0.8}, 0.0, {-0.7, -0.6, 1.4}};
    check_light("part of a sphere, outside",
                RADIANCE "Translate -0.7 -0.6 1.4 Shape \"sphere\" \"float radius\" 0.8 \"float zmin\" -0.4 "
                         "\"float zmax\" 0.6 \"float phimax\" 250",
                analytic_irradiance(ball_point, &part, 1));
    Ball bowl = {0.0, 1.0, 2.0 * M_PI, {2.0, 2.0, 2.0}, 0.0, {0.0, 0.0, 0.9}};
    check_light("bowl above, shining inwards",
                "ReverseOrientation " RADIANCE "Translate 0 0 0.9 Shape \"sphere\" \"float radius\" 2 \"float zmin\" 0",
                analytic_irradiance(ball_point, &bowl, -1));
}
END_TEST

/* ---- several lights, and lights behind the plane ----------------------------------------------------------------- */

START_TEST(test_sum_of_lights)
{
    double h = 1.21 + 0.64, square = 9.0 + 0.36 + 2.56;
    double got =
        analytic_mean(SAMPLES, 2,
                      ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                      "AttributeBegin\n" RADIANCE
                      "Translate 0 0 1.1 ReverseOrientation Shape \"disk\" \"float radius\" 0.8\nAttributeEnd\n"
                      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ] "
                      "Translate -3 0.6 1.6 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
                      "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"point3 from\" [ -1 -1 0.5 ]\n");
    double expected =
        2.0 * M_PI * 0.64 / h + 9.0 * M_PI * 0.25 / square * 1.6 / sqrt(square) + 3.0 * 0.5 / pow(2.25, 1.5);
    analytic_check("disk, sphere and point together", got, expected * 0.5 / M_PI, ANALYTIC_TOLERANCE);
}
END_TEST

START_TEST(test_diffuse_transmission)
{
    for (int below = 0; below < 2; ++below) {
        double got = analytic_mean(SAMPLES, 2,
                                   ANALYTIC_LOOK_AT_ORIGIN
                                   "AttributeBegin Material \"diffusetransmission\" \"rgb reflectance\" [ .3 .3 .3 ] "
                                   "\"rgb transmittance\" [ .4 .4 .4 ] \"float scale\" 0.5\n"
                                   "Shape \"disk\" \"float radius\" 50 AttributeEnd\n" RADIANCE
                                   "Translate 0 0 %d %s Shape \"disk\" \"float radius\" 0.5\n",
                                   below ? -1 : 1, below ? "" : "ReverseOrientation");
        analytic_check(below ? "sheet lit from behind" : "sheet lit from the front", got,
                       2.0 * 0.5 * (below ? 0.4 : 0.3) * 0.25 / 1.25, ANALYTIC_TOLERANCE);
    }
}
END_TEST

TCase *analytic_area_case(void)
{
    TCase *tcase = tcase_create("area");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_parallel_disk);
    tcase_add_test(tcase, test_tilted_disks);
    tcase_add_test(tcase, test_rectangles);
    tcase_add_test(tcase, test_mesh);
    tcase_add_test(tcase, test_bent_patch);
    tcase_add_test(tcase, test_spheres);
    tcase_add_test(tcase, test_sum_of_lights);
    tcase_add_test(tcase, test_diffuse_transmission);
    return tcase;
}
