#include "support/analytic.h"

#include "support/test_files.h"

#include <stdarg.h>

static void picture(RenderedImage *image, unsigned samples, int depth, const char *format, va_list arguments)
{
    static char text[16384];
    int length = vsnprintf(text, sizeof text, format, arguments);
    ck_assert(length >= 0 && (size_t)length < sizeof text);
    RenderSetup setup = {.text = text, .samples = samples, .max_depth = depth, .seed = 11};
    fixture_render(&setup, image);
}

void analytic_picture(RenderedImage *image, unsigned samples, int depth, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    picture(image, samples, depth, format, arguments);
    va_end(arguments);
}

static void color(double mean[3], unsigned samples, int depth, const char *format, va_list arguments)
{
    RenderedImage image;
    picture(&image, samples, depth, format, arguments);
    int pixels = image.width * image.height;
    for (int c = 0; c < 3; ++c) {
        mean[c] = 0.0;
        for (int i = 0; i < pixels; ++i)
            mean[c] += (double)image.rgb[3 * i + c] / pixels;
    }
    fixture_destroy(&image);
}

void analytic_color(double mean[3], unsigned samples, int depth, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    color(mean, samples, depth, format, arguments);
    va_end(arguments);
}

double analytic_mean(unsigned samples, int depth, const char *format, ...)
{
    double mean[3];
    va_list arguments;
    va_start(arguments, format);
    color(mean, samples, depth, format, arguments);
    va_end(arguments);
    return (mean[0] + mean[1] + mean[2]) / 3.0;
}

void analytic_check(const char *name, double got, double expected, double tolerance)
{
    double error = expected != 0.0 ? got / expected - 1.0 : got;
    fprintf(stderr, "%-52s expected %10.6f rendered %10.6f (%+.3f %%)\n", name, expected, got, 100.0 * error);
    ck_assert_msg(fabs(error) <= tolerance, "%s: rendered %.6g, not %.6g", name, got, expected);
}

/* ---- irradiance at the origin ------------------------------------------------------------------------------------ */

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double analytic_irradiance(AnalyticSurface *surface, const void *context, int side)
{
    enum { COUNT = 500 };
    const double step = 1e-5;
    double sum = 0.0;
    for (int j = 0; j < COUNT; ++j)
        for (int i = 0; i < COUNT; ++i) {
            double u = (i + 0.5) / COUNT, v = (j + 0.5) / COUNT, p[3], a[3], b[3], du[3], dv[3], n[3];
            surface(context, u, v, p);
            surface(context, u + step, v, a);
            surface(context, u - step, v, b);
            for (int k = 0; k < 3; ++k)
                du[k] = (a[k] - b[k]) / (2.0 * step);
            surface(context, u, v + step, a);
            surface(context, u, v - step, b);
            for (int k = 0; k < 3; ++k)
                dv[k] = (a[k] - b[k]) / (2.0 * step);
            cross(du, dv, n);
            double square = dot(p, p), out = -dot(n, p) * (side ? side : 1);
            if (side == 0)
                out = fabs(out);
            sum += out > 0.0 && p[2] > 0.0 ? out * p[2] / (square * square) : 0.0;
        }
    return sum / ((double)COUNT * COUNT);
}

/* Clipping against z = 0 by Sutherland and Hodgman. */
static int polygon_clip(const double (*in)[3], int count, double (*out)[3])
{
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        const double *a = in[i], *b = in[(i + 1) % count];
        if (a[2] > 0.0)
            memcpy(out[kept++], a, sizeof out[0]);
        if ((a[2] > 0.0) != (b[2] > 0.0)) {
            double t = a[2] / (a[2] - b[2]);
            for (int k = 0; k < 3; ++k)
                out[kept][k] = a[k] + t * (b[k] - a[k]);
            ++kept;
        }
    }
    return kept;
}

