/* The report for people: its contents and its alignment. */
#include <float.h>
#include <jansson.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "print/record_print.h"
#include "support/record.h"
#include "support/support.h"
#include "text/grid.h"
#include "text/json_compare.h"

static const wh_style_t piped = {false, true, 0};

static char *print(const wh_record_t *record, const wh_style_t *style) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_table(record, out, style, NULL), 0);
    fclose(out);
    return text;
}

static void assert_says(const char *text, const char *wanted) {
    if (!strstr(text, wanted)) {
        print_error("not found: %s\nin:\n%s", wanted, text);
        fail();
    }
}

static void assert_silent(const char *text, const char *unwanted) {
    if (strstr(text, unwanted)) {
        print_error("found: %s\nin:\n%s", unwanted, text);
        fail();
    }
}

static void transfer(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    (void)fixture_event(&f, WH_EVENT_SETTLED, 13090000, 0, FIXTURE_EE); /* no miss */
    f.record.unlooked = WH_RECORD_UNLOOKED;
    char *text = print(&f.record, &piped);
    assert_says(text, "lua/examples/01_transfer.lua on lua/layouts/paper.lua\n"
                      "tolerance paper: |dr_proj_z| < 0.5 mm, |dr_proj_xy| < 50 mm, "
                      "n1_proj_n2 > 0.99 (8.11°)\n");
    assert_says(text, "\nCommands\n"
                      "line  command   begin s   end s  result  taken           |dr_proj_z| < 0.5  rim gap  "
                      "|dr_proj_xy| < 50  n1_proj_n2 > 0.99\n"
                      "   3  GET A 1     0.000   6.412  ok      Wafer 1 by EE              0.4498   4.3765  "
                      "           0.0118           0.999657\n"
                      "   3  PUT B 2     6.412  13.090  ok      Wafer 1 let go\n");
    assert_says(text, "\nWafers\n"
                      "wafer     held by  lies in    dX mm   dY mm   dz mm  tilt deg\n"
                      "Wafer 1            B 2       0.0000  0.0000  0.2000     1.500\n"
                      "Wafer 2            B 10     13.7940  7.2385  0.2000     0.000\n"
                      "Wäfer №3           A 25      0.0000  0.0000  0.0000     0.000\n"
                      "Wafer 1 keeps 1.500° against EE, its rim 4.38 mm from the pads' plane: "
                      "the robot cannot tilt.\n");
    assert_says(text, "\n✓ all 2 met\n");
    assert_says(text, "4 commands, 22.870 s simulated in 22,870 slices; 0.009 s of wall time, "
                      "2,628 times faster than real time\n"
                      "no wafers per hour: no station is known to count\nhash 00c0ffee12345678\n! collisions "
                      "were not looked for: the layout has no collision = true\nok\n");
    assert_silent(text, "Misses");
    assert_silent(text, "Hand-over");
    assert_silent(text, "Errors");
    assert_silent(text, "\033");
    free(text);
}

static void failed_run(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    char *text = print(&f.record, &piped);
    assert_says(text, "error 42 WAFER_MISSING");
    assert_says(text, "\nErrors\nline 9: GET A 3: wafer missing: nothing was on the gripper");
    assert_says(text, "Wafer 2 EE → PA ");
    assert_says(text, "  |dr_proj_z| 0.700 is not below 0.5 (by 0.200 mm)\n");
    assert_says(text, "  |dr_proj_xy| 55.000 is not below 50 (by 5.000 mm)\n");
    assert_says(text, "  ready, but EE holds it\n");
    assert_says(text, "  in no slot, 12.500 mm above the nearest slot below or the floor\n");
    assert_says(text, "  Wafer 1 lies in that slot\n");
    assert_says(text, "  a number is NaN or infinite\n");
    assert_says(text, "\n✗    12  Wafer 3 on EE, but nobody holds it\n✓ 1 met\n");
    assert_says(text, "failed: 1 expectation not met, 1 command with an error, 3 complaints\n"
                      "02_prealigner.lua:9: error 42: wafer missing\n");
    free(text);
}

static void handover(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    char *text = print(&f.record, &piped);
    assert_says(text, "\nHand-over\n"
                      "Wafer 2, EE → PA, at 9.220 s: isReadyToPickPA: true\n"
                      "                  measured  limit      margin\n"
                      "  |dr_proj_z|     0.200000  < 0.5    0.300000\n"
                      "  |dr_proj_xy|   15.577879  < 50    34.422121\n"
                      "  n1_proj_n2      1.000000  > 0.99   0.010000\n"
                      "  dr_proj_xy  x  13.794000\n"
                      "              y   7.238500\n"
                      "              z   0.200000\n");
    free(text);
}

