/* 4x4 matrices in double precision, row-major, acting on column vectors: m[4 i + j] is row i, column j. */
#ifndef TWINLIGHT_BASE_MATRIX_H
#define TWINLIGHT_BASE_MATRIX_H

#include "math/vec.h"

typedef struct Matrix {
    double m[16];
} Matrix;

Matrix matrix_identity(void);
Matrix matrix_translate(double x, double y, double z);
Matrix matrix_scale(double x, double y, double z);

/* Rotation by `degrees` about the axis, counterclockwise seen against it (Rodrigues). The axis must not be zero. */
Matrix matrix_rotate(double degrees, const double axis[3]);

/* World to camera for pbrt's left-handed camera: eye at the origin, `look` on +z, `up` in the half plane of +y. False
 * when eye and look coincide or up is parallel to the view. */
bool matrix_look_at(const double eye[3], const double look[3], const double up[3], Matrix *out);

/* Apply b first: (a b) p = a (b p). */
Matrix matrix_multiply(const Matrix *a, const Matrix *b);

/* False when singular. */
bool matrix_inverse(const Matrix *matrix, Matrix *out);

/* The upper three rows in single precision. */
Affine matrix_affine(const double m[16]);

bool matrix_finite(const Matrix *matrix);

/* Every element fits a float. */
bool matrix_fits_float(const Matrix *matrix);

bool matrix_equal(const Matrix *a, const Matrix *b);

/* Of the upper left 3x3 part. */
double matrix_determinant(const Matrix *matrix);

/* matrix_determinant is negative: left- and right-handed change places. */
bool matrix_swaps_handedness(const Matrix *matrix);

/* a x b; out must be neither. */
void vector_cross(const double a[3], const double b[3], double out[3]);

/* out = M (x, y, z, 1), and without the translation; in and out may be the same. */
void matrix_point(const Matrix *matrix, const double in[3], double out[3]);
void matrix_vector(const Matrix *matrix, const double in[3], double out[3]);

/* n' = inverse^T n from the inverse of the map of points. Not normalised. */
void matrix_normal(const Matrix *inverse, const double in[3], double out[3]);

#endif
