/* The parts of test_geometry, one per file. */
#ifndef TWINLIGHT_TESTS_GEOMETRY_GEOMETRY_SUITES_H
#define TWINLIGHT_TESTS_GEOMETRY_GEOMETRY_SUITES_H

#include <check.h>

TCase *geometry_quadrics_tcase(void); /* spheres, disks, patches, surfaces */
TCase *geometry_cylinder_tcase(void);
TCase *geometry_curve_tcase(void);
TCase *geometry_rays_tcase(void); /* Embree against brute force, instances, ties */
TCase *geometry_backend_tcase(void); /* threads, denormals, counters */

#endif
