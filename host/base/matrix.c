#include "base/matrix.h"

#include <float.h>
#include <math.h>
#include <string.h>

Matrix matrix_identity(void)
{
    Matrix r = {{0}};
    for (int i = 0; i < 4; ++i)
        r.m[5 * i] = 1.0;
    return r;
}

Matrix matrix_translate(double x, double y, double z)
{
    Matrix r = matrix_identity();
    r.m[3] = x;
    r.m[7] = y;
    r.m[11] = z;
    return r;
}

Matrix matrix_scale(double x, double y, double z)
{
    Matrix r = matrix_identity();
    r.m[0] = x;
    r.m[5] = y;
    r.m[10] = z;
    return r;
}

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void vector_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

bool vector_normalize(double v[3])
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))); /* against underflow and overflow */
    if (!(largest > 0.0) || !isfinite(largest))
        return false;
    for (int i = 0; i < 3; ++i)
        v[i] /= largest;
    double length = sqrt(dot3(v, v));
    for (int i = 0; i < 3; ++i)
        v[i] /= length;
    return true;
}

Matrix matrix_rotate(double degrees, const double axis[3])
{
    double a[3] = {axis[0], axis[1], axis[2]};
    vector_normalize(a);
    double radians = degrees * (M_PI / 180.0);
    double s = sin(radians), c = cos(radians);
    Matrix r = matrix_identity();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            r.m[4 * i + j] = a[i] * a[j] * (1.0 - c) + (i == j ? c : 0.0);
    r.m[1] -= a[2] * s;
    r.m[2] += a[1] * s;
    r.m[4] += a[2] * s;
    r.m[6] -= a[0] * s;
    r.m[8] -= a[1] * s;
    r.m[9] += a[0] * s;
    return r;
}

bool matrix_look_at(const double eye[3], const double look[3], const double up[3], Matrix *out)
{
    double direction[3] = {look[0] - eye[0], look[1] - eye[1], look[2] - eye[2]};
    double up_unit[3] = {up[0], up[1], up[2]}, right[3], new_up[3];
    if (!vector_normalize(direction) || !vector_normalize(up_unit))
        return false;
    vector_cross(up_unit, direction, right);
    if (!vector_normalize(right))
        return false;
    vector_cross(direction, right, new_up);
    const double *axes[3] = {right, new_up, direction};
    *out = matrix_identity();
    for (int i = 0; i < 3; ++i) {
        memcpy(&out->m[4 * i], axes[i], 3 * sizeof(double));
        out->m[4 * i + 3] = -dot3(axes[i], eye);
    }
    return true;
}

Matrix matrix_multiply(const Matrix *a, const Matrix *b)
{
    Matrix r;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k)
                sum += a->m[4 * i + k] * b->m[4 * k + j];
            r.m[4 * i + j] = sum;
        }
    return r;
}

static void rows_swap(double (*rows)[8], int i, int j)
{
    for (int k = 0; k < 8; ++k) {
        double t = rows[i][k];
        rows[i][k] = rows[j][k];
        rows[j][k] = t;
    }
}

/* Gauss-Jordan elimination with partial pivoting on [M | I]. */
bool matrix_inverse(const Matrix *matrix, Matrix *out)
{
    double rows[4][8];
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            rows[i][j] = matrix->m[4 * i + j];
            rows[i][4 + j] = i == j ? 1.0 : 0.0;
        }
    for (int column = 0; column < 4; ++column) {
        int pivot = column;
        for (int i = column + 1; i < 4; ++i)
            if (fabs(rows[i][column]) > fabs(rows[pivot][column]))
                pivot = i;
        if (!(fabs(rows[pivot][column]) > 0.0))
            return false;
        rows_swap(rows, column, pivot);
        double p = rows[column][column];
        for (int k = 0; k < 8; ++k)
            rows[column][k] /= p;
        for (int i = 0; i < 4; ++i) {
            double factor = rows[i][column];
            for (int k = 0; i != column && k < 8; ++k)
                rows[i][k] -= factor * rows[column][k];
        }
    }
    for (int i = 0; i < 4; ++i)
        memcpy(&out->m[4 * i], &rows[i][4], 4 * sizeof(double));
    return matrix_finite(out);
}

Affine matrix_affine(const double m[16])
{
    Affine a;
    for (int i = 0; i < 12; ++i)
        a.m[i] = (float)m[i];
    return a;
}

bool matrix_finite(const Matrix *matrix)
{
    for (int i = 0; i < 16; ++i)
        if (!isfinite(matrix->m[i]))
            return false;
    return true;
}

bool matrix_fits_float(const Matrix *matrix)
{
    for (int i = 0; i < 16; ++i)
        if (!(fabs(matrix->m[i]) <= (double)FLT_MAX))
            return false;
    return true;
}

bool matrix_equal(const Matrix *a, const Matrix *b)
{
    for (int i = 0; i < 16; ++i)
        if (!(a->m[i] == b->m[i]))
            return false;
    return true;
}

double matrix_determinant(const Matrix *matrix)
{
    const double *m = matrix->m;
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

bool matrix_swaps_handedness(const Matrix *matrix)
{
    return matrix_determinant(matrix) < 0.0;
}

double matrix_similarity_scale(const double m[16])
{
    double column[3][3];
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            column[j][i] = m[4 * i + j];
    double length = sqrt(column[0][0] * column[0][0] + column[0][1] * column[0][1] + column[0][2] * column[0][2]);
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            double dot = 0.0;
            for (int i = 0; i < 3; ++i)
                dot += column[j][i] * column[k][i];
            if (fabs(dot - (j == k ? length * length : 0.0)) > 1e-5 * length * length)
                return 0.0;
        }
    return length;
}

void matrix_vector(const Matrix *matrix, const double in[3], double out[3])
{
    const double *m = matrix->m;
    double x = in[0], y = in[1], z = in[2];
    for (int i = 0; i < 3; ++i)
        out[i] = m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z;
}

void matrix_point(const Matrix *matrix, const double in[3], double out[3])
{
    matrix_vector(matrix, in, out);
    for (int i = 0; i < 3; ++i)
        out[i] += matrix->m[4 * i + 3];
}

void matrix_normal(const Matrix *inverse, const double in[3], double out[3])
{
    const double *m = inverse->m;
    double x = in[0], y = in[1], z = in[2];
    for (int i = 0; i < 3; ++i)
        out[i] = m[i] * x + m[4 + i] * y + m[8 + i] * z;
}
