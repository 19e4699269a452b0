/* What stratification leaves of the variance of path tracing: generations state that of independent samples. */
#ifndef TWINLIGHT_MMLT_COMBINATION_STRATIFIED_H
#define TWINLIGHT_MMLT_COMBINATION_STRATIFIED_H

#include "mmlt/combination_learn.h"

/* The parts that are left of the variances of indirect and of direct light; at most 1. */
typedef struct StratifiedParts {
    double indirect, direct;
} StratifiedParts;

/* Samples of both replicas are two sequences, whose means are compared, or one (Combination.one_sequence): then the
 * mean is compared with that at half as many samples or fewer, and the part is what such a comparison said last. 1
 * until there are enough images, or if `other`, the other replica, is `combination` itself. */
StratifiedParts combination_stratified(Combination *combination, const Combination *other);

#endif
