/* Writing of files: all or nothing, under the intended name, without overwriting anything else. */
#include "support/test_files.h"
#include "film/test_film.h"

#include "base/output_file.h"
#include "base/path_name.h"
#include "base/temporary_file.h"
#include "command/output_check.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>

/* A cancelled write leaves the old file; a link remains a link. */
START_TEST(test_output_file)
{
    OutputFile file;
    Error error;
    struct stat status;
    size_t size;
    test_file_write(test_path("old"), "old", 3);
    ck_assert(output_file_begin(&file, test_path("old"), &error));
    ck_assert_int_eq(write(file.descriptor, "newer", 5), 5);
    ck_assert_int_eq(test_folder_entries(), 2);
    output_file_cancel(&file);
    output_file_cancel(&file);
    unsigned char *bytes = test_file_read(test_path("old"), &size);
    ck_assert(size == 3 && memcmp(bytes, "old", 3) == 0);
    free(bytes);
    ck_assert_int_eq(symlink("old", test_path("link")), 0);
    ck_assert(output_file_begin(&file, test_path("link"), &error));
    ck_assert_int_eq(write(file.descriptor, "newer", 5), 5);
    ck_assert(output_file_commit(&file, &error));
    output_file_cancel(&file);
    bytes = test_file_read(test_path("old"), &size);
    ck_assert(size == 5 && memcmp(bytes, "newer", 5) == 0);
    free(bytes);
    ck_assert(lstat(test_path("link"), &status) == 0 && S_ISLNK(status.st_mode));
    ck_assert_int_eq(test_folder_entries(), 2);
}
END_TEST

/* Resolution of names, of existing and of missing files. */
START_TEST(test_path_target)
{
    char target[PATH_MAX], real[PATH_MAX];
    ck_assert_ptr_nonnull(realpath(test_folder, real));
    ck_assert_int_eq(symlink("b", test_path("a")), 0);
    ck_assert_int_eq(symlink("c", test_path("b")), 0);
    ck_assert_int_eq(symlink("loop", test_path("loop")), 0);
    ck_assert(path_target(test_path("a"), target));
    ck_assert(strncmp(target, real, strlen(real)) == 0 && strcmp(target + strlen(real), "/c") == 0);
    ck_assert(path_same(test_path("a"), test_path("b")) && path_same(test_path("./b"), test_path("c")));
    ck_assert(!path_same(test_path("a"), test_path("d")));
    test_file_write(test_path("c"), "c", 1);
    ck_assert(path_same(test_path("a"), test_path("c")) && !path_same(test_path("a"), test_path("d")));
    ck_assert_int_eq(link(test_path("c"), test_path("d")), 0);
    ck_assert(path_same(test_path("a"), test_path("d")));
    ck_assert(!path_target(test_path("loop"), target) && errno == ELOOP);
    ck_assert(!path_same("/dev/null", "/dev/null"));
    ck_assert(path_target("no/such/folder/x", target));
    ck_assert_str_eq(target, "no/such/folder/x");
}
END_TEST

/* Writing through a link whose target does not exist yet. */
START_TEST(test_dangling_link)
{
    Error error;
    struct stat status;
    ck_assert_int_eq(symlink("late", test_path("link")), 0);
    ck_assert(output_file_write(test_path("link"), "new", 3, &error));
    ck_assert(lstat(test_path("link"), &status) == 0 && S_ISLNK(status.st_mode));
    ck_assert(lstat(test_path("late"), &status) == 0 && S_ISREG(status.st_mode) && status.st_size == 3);
    ck_assert_int_eq(test_folder_entries(), 2);
}
END_TEST

static void child_leave(const char *path, bool unlinks)
{
    char name[PATH_MAX];
    pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        int descriptor = temporary_file_create(path, name);
        if (unlinks)
            temporary_files_unlink();
        _exit(descriptor >= 0 ? 0 : 1);
    }
    int status = 1;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert_int_eq(status, 0);
}

/* The next write to a name removes temporary files that a killed process left for it; those of a running process
 * stay. */
START_TEST(test_strays)
{
    char living[PATH_MAX], other[PATH_MAX];
    child_leave(test_path("x"), true);
    ck_assert_int_eq(test_folder_entries(), 0);
    child_leave(test_path("x"), false);
    child_leave(test_path("xy"), false);
    ck_assert_int_eq(test_folder_entries(), 2);
    int descriptor = temporary_file_create(test_path("x"), living);
    int second = temporary_file_create(test_path("x"), other);
    ck_assert(descriptor >= 0 && second >= 0);
    ck_assert_int_eq(test_folder_entries(), 3);
    close(descriptor); /* as if the process had died */
    close(second);
    Error error;
    ck_assert(output_file_write(test_path("x"), "new", 3, &error));
    temporary_file_forget(living);
    temporary_file_forget(other);
    ck_assert_int_eq(test_folder_entries(), 2);
}
END_TEST

/* Outputs must not overwrite inputs or each other; any number of them may go to devices. */
START_TEST(test_output_check)
{
    Error error;
    test_file_write(test_path("in"), "in", 2);
    ck_assert_int_eq(link(test_path("in"), test_path("hard")), 0);
    const CommandFile over[] = {{"the scene", test_path("in"), false}, {"the image", test_path("hard"), true}};
    ck_assert(!output_files_check(over, 2, "give another name", &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the image would overwrite the scene: "));
    const CommandFile twice[] = {{"a", test_path("new"), true}, {"b", NULL, true}, {"c", test_path("./new"), true}};
    ck_assert(!output_files_check(twice, 3, "give another name", &error));
    ck_assert_ptr_nonnull(strstr(error.message, "c would overwrite a: "));
    const CommandFile good[] = {{"in", test_path("in"), false},
                                {"in again", test_path("in"), false},
                                {"out", test_path("new"), true},
                                {"a", "/dev/null", true},
                                {"b", "/dev/null", true}};
    ck_assert_msg(output_files_check(good, 5, "", &error), "%s", error.message);
    ck_assert_int_eq(test_folder_entries(), 2);
}
END_TEST

TCase *film_files_tcase(void)
{
    TCase *tcase = tcase_create("files");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_output_file);
    tcase_add_test(tcase, test_path_target);
    tcase_add_test(tcase, test_dangling_link);
    tcase_add_test(tcase, test_strays);
    tcase_add_test(tcase, test_output_check);
    return tcase;
}
