/* The report for people: what it says, and that it lines up. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <locale.h>
#include <stdlib.h>
#include <wchar.h>

#include "print/record_print.h"
#include "support/record.h"
#include "text/grid.h"

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
                      "no wafers per hour: no station is known to count\nhash 00c0ffee12345678\nok\n");
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
    assert_says(text, "  in no slot, 12.500 mm above what is below\n");
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

/* Equality fails, and the words say so. */
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

/* Where a heading begins or ends in a header line, in columns. */
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

/* What a script wrote reaches the terminal as text. */
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

/* What happened between commands is not lost, and a command may take more than one wafer. */
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
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
