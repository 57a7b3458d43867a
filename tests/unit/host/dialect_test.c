/* Dialects: every error in one gives a message of one line that names the file and is printable. */
#include <sys/mman.h>
#include <unistd.h>

#include "host/dialect.h"
#include "layout/layout.h"
#include "reading/layout_read.h"
#include "support/support.h"

#define FRAMING "name = 'n', framing = { ends = { '\\r' } }, other_error = '9',\n"
#define ENCODE                                                                                               \
    "encode = { answer = function() end, complete = function() end, refuse = function() end,\n"              \
    "           bad = function() end },\n"
#define COMMANDS "commands = { A = { does = 'STATUS' } },\n"
#define DECODE "decode = function() return { command = 'A' } end,\n"

static wh_sandbox_t *sandbox;
static const wh_layout_t *layout;
static wh_dialect_t dialect;
static char path[40]; /* the path of a file in memory */
static int file;
static const wh_client_t client = {"", 1};

static int load_layout(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    sandbox = wh_sandbox_new(NULL);
    layout = wh_layout_load(sandbox, "lua/layouts/paper.lua", &result);
    file = memfd_create("dialect", 0);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    return layout && file >= 0 ? 0 : 1;
}

static int free_layout(void **state) {
    (void)state;
    wh_sandbox_free(sandbox);
    return close(file);
}

static bool open_text(const char *text) {
    assert_int_equal(ftruncate(file, 0), 0);
    assert_int_equal(pwrite(file, text, strlen(text), 0), (ssize_t)strlen(text));
    return wh_dialect_open(&dialect, path, NULL);
}

/* One printable line that begins with the file's name and contains this text. */
static void assert_message(const char *expected) {
    assert_memory_equal(dialect.message, path, strlen(path));
    assert_non_null(strstr(dialect.message, expected));
    for (const char *c = dialect.message; *c; ++c) {
        assert_true((unsigned char)*c >= 0x20 && *c != 0x7F);
    }
}

static void names_with_control_characters(void **state) {
    (void)state;
    assert_true(open_text("return {" FRAMING DECODE COMMANDS ENCODE "arms = { ['\\x1b[A'] = '\\x05E' } }"));
    assert_false(wh_dialect_fits(&dialect, layout));
    assert_message(": arms.\\x1B[A: \"\\x05E\" (expected a name of the layout's: EE, PA)");
    wh_dialect_close(&dialect);
    assert_true(open_text("return {" FRAMING DECODE COMMANDS ENCODE "stations = { ['1'] = 'A\\127' } }"));
    assert_false(wh_dialect_fits(&dialect, layout));
    assert_message(": stations.1: \"A\\x7F\" (expected a name of the layout's: A, ");
    wh_dialect_close(&dialect);
}

static const wh_frame_t frame_a = {.kind = WH_FRAME_GOOD, .body = (const uint8_t *)"A", .body_size = 1};

static void a_name_that_fills_the_message(void **state) {
    (void)state;
    static char text[4000];
    (void)snprintf(text, sizeof text,
                   "return {" FRAMING COMMANDS ENCODE
                   "decode = function() error(('x'):rep(900) .. '%s', 0) end }",
                   path);
    assert_true(open_text(text));
    wh_request_t request;
    wh_failure_t failure;
    assert_int_equal(wh_dialect_decode(&dialect, &client, &frame_a, &request, &failure), WH_DECODED_MISTAKE);
    assert_message(": xxx");
    wh_dialect_forget(&dialect, &request);
    wh_dialect_close(&dialect);
}

/* A limit is spent in the file, and in its functions. */
static void limits_that_are_spent(void **state) {
    (void)state;
    wh_request_t request;
    wh_failure_t failure;
    assert_false(open_text("while true do end"));
    assert_message(":1: instruction budget");
    wh_dialect_close(&dialect);
    assert_false(open_text("local a = ('x'):rep(1 << 25)"));
    assert_message(":1: memory");
    wh_dialect_close(&dialect);
    assert_true(open_text("return {" FRAMING COMMANDS ENCODE "decode = function() while true do end end }"));
    assert_int_equal(wh_dialect_decode(&dialect, &client, &frame_a, &request, &failure), WH_DECODED_MISTAKE);
    assert_message(": instruction budget");
    wh_dialect_forget(&dialect, &request);
    wh_dialect_close(&dialect);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_with_control_characters),
        cmocka_unit_test(a_name_that_fills_the_message),
        cmocka_unit_test(limits_that_are_spent),
    };
    return cmocka_run_group_tests(tests, load_layout, free_layout);
}
