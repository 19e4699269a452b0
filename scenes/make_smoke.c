/* Writes scenes/parts/smoke.pbrt: the medium of smoke.pbrt, a plume that rises in a box of 1.2 x 2.4 x 1.2, as a grid
 * of densities from 0 to 99. */
#include "base/output_file.h"
#include "math/noise.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ACROSS = 24, UP = 48 };

/* The plume is a tube around a line that wanders more the higher it is, frayed by noise that is stretched upwards. x
 * and z are from -1 to 1, height from 0 to 1. */
static double smoke_density(double x, double height, double z)
{
    Vec3 curl = vec3((float)(3.0 * x), (float)(4.0 * height), (float)(3.0 * z));
    double sway = 0.5 * height, radius = 0.16 + 0.38 * height;
    double dx =
        x - sway * (double)noise(vec3(0.3f, (float)(3.5 * height), 7.1f)) + 0.25 * (double)noise_fbm(curl, 0.5f, 3u);
    double dz = z - sway * (double)noise(vec3(5.2f, (float)(3.5 * height), 1.7f)) +
                0.25 * (double)noise_fbm(vec3_add(curl, vec3_splat(11.3f)), 0.5f, 3u);
    double inside = 1.0 - (dx * dx + dz * dz) / (radius * radius);
    double wisps = 0.6 + 1.1 * (double)noise_fbm(vec3_scale(curl, 2.0f), 0.6f, 4u);
    double top = fmin(1.0, 6.0 * (1.0 - height)), density = fmax(inside, 0.0) * wisps * top * (0.2 / radius);
    return fmin(fmax(density, 0.0), 1.0);
}

static void smoke_write(FILE *file)
{
    fprintf(file, "# Drawn for Twinlight by scenes/make_smoke.c; Apache-2.0\n");
    fprintf(file, "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"float scale\" 0.01\n");
    fprintf(file, "    \"rgb sigma_a\" [ 1.4 1.5 1.7 ] \"rgb sigma_s\" [ 11 11.5 12.5 ] \"float g\" 0.35\n");
    fprintf(file, "    \"point3 p0\" [ -0.6 0 -0.6 ] \"point3 p1\" [ 0.6 2.4 0.6 ]\n");
    fprintf(file, "    \"integer nx\" %d \"integer ny\" %d \"integer nz\" %d\n    \"float density\" [\n", ACROSS, UP,
            ACROSS);
    for (int z = 0; z < ACROSS; ++z)
        for (int y = 0; y < UP; ++y)
            for (int x = 0; x < ACROSS; ++x) {
                double density =
                    smoke_density((2.0 * x + 1.0) / ACROSS - 1.0, (y + 0.5) / UP, (2.0 * z + 1.0) / ACROSS - 1.0);
                fprintf(file, "%d%c", (int)(99.0 * density + 0.5), x == ACROSS - 1 ? '\n' : ' ');
            }
    fprintf(file, "    ]\n");
}

int main(int argc, char **argv)
{
    char path[4096];
    OutputFile file;
    Error error = {0};
    if (argc != 2) {
        fprintf(stderr, "usage: make_smoke FOLDER\n");
        return 2;
    }
    snprintf(path, sizeof path, "%s/parts/smoke.pbrt", argv[1]);
    FILE *stream = output_file_begin(&file, path, &error) ? output_file_stream(&file, &error) : NULL;
    if (stream)
        smoke_write(stream);
    if (stream && output_file_stream_commit(&file, stream, &error))
        return 0;
    fprintf(stderr, "make_smoke: %s\n", error_text(&error));
    return 1;
}