static void empty(void **state) {
    static fixture_t f;
    (void)state;
    fixture_empty(&f);
    char *text = print(&f.record, &piped);
    assert_string_equal(text, "(no script) on no layout\n\nCommands\nnone\n\n"
                              "0 commands, 0.000 s simulated in 0 slices; 0.000 s of wall time\n"
                              "hash 0000000000000000\nnothing moved\n");
    free(text);
}

/* Events without a layout have no names and no limits, and are shown all the same. */
static void events_without_layout(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    f.record.layout = NULL;
    char *text = print(&f.record, &piped);
    assert_says(text, "|dr_proj_z|  rim gap  |dr_proj_xy|  n1_proj_n2\n");
    assert_says(text, "  - by - ");
    assert_says(text, "  - - → - ");
    assert_says(text, "near miss");
    free(text);
}

static void limits_come_from_the_layout(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    strcpy(f.layout.tolerance_name, "strict");
    f.layout.grasp.tolerance = wh_tolerance_strict();
    f.layout.grasp.check = WH_CHECK_SWEPT;
    f.layout.grasp.seat = true;
    char *text = print(&f.record, &piped);
    assert_says(text, "tolerance strict: |dr_proj_z| < 0.5 mm, |dr_proj_xy| < 5 mm, n1_proj_n2 > 0.99998");
    assert_says(text, "|dr_proj_xy| < 5  n1_proj_n2 > 0.99998\n");
    assert_says(text, "checked along the whole of each slice of 1 ms; wafers are drawn flat onto the pads\n");
    assert_says(text, "Wafer 1 was at 1.500° to EE when it was taken, and was drawn flat onto the pads.\n");
    free(text);
}

/* A value that rounding would put onto its limit or across it gets more decimals. */
static void digits_do_not_hide_the_verdict(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    f.events[0].event.measured.dr_proj_z = 0.4999999;
    f.events[2].event.measured.n1_proj_n2 = 0.99000004;
    char *text = print(&f.record, &piped);
    assert_says(text, " 0.4999999 ");
    assert_says(text, " 0.4500000 ");
    assert_says(text, " 0.99000004\n");
    free(text);
}

static void offsets_show_a_nanometre(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    f.wafers[0].place.dx = -2e-9 * 500;
    f.wafers[0].place.dy = -4e-10;
    char *text = print(&f.record, &piped);
    assert_says(text, "Wafer 1            B 2      -0.000001  0.0000  0.2000     1.500\n"
                      "Wafer 2            B 10     13.794000  7.2385  0.2000     0.000\n");
    free(text);
}

static void digits(void **state) {
    const wh_grid_digits_t offset = {4, 9, false, 0}, limited = {4, 4, true, 50};
    char text[WH_GRID_NUMBER_SIZE];
    (void)state;
    assert_int_equal(wh_grid_decimals(&offset, 0), 4);
    assert_int_equal(wh_grid_decimals(&offset, 13.794), 4);
    assert_int_equal(wh_grid_decimals(&offset, 1e-9), 9);
    assert_int_equal(wh_grid_decimals(&offset, 1e300), 4);
    assert_int_equal(wh_grid_decimals(&offset, (double)NAN), 4);
    assert_int_equal(wh_grid_decimals(&limited, 50), 4);
    assert_int_equal(wh_grid_decimals(&limited, 49.99999), 5);
    assert_int_equal(wh_grid_decimals(&limited, nextafter(50, 0)), 14);
    wh_grid_format(text, sizeof text, -1e-12, 4);
    assert_string_equal(text, "0.0000");
    wh_grid_format(text, sizeof text, -1e-3, 4);
    assert_string_equal(text, "-0.0010");
}

/* Equality fails, and the text says so. */
static void equal_to_the_limit(void **state) {
    static fixture_t f;
    (void)state;
    fixture_begin(&f);
    fixture_measure(&f, fixture_event(&f, WH_EVENT_NEAR_MISS, 1000, 0, FIXTURE_EE), 0, 50, 0, 0);
    fixture_measure(&f, fixture_event(&f, WH_EVENT_NEAR_MISS, 1500, 0, FIXTURE_EE), 0, 0, 0, 9.25);
    char *text = print(&f.record, &piped);
    assert_says(text, "|dr_proj_xy| 50.000 is not below 50 (it is equal)\n");
    assert_says(text, "n1_proj_n2 0.986996 is not above 0.99 (by 0.003004): tilted by 9.250°\n");
    assert_says(text, "\n0.0015  near miss");
    free(text);
}

