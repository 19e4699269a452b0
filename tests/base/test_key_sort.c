/* Items are sorted by their keys, and keep their order where keys are equal. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/key_sort.h"

#include <string.h>

#define COUNT 3000

/* Keys of `bits` random bits from bit `low` on, below which and above which they are all alike. */
static void check_sorted(size_t count, unsigned low, unsigned bits)
{
    static KeyedItem items[COUNT];
    static char places[COUNT];
    unsigned state = 7;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t random =
            (uint64_t)test_random(&state) << 40u ^ (uint64_t)test_random(&state) << 20u ^ (uint64_t)test_random(&state);
        const uint64_t part = bits < 64u ? random & ((UINT64_C(1) << bits) - 1u) : random;
        items[i] = (KeyedItem){part << low | UINT64_C(1) << (low > 0u ? low - 1u : 0u), &places[i]};
    }
    static KeyedItem before[COUNT];
    memcpy(before, items, count * sizeof *items);
    ck_assert(key_sort(items, count));
    static bool seen[COUNT];
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < count; ++i) {
        const size_t place = (size_t)((const char *)items[i].item - places);
        ck_assert(!seen[place]);
        seen[place] = true;
        ck_assert_uint_eq(items[i].key, before[place].key);
        if (i > 0)
            ck_assert(items[i - 1].key < items[i].key ||
                      (items[i - 1].key == items[i].key && items[i - 1].item < items[i].item));
    }
}

START_TEST(test_sorted)
{
    for (unsigned low = 0; low < 64; low += 7)
        for (unsigned bits = 1; low + bits <= 64; bits += 3)
            check_sorted(COUNT, low, bits);
    check_sorted(COUNT, 0, 64);
    check_sorted(COUNT, 3, 0); /* all alike */
    check_sorted(1, 0, 64);
    check_sorted(2, 0, 64);
    check_sorted(0, 0, 64);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("key_sort");
    TCase *tcase = tcase_create("key_sort");
    tcase_add_test(tcase, test_sorted);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
