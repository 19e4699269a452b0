/* Pixel filters, cameras and lenses: how much of every pixel is covered by a lamp at a known position. */
#include "support/analytic.h"

enum { WIDTH = 16, HEIGHT = 10 };

/* A black rectangle of radiance 1; its coverage of pixel x, y is x[x] * y[y]. */
typedef struct Coverage {
    double x[WIDTH], y[HEIGHT];
} Coverage;

/* Checks the factor between image and prediction, and the root mean square residual, which must be explained by
 * noise. */
static void coverage_check(const char *name, const RenderedImage *image, const Coverage *cover, double rest_limit)
{
    double both = 0.0, square = 0.0, rest = 0.0;
    ck_assert(image->width == WIDTH && image->height == HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) {
            double expected = cover->x[x] * cover->y[y], got = (double)image->rgb[3 * (y * WIDTH + x)];
            both += expected * got;
            square += expected * expected;
            rest += (got - expected) * (got - expected) / (WIDTH * HEIGHT);
        }
    analytic_check(name, both / square, 1.0, ANALYTIC_TOLERANCE);
    ck_assert_msg(sqrt(rest) <= rest_limit, "%s: pixels differ by %g", name, sqrt(rest));
}

/* The overlap of every pixel with [a, b], in pixels. */
static void overlap(double a, double b, int count, double *cover)
{
    for (int i = 0; i < count; ++i)
        cover[i] = fmax(0.0, fmin(b, i + 1.0) - fmax(a, (double)i));
}

/* ---- filters ----------------------------------------------------------------------------------------------------- */

typedef struct Filter {
    const char *name, *parameters;
    double radius_x, radius_y;
    double a, b; /* sigma; B, C; tau */
} Filter;

static const Filter FILTERS[] = {
    {"box", "\"float xradius\" 1.2 \"float yradius\" 0.7", 1.2, 0.7, 0.0, 0.0},
    {"triangle", "\"float xradius\" 2.5 \"float yradius\" 1.5", 2.5, 1.5, 0.0, 0.0},
    {"gaussian", "\"float xradius\" 1.5 \"float yradius\" 2.5 \"float sigma\" 0.8", 1.5, 2.5, 0.8, 0.0},
    {"mitchell", "\"float xradius\" 2.5 \"float yradius\" 1.5 \"float B\" 0.2 \"float C\" 0.4", 2.5, 1.5, 0.2, 0.4},
    {"sinc", "\"float xradius\" 3 \"float yradius\" 4 \"float tau\" 2", 3.0, 4.0, 2.0, 0.0},
};
#define FILTER_KINDS ((int)(sizeof FILTERS / sizeof *FILTERS))

static double sinc(double x)
{
    return fabs(x) < 1e-8 ? 1.0 : sin(M_PI * x) / (M_PI * x);
}

/* Mitchell and Netravali 1988, eq. 8, x in 0 ... 2. */
static double mitchell(double x, double b, double c)
{
    if (x < 1.0)
        return ((12.0 - 9.0 * b - 6.0 * c) * x * x * x + (-18.0 + 12.0 * b + 6.0 * c) * x * x + 6.0 - 2.0 * b) / 6.0;
    return ((-b - 6.0 * c) * x * x * x + (6.0 * b + 30.0 * c) * x * x + (-12.0 * b - 48.0 * c) * x + 8.0 * b +
            24.0 * c) /
           6.0;
}

static double filter_value(const Filter *filter, double radius, double x)
{
    x = fabs(x);
    switch (filter->name[0]) {
    case 't':
        return radius - x;
    case 'g':
        return exp(-0.5 * x * x / (filter->a * filter->a)) - exp(-0.5 * radius * radius / (filter->a * filter->a));
    case 'm':
        return mitchell(2.0 * x / radius, filter->a, filter->b);
    case 's':
        return sinc(x) * sinc(x / filter->a);
    default:
        return 1.0;
    }
}