/* The columns in which a heading begins and ends in a header line. */
static size_t column_of(const wchar_t *header, const wchar_t *heading, bool at_end) {
    const wchar_t *found = wcsstr(header, heading);
    assert_non_null(found);
    return (size_t)(found - header) + (at_end ? wcslen(heading) : 0);
}

/* A table's lines in wide characters, all of them one column wide here. */
static size_t read_table(const char *text, const char *title, wchar_t lines[8][256]) {
    const char *line = strstr(text, title);
    size_t count = 0;
    assert_non_null(line);
    line = strchr(line + 1, '\n') + 1;
    while (*line != '\n' && *line != '\0' && count < 8) {
        char copy[512];
        const size_t length = strcspn(line, "\n");
        assert_true(length < sizeof copy);
        memcpy(copy, line, length);
        copy[length] = '\0';
        assert_true(mbstowcs(lines[count++], copy, 256) != (size_t)-1);
        line += length + 1;
    }
    return count;
}

static void assert_right_aligned(const wchar_t *line, size_t end) {
    assert_true(wcslen(line) >= end);
    assert_true(line[end - 1] >= L'0' && line[end - 1] <= L'9');
    assert_true(line[end] == L' ' || line[end] == L'\0');
}

static void assert_left_aligned(const wchar_t *line, size_t begin) {
    assert_true(wcslen(line) > begin);
    assert_true(line[begin] != L' ' && line[begin - 1] == L' ' && line[begin - 2] == L' ');
}

static void columns_line_up(void **state) {
    static const wchar_t *const numbers[] = {L"line",
                                             L"begin s",
                                             L"end s",
                                             L"|dr_proj_z| < 0.5",
                                             L"rim gap",
                                             L"|dr_proj_xy| < 50",
                                             L"n1_proj_n2 > 0.99"};
    static fixture_t f;
    wchar_t lines[8][256];
    (void)state;
    fixture_failed(&f);
    strcpy(f.layout_wafers[1].name, "Wäfer Ω");
    char *text = print(&f.record, &piped);
    assert_int_equal(read_table(text, "\nCommands\n", lines), 4);
    for (size_t c = 0; c < 7; ++c) {
        const size_t end = column_of(lines[0], numbers[c], true);
        assert_right_aligned(lines[1], end);
        assert_right_aligned(lines[2], end);
    }
    for (size_t row = 1; row < 3; ++row) {
        assert_left_aligned(lines[row], column_of(lines[0], L"command", false));
        assert_left_aligned(lines[row], column_of(lines[0], L"result", false));
        assert_left_aligned(lines[row], column_of(lines[0], L"taken", false));
    }
    assert_int_equal(read_table(text, "\nWafers\n", lines), 4);
    for (size_t row = 1; row < 4; ++row) {
        assert_left_aligned(lines[row], column_of(lines[0], L"lies in", false));
    }
    for (size_t row = 1; row < 3; ++row) {
        assert_right_aligned(lines[row], column_of(lines[0], L"dX mm", true));
        assert_right_aligned(lines[row], column_of(lines[0], L"tilt deg", true));
    }
    free(text);
}

/* The text without its escape sequences. */
static void remove_escapes(char *text) {
    char *to = text;
    while (*text != '\0') {
        if (*text == '\033') {
            text = strchr(text, 'm') + 1;
        } else {
            *to++ = *text++;
        }
    }
    *to = '\0';
}

static void colour_only_when_asked(void **state) {
    const wh_style_t colourful = {true, true, 0};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    char *plain = print(&f.record, &piped);
    char *colour = print(&f.record, &colourful);
    assert_silent(plain, "\033");
    assert_says(colour, "\033[31merror 42 WAFER_MISSING\033[0m");
    assert_says(colour, "\033[32mtrue\033[0m\n");
    assert_says(colour, "\033[31mfailed\033[0m: 1 expectation");
    remove_escapes(colour);
    assert_string_equal(colour, plain);
    free(plain);
    free(colour);
}

