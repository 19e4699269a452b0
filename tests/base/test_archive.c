/* What is saved is restored, and no damage to a file goes unnoticed. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/archive_file.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

/* Bytes that do not compress to nothing, so that a file has many to damage. */
#define WORDS 40

typedef struct State {
    uint32_t words[WORDS];
    double real;
    uint32_t count;
} State;

static State state_make(void)
{
    State state = {.real = 0.1, .count = 7};
    for (uint32_t i = 0; i < WORDS; ++i)
        state.words[i] = (i + 1) * 2654435761u;
    return state;
}

static void state_archive(Archive *archive, State *state)
{
    archive_same(archive, WORDS, "words");
    archive_bytes(archive, state->words, sizeof state->words);
    ARCHIVE_FIELD(archive, state->real);
    archive_count(archive, &state->count, 1, 9, "things");
}

static void state_save(State *state, const char *path)
{
    ArchiveWriter writer;
    Error error = {0};
    ck_assert_msg(archive_writer_begin(&writer, path, 2, &error), "%s", error.message);
    state_archive(&writer.archive, state);
    ck_assert_msg(archive_writer_finish(&writer, &error), "%s", error.message);
    ck_assert_msg(output_file_commit(&writer.file, &error), "%s", error.message);
    archive_writer_destroy(&writer);
}

/* Whether the file is whole and holds a state, and nothing else. */
static bool state_restore(State *state, const char *path, Error *error)
{
    ArchiveReader reader = {.descriptor = -1};
    if (!archive_reader_open(&reader, path, error))
        return false;
    state_archive(&reader.archive, state);
    bool good = archive_reader_finish(&reader, error);
    archive_reader_close(&reader);
    return good;
}

START_TEST(test_round_trip)
{
    State saved = state_make(), restored = {.count = 1};
    Error error = {0};
    state_save(&saved, test_path("state"));
    ck_assert_msg(state_restore(&restored, test_path("state"), &error), "%s", error.message);
    ck_assert_mem_eq(&restored, &saved, sizeof saved);
    ck_assert_int_eq(test_folder_entries(), 1);
}
END_TEST

/* More than the buffers hold, in pieces of all sizes. */
START_TEST(test_large)
{
    const size_t size = 3000000;
    unsigned char *saved = malloc(size), *restored = malloc(size);
    ArchiveWriter writer;
    ArchiveReader reader;
    Error error = {0};
    uint32_t x = 1;
    for (size_t i = 0; i < size; ++i)
        saved[i] = (unsigned char)((x = x * 1664525u + 1013904223u) >> 24);
    ck_assert(archive_writer_begin(&writer, test_path("large"), 1, &error));
    for (size_t i = 0, n = 1; i < size; i += n, n = n * 3 % 400009)
        archive_bytes(&writer.archive, saved + i, n < size - i ? n : size - i);
    ck_assert(archive_writer_finish(&writer, &error) && output_file_commit(&writer.file, &error));
    archive_writer_destroy(&writer);
    ck_assert(archive_reader_open(&reader, test_path("large"), &error));
    archive_bytes(&reader.archive, restored, size);
    ck_assert(archive_reader_finish(&reader, &error));
    archive_reader_close(&reader);
    ck_assert(memcmp(saved, restored, size) == 0);
    free(saved);
    free(restored);
}
END_TEST

/* A file that ends early, anywhere, is not restored, nor is one that something follows. */
START_TEST(test_truncated)
{
    State state = state_make();
    Error error;
    size_t size;
    state_save(&state, test_path("whole"));
    unsigned char *bytes = test_file_read(test_path("whole"), &size);
    ck_assert_uint_gt(size, WORDS * sizeof state.words[0]);
    for (size_t length = 0; length < size; ++length) {
        test_file_write(test_path("part"), bytes, length);
        TEST_TRUE(!state_restore(&state, test_path("part"), &error));
        TEST_TRUE(error.message[0] != '\0');
    }
    unsigned char *longer = calloc(1, size + 1);
    memcpy(longer, bytes, size);
    test_file_write(test_path("longer"), longer, size + 1);
    ck_assert(!state_restore(&state, test_path("longer"), &error));
    free(longer);
    free(bytes);
}
END_TEST

