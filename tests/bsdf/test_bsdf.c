#include "support/bsdf_cases.h"

int main(void)
{
    Suite *suite = suite_create("bsdf");
    suite_add_tcase(suite, bsdf_formula_tests());
    suite_add_tcase(suite, bsdf_hair_tests());
    suite_add_tcase(suite, bsdf_identity_tests());
    suite_add_tcase(suite, bsdf_phase_tests());
    suite_add_tcase(suite, bsdf_sampling_tests());
    suite_add_tcase(suite, bsdf_inverse_tests());
    suite_add_tcase(suite, bsdf_energy_tests());
    suite_add_tcase(suite, bsdf_coated_tests());
    suite_add_tcase(suite, bsdf_coated_conductor_tests());
    suite_add_tcase(suite, bsdf_coat_medium_tests());
    suite_add_tcase(suite, bsdf_mix_tests());
    return test_run(suite);
}
