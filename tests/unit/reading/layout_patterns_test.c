/* The file of patterns that a layout names: where it is, what of it counts in the layout's hash, and what is refused. */
#include "support/layout.h"

#include <stdlib.h>
#include <unistd.h>

#include "reading/layout_read.h"

#define CELL "grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 } } }"

static char folder[WH_TEST_PATH];
static char path[2 * WH_TEST_PATH];

/* A new file with this text, named by its whole path. */
static const char *fields_with(const char *text) {
    static char fields[4 * WH_TEST_PATH];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    (void)snprintf(fields, sizeof fields, "patterns = '%s', " CELL, path);
    return fields;
}

static int make_folder(void **state) {
    if (!mkdtemp(wh_test_path(folder, "patterns"))) {
        return -1;
    }
    (void)snprintf(path, sizeof path, "%s/mine.lua", folder);
    return open_sandbox(state);
}

static int remove_folder(void **state) {
    (void)unlink(path);
    return rmdir(folder) == 0 ? close_sandbox(state) : -1;
}

static void a_layout_without_patterns_names_none(void **state) {
    (void)state;
    assert_null(read_sound(CELL)->patterns);
}

static void the_files_text_counts_in_the_hash_and_its_path_does_not(void **state) {
    (void)state;
    const uint64_t none = wh_layout_hash(read_sound(CELL));
    const wh_layout_t *layout = read_sound(fields_with("return {}"));
    const uint64_t one = wh_layout_hash(layout);
    assert_string_equal(layout->patterns, path);
    assert_true(wh_layout_hash(read_sound(fields_with("return { }"))) != one);
    assert_true(wh_layout_hash(read_sound(fields_with("return {}\n"))) != one);
    assert_true(wh_layout_hash(read_sound(fields_with(""))) != none);
    (void)unlink(path);
    (void)snprintf(path, sizeof path, "%s/other.lua", folder);
    assert_true(wh_layout_hash(read_sound(fields_with("return {}"))) == one);
    assert_true(wh_layout_hash(read_sound(CELL)) == none);
}

static void what_is_no_file_is_refused(void **state) {
    (void)state;
    char fields[4 * WH_TEST_PATH];
    expect_refused("patterns = 'not_there.lua', " CELL,
                   "cell.lua: patterns: \"not_there.lua\" (expected a Lua file: not_there.lua: No such file");
    (void)snprintf(fields, sizeof fields, "patterns = '%s', " CELL, folder);
    expect_refused(fields, "it is no regular file");
    expect_refused("patterns = {}, " CELL, "cell.lua: patterns: a table (expected text");
    expect_refused("patterns = '', " CELL, "cell.lua: patterns: \"\" (expected text");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_layout_without_patterns_names_none),
        cmocka_unit_test(the_files_text_counts_in_the_hash_and_its_path_does_not),
        cmocka_unit_test(what_is_no_file_is_refused)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
