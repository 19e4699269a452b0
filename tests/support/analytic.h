/* Whole images against numbers that do not come from the renderer: closed forms, and integrals computed here in double
 * by the midpoint rule. */
#ifndef TWINLIGHT_TESTS_SUPPORT_ANALYTIC_H
#define TWINLIGHT_TESTS_SUPPORT_ANALYTIC_H

#include "support/render_fixture.h"
#include "support/test_util.h"

/* Largest relative error of a rendered number. Numbers of samples are chosen so that the standard error is at most a
 * fifth of it. */
#define ANALYTIC_TOLERANCE 0.005

/* An 8 x 8 film, box filter, no lens: every pixel shows nearly the same point. */
#define ANALYTIC_FILM "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"

/* The origin seen from one side; the view spans 0.002 units. */
#define ANALYTIC_LOOK_AT_ORIGIN                                                                                        \
    ANALYTIC_FILM "LookAt 8 1 3  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 0.01\nWorldBegin\n"

/* The plane z = 0, diffuse with reflectance 1/2: radiance E / (2 pi). */
#define ANALYTIC_DIFFUSE_PLANE                                                                                         \
    "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ]\nAttributeEnd\n"

/* The square [0,1]^2 of the plane z = 0 seen from above on a film of %d x %d, x to the right and y up, by rays through
 * the pixels' centres. With a light straight above of irradiance pi, radiance equals reflectance. */
#define ANALYTIC_FROM_ABOVE                                                                                            \
    "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d\n"                                             \
    "PixelFilter \"box\" \"float xradius\" 1e-4 \"float yradius\" 1e-4\n"                                              \
    "Scale -1 1 1 LookAt 0.5 0.5 5  0.5 0.5 0  0 1 0\n"                                                                \
    "Camera \"orthographic\" \"float screenwindow\" [ -0.5 0.5 -0.5 0.5 ]\nWorldBegin\n"
#define ANALYTIC_OVERHEAD                                                                                              \
    "LightSource \"distant\" \"rgb L\" [ 3.14159265 3.14159265 3.14159265 ] \"point3 to\" [ 0 0 -1 ]\n"
#define ANALYTIC_SQUARE                                                                                                \
    "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\n"

/* Renders the scene text given by `format`, with paths of up to `depth` segments. */
void analytic_picture(RenderedImage *image, unsigned samples, int depth, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The mean over all pixels, of every channel. */
void analytic_color(double mean[3], unsigned samples, int depth, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The mean over pixels and channels. */
double analytic_mean(unsigned samples, int depth, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Prints a line of the table of cases and fails unless |got - expected| <= tolerance * |expected|, or <= tolerance if
 * expected is 0. */
void analytic_check(const char *name, double got, double expected, double tolerance);

/* A surface (u, v) in [0,1]^2 -> p, and the irradiance that it gives the plane z = 0 at the origin, for radiance 1
 * emitted on the side of dp/du x dp/dv (side = 1), the other (-1) or both (0). Without occlusion. */
typedef void AnalyticSurface(const void *context, double u, double v, double p[3]);
double analytic_irradiance(AnalyticSurface *surface, const void *context, int side);

/* Irradiance from a flat polygon of radiance 1 on z = 0 at the origin, by Lambert's formula; parts below the horizon
 * are clipped. Both sides emit. */
double analytic_polygon(const double (*vertices)[3], int count);

/* Reflectance of a dielectric interface for unpolarised light; eta = index beyond / index here. */
double analytic_fresnel(double cosine, double eta);

/* Writes RGB floats as a PFM file; row 0 is the top. */
void analytic_write_pfm(const char *path, int width, int height, const float *rgb);

/* A small image of random colours below 0.9 (greys if `grey`), row 0 at v = 1, which is also written to a file, and its
 * bilinear value at (u, v); wrap is pbrt's "repeat", "clamp" or "black". */
enum {
    ANALYTIC_MAP_WIDTH = 4,
    ANALYTIC_MAP_HEIGHT = 3,
    ANALYTIC_MAP_TEXELS = ANALYTIC_MAP_WIDTH * ANALYTIC_MAP_HEIGHT
};
extern float analytic_map[3 * ANALYTIC_MAP_TEXELS];
void analytic_map_make(const char *path, bool grey);
double analytic_map_at(double u, double v, int channel, const char *wrap);

double analytic_pixel(const RenderedImage *image, int x, int y, int channel);

/* Fails unless every pixel has the expected value at its centre, (u, v) with v upward, within `tolerance`. */
typedef double AnalyticValue(const void *context, double u, double v, int channel);
void analytic_compare(const RenderedImage *image, AnalyticValue *expected, const void *context, double tolerance);

TCase *analytic_area_case(void);
TCase *analytic_bumps_case(void);
TCase *analytic_camera_case(void);
TCase *analytic_environment_case(void);
TCase *analytic_glass_case(void);
TCase *analytic_instances_case(void);
TCase *analytic_intensity_case(void);
TCase *analytic_lights_case(void);
TCase *analytic_media_case(void);
TCase *analytic_opaque_case(void);
TCase *analytic_textures_case(void);

#endif