/* Convolution of the indicator of [a, b] with the filter, at every pixel's centre. */
static void convolve(const Filter *filter, double radius, double a, double b, int count, double *cover)
{
    enum { STEPS = 20000 };
    for (int i = 0; i < count; ++i) {
        double inside = 0.0, all = 0.0;
        for (int k = 0; k < STEPS; ++k) {
            double x = radius * (2.0 * (k + 0.5) / STEPS - 1.0), value = filter_value(filter, radius, x);
            all += value;
            inside += i + 0.5 + x > a && i + 0.5 + x < b ? value : 0.0;
        }
        cover[i] = inside / all;
    }
}

/* A lamp from (4.3, 2.8) to (11.6, 7.25) in pixels. */
START_TEST(test_filter)
{
    const Filter *filter = &FILTERS[_i];
    RenderedImage image;
    Coverage cover;
    char name[64];
    analytic_picture(&image, 8192, 1,
                     "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10\nPixelFilter \"%s\" %s\n"
                     "Camera \"orthographic\" \"float screenwindow\" [ 0 16 -10 0 ]\nWorldBegin\n"
                     "AreaLightSource \"diffuse\" \"bool twosided\" true\nShape \"bilinearmesh\" "
                     "\"point3 P\" [ 4.3 -2.8 1  11.6 -2.8 1  4.3 -7.25 1  11.6 -7.25 1 ]",
                     filter->name, filter->parameters);
    convolve(filter, filter->radius_x, 4.3, 11.6, WIDTH, cover.x);
    convolve(filter, filter->radius_y, 2.8, 7.25, HEIGHT, cover.y);
    snprintf(name, sizeof name, "%s filter of a rectangle", filter->name);
    coverage_check(name, &image, &cover, 0.01);
    fixture_destroy(&image);
}
END_TEST

/* ---- cameras ----------------------------------------------------------------------------------------------------- */

typedef struct View {
    const char *name, *camera;
    double scale_x, scale_y, shift_x, shift_y; /* screen = (x, y) / z (or x, y) in units of the window, -1 ... 1 */
} View;

/* tan(20 degrees) and tan(25 degrees) by hand: the shorter side of a film of 16 x 10 spans the angle. */
static const View VIEWS[] = {
    {"fov 40", "\"perspective\" \"float fov\" 40", 1.6 * 0.36397023, 0.36397023, 0, 0},
    {"fov 50, frame aspect 0.5", "\"perspective\" \"float fov\" 50 \"float frameaspectratio\" 0.5", 0.46630766,
     2.0 * 0.46630766, 0, 0},
    {"fov 50, frame aspect 3", "\"perspective\" \"float fov\" 50 \"float frameaspectratio\" 3", 3.0 * 0.46630766,
     0.46630766, 0, 0},
    {"fov 50, window", "\"perspective\" \"float fov\" 50 \"float screenwindow\" [ -0.5 1.5 -1 0.6 ]", 0.46630766,
     0.8 * 0.46630766, 0.5 * 0.46630766, -0.2 * 0.46630766},
    {"fov 50, mirrored window", "\"perspective\" \"float fov\" 50 \"float screenwindow\" [ 1 -1 -1 1 ]", -0.46630766,
     0.46630766, 0, 0},
};

/* A rectangle, x from -0.5 to 1.1, y from -0.9 to 0.7 at z = 4, and five times as large at z = 20. */
START_TEST(test_view)
{
    const View *view = &VIEWS[_i];
    for (int far = 0; far < 2; ++far) {
        RenderedImage image;
        Coverage cover;
        double s = far ? 5.0 : 1.0, x[2], y[2];
        analytic_picture(&image, 4096, 1,
                         "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10\nPixelFilter \"box\"\n"
                         "Camera %s\nWorldBegin\nScale %g %g %g\nAreaLightSource \"diffuse\" \"bool twosided\" true\n"
                         "Shape \"bilinearmesh\" \"point3 P\" [ -0.5 -0.9 4  1.1 -0.9 4  -0.5 0.7 4  1.1 0.7 4 ]",
                         view->camera, s, s, s);
        for (int i = 0; i < 2; ++i) {
            x[i] = WIDTH * 0.5 * (1.0 + ((i ? 1.1 : -0.5) / 4.0 - view->shift_x) / view->scale_x);
            y[i] = HEIGHT * 0.5 * (1.0 - ((i ? -0.9 : 0.7) / 4.0 - view->shift_y) / view->scale_y);
        }
        overlap(fmin(x[0], x[1]), fmax(x[0], x[1]), WIDTH, cover.x);
        overlap(fmin(y[0], y[1]), fmax(y[0], y[1]), HEIGHT, cover.y);
        coverage_check(view->name, &image, &cover, 0.01);
        fixture_destroy(&image);
    }
}
END_TEST

