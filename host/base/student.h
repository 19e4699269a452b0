/* Student's t distribution. */
#ifndef TWINLIGHT_BASE_STUDENT_H
#define TWINLIGHT_BASE_STUDENT_H

/* The probability that |T| > |t| for T with `freedom` > 0 degrees of freedom, which need not be whole. 1 for t = 0, 0
 * for an infinite t. */
double student_two_sided(double t, double freedom);

/* The t > 0 that |T| exceeds with that probability, 0 < probability < 1. */
double student_threshold(double probability, double freedom);

#endif