static size_t widest_line(const char *text, const char *from, const char *to) {
    size_t widest = 0;
    const char *line = strstr(text, from), *end = strstr(text, to);
    assert_true(line && end && line < end);
    while (line < end) {
        char copy[512];
        const size_t length = strcspn(line, "\n");
        assert_true(length < sizeof copy);
        memcpy(copy, line, length);
        copy[length] = '\0';
        const size_t width = wh_style_columns(copy);
        widest = width > widest ? width : widest;
        line += length + 1;
    }
    return widest;
}

/* On a narrow terminal tables are split, never cut: each number is still there. */
static void narrow_terminal(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    for (size_t width = 18; width < 140; ++width) {
        const wh_style_t narrow = {false, true, width};
        char *text = print(&f.record, &narrow);
        assert_true(widest_line(text, "Commands", "\nWafers") <= (width < 25 ? 25 : width));
        assert_says(text, "GET A 1");
        assert_says(text, "0.4498");
        assert_says(text, "15.5779");
        assert_says(text, "0.999657");
        assert_says(text, "13.7940");
        free(text);
    }
}

/* The values of the check stay side by side on an ordinary terminal. */
static void measured_columns_stay_together(void **state) {
    const wh_style_t terminal = {false, true, 80};
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    char *text = print(&f.record, &terminal);
    assert_says(text, "\nline  |dr_proj_z| < 0.5  rim gap  |dr_proj_xy| < 50  n1_proj_n2 > 0.99\n"
                      "   3             0.4498   4.3765             0.0118           0.999657\n"
                      "   4             0.4500   0.4500            15.5779           1.000000\n");
    free(text);
}

static void ascii_serves_where_utf8_does_not(void **state) {
    const wh_style_t ascii = {false, false, 0};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    strcpy(f.layout_wafers[2].name, "Wafer 3");
    char *text = print(&f.record, &ascii);
    for (const char *c = text; *c != '\0'; ++c) {
        assert_true((unsigned char)*c < 128);
    }
    assert_says(text, "Wafer 2 EE -> PA");
    assert_says(text, "\nok 1 met\n");
    free(text);
}

/* A script's text reaches the terminal as text. */
static void hostile_text(void **state) {
    static char script[] = "a\033[2Jb", failure[] = "line 1\nline 2\t\x9b\xff";
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    f.record.script = script;
    f.record.failure = failure;
    strcpy(f.texts[0], "GET\nB\x1b");
    char *text = print(&f.record, &piped);
    assert_silent(text, "\033");
    assert_says(text, "a\\x1b[2Jb on ");
    assert_says(text, "  GET\\x0aB\\x1b ");
    assert_says(text, "\nline 1\n  line 2  \\x9b\\xff\n");
    free(text);
}

/* Events between commands are not lost, and a command may take more than one wafer. */
static void rows_of_events(void **state) {
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    f.events[2].command = 0;
    f.events[3].command = WH_NONE;
    char *text = print(&f.record, &piped);
    assert_says(text, "   3  GET A 1         0.000   6.412  ok      Wafer 1 by EE ");
    assert_says(text, "\n   3                                         Wafer 2 by EE ");
    assert_says(text, "\n      (no command)   20.900                  Wafer 2 let go\n");
    free(text);
}

static void many_wafers(void **state) {
    enum { MANY = 2000 };
    static wh_layout_wafer_t layout_wafers[MANY];
    static wh_wafer_record_t wafers[MANY];
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    for (size_t i = 0; i < MANY; ++i) {
        snprintf(layout_wafers[i].name, sizeof layout_wafers[i].name, "W%zu", i);
        wafers[i].holder = WH_NONE;
    }
    wafers[1999].holder = FIXTURE_PA;
    f.layout.wafers = layout_wafers;
    f.layout.wafer_count = MANY;
    f.record.wafers = wafers;
    char *text = print(&f.record, &piped);
    assert_says(text, "\nW0 ");
    assert_says(text, "\nW1 ");
    assert_says(text, "\nW1999  PA ");
    assert_says(text, "\n1,997 wafers lie where nothing happened to them\n");
    assert_silent(text, "\nW2 ");
    free(text);
}

static void same_record_same_bytes(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    char *first = print(&f.record, &piped);
    char *second = print(&f.record, &piped);
    assert_string_equal(first, second);
    free(first);
    free(second);
}

static void write_error(void **state) {
    static fixture_t f;
    (void)state;
    FILE *full = fopen("/dev/full", "w");
    if (!full) {
        skip();
    }
    fixture_transfer(&f);
    assert_int_equal(wh_record_print_table(&f.record, full, &piped, NULL), -1);
    fclose(full);
}

