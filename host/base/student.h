/* Student's t distribution. */
#ifndef TWINLIGHT_BASE_STUDENT_H
#define TWINLIGHT_BASE_STUDENT_H

/* P(|T| > |t|) for T with `freedom` > 0 degrees of freedom, not necessarily an integer. 1 for t = 0, 0 for infinite
 * t. */
double student_two_sided(double t, double freedom);

/* The t > 0 with P(|T| > t) = probability, 0 < probability < 1. */
double student_threshold(double probability, double freedom);

#endif
