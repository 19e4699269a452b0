/* Matrix inverse for tests. */
#ifndef TWINLIGHT_TESTS_SUPPORT_TEST_MATRIX_H
#define TWINLIGHT_TESTS_SUPPORT_TEST_MATRIX_H

#include "base/matrix.h"

#include <check.h>
#include <string.h>

/* Both 4x4, row-major. */
static inline void test_matrix_inverse(const double m[16], double out[16])
{
    Matrix matrix, inverse;
    memcpy(matrix.m, m, sizeof matrix.m);
    ck_assert(matrix_inverse(&matrix, &inverse));
    memcpy(out, inverse.m, sizeof inverse.m);
}

#endif