/* -------------------------------------------------------------------------------------------------- as JSON */

/* The record as JSON: read back, it is the record; two results are compared member by member. */

/* Prints a record and parses it again. */
static json_t *reread(const wh_record_t *record) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_json(record, out), 0);
    fclose(out);
    json_error_t error;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!root) {
        print_error("line %d: %s\n%s\n", error.line, error.text, text);
    }
    assert_non_null(root);
    free(text);
    return root;
}

/* The object's keys are these, in this order; `keys` ends with null. */
static void assert_keys(json_t *object, const char *const *keys) {
    const char *key;
    json_t *value;
    size_t i = 0;
    json_object_foreach(object, key, value) {
        assert_non_null(keys[i]);
        assert_string_equal(key, keys[i]);
        ++i;
    }
    assert_null(keys[i]);
}

static json_t *element(json_t *root, const char *list, size_t i) {
    json_t *value = json_array_get(json_object_get(root, list), i);
    assert_non_null(value);
    return value;
}

static void assert_text(json_t *object, const char *key, const char *text) {
    json_t *value = json_object_get(object, key);
    assert_non_null(value);
    if (text) {
        assert_string_equal(json_string_value(value), text);
    } else {
        assert_true(json_is_null(value));
    }
}

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void assert_real(json_t *object, const char *key, double value) {
    json_t *found = json_object_get(object, key);
    assert_true(json_is_real(found));
    assert_true(bits_of(json_real_value(found)) == bits_of(value));
}

static void head(void **state) {
    static const char *const keys[] = {
        "format", "ok",     "script",         "layout",       "slices",     "missed", "simulated_s",
        "wall_s", "hash",   "not_looked_for", "steady_cycle", "throughput", "split",  "commands",
        "wafers", "events", "expectations",   "cycles",       "gantt",      "reach",  NULL};
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    json_t *root = reread(&f.record);
    assert_keys(root, keys);
    assert_int_equal(json_integer_value(json_object_get(root, "format")), 2);
    assert_true(json_is_true(json_object_get(root, "ok")));
    assert_text(root, "script", "lua/examples/01_transfer.lua");
    assert_text(root, "layout", "lua/layouts/paper.lua");
    assert_int_equal(json_integer_value(json_object_get(root, "slices")), 22870);
    assert_real(root, "simulated_s", 22.87);
    assert_real(root, "wall_s", 0.0087);
    assert_text(root, "hash", "00c0ffee12345678");
    json_decref(root);
}

static void empty_json(void **state) {
    static fixture_t f;
    (void)state;
    fixture_empty(&f);
    json_t *root = reread(&f.record);
    assert_text(root, "script", NULL);
    assert_text(root, "layout", NULL);
    assert_text(root, "hash", "0000000000000000");
    assert_int_equal(json_array_size(json_object_get(root, "commands")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "wafers")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "events")), 0);
    assert_int_equal(json_array_size(json_object_get(root, "expectations")), 0);
    json_decref(root);
}

static void failure_and_commands(void **state) {
    static const char *const keys[] = {"line", "text", "error", "begin_s", "end_s", "split", NULL};
    static const char *const keys_failed[] = {"line",  "text",  "error",   "begin_s",
                                              "end_s", "split", "message", NULL};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    assert_true(json_is_false(json_object_get(root, "ok")));
    assert_text(root, "failure", "02_prealigner.lua:9: error 42: wafer missing");
    assert_keys(element(root, "commands", 0), keys);
    json_t *failed = element(root, "commands", 2);
    assert_keys(failed, keys_failed);
    assert_text(failed, "text", "GET A 3");
    assert_int_equal(json_integer_value(json_object_get(failed, "error")), 42);
    assert_int_equal(json_integer_value(json_object_get(failed, "line")), 9);
    assert_real(failed, "begin_s", 30.5);
    assert_real(failed, "end_s", 33.75);
    json_decref(root);
}

