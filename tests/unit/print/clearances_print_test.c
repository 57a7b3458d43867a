/* The smallest gaps of a run and their course over time, and the distances of axes from their ends:
 * word for word. */
#include "print/print_internal.h"

#include <locale.h>

#include "support/layout.h"

static const char cell[] = "grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, slots = "
                           "3, retract = 310 }, B = { at = { 0, 700, 900 } } }, "
                           "wafers = { { name = 'W1', station = 'A', slot = 1 } }, clearance = { "
                           "blade_wafer_above = 0.5, blade_wafer_below = 0.75, arm_itself = 1 }";

static wh_record_t record;
static wh_curves_t curves;
static wh_station_reach_t reach[2];
static char *text;

/* The blade came 0.25 mm below a wafer and 3 mm above another one, and touched a ledge; the arm
 * came near nothing. */
static int set_up(void **state) {
    (void)state;
    const wh_layout_t *layout = read_sound(cell);
    const int32_t wafer = (int32_t)layout->world.part_count;
    record = (wh_record_t){.layout = layout, .checked = true, .curves = &curves, .reach = reach};
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        record.clearances[kind] = (wh_clearance_t){.gap = WH_CLEARANCE_RANGE, .parts = {WH_NONE, WH_NONE}};
    }
    record.clearances[WH_CLEARANCE_BLADE_WAFER_ABOVE] =
        (wh_clearance_t){.gap = 0.25, .slice = 1500, .parts = {0, wafer}};
    record.clearances[WH_CLEARANCE_BLADE_WAFER_BELOW] =
        (wh_clearance_t){.gap = 3, .slice = 2250, .parts = {1, wafer}};
    record.clearances[WH_CLEARANCE_BLADE_OTHER] = (wh_clearance_t){.gap = 0, .slice = 4000, .parts = {0, 1}};
    memset(&curves, 0, sizeof curves);
    curves.count = 40;
    curves.slices = 100;
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        for (size_t bin = 0; bin < 40; ++bin) {
            curves.gaps[kind][bin] = kind == WH_CLEARANCE_BLADE_OTHER ? (bin == 39 ? 0 : 1.9)
                                                                      : 0.25 + 0.125 * fabs((double)bin - 15);
        }
    }
    memset(reach, 0, sizeof reach);
    reach[0].axes[0] = (wh_travel_margin_t){.margin = WH_PI / 360, .slot = 2, .is_max = true};
    reach[0].axes[1] = (wh_travel_margin_t){.margin = 12.5, .slot = 1};
    reach[0].axes[3] = (wh_travel_margin_t){.margin = WH_PI, .slot = 3};
    reach[1].axes[2] = (wh_travel_margin_t){.margin = 0.125, .slot = 1, .is_max = true};
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    free(text);
    text = NULL;
    return 0;
}

static void print(void to(const wh_printer_t *printer), const wh_style_t *style) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    const wh_printer_t printer = {&record, style, out};
    to(&printer);
    assert_int_equal(fclose(out), 0);
}

static const wh_style_t piped = {false, true, 0};
static const wh_style_t narrow = {false, false, 70};

static void gaps_and_their_curves(void **state) {
    (void)state;
    print(wh_print_clearances, &piped);
    assert_string_equal(
        text, "\n"
              "Clearances\n"
              "smallest gap                 mm  limit mm       at s  between\n"
              "blade to the wafer above  0.250  0.5 not kept  1.500  A ledge 1 left and W1\n"
              "blade to the wafer below  3.000  0.75 kept     2.250  A ledge 1 right and W1\n"
              "blade to the cell         0.000                4.000  A ledge 1 left and A ledge 1 right\n"
              "arm to itself                    1 kept               never nearer than 20 mm\n"
              "\n"
              "Clearances over time\n"
              "blade to the wafer above  ████▇▇▆▆▅▅▄▄▃▃▂▂▂▃▃▄▄▅▅▆▆▇▇█████████████  0 to 2 mm\n"
              "                                        ^ 0.250 mm at 1.500 s\n"
              "blade to the wafer below  ▂▂▂▂▂▂▂▂▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▂▂▂▂▂▂▂▂▂▂▃▃▃▃▃▃▃  0 to 10 mm\n"
              "                                                ^ 3.000 mm at 2.250 s\n"
              "blade to the cell         ███████████████████████████████████████▁  0 to 1 mm\n"
              "                                                                 ^ 0.000 mm at 4.000 s\n");
}

/* 28 columns beside names and scale, without UTF-8, for a curve that begins later. */
static void curves_in_a_narrow_terminal(void **state) {
    (void)state;
    curves.first = 1000;
    print(wh_print_clearances, &narrow);
    const char *at = strstr(text, "Clearances over time");
    assert_non_null(at);
    assert_string_equal(at, "Clearances over time\n"
                            "blade to the wafer above  ##**+==-:...:--=+**#########  0 to 2 mm\n"
                            "                             ^ 0.250 mm at 1.500 s\n"
                            "blade to the wafer below  .....___________.......:::::  0 to 10 mm\n"
                            "                                  ^ 3.000 mm at 2.250 s\n"
                            "blade to the cell         ###########################_  0 to 1 mm\n"
                            "                                              ^ 0.000 mm at 4.000 s\n");
}

static void nothing_was_looked_for(void **state) {
    (void)state;
    record.checked = false;
    print(wh_print_clearances, &piped);
    assert_string_equal(text, "");
    record.checked = true;
    record.curves = NULL;
    print(wh_print_clearances, &piped);
    assert_null(strstr(text, "over time"));
}

static void how_near_axes_come_to_their_ends(void **state) {
    (void)state;
    print(wh_print_margins, &piped);
    assert_string_equal(
        text, "\n"
              "Reach: how far GET and PUT, coming from home, stay from the ends of the axes' travel\n"
              "station  theta deg  from         r mm  from          z mm  from         yaw deg  from\n"
              "A              0.5  max, slot 2  12.5  min, slot 1                        180.0  min, slot 3\n"
              "B                                                   0.125  max, slot 1\n");
    record.reach = NULL;
    print(wh_print_margins, &piped);
    assert_string_equal(text, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(gaps_and_their_curves, set_up, tear_down),
        cmocka_unit_test_setup_teardown(curves_in_a_narrow_terminal, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_was_looked_for, set_up, tear_down),
        cmocka_unit_test_setup_teardown(how_near_axes_come_to_their_ends, set_up, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
