/* Statistics of chains, from the words that a pass leaves: acceptance and runs by depth, and R-hat over groups. */
#include "mmlt/chain_groups.h"
#include "render/chain_statistics.h"

#include "chain/chain_numbers.h"

#include "support/test_util.h"

#include <math.h>
#include <string.h>

#define CHAINS 64u
#define FIELDS (CHAIN_PASS_NUMBERS + NUMBER_VERTICES)

static uint *word(uint *words, uint field, uint i)
{
    return words + (size_t)field * CHAINS + i;
}

/* Chains of 3 + i % 2 segments with one light vertex, of luminance e^(value), at film position (x, y). */
static void chain_place(uint *words, uint i, double value, double x, double y)
{
    *word(words, CHAIN_PASS_KEY, i) = chain_key(3 + i % 2, 1);
    *word(words, CHAIN_PASS_LUMINANCE, i) = float_bits((float)exp(value));
    *word(words, CHAIN_PASS_NUMBERS + NUMBER_CAMERA, i) = (uint)(x * 4294967296.0);
    *word(words, CHAIN_PASS_NUMBERS + NUMBER_CAMERA + 1, i) = (uint)(y * 4294967296.0);
}

START_TEST(test_pass)
{
    static uint words[FIELDS * CHAINS];
    ChainStatistics statistics = {0}, other = {0};
    for (uint i = 0; i < CHAINS; ++i) {
        chain_place(words, i, 0.0, 0.0, 0.0);
        *word(words, CHAIN_PASS_TALLY + MUTATION_LIGHT, i) = 10u | 3u << 16;
        *word(words, CHAIN_PASS_RUN, i) = i | (100u + i) << 16;
    }
    chain_statistics_pass(&statistics, words, CHAINS, 10);
    chain_statistics_pass(&statistics, words, CHAINS, 10);
    ck_assert_uint_eq(statistics.steps, 20 * CHAINS);
    ck_assert(statistics.proposals[MUTATION_LIGHT][3] == 10 * CHAINS &&
              statistics.accepted[MUTATION_LIGHT][4] == 3 * CHAINS);
    ck_assert_uint_eq(chain_statistics_proposals(&statistics, 3), 10 * CHAINS);
    ck_assert(statistics.longest_run[3] == 162 && statistics.longest_run[4] == 163 && statistics.longest_run[5] == 0);
    other.longest_run[3] = 1000;
    other.r_hat[4] = 1.5;
    other.least_distinct = 0.25;
    chain_statistics_add(&other, &statistics);
    ck_assert(other.longest_run[3] == 1000 && other.longest_run[4] == 163);
    ck_assert(other.r_hat[4] == 1.5 && other.least_distinct == 0.25);
}
END_TEST

/* Two halves of chains with the same luminances and y; those of the second half are `apart` further to the right. */
static double halves_r_hat(double apart)
{
    static uint words[FIELDS * CHAINS];
    ChainGroups groups;
    memset(&groups, 0, sizeof groups);
    for (uint half = 0; half < 2; ++half) {
        for (uint i = 0; i < CHAINS; ++i) {
            double place = (double)(i / 2) / (CHAINS / 2);
            chain_place(words, i, -3.0 + place, 0.25 + 0.125 * place + half * apart, 0.5 * place);
        }
        chain_groups_add(&groups, words, CHAINS, half, 1);
    }
    ck_assert_double_eq(chain_groups_r_hat(&groups, 5), 0.0);
    ck_assert_double_eq_tol(chain_groups_r_hat(&groups, 3), chain_groups_r_hat(&groups, 4), 1e-9);
    return chain_groups_r_hat(&groups, 3);
}

/* n = 32 draws at positions k / 256: W = (n^2 - 1) / 12 n / (n - 1) / 256^2, B / n = apart^2 / 2. */
START_TEST(test_halves)
{
    const double n = CHAINS / 2.0, within = (n * n - 1.0) / 12.0 * n / (n - 1.0) / 65536.0;
    ck_assert_double_eq_tol(halves_r_hat(0.0), sqrt((n - 1.0) / n), 1e-6);
    ck_assert_double_eq_tol(halves_r_hat(0.01), sqrt((n - 1.0) / n + 0.5 * 0.01 * 0.01 / within), 1e-6);
    ck_assert_double_gt(halves_r_hat(0.5), 5.0);
}
END_TEST

/* Chains that never restart: the groups are ranges of adjacent chains that have nothing else in common. With t = 1 the
 * film coordinates are meaningless. */
START_TEST(test_parts)
{
    static uint words[FIELDS * CHAINS];
    ChainGroups groups;
    memset(&groups, 0, sizeof groups);
    for (uint i = 0; i < CHAINS; ++i) {
        uint part = i / (CHAINS / CHAIN_GROUPS);
        chain_place(words, i, 0.125 * (i / 2 % 2), i % 2 == 0 ? part / 8.0 + 0.01 * (i / 2 % 2) : 0.0, 0.5);
        if (i % 2 == 0)
            continue;
        *word(words, CHAIN_PASS_KEY, i) = chain_key(4, 4);
        *word(words, CHAIN_PASS_NUMBERS + NUMBER_CAMERA, i) = part << 28;
    }
    for (int pass = 0; pass < 10; ++pass)
        chain_groups_add(&groups, words, CHAINS, 0, CHAIN_GROUPS);
    for (uint group = 0; group < CHAIN_GROUPS; ++group)
        ck_assert_double_eq(groups.moments[3][1][group].count, 40.0);
    ck_assert_double_gt(chain_groups_r_hat(&groups, 3), 20.0);
    ck_assert_double_eq_tol(chain_groups_r_hat(&groups, 4), sqrt(39.0 / 40.0), 1e-9);
    *word(words, CHAIN_PASS_LUMINANCE, 0) = 0; /* a chain that never started */
    chain_groups_add(&groups, words, CHAINS, 0, CHAIN_GROUPS);
    ck_assert_double_eq(groups.moments[3][0][0].count, 43.0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("chain_statistics");
    TCase *tcase = tcase_create("chain_statistics");
    tcase_add_test(tcase, test_pass);
    tcase_add_test(tcase, test_halves);
    tcase_add_test(tcase, test_parts);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
