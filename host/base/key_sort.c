#include "base/key_sort.h"

#include <stdlib.h>
#include <string.h>

#define DIGIT_BITS 11u
#define DIGIT_VALUES (1u << DIGIT_BITS)
#define DIGITS ((64u + DIGIT_BITS - 1u) / DIGIT_BITS)

static size_t digit_of(const KeyedItem *item, size_t digit)
{
    return (size_t)(item->key >> digit * DIGIT_BITS) & (DIGIT_VALUES - 1u);
}

/* How many items have each value of each digit. */
static void digits_count(const KeyedItem *items, size_t count, size_t (*counts)[DIGIT_VALUES])
{
    for (size_t i = 0; i < count; ++i)
        for (size_t digit = 0; digit < DIGITS; ++digit)
            ++counts[digit][digit_of(&items[i], digit)];
}

/* Moves the items to `sorted`, ordered by one digit. places: how many have each of its values; changed. */
static void items_move(const KeyedItem *items, size_t count, size_t digit, size_t *places, KeyedItem *sorted)
{
    for (size_t value = 0, next = 0; value < DIGIT_VALUES; ++value) {
        const size_t number = places[value];
        places[value] = next;
        next += number;
    }
    for (size_t i = 0; i < count; ++i)
        sorted[places[digit_of(&items[i], digit)]++] = items[i];
}

/* Radix sort from the least significant digit (Knuth, The Art of Computer Programming 3, 5.2.5), without the digits
 * that all keys share. */
bool key_sort(KeyedItem *items, size_t count)
{
    size_t(*counts)[DIGIT_VALUES] = calloc(DIGITS, sizeof *counts);
    KeyedItem *other = malloc((count > 0 ? count : 1) * sizeof *other), *from = items, *to = other;
    const bool enough = counts && other;
    if (enough)
        digits_count(items, count, counts);
    for (size_t digit = 0; enough && count > 0 && digit < DIGITS; ++digit) {
        if (counts[digit][digit_of(items, digit)] == count)
            continue;
        items_move(from, count, digit, counts[digit], to);
        KeyedItem *moved = to;
        to = from;
        from = moved;
    }
    if (enough && from != items)
        memcpy(items, from, count * sizeof *items);
    free(counts);
    free(other);
    return enough;
}
