/* What tests of watched renderings share. */
#ifndef TWINLIGHT_TESTS_SERVE_TEST_SERVE_H
#define TWINLIGHT_TESTS_SERVE_TEST_SERVE_H

#include <check.h>

#include <sys/types.h>

TCase *tev_case(void);
TCase *page_case(void);
TCase *clients_case(void);

/* Starts ./twinlight render --integrator=pt --no-png of scenes/cornell.pbrt with the arguments that are not NULL, at
 * most four; standard error goes to `messages`, unless that is NULL. */
pid_t program_start(const char *const arguments[4], const char *messages);

#endif