/* An orthographic camera with a window of one unit per side, scaled by 3 and translated: 3 units of the world at any
 * depth. */
START_TEST(test_orthographic)
{
    for (int far = 0; far < 2; ++far) {
        RenderedImage image;
        Coverage cover;
        analytic_picture(
            &image, 4096, 1,
            "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10\nPixelFilter \"box\"\n"
            "Scale 0.3333333333 0.3333333333 1\nTranslate -0.5 0.2 0\nCamera \"orthographic\"\nWorldBegin\n"
            "AreaLightSource \"diffuse\" \"bool twosided\" true\nTranslate 0 0 %d\nShape \"bilinearmesh\" "
            "\"point3 P\" [ -2 -1.9 0  1.1 -1.9 0  -2 0.7 0  1.1 0.7 0 ]",
            far ? 40 : 2);
        overlap(8.0 + (-2.0 - 0.5) / 0.6, 8.0 + (1.1 - 0.5) / 0.6, WIDTH, cover.x);
        overlap(5.0 - (0.7 + 0.2) / 0.6, 5.0 - (-1.9 + 0.2) / 0.6, HEIGHT, cover.y);
        coverage_check("orthographic, scaled and moved", &image, &cover, 0.01);
        fixture_destroy(&image);
    }
}
END_TEST

/* LookAt: the axis hits the film's centre, up is up, and right is up x forward, as in pbrt's left-handed camera
 * space. */
START_TEST(test_look_at)
{
    RenderedImage image;
    Coverage cover;
    analytic_picture(&image, 4096, 1,
                     "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10\nPixelFilter \"box\"\n"
                     "LookAt 3 5 2  3 1 2  0 0 1\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n"
                     "AreaLightSource \"diffuse\" \"bool twosided\" true\nShape \"bilinearmesh\" "
                     "\"point3 P\" [ 3 1 1  7 1 1  3 1 5  7 1 5 ]");
    /* up x forward = z x -y = x: the lamp is on the right, 4 wide, from 1 below to 3 above the axis. */
    overlap(8.0, 8.0 + 5.0, WIDTH, cover.x);
    overlap(5.0 - 5.0 * 0.75, 5.0 + 5.0 * 0.25, HEIGHT, cover.y);
    coverage_check("LookAt", &image, &cover, 0.01);
    fixture_destroy(&image);
}
END_TEST

/* ---- lenses ------------------------------------------------------------------------------------------------------ */

/* The sum, centroid and mean squared distance from the centroid of a small lamp's image on the film. */
static void spot_moments(const RenderedImage *image, double *sum, double middle[2], double *square)
{
    *sum = middle[0] = middle[1] = *square = 0.0;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            double value = (double)image->rgb[3 * (y * image->width + x)];
            *sum += value;
            middle[0] += value * (x + 0.5);
            middle[1] += value * (y + 0.5);
            *square += value * ((x + 0.5) * (x + 0.5) + (y + 0.5) * (y + 0.5));
        }
    middle[0] /= *sum;
    middle[1] /= *sum;
    *square = *square / *sum - middle[0] * middle[0] - middle[1] * middle[1];
}

/* A square lamp of half side h at depth z. A lens of radius R focused at f images a point as a disk of radius R |z - f|
 * / z in the plane of focus. The mean squared distance from the centre is r^2 / 2 for a disk, 2 h^2 / 3 for a square,
 * 1/6 for a pixel. Perspective: a pixel spans 2 f tan(fov / 2) / 32 there and the lamp's image shrinks by f / z;
 * orthographic: neither. A camera that is scaled with its world has the same image. */
