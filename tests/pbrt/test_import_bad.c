/* tests/bad: each file must be rejected with the message in its first line, "# expect: MESSAGE". tests/corpus/scene:
 * the fuzzer's seeds that have a name are valid files that use much of the format. */
#include "pbrt/test_import.h"

#include <dirent.h>
#include <string.h>

static struct dirent **bad_files, **corpus_files;
static int bad_count, corpus_count;

static int is_scene(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".pbrt") == 0;
}

/* Removes every occurrence of `directory`/ from text. */
static void directory_strip(char *text, const char *directory)
{
    size_t length = strlen(directory) + 1;
    for (char *p; (p = strstr(text, directory)) && p[length - 1] == '/';)
        memmove(p, p + length, strlen(p + length) + 1);
}

static void expectation_read(const char *path, char *line, size_t size)
{
    FILE *file = fopen(path, "r");
    ck_assert_ptr_nonnull(file);
    ck_assert_ptr_nonnull(fgets(line, (int)size, file));
    fclose(file);
    line[strcspn(line, "\n")] = '\0';
    static const char PREFIX[] = "# expect: ";
    ck_assert_msg(strncmp(line, PREFIX, strlen(PREFIX)) == 0, "%s: the first line is no expectation", path);
    memmove(line, line + strlen(PREFIX), strlen(line + strlen(PREFIX)) + 1);
}

START_TEST(bad_file)
{
    char directory[1100], path[1400], wanted[1024];
    Scene scene;
    Error error = {{0}, {0}};
    ImportOptions options = {.lenient = false};
    snprintf(directory, sizeof directory, "%s/bad", import_tests_dir());
    snprintf(path, sizeof path, "%s/%s", directory, bad_files[_i]->d_name);
    expectation_read(path, wanted, sizeof wanted);
    scene_init(&scene);
    bool good = pbrt_import(path, &options, &scene, &error) && scene_finish(&scene, &error);
    scene_destroy(&scene);
    ck_assert_msg(!good, "%s was accepted", path);
    directory_strip(error.message, directory);
    ck_assert_str_eq(error.message, wanted);
    ck_assert_msg(error.fix[0] != '\0', "%s: the error does not say what to do", path);
}
END_TEST

START_TEST(there_are_enough_bad_files)
{
    ck_assert_int_ge(bad_count, 60);
}
END_TEST

TCase *import_bad_case(void)
{
    char directory[1100];
    TCase *tcase = tcase_create("bad");
    snprintf(directory, sizeof directory, "%s/bad", import_tests_dir());
    bad_count = scandir(directory, &bad_files, is_scene, alphasort);
    tcase_add_test(tcase, there_are_enough_bad_files);
    tcase_add_loop_test(tcase, bad_file, 0, bad_count);
    return tcase;
}

START_TEST(corpus_file)
{
    char path[1400];
    Scene scene;
    Error error = {{0}, {0}};
    ImportOptions options = {.lenient = false};
    snprintf(path, sizeof path, "%s/corpus/scene/%s", import_tests_dir(), corpus_files[_i]->d_name);
    scene_init(&scene);
    ck_assert_msg(pbrt_import(path, &options, &scene, &error), "%s", error.message);
    scene_destroy(&scene);
}
END_TEST

START_TEST(there_is_a_corpus)
{
    ck_assert_int_ge(corpus_count, 8);
}
END_TEST

TCase *import_corpus_case(void)
{
    char directory[1100];
    TCase *tcase = tcase_create("corpus");
    snprintf(directory, sizeof directory, "%s/corpus/scene", import_tests_dir());
    corpus_count = scandir(directory, &corpus_files, is_scene, alphasort);
    tcase_add_test(tcase, there_is_a_corpus);
    tcase_add_loop_test(tcase, corpus_file, 0, corpus_count);
    return tcase;
}
