/* Writes the medium of fire.pbrt: flames in a box of 0.9 x 1.5 x 0.9, as grids of soot and of temperatures.
 * usage: make_fire, into gzip -9n */
#include "math/noise.h"

#include <math.h>
#include <stdio.h>

enum { ACROSS = 30, UP = 50 };

/* From 0 outside to 1 in the middle of a tongue of fire that rises from (cx, cz) to `top`, bent by noise. x and z are
 * from -1 to 1, height from 0 to 1. */
static double tongue(double x, double height, double z, double cx, double cz, double top)
{
    double along = height / top, seed = 3.0 * cx + 7.0 * cz;
    if (along >= 1.0)
        return 0.0;
    double sway = 0.35 * along, radius = 0.34 * sqrt(top) * (1.0 - along) * (0.75 + 1.6 * along);
    double dx = x - cx * (1.0 - 0.6 * along) - sway * (double)noise(vec3((float)seed, (float)(4.0 * height), 0.7f));
    double dz = z - cz * (1.0 - 0.6 * along) - sway * (double)noise(vec3(9.1f, (float)(4.0 * height), (float)seed));
    Vec3 at = vec3((float)(4.0 * x + seed), (float)(3.0 * height), (float)(4.0 * z));
    double frayed = 0.9 * (double)noise_fbm(at, 0.5f, 3u) * along;
    return fmin(fmax(1.0 - (dx * dx + dz * dz) / (radius * radius) + frayed, 0.0), 1.0);
}

/* The hottest of all tongues. */
static double fire(double x, double height, double z)
{
    static const double TONGUES[6][3] = {{0.0, 0.05, 0.97},  {0.3, -0.1, 0.7},   {-0.32, 0.0, 0.62},
                                         {0.05, -0.34, 0.5}, {-0.1, 0.33, 0.55}, {0.45, 0.2, 0.35}};
    double most = 0.0;
    for (int i = 0; i < 6; ++i)
        most = fmax(most, tongue(x, height, z, TONGUES[i][0], TONGUES[i][1], TONGUES[i][2]));
    return most;
}

/* Per thousand of the densest soot. */
static int soot(double x, double height, double z)
{
    return (int)(99.0 * pow(fire(x, height, z), 1.5) * (0.35 + 0.65 * height) + 0.5);
}

/* In units of 10 kelvin: hottest in the middle, and cooler where the flame is older. */
static int temperature(double x, double height, double z)
{
    double inside = fire(x, height, z);
    return (int)(30.0 + inside * (165.0 - 45.0 * height) + 0.5);
}

static int one(double x, double height, double z)
{
    (void)x;
    (void)height;
    (void)z;
    return 40;
}

static void grid_write(const char *name, int (*value)(double x, double height, double z))
{
    printf("    \"float %s\" [\n", name);
    for (int z = 0; z < ACROSS; ++z)
        for (int y = 0; y < UP; ++y)
            for (int x = 0; x < ACROSS; ++x)
                printf("%d%c", value((2.0 * x + 1.0) / ACROSS - 1.0, (y + 0.5) / UP, (2.0 * z + 1.0) / ACROSS - 1.0),
                       x == ACROSS - 1 ? '\n' : ' ');
    printf("    ]\n");
}

int main(void)
{
    printf("# Drawn for Twinlight by scenes/make_fire.c; Apache-2.0\n");
    printf("MakeNamedMedium \"fire\" \"string type\" \"uniformgrid\" \"float scale\" 0.01\n");
    printf("    \"rgb sigma_a\" [ 2.5 2.5 2.5 ] \"rgb sigma_s\" [ 1 1 1 ] \"float g\" 0.4\n");
    printf("    \"point3 p0\" [ -0.45 0 -0.45 ] \"point3 p1\" [ 0.45 1.5 0.45 ]\n");
    printf("    \"integer nx\" %d \"integer ny\" %d \"integer nz\" %d\n", ACROSS, UP, ACROSS);
    printf("    \"float temperaturescale\" 10\n");
    grid_write("density", soot);
    grid_write("temperature", temperature);
    grid_write("Lescale", one);
    return ferror(stdout) != 0;
}