static void lens_case(const char *name, bool perspective, double radius, double f, double z, double scale)
{
    const double half = 0.25, fov = 30.0 * M_PI / 180.0;
    RenderedImage image;
    double sum, middle[2], square;
    analytic_picture(&image, 2048, 1,
                     "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
                     "Scale %.9g %.9g %.9g "
                     "Camera \"%s\" \"float lensradius\" %g \"float focaldistance\" %g %s\nWorldBegin\n"
                     "AreaLightSource \"diffuse\" \"bool twosided\" true\nScale %.9g %.9g %.9g Translate %.9g %.9g "
                     "%.9g Scale %g %g 1\n"
                     "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]",
                     1.0 / scale, 1.0 / scale, 1.0 / scale, perspective ? "perspective" : "orthographic", radius, f,
                     perspective ? "\"float fov\" 30" : "", scale, scale, scale, 0.05 * z, -0.02 * z, z, half, half);
    spot_moments(&image, &sum, middle, &square);
    double pixel = perspective ? 2.0 * f * tan(0.5 * fov) / 32.0 : 2.0 / 32.0;
    double blur = radius * fabs(z - f) / (perspective ? z : f) / pixel;
    double side = (perspective ? half * f / z : half) / pixel, shift = perspective ? f : z;
    char line[100];
    snprintf(line, sizeof line, "%s: radius of the blur, pixels", name);
    analytic_check(line, sqrt(2.0 * (square - 1.0 / 6.0 - 2.0 / 3.0 * side * side)), blur, 0.01);
    snprintf(line, sizeof line, "%s: light on the film", name);
    analytic_check(line, sum, 4.0 * side * side, 0.01);
    ck_assert_double_eq_tol(middle[0], 16.0 + 0.05 * shift / pixel, 0.05);
    ck_assert_double_eq_tol(middle[1], 16.0 + 0.02 * shift / pixel, 0.05);
    fixture_destroy(&image);
}

START_TEST(test_lenses)
{
    lens_case("thin lens, behind the focus", true, 0.3, 4.0, 8.0, 1.0);
    lens_case("thin lens, before the focus", true, 0.2, 6.0, 3.0, 1.0);
    lens_case("thin lens of a scaled camera", true, 0.3, 4.0, 8.0, 2.5);
    lens_case("telecentric lens", false, 0.4, 5.0, 8.0, 1.0);
}
END_TEST

/* ---- crop windows ------------------------------------------------------------------------------------------------ */

/* A window in fractions, rounded up as in pbrt: pixels 4 ... 11 of 16 and 3 ... 7 of 10 of the whole image. */
START_TEST(test_crop_window)
{
    RenderedImage images[2];
    for (int i = 0; i < 2; ++i)
        analytic_picture(&images[i], 256, 1,
                         "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 10 %s\n"
                         "Camera \"perspective\" \"float fov\" 70\nWorldBegin\nAreaLightSource \"diffuse\"\n"
                         "Translate 0.4 -0.3 3 Shape \"sphere\" \"float radius\" 1",
                         i ? "\"float cropwindow\" [ 0.23 0.75 0.25 0.8 ]" : "");
    const int *crop = images[1].film.crop;
    ck_assert(crop[0] == 4 && crop[1] == 3 && crop[2] == 12 && crop[3] == 8);
    for (int y = crop[1]; y < crop[3]; ++y)
        for (int x = crop[0]; x < crop[2]; ++x)
            ck_assert(images[0].film.sums[3 * (16 * y + x)] == images[1].film.sums[3 * (8 * (y - 3) + x - 4)]);
    for (int i = 0; i < 2; ++i)
        fixture_destroy(&images[i]);
}
END_TEST

TCase *analytic_camera_case(void)
{
    TCase *tcase = tcase_create("camera");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_filter, 0, FILTER_KINDS);
    tcase_add_loop_test(tcase, test_view, 0, (int)(sizeof VIEWS / sizeof *VIEWS));
    tcase_add_test(tcase, test_orthographic);
    tcase_add_test(tcase, test_look_at);
    tcase_add_test(tcase, test_lenses);
    tcase_add_test(tcase, test_crop_window);
    return tcase;
}