double analytic_polygon(const double (*vertices)[3], int count)
{
    double above[16][3], sum = 0.0;
    ck_assert_int_le(2 * count, 16);
    count = polygon_clip(vertices, count, above);
    for (int i = 0; i < count; ++i) {
        const double *a = above[i], *b = above[(i + 1) % count];
        double c[3];
        cross(a, b, c);
        double sine = sqrt(dot(c, c));
        if (sine > 0.0)
            sum += atan2(sine, dot(a, b)) * c[2] / sine;
    }
    return 0.5 * fabs(sum);
}

double analytic_fresnel(double cosine, double eta)
{
    double sine = sqrt(1.0 - cosine * cosine) / eta;
    if (sine >= 1.0)
        return 1.0;
    double inner = sqrt(1.0 - sine * sine);
    double s = (cosine - eta * inner) / (cosine + eta * inner), p = (eta * cosine - inner) / (eta * cosine + inner);
    return 0.5 * (s * s + p * p);
}

void analytic_write_pfm(const char *path, int width, int height, const float *rgb)
{
    size_t row = (size_t)width * 3;
    char *bytes = malloc(64 + sizeof *rgb * row * (size_t)height);
    ck_assert_ptr_nonnull(bytes);
    size_t size = (size_t)snprintf(bytes, 64, "PF\n%d %d\n-1.0\n", width, height);
    for (int y = height - 1; y >= 0; --y) {
        memcpy(bytes + size, rgb + (size_t)y * row, sizeof *rgb * row);
        size += sizeof *rgb * row;
    }
    test_file_write(path, bytes, size);
    free(bytes);
}

double analytic_pixel(const RenderedImage *image, int x, int y, int channel)
{
    return (double)image->rgb[3 * (y * image->width + x) + channel];
}

void analytic_compare(const RenderedImage *image, AnalyticValue *expected, const void *context, double tolerance)
{
    for (int i = 0; i < 3 * image->width * image->height; ++i) {
        int x = i / 3 % image->width, y = i / 3 / image->width;
        double u = (x + 0.5) / image->width, v = 1.0 - (y + 0.5) / image->height;
        double value = expected(context, u, v, i % 3);
        if (!(fabs((double)image->rgb[i] - value) <= tolerance))
            ck_abort_msg("channel %d of pixel %d %d is %g, not %g", i % 3, x, y, (double)image->rgb[i], value);
    }
}

float analytic_map[3 * ANALYTIC_MAP_TEXELS];

void analytic_map_make(const char *path, bool grey)
{
    unsigned state = 9;
    for (int i = 0; i < 3 * ANALYTIC_MAP_TEXELS; ++i)
        analytic_map[i] = grey && i % 3 > 0 ? analytic_map[i - 1] : (float)(0.9 * test_random_unit(&state));
    analytic_write_pfm(path, ANALYTIC_MAP_WIDTH, ANALYTIC_MAP_HEIGHT, analytic_map);
}

static double texel(int x, int y, int c, const char *wrap)
{
    const int width = ANALYTIC_MAP_WIDTH, height = ANALYTIC_MAP_HEIGHT;
    if (strcmp(wrap, "black") == 0 && (x < 0 || x >= width || y < 0 || y >= height))
        return 0.0;
    if (strcmp(wrap, "clamp") == 0) {
        x = x < 0 ? 0 : x >= width ? width - 1 : x;
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
    }
    return (double)analytic_map[3 * ((y + 9 * height) % height * width + (x + 9 * width) % width) + c];
}

double analytic_map_at(double u, double v, int channel, const char *wrap)
{
    double x = u * ANALYTIC_MAP_WIDTH - 0.5, y = (1.0 - v) * ANALYTIC_MAP_HEIGHT - 0.5, sum = 0.0;
    int i = (int)floor(x), j = (int)floor(y);
    for (int k = 0; k < 4; ++k) {
        double weight = (k % 2 ? x - i : 1.0 - (x - i)) * (k / 2 ? y - j : 1.0 - (y - j));
        sum += weight * texel(i + k % 2, j + k / 2, channel, wrap);
    }
    return sum;
}