/* Bits of the frame's descriptor that Zstandard leaves unused do not count: then the state is the saved one all the
 * same. */
START_TEST(test_flipped)
{
    State saved = state_make();
    Error error;
    size_t size, unused = 0;
    state_save(&saved, test_path("whole"));
    unsigned char *bytes = test_file_read(test_path("whole"), &size);
    for (size_t bit = 0; bit < 8 * size; ++bit) {
        State restored = {.count = 1};
        bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
        test_file_write(test_path("flipped"), bytes, size);
        if (state_restore(&restored, test_path("flipped"), &error)) {
            TEST_TRUE(memcmp(&restored, &saved, sizeof saved) == 0);
            ++unused;
        }
        bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    ck_assert_uint_le(unused, 8);
    free(bytes);
}
END_TEST

/* Sizes that do not fit, and a state that is shorter or longer than the saved one. */
START_TEST(test_sizes)
{
    State state = state_make();
    Error error = {0};
    ArchiveReader reader;
    state.count = 10; /* one too many */
    state_save(&state, test_path("state"));
    State restored = {.count = 3};
    ck_assert(!state_restore(&restored, test_path("state"), &error));
    ck_assert_ptr_nonnull(strstr(error.message, "things: 10 were saved, but there can be 1 to 9"));
    ck_assert_uint_eq(restored.count, 3);

    ck_assert(archive_reader_open(&reader, test_path("state"), &error));
    archive_same(&reader.archive, WORDS + 1, "words");
    archive_bytes(&reader.archive, restored.words, sizeof restored.words); /* does nothing after a failure */
    ck_assert(!archive_reader_finish(&reader, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "words: 40 were saved, but there are 41"));
    ck_assert_uint_ne(restored.words[0], 0);
    archive_reader_close(&reader);

    ck_assert(archive_reader_open(&reader, test_path("state"), &error));
    archive_same(&reader.archive, WORDS, "words");
    ck_assert(!archive_reader_finish(&reader, &error)); /* most is left over */
    archive_reader_close(&reader);

    ck_assert(archive_reader_open(&reader, test_path("state"), &error));
    state.count = 5;
    archive_bytes(&reader.archive, state.words, 8);
    for (int i = 0; i < 2; ++i)
        archive_bytes(&reader.archive, state.words, sizeof state.words); /* the second time there is less */
    ck_assert(reader.archive.failed);
    archive_reader_close(&reader);
}
END_TEST

typedef struct Numbers {
    double doubles[3];
    float floats[3];
    bool flags[2];
} Numbers;

static void numbers_archive(Archive *archive, Numbers *numbers)
{
    archive_doubles(archive, numbers->doubles, 3, (NumberRange){-1.0, 2.5}, "heights");
    archive_floats(archive, numbers->floats, 3, RANGE_FLOATS, "widths");
    archive_flags(archive, numbers->flags, 2, "doors");
}

/* Restores what `saved` was saved as, with one byte changed (`place` < 0: none). */
static bool numbers_restore(const Numbers *saved, int place, unsigned char byte, Numbers *restored, Error *error)
{
    Numbers copy = *saved;
    ArchiveMemory memory = {0};
    Archive archive = archive_to_memory(&memory);
    ArchiveWriter writer;
    ArchiveReader reader;
    numbers_archive(&archive, &copy);
    ck_assert(!archive.failed);
    if (place >= 0)
        memory.bytes[place] = byte;
    ck_assert(archive_writer_begin(&writer, test_path("numbers"), 1, error));
    archive_bytes(&writer.archive, memory.bytes, memory.size);
    ck_assert(archive_writer_finish(&writer, error) && output_file_commit(&writer.file, error));
    archive_writer_destroy(&writer);
    archive_memory_destroy(&memory);
    ck_assert(archive_reader_open(&reader, test_path("numbers"), error));
    numbers_archive(&reader.archive, restored);
    bool good = archive_reader_finish(&reader, error);
    archive_reader_close(&reader);
    return good;
}

/* What is out of range is saved, but not restored. */
START_TEST(test_ranges)
{
    static const struct {
        Numbers numbers;
        const char *message; /* NULL: all is in range */
    } CASES[] = {
        {{{-1.0, 2.5, 0.0}, {-FLT_MAX, FLT_MAX, 0.0f}, {true, false}}, NULL},
        {{{0.0, 0.0, 2.6}, {0.0f}, {false}}, "heights: 2.6 was saved, but there can be -1 to 2.5"},
        {{{-1.1, 0.0, 0.0}, {0.0f}, {false}}, "heights: -1.1 was saved"},
        {{{0.0, (double)NAN, 0.0}, {0.0f}, {false}}, "heights: NaN was saved"},
        {{{0.0}, {0.0f, 0.0f, (float)INFINITY}, {false}}, "widths: inf was saved"},
        {{{0.0}, {0.0f, (float)NAN, 0.0f}, {false}}, "widths: NaN was saved"},
    };
    Error error = {0};
    Numbers restored = {.doubles = {0.0}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; ++i) {
        bool good = numbers_restore(&CASES[i].numbers, -1, 0, &restored, &error);
        ck_assert_int_eq(good, CASES[i].message == NULL);
        if (CASES[i].message)
            ck_assert_msg(strstr(error.message, CASES[i].message) != NULL, "%s", error.message);
        else
            ck_assert(restored.flags[0] && !restored.flags[1] && restored.doubles[1] == 2.5);
    }
    ck_assert(!numbers_restore(&CASES[0].numbers, sizeof restored.doubles + sizeof restored.floats + 1, 2, &restored,
                               &error));
    ck_assert_ptr_nonnull(strstr(error.message, "doors: 2 was saved, but there can be 0 or 1"));
}
END_TEST

/* An archive that has failed leaves no file, and the old one stays. */
START_TEST(test_failed)
{
    State state = state_make();
    ArchiveWriter writer;
    Error error = {0};
    ck_assert(archive_writer_begin(&writer, test_path("state"), 1, &error));
    state_archive(&writer.archive, &state);
    archive_fail(&writer.archive, "no");
    archive_fail(&writer.archive, "never");
    ck_assert(!archive_writer_finish(&writer, &error));
    ck_assert_str_eq(error_text(&error), "no");
    archive_writer_destroy(&writer);
    archive_writer_destroy(&writer);
    ck_assert_int_eq(test_folder_entries(), 0);
}
END_TEST

/* Neither read nor written: what is no regular file. */
START_TEST(test_not_regular)
{
    ArchiveReader reader;
    ArchiveWriter writer;
    Error error;
    ck_assert_int_eq(mkfifo(test_path("pipe"), 0600), 0);
    ck_assert(!archive_reader_open(&reader, test_path("pipe"), &error));
    ck_assert(!archive_reader_open(&reader, test_folder, &error));
    ck_assert(!archive_reader_open(&reader, test_path("none"), &error));
    archive_reader_close(&reader);
    ck_assert(!archive_writer_begin(&writer, "/dev/null", 1, &error));
    archive_writer_destroy(&writer);
    ck_assert(!archive_writer_begin(&writer, test_path("no/folder"), 1, &error));
    archive_writer_destroy(&writer);
}
END_TEST

START_TEST(test_memory)
{
    State saved = state_make();
    ArchiveMemory memory = {0};
    for (int i = 0; i < 3; ++i) {
        Archive archive = archive_to_memory(&memory);
        memory.size = 0;
        state_archive(&archive, &saved);
        ck_assert(!archive.failed);
        ck_assert_uint_eq(memory.size, sizeof(uint64_t) + sizeof saved.words + sizeof saved.real + sizeof saved.count);
        ck_assert_mem_eq(memory.bytes + sizeof(uint64_t), saved.words, sizeof saved.words);
    }
    archive_memory_destroy(&memory);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("archive");
    TCase *tcase = tcase_create("archive");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_round_trip);
    tcase_add_test(tcase, test_large);
    tcase_add_test(tcase, test_truncated);
    tcase_add_test(tcase, test_flipped);
    tcase_add_test(tcase, test_sizes);
    tcase_add_test(tcase, test_ranges);
    tcase_add_test(tcase, test_failed);
    tcase_add_test(tcase, test_not_regular);
    tcase_add_test(tcase, test_memory);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