static void wafers_are_written(void **state) {
    static const char *const keys[] = {"name",     "holder",    "station", "slot",     "dx",       "dy", "dz",
                                       "tilt_deg", "notch_deg", "face",    "position", "rotation", NULL};
    static const char *const nulls[] = {"holder", "station", "slot", "dx", "dy", "dz", "tilt_deg"};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    f.wafers[1].base_from_wafer.r = wh_vec3(1.5, -0.0, 1e-310);
    f.wafers[1].base_from_wafer.R.m[1][2] = 0.1;
    json_t *root = reread(&f.record);
    json_t *held = element(root, "wafers", 1);
    assert_keys(held, keys);
    assert_text(held, "name", "Wafer 2");
    assert_text(held, "holder", "PA");
    assert_text(held, "station", "P");
    assert_int_equal(json_integer_value(json_object_get(held, "slot")), 1);
    assert_real(held, "dx", 13.794);
    assert_real(held, "tilt_deg", 0);
    assert_real(held, "notch_deg", 0);
    json_t *position = json_object_get(held, "position");
    assert_int_equal(json_array_size(position), 3);
    assert_true(bits_of(json_real_value(json_array_get(position, 1))) == bits_of(-0.0));
    assert_true(bits_of(json_real_value(json_array_get(position, 2))) == bits_of(1e-310));
    json_t *row = json_array_get(json_object_get(held, "rotation"), 1);
    assert_int_equal(json_array_size(row), 3);
    assert_true(bits_of(json_real_value(json_array_get(row, 2))) == bits_of(0.1));
    json_t *nowhere = element(root, "wafers", 2);
    assert_text(nowhere, "name", "Wäfer №3");
    for (size_t i = 0; i < sizeof nulls / sizeof nulls[0]; ++i) {
        assert_text(nowhere, nulls[i], NULL);
    }
    json_decref(root);
}

#define EVENT_KEYS                                                                                           \
    "utime", "kind", "wafer", "gripper", "dr_proj_z", "dr_proj_xy", "dr_proj_xy_norm", "n1_proj_n2",         \
        "margins", "failed", "measured_utime", "face"

static void event_kinds(void **state) {
    static const char *const picked[] = {EVENT_KEYS, NULL};
    static const char *const handed_over[] = {EVENT_KEYS, "from", NULL};
    static const char *const contested[] = {EVENT_KEYS, "holder", NULL};
    static const char *const unsupported[] = {EVENT_KEYS, "height", NULL};
    static const char *const occupied[] = {EVENT_KEYS, "other", NULL};
    static const char *const bad_input[] = {EVENT_KEYS, "status", "message", NULL};
    static const char *const *const keys[] = {picked,      handed_over, picked,   contested,
                                              unsupported, occupied,    bad_input};
    static const char *const kinds[] = {"picked",    "handed_over",          "near_miss",
                                        "contested", "released_unsupported", "slot_occupied",
                                        "bad_input"};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    for (size_t i = 0; i < 7; ++i) {
        assert_keys(element(root, "events", i), keys[i]);
        assert_text(element(root, "events", i), "kind", kinds[i]);
    }
    assert_text(element(root, "events", 1), "from", "EE");
    assert_text(element(root, "events", 3), "holder", "EE");
    assert_real(element(root, "events", 4), "height", 12.5);
    assert_text(element(root, "events", 5), "other", "Wafer 1");
    assert_text(element(root, "events", 6), "wafer", NULL);
    assert_text(element(root, "events", 6), "margins", NULL);
    assert_int_equal(json_integer_value(json_object_get(element(root, "events", 6), "status")), 2);
    json_decref(root);
}

static void event_values(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    const wh_proximity_t *measured = &f.events[2].event.measured;
    f.events[2].event.measured_slice = 31999;
    json_t *root = reread(&f.record);
    json_t *miss = element(root, "events", 2);
    assert_int_equal(json_integer_value(json_object_get(miss, "utime")), 32100000);
    assert_int_equal(json_integer_value(json_object_get(miss, "measured_utime")), 31999000);
    assert_text(miss, "wafer", "Wäfer №3");
    assert_text(miss, "gripper", "EE");
    assert_real(miss, "dr_proj_z", measured->dr_proj_z);
    assert_real(miss, "dr_proj_xy_norm", 55);
    assert_real(miss, "n1_proj_n2", 1);
    json_t *margins = json_object_get(miss, "margins");
    assert_real(margins, "projz", measured->margin_projz);
    assert_real(margins, "projxy", -5);
    assert_real(margins, "planar", measured->margin_planar);
    json_t *failed = json_object_get(miss, "failed");
    assert_int_equal(json_array_size(failed), 2);
    assert_string_equal(json_string_value(json_array_get(failed, 0)), "projz");
    assert_string_equal(json_string_value(json_array_get(failed, 1)), "projxy");
    json_decref(root);
}

