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

/* Rotation by `degrees` about a nonzero axis, counterclockwise when looking against it (Rodrigues' formula). */
Matrix matrix_rotate(double degrees, const double axis[3]);

/* World to camera for pbrt's left-handed camera: eye at the origin, `look` on the +z axis, `up` in the half-plane of
 * +y. False if eye and look coincide or up is parallel to the view direction. */
bool matrix_look_at(const double eye[3], const double look[3], const double up[3], Matrix *out);

/* The product a b: applies b first, (a b) p = a (b p). */
Matrix matrix_multiply(const Matrix *a, const Matrix *b);

/* False if the matrix is singular. */
bool matrix_inverse(const Matrix *matrix, Matrix *out);

/* The upper three rows in single precision. */
Affine matrix_affine(const double m[16]);

bool matrix_finite(const Matrix *matrix);

/* Whether every element is in a float's range. */
bool matrix_fits_float(const Matrix *matrix);

bool matrix_equal(const Matrix *a, const Matrix *b);

/* Determinant of the upper left 3x3 part. */
double matrix_determinant(const Matrix *matrix);

/* Whether matrix_determinant is negative, which exchanges left- and right-handed. */
bool matrix_swaps_handedness(const Matrix *matrix);

/* The factor of a similarity transform (rotation, reflection, uniform scale); 0 if it is none to within 1e-5. */
double matrix_similarity_scale(const double m[16]);

/* out = a x b; `out` must not be a or b. */
void vector_cross(const double a[3], const double b[3], double out[3]);

/* Makes v a unit vector; false, and v unchanged, if it has no direction. */
bool vector_normalize(double v[3]);

/* out = M (x, y, z, 1), and the same without translation; `in` and `out` may be the same. */
void matrix_point(const Matrix *matrix, const double in[3], double out[3]);
void matrix_vector(const Matrix *matrix, const double in[3], double out[3]);

/* n' = inverse^T n, from the inverse of the matrix that transforms points. Not normalised. */
void matrix_normal(const Matrix *inverse, const double in[3], double out[3]);

#endif
