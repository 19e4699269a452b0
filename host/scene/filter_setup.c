#include "scene/filter_setup.h"

#include <math.h>

static double sinc(double x)
{
    return fabs(x) < 1e-9 ? 1.0 : sin(M_PI * x) / (M_PI * x);
}

/* The filter on [0, 2]: Mitchell and Netravali 1988, equation 8. */
static double mitchell(double b, double c, double x)
{
    if (x < 1.0)
        return ((12.0 - 9.0 * b - 6.0 * c) * x * x * x + (-18.0 + 12.0 * b + 6.0 * c) * x * x + (6.0 - 2.0 * b)) / 6.0;
    if (x < 2.0)
        return ((-b - 6.0 * c) * x * x * x + (6.0 * b + 30.0 * c) * x * x + (-12.0 * b - 48.0 * c) * x +
                (8.0 * b + 24.0 * c)) /
               6.0;
    return 0.0;
}

double filter_evaluate(const FilterSettings *settings, double radius, double x)
{
    x = fabs(x);
    if (x > radius)
        return 0.0;
    switch (settings->kind) {
    case PIXEL_FILTER_TRIANGLE:
        return radius - x;
    case PIXEL_FILTER_GAUSSIAN: {
        double scale = -0.5 / ((double)settings->sigma * (double)settings->sigma);
        return fmax(0.0, exp(scale * x * x) - exp(scale * radius * radius));
    }
    case PIXEL_FILTER_MITCHELL:
        return mitchell((double)settings->b, (double)settings->c, 2.0 * x / radius);
    case PIXEL_FILTER_SINC:
        return sinc(x) * sinc(x / (double)settings->tau);
    default:
        return 1.0;
    }
}

/* Integral over [a, b] by three-point Gauss-Legendre quadrature on four subintervals. */
static double filter_integral(const FilterSettings *settings, double radius, double a, double b)
{
    double h = (b - a) / 4.0, sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        double middle = a + h * (i + 0.5), offset = 0.5 * h * sqrt(0.6);
        sum += 5.0 * filter_evaluate(settings, radius, middle - offset) +
               8.0 * filter_evaluate(settings, radius, middle) +
               5.0 * filter_evaluate(settings, radius, middle + offset);
    }
    return sum * h / 18.0;
}

/* Builds the table of one axis: the CDF of the absolute integrals of the cells, and their signs. *integral: of f;
 * *absolute: sum of the cells' absolute integrals, which gives a cell in which f changes sign the right net weight. */
static bool table_build(const FilterSettings *settings, double radius, Array *lookup, uint *first, double *integral,
                        double *absolute, Error *error)
{
    double cells[PIXEL_FILTER_CELLS];
    const double h = 2.0 * radius / PIXEL_FILTER_CELLS;
    *integral = *absolute = 0.0;
    for (int i = 0; i < PIXEL_FILTER_CELLS; ++i) {
        /* mirrored, so that the table is symmetric to the last bit */
        int k = i < PIXEL_FILTER_CELLS / 2 ? PIXEL_FILTER_CELLS - 1 - i : i;
        cells[i] = filter_integral(settings, radius, h * k - radius, h * (k + 1) - radius);
        *integral += cells[i];
        *absolute += fabs(cells[i]);
    }
    if (!(*integral > 1e-6 * *absolute) || !isfinite(*absolute)) {
        error_set(error, "the pixel filter's integral is not positive");
        return error_fix(error, "use pbrt's default parameters, or the gaussian filter");
    }
    *first = (uint)lookup->count;
    float *table = array_grow(lookup, 2 * PIXEL_FILTER_CELLS + 1, error);
    if (!table)
        return false;
    double sum = 0.0;
    for (int i = 0; i < PIXEL_FILTER_CELLS; ++i) {
        table[i] = (float)(sum / *absolute);
        table[PIXEL_FILTER_CELLS + 1 + i] = cells[i] < 0.0 ? -1.0f : 1.0f;
        sum += fabs(cells[i]);
    }
    table[PIXEL_FILTER_CELLS] = 1.0f;
    return true;
}

static bool settings_check(const FilterSettings *s, Error *error)
{
    if (!(s->radius_x > 0.0f && s->radius_y > 0.0f && s->radius_x < 1e3f && s->radius_y < 1e3f)) {
        error_set(error, "the pixel filter's radius %g x %g is not between 0 and 1000 pixels", (double)s->radius_x,
                  (double)s->radius_y);
        return error_fix(error, "set \"float xradius\" and \"float yradius\" to about 1.5");
    }
    if (s->kind == PIXEL_FILTER_GAUSSIAN && !(s->sigma > 0.0f && isfinite(s->sigma))) {
        error_set(error, "the gaussian filter's sigma %g is not positive", (double)s->sigma);
        return error_fix(error, "set \"float sigma\" to about 0.5");
    }
    if (s->kind == PIXEL_FILTER_SINC && !(s->tau > 0.0f && isfinite(s->tau))) {
        error_set(error, "the sinc filter's tau %g is not positive", (double)s->tau);
        return error_fix(error, "set \"float tau\" to about 3");
    }
    return true;
}

bool filter_setup(const FilterSettings *settings, Array *lookup, PixelFilter *out, Error *error)
{
    if (!settings_check(settings, error))
        return false;
    *out = (PixelFilter){.kind = settings->kind,
                         .radius_x = settings->radius_x,
                         .radius_y = settings->radius_y,
                         .table_x = NONE,
                         .table_y = NONE,
                         .weight = 1.0f};
    if (settings->kind == PIXEL_FILTER_BOX || settings->kind == PIXEL_FILTER_TRIANGLE)
        return true;
    double integral_x, absolute_x, integral_y, absolute_y;
    if (!table_build(settings, (double)settings->radius_x, lookup, &out->table_x, &integral_x, &absolute_x, error))
        return false;
    out->table_y = out->table_x;
    integral_y = integral_x;
    absolute_y = absolute_x;
    if (settings->radius_y != settings->radius_x &&
        !table_build(settings, (double)settings->radius_y, lookup, &out->table_y, &integral_y, &absolute_y, error))
        return false;
    out->weight = (float)(absolute_x * absolute_y / (integral_x * integral_y));
    return true;
}