/* Degrees, the unit of the layout's limit and of a wafer's tilt. */
static void askew_in_degrees(void **state) {
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    const size_t i = f.record.event_count;
    wh_event_t *event = fixture_event(&f, WH_EVENT_PLACED_ASKEW, 33300000, 1, FIXTURE_EE);
    event->value = wh_rad_from_deg(90);
    event->limit = wh_rad_from_deg(45);
    event = fixture_event(&f, WH_EVENT_PLACED_OFF_CENTRE, 33300000, 1, FIXTURE_EE);
    event->value = 4;
    event->limit = 2;
    json_t *root = reread(&f.record);
    assert_real(element(root, "events", i), "value", 90);
    assert_real(element(root, "events", i), "limit", 45);
    assert_real(element(root, "events", i + 1), "value", 4);
    assert_real(element(root, "events", i + 1), "limit", 2);
    json_decref(root);
}

static void expectations_are_written(void **state) {
    static const char *const keys[] = {"line", "text", "ok", NULL};
    static fixture_t f;
    (void)state;
    fixture_failed(&f);
    json_t *root = reread(&f.record);
    json_t *unmet = element(root, "expectations", 1);
    assert_keys(unmet, keys);
    assert_int_equal(json_integer_value(json_object_get(unmet, "line")), 12);
    assert_text(unmet, "text", "Wafer 3 on EE, but nobody holds it");
    assert_true(json_is_false(json_object_get(unmet, "ok")));
    assert_true(json_is_true(json_object_get(element(root, "expectations", 0), "ok")));
    json_decref(root);
}

