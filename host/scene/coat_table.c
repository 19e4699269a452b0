#include "scene/coat_table.h"

#include "bsdf/bsdf.h"

#include <math.h>

/* Midpoints per axis over the square of canonical random numbers: with these variables, the integrand of the visible
 * normal distribution is smooth for every alpha. */
#define QUADRATURE_PHI 16
#define QUADRATURE_HEIGHT 24
#define AZIMUTHS 64 /* samples of the mean over azimuth */

/* Cosine used for the table's entry at c = 0: T has a limit there. */
#define GRAZING_COSINE 1e-4f

/* Fraction of light from direction o (o.z > 0) that the rough interface transmits: the mean over visible normals of
 * (1 - F) G2 / G1, the weight of dielectric_rough_sample times the probability of refraction. */
static float rough_transmission(float alpha_x, float alpha_y, float eta, Vec3 o)
{
    float root_o = ggx_root(o, alpha_x, alpha_y);
    double sum = 0.0;
    for (int y = 0; y < QUADRATURE_HEIGHT; ++y) {
        for (int x = 0; x < QUADRATURE_PHI; ++x) {
            Vec2 u = vec2(((float)x + 0.5f) / QUADRATURE_PHI, ((float)y + 0.5f) / QUADRATURE_HEIGHT);
            Vec3 m = ggx_sample_visible(o, alpha_x, alpha_y, u);
            float cos_o = vec3_dot(o, m);
            float cos_t = refraction_cosine(cos_o, eta);
            if (!(cos_o > 0.0f) || cos_t < 0.0f)
                continue;
            Vec3 i = vec3_mad(vec3_scale(o, -1.0f / eta), cos_o / eta - cos_t, m);
            if (!(i.z < -BSDF_COSINE_MIN))
                continue;
            float transmittance = 1.0f - fresnel_from_cosines(cos_o, cos_t, eta);
            sum += (double)(transmittance * ggx_shadowing(o.z, root_o, -i.z, ggx_root(i, alpha_x, alpha_y)));
        }
    }
    return (float)(sum / (QUADRATURE_PHI * QUADRATURE_HEIGHT));
}

/* T_mean / eta^2 of the linear interpolant; Simpson's rule is exact for the integral of T(c) 2 c dc over a cell. */
static float row_escape(const float *row, float eta)
{
    const double width = 1.0 / (COAT_CELLS - 1);
    double sum = 0.0;
    for (unsigned k = 0; k + 1 < COAT_CELLS; ++k) {
        double c0 = k * width, c1 = (k + 1) * width;
        double t0 = (double)row[k], t1 = (double)row[k + 1];
        sum += width / 3.0 * (t0 * c0 + (t0 + t1) * (c0 + c1) + t1 * c1);
    }
    return (float)(sum / ((double)eta * (double)eta));
}

/* Fills one row: directions with sine `across` of the azimuth measured from the less rough axis. */
static void row_fill(float alpha_x, float alpha_y, float across, float eta, float *row)
{
    bool smooth = alpha_x < ALPHA_DELTA && alpha_y < ALPHA_DELTA;
    alpha_x = float_clamp(alpha_x, ALPHA_MIN, ALPHA_MAX);
    alpha_y = float_clamp(alpha_y, ALPHA_MIN, ALPHA_MAX);
    float along = float_sqrt((1.0f - across) * (1.0f + across));
    for (unsigned k = 0; k < COAT_CELLS; ++k) {
        float cosine = float_max((float)k / (float)(COAT_CELLS - 1u), GRAZING_COSINE);
        float sine = float_sqrt((1.0f - cosine) * (1.0f + cosine));
        Vec3 o =
            alpha_x < alpha_y ? vec3(sine * along, sine * across, cosine) : vec3(sine * across, sine * along, cosine);
        row[k] = smooth ? 1.0f - fresnel_dielectric(cosine, eta) : rough_transmission(alpha_x, alpha_y, eta, o);
    }
    row[COAT_CELLS] = row_escape(row, eta);
}

/* Sets every row's escape value to the mean over azimuth of 1 - R_i, by the midpoint rule over a quadrant. */
static void rows_average_escape(float *rows)
{
    double sum = 0.0;
    for (int k = 0; k < AZIMUTHS; ++k) {
        float s, c;
        float_sincos(PI_OVER_2 * ((float)k + 0.5f) / AZIMUTHS, &s, &c);
        float position = s * (float)(COAT_AZIMUTH_ROWS - 1u);
        unsigned r = (unsigned)position < COAT_AZIMUTH_ROWS - 2u ? (unsigned)position : COAT_AZIMUTH_ROWS - 2u;
        float t = position - (float)r;
        const float *row = rows + r * COAT_ROW + COAT_CELLS;
        sum += (double)((1.0f - t) * row[0] + t * row[COAT_ROW]);
    }
    for (unsigned r = 0; r < COAT_AZIMUTH_ROWS; ++r)
        rows[r * COAT_ROW + COAT_CELLS] = (float)(sum / AZIMUTHS);
}

/* Allocates a table of `rows` rows and fills in its head; NULL on failure. */
static float *table_begin(unsigned rows, Array *lookup, uint32_t *first, Error *error)
{
    size_t words = 1 + (size_t)rows * COAT_ROW;
    if (lookup->count + words >= NONE) {
        error_set(error, "the scene's tables exceed %u numbers", NONE);
        return NULL;
    }
    *first = (uint32_t)lookup->count;
    float *table = array_grow(lookup, words, error);
    if (table)
        table[0] = (float)rows;
    return table;
}

bool coat_table_build(float alpha_x, float alpha_y, float eta, Array *lookup, uint32_t *first, Error *error)
{
    unsigned rows = alpha_x == alpha_y ? 1 : COAT_AZIMUTH_ROWS;
    float *table = table_begin(rows, lookup, first, error);
    if (!table)
        return false;
    for (unsigned r = 0; r < rows; ++r)
        row_fill(alpha_x, alpha_y, (float)r / (float)(COAT_AZIMUTH_ROWS - 1u), eta, table + 1 + r * COAT_ROW);
    if (rows > 1)
        rows_average_escape(table + 1);
    return true;
}

bool coat_table_build_range(float eta, Array *lookup, uint32_t *first, Error *error)
{
    float *table = table_begin(COAT_ALPHA_ROWS, lookup, first, error);
    if (!table)
        return false;
    for (unsigned r = 0; r < COAT_ALPHA_ROWS; ++r) {
        float root = (float)r / (float)(COAT_ALPHA_ROWS - 1u);
        row_fill(root * root, root * root, 0.0f, eta, table + 1 + r * COAT_ROW);
    }
    return true;
}

float coat_escape(float alpha, float eta)
{
    float row[COAT_ROW];
    row_fill(alpha, alpha, 0.0f, eta, row);
    return row[COAT_CELLS];
}

float coat_round_trip(float eta, float thickness)
{
    enum { STEPS = 4096 };
    double kept = 0.0, all = 0.0;
    if (!(thickness > 0.0f))
        return 1.0f;
    for (int i = 0; i < STEPS; ++i) {
        double c = (i + 0.5) / STEPS;
        double reflected = (double)fresnel_dielectric((float)c, 1.0f / eta) * c;
        all += reflected;
        kept += reflected * exp(-2.0 * (double)thickness / c);
    }
    return all > 0.0 ? (float)(kept / all) : 1.0f;
}
