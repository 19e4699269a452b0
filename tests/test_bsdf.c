#include "test_util.h"

START_TEST(test_placeholder)
{
    ck_assert_int_eq(1, 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bsdf");
    TCase *tcase = tcase_create("bsdf");
    tcase_add_test(tcase, test_placeholder);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