/* Text may contain anything, and NaN is no JSON. */
static void hostile_values(void **state) {
    static char wrong[] = "a\xff\xc3\xa4\xe2\x82 \x1b\"\n\xed\xa0\x80", broken[] = "\xf0\x9f";
    static fixture_t f;
    (void)state;
    fixture_transfer(&f);
    f.commands[0].text = wrong;
    f.record.script = broken;
    f.commands[0].begin_s = (double)NAN;
    f.commands[0].end_s = -(double)INFINITY;
    f.events[0].event.wafer = 99;
    f.events[0].event.gripper = -7;
    json_t *root = reread(&f.record);
    assert_text(element(root, "commands", 0), "text",
                "a\xef\xbf\xbd\xc3\xa4\xef\xbf\xbd\xef\xbf\xbd \x1b\"\n"
                "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    assert_text(root, "script", "\xef\xbf\xbd\xef\xbf\xbd");
    assert_text(element(root, "commands", 0), "begin_s", NULL);
    assert_text(element(root, "commands", 0), "end_s", NULL);
    assert_text(element(root, "events", 0), "wafer", NULL);
    assert_text(element(root, "events", 0), "gripper", NULL);
    json_decref(root);
}

static void write_error_json(void **state) {
    static fixture_t f;
    (void)state;
    FILE *full = fopen("/dev/full", "w");
    if (!full) {
        skip();
    }
    fixture_transfer(&f);
    assert_int_equal(wh_record_print_json(&f.record, full), -1);
    fclose(full);
}

static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* Any finite double; one in eight a denormal, one in eight of a magnitude that reports have. */
static double random_double(uint64_t *state) {
    double value;
    do {
        uint64_t bits = next_random(state);
        const uint64_t form = next_random(state) % 8;
        if (form == 0) {
            bits &= UINT64_C(0x800fffffffffffff);
        } else if (form == 1) {
            bits = (bits & UINT64_C(0x800fffffffffffff)) | ((UINT64_C(1013) + bits % 20) << 52);
        }
        memcpy(&value, &bits, sizeof value);
    } while (!isfinite(value));
    return value;
}

static void doubles_return_bit_for_bit(void **state) {
    static const double special[] = {0.0, -0.0, DBL_MAX, -DBL_MAX, DBL_MIN, -DBL_MIN, 4.9e-324, -4.9e-324};
    enum { COMMANDS = 50000 };
    static wh_command_record_t commands[COMMANDS];
    static fixture_t f;
    uint64_t random = 20261121;
    (void)state;
    fixture_empty(&f);
    for (size_t i = 0; i < COMMANDS; ++i) {
        commands[i].begin_s = i < 8 ? special[i] : random_double(&random);
        commands[i].end_s = random_double(&random);
    }
    f.record.commands = commands;
    f.record.command_count = COMMANDS;
    json_t *root = reread(&f.record);
    for (size_t i = 0; i < COMMANDS; ++i) {
        assert_real(element(root, "commands", i), "begin_s", commands[i].begin_s);
        assert_real(element(root, "commands", i), "end_s", commands[i].end_s);
    }
    json_decref(root);
}

/* --------------------------------------------------------------------------------------------- comparison */

static char told[500];

/* "path@time " for each difference. */
static void note(void *user, const wh_json_difference_t *difference) {
    const size_t length = strlen(told);
    assert_ptr_equal(user, told);
    assert_true(difference->a || difference->b);
    snprintf(told + length, sizeof told - length, isnan(difference->time_s) ? "%s " : "%s@%g ",
             difference->path, difference->time_s);
}

static void results_are_compared_member_by_member(void **state) {
    (void)state;
    static const char *const aside[] = {"wall_s", NULL};
    static const struct {
        const char *a, *b, *told;
    } rows[] = {
        {"{}", "{}", ""},
        {"{\"x\": 1}", "{\"x\": 1.0}", ""},
        {"{\"x\": 0.0}", "{\"x\": -0.0}", "x "},
        {"{\"x\": 1}", "{\"x\": \"1\"}", "x "},
        {"{\"x\": 9007199254740993}", "{\"x\": 9007199254740992}", "x "},
        {"{\"x\": null}", "{}", "x "},
        {"{\"wall_s\": 1, \"y\": {\"wall_s\": 2}}", "{\"y\": {}}", ""},
        {"{\"a\": 1, \"b\": {\"c\": [1, 2]}}", "{\"d\": 1, \"b\": {\"c\": [1, 3, 4]}}", "a b.c[1] b.c[2] d "},
        /* Times: an element has its own time; of two the earlier one counts; otherwise the time of
         * the element around it, or of its place in the list beside. */
        {"{\"e\": [{\"utime\": 2000000, \"v\": 1}]}", "{\"e\": [{\"utime\": 2000000, \"v\": 2}]}",
         "e[0].v@2 "},
        {"{\"e\": [{\"begin_s\": 2}]}", "{\"e\": [{\"begin_s\": 3}]}", "e[0].begin_s@2 "},
        {"{\"e\": [{\"t\": 4, \"l\": [1]}]}", "{\"e\": [{\"t\": 4, \"l\": [2]}]}", "e[0].l[0]@4 "},
        {"{\"t\": [1, 2], \"v\": [5, 6]}", "{\"t\": [1, 2], \"v\": [5, 7]}", "v[1]@2 "},
        {"{\"t\": [1], \"v\": [5, 6]}", "{\"t\": [1], \"v\": [5, 7]}", "v[1] "},
        {"{\"begin_s\": 1, \"v\": 1}", "{\"begin_s\": 1, \"v\": 2}", "v "},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        json_t *a = json_loads(rows[i].a, 0, NULL);
        json_t *b = json_loads(rows[i].b, 0, NULL);
        assert_true(a && b);
        told[0] = '\0';
        wh_json_compare(a, b, aside, note, told);
        assert_string_equal(told, rows[i].told);
        json_decref(a);
        json_decref(b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transfer),
        cmocka_unit_test(failed_run),
        cmocka_unit_test(handover),
        cmocka_unit_test(empty),
        cmocka_unit_test(events_without_layout),
        cmocka_unit_test(limits_come_from_the_layout),
        cmocka_unit_test(digits_do_not_hide_the_verdict),
        cmocka_unit_test(offsets_show_a_nanometre),
        cmocka_unit_test(digits),
        cmocka_unit_test(equal_to_the_limit),
        cmocka_unit_test(columns_line_up),
        cmocka_unit_test(colour_only_when_asked),
        cmocka_unit_test(narrow_terminal),
        cmocka_unit_test(measured_columns_stay_together),
        cmocka_unit_test(ascii_serves_where_utf8_does_not),
        cmocka_unit_test(hostile_text),
        cmocka_unit_test(rows_of_events),
        cmocka_unit_test(many_wafers),
        cmocka_unit_test(same_record_same_bytes),
        cmocka_unit_test(write_error),
        cmocka_unit_test(head),
        cmocka_unit_test(empty_json),
        cmocka_unit_test(failure_and_commands),
        cmocka_unit_test(wafers_are_written),
        cmocka_unit_test(event_kinds),
        cmocka_unit_test(event_values),
        cmocka_unit_test(askew_in_degrees),
        cmocka_unit_test(expectations_are_written),
        cmocka_unit_test(hostile_values),
        cmocka_unit_test(write_error_json),
        cmocka_unit_test(doubles_return_bit_for_bit),
        cmocka_unit_test(results_are_compared_member_by_member),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
