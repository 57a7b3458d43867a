/* The figures as a report prints them and as JSON has them. */
#include "support/support.h"

#include <jansson.h>
#include <locale.h>

#include "print/record_print.h"
#include "support/record.h"

static fixture_t f;
static wh_busy_span_t intervals[16];
static wh_station_reach_t reach[FIXTURE_STATIONS];
static wh_put_record_t made_puts[4];
static wh_cycle_record_t made_cycles[4];

static void add_interval(wh_busy_t who, int32_t gripper, int32_t what, int64_t from, int64_t to) {
    const wh_busy_span_t interval = {who, gripper, what, from, to};
    intervals[f.record.activity.interval_count++] = interval;
}

static void add_cycle(int line, char *name, int64_t slice) {
    const wh_cycle_record_t cycle = {line, name, slice};
    made_cycles[f.record.cycle_count++] = cycle;
}

static void fill_shares(int64_t shares[WH_SHARES], int64_t loaded, int64_t empty, int64_t vacuum,
                        int64_t handover, int64_t waiting) {
    const int64_t values[WH_SHARES] = {loaded, empty, vacuum, handover, waiting};
    memcpy(shares, values, sizeof values);
}

/* 10 s in slices of 1 ms: a GET of 4 s, a WAIT of 1 s, a PUT onto the prealigner of 5 s. */
static void begin(void) {
    fixture_begin(&f);
    f.record.simulated_s = 10;
    f.record.slices = 10000;
    f.record.activity.intervals = intervals;
    f.record.puts = made_puts;
    f.record.cycles = made_cycles;
    f.stations[FIXTURE_P].prealigner = f.stations[FIXTURE_P].counts = true;
    fill_shares(fixture_command(&f, 3, "GET B 1", 0, 4)->shares, 2000, 1500, 499, 1, 0);
    fill_shares(fixture_command(&f, 4, "WAIT 1", 4, 5)->shares, 0, 0, 0, 0, 1000);
    fill_shares(fixture_command(&f, 5, "PUT P 1", 5, 10)->shares, 4000, 998, 0, 2, 0);
    fill_shares(f.record.activity.shares, 6000, 2498, 499, 3, 1000);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_EMPTY, 0, 1500);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_VACUUM, 1500, 2000);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_LOADED, 2000, 4000);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_WAITING, 4000, 5000);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_LOADED, 5000, 9000);
    add_interval(WH_BUSY_WAFER, FIXTURE_EE, 1 + 2, 1500, 9000);
    add_interval(WH_BUSY_CHUCK, FIXTURE_PA, 1 + WH_SHARE_LOADED, 9500, 10000);
    add_interval(WH_BUSY_ROBOT, WH_NONE, 1 + WH_SHARE_EMPTY, 9000, 9500);
    add_interval(WH_BUSY_WAFER, FIXTURE_PA, 1 + 1, 9000, 10000);
    add_interval(WH_BUSY_VALVE, FIXTURE_EE, 1, 1400, 9010);
}

/* ---------------------------------------------------------------------------------------------------- table */

static const wh_record_sections_t with_gantt = {.gantt = true};

static char *print(const wh_style_t *style, const wh_record_sections_t *sections) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_table(&f.record, out, style, sections), 0);
    fclose(out);
    return text;
}

static void assert_says(const char *text, const char *wanted) {
    if (!strstr(text, wanted)) {
        fprintf(stderr, "not found: %s\nin:\n%s", wanted, text); /* print_error cuts */
        fail();
    }
}

/* 49 columns and a label of 8: 40 columns of 250 slices. */
static void gantt_shows_the_commands(void **state) {
    const wh_style_t style = {false, true, 50};
    (void)state;
    begin();
    char *text = print(&style, &with_gantt);
    assert_says(
        text,
        "\nGantt\n"
        "s         0                   5\n"
        "command   │GET B 1        │   │PUT P 1\n"
        "robot     ▒▒▒▒▒▒vv████████····████████████████▒▒\n"
        "EE holds        ━Wäfer №3━━━━━━━━━━━━━━━━━━━━━\n"
        "EE valve       oooooooooooooooooooooooooooooooo\n"
        "PA turns                                        ██\n"
        "PA holds                                      ━━━━\n"
        "█ moving with a wafer, ▒ moving without, v waiting for vacuum, x valves switching, · waiting, o "
        "vacuum on\n");
    free(text);
}

static void gantt_in_ascii(void **state) {
    const wh_style_t style = {false, false, 50};
    (void)state;
    begin();
    strcpy(f.layout_wafers[2].name, "W3");
    add_cycle(2, f.texts[7], 0);
    strcpy(f.texts[6], "put it there");
    add_cycle(4, f.texts[6], 5000);
    char *text = print(&style, &with_gantt);
    assert_says(text, "\ncycle     |1                  |put it there\n"
                      "command   |GET B 1        |   |PUT P 1\n"
                      "robot     ------vv########....################--\n"
                      "EE holds        =W3===========================\n");
    for (const char *c = text; *c != '\0'; ++c) {
        assert_true((unsigned char)*c < 128);
    }
    free(text);
}

/* Without a terminal it has 100 columns, on the narrowest 20, and never a blank at a line's end. */
static void gantt_at_any_width(void **state) {
    (void)state;
    begin();
    for (size_t width = 0; width < 200; ++width) {
        const wh_style_t style = {false, false, width};
        const size_t columns = width == 0 ? 100 : width > 30 ? width - 10 : 20;
        char *text = print(&style, &with_gantt);
        const char *row = strstr(text, "\nPA turns ");
        assert_non_null(row);
        assert_int_equal(strcspn(row + 1, "\n"), 10 + columns);
        assert_null(strstr(strstr(text, "\nGantt"), " \ncommand"));
        free(text);
    }
}

/* From 2 s to 7 s, 40 columns of 125 slices: what began before has no bar, what lies outside has no row. */
static void gantt_of_a_window(void **state) {
    const wh_style_t style = {false, true, 50};
    const wh_record_sections_t window = {.gantt = true, .from_s = 2, .to_s = 7};
    const wh_record_sections_t beyond = {.gantt = true, .from_s = 10};
    (void)state;
    begin();
    char *text = print(&style, &window);
    assert_says(text, "\nGantt\n"
                      "s         2               4               6\n"
                      "command   GET B 1         │WAIT 1 │PUT P 1\n"
                      "robot     ████████████████········████████████████\n"
                      "EE holds  ━Wäfer №3━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━━\n"
                      "EE valve  oooooooooooooooooooooooooooooooooooooooo\n"
                      "█ moving with a wafer");
    assert_says(text, "   3  GET B 1   4.000");
    assert_says(text, "  all      10.000");
    free(text);
    text = print(&style, &beyond);
    assert_says(text, "\nGantt\nnothing: no slice of the run, which took 10.000 s, lies there\n");
    assert_null(strstr(text, "Totals"));
    free(text);
}

static void steady_cycles_by_themselves(void **state) {
    const wh_style_t style = {false, false, 50};
    const wh_record_sections_t wanted = {.cycle = true};
    (void)state;
    begin();
    char *text = print(&style, &wanted);
    assert_says(text, "\nFirst steady cycle\nno steady cycle: no two cycles are marked");
    assert_null(strstr(text, "\nGantt\n"));
    free(text);
    fixture_command(&f, 6, "PUT P 1", 10, 15);
    f.record.slices = 15000;
    f.record.simulated_s = 15;
    add_cycle(2, f.texts[7], 5000);
    strcpy(f.texts[6], "again");
    add_cycle(2, f.texts[6], 10000);
    text = print(&style, &wanted);
    assert_says(text,
                "\nFirst steady cycle\n5.000 s, from 5.000 s to 10.000 s, with 1 command: cycle 1; 2 like it "
                "in a row, to 1 %\nno wafers per hour: no wafer was put into a station that counts\n");
    assert_says(text, "\ncycle     |1\ncommand   |PUT P 1\n");
    free(text);
}

static void times(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin();
    char *text = print(&style, &with_gantt);
    assert_says(text, "line  command       s  with wafer  without  vacuum  valves  waiting\n"
                      "   3  GET B 1   4.000       2.000    1.500   0.499   0.001\n"
                      "   4  WAIT 1    1.000                                         1.000\n"
                      "   5  PUT P 1   5.000       4.000    0.998           0.002\n"
                      "      all      10.000       6.000    2.498   0.499   0.003    1.000\n");
    free(text);
}

static void sections_are_asked_for(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin();
    f.record.reach = reach;
    char *text = print(&style, 0);
    assert_null(strstr(text, "Gantt"));
    assert_null(strstr(text, "Time"));
    assert_null(strstr(text, "Reach"));
    assert_says(text, "\nno wafers per hour: no wafer was put into a station that counts\nhash");
    free(text);
}

static void wafers_per_hour_are_counted(void **state) {
    const wh_style_t style = {false, true, 0};
    const wh_put_record_t put = {1, FIXTURE_P, 1, 10000};
    const wh_put_record_t early = {0, FIXTURE_P, 1, 4000};
    (void)state;
    begin();
    made_puts[f.record.put_count++] = early;
    made_puts[f.record.put_count++] = put;
    char *text = print(&style, 0);
    assert_says(text,
                "720.0 wafers per hour: 2 in 10.000 s, the whole run; 85.0 % motion, 5.0 % vacuum, 10.0 % "
                "waiting\nhash");
    free(text);
    add_cycle(2, f.texts[7], 0);
    text = print(&style, 0);
    assert_says(text, "\n720.0 wafers per hour: 2 in 10.000 s, cycle 1; ");
    free(text);
    add_cycle(2, f.texts[7], 5000);
    add_cycle(2, f.texts[7], 8000);
    text = print(&style, 0);
    assert_says(text, "\n720.0 wafers per hour: 1 in 5.000 s, cycles 2 to 3; ");
    free(text);
}

static void set_reach(int32_t station, size_t axis, double margin, double at, bool is_max, int32_t slot) {
    const wh_travel_margin_t made = {margin, at, is_max, slot};
    reach[station].axes[axis] = made;
}

static void fill_reach(void) {
    memset(reach, 0, sizeof reach);
    set_reach(FIXTURE_A, WH_AXIS_THETA, 9 * WH_PI, 0, false, 1);
    set_reach(FIXTURE_A, WH_AXIS_R, 100, 400, false, 1);
    set_reach(FIXTURE_A, WH_AXIS_Z, 157.25, 1142.75, true, 25);
    set_reach(FIXTURE_A, WH_AXIS_YAW, WH_PI, WH_PI / 2, true, 1);
    f.record.reach = reach;
}

static void margins(void **state) {
    const wh_style_t style = {false, true, 0};
    (void)state;
    begin();
    fill_reach();
    char *text = print(&style, &(wh_record_sections_t){.margins = true});
    assert_says(
        text,
        "station  theta deg  from          r mm  from           z mm  from          yaw deg  from\n"
        "A           1620.0  min, slot 1  100.0  min, slot 1  157.25  max, slot 25    180.0  max, slot 1\n"
        "\n3 commands");
    free(text);
}

/* ----------------------------------------------------------------------------------------------------- JSON */

static json_t *reread(void) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(wh_record_print_json(&f.record, out), 0);
    fclose(out);
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(root);
    free(text);
    return root;
}

/* A member or element is what this JSON text says, keys in the same order. */
static void assert_json(const json_t *value, const char *wanted) {
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
    assert_non_null(text);
    assert_string_equal(text, wanted);
    free(text);
}

static const json_t *element(const json_t *root, const char *list, size_t i) {
    return json_array_get(json_object_get(root, list), i);
}

static void json_sums(void **state) {
    const wh_put_record_t put = {1, FIXTURE_P, 1, 10000};
    (void)state;
    begin();
    made_puts[f.record.put_count++] = put;
    add_cycle(2, f.texts[7], 0);
    strcpy(f.texts[6], "second");
    add_cycle(4, f.texts[6], 5000);
    json_t *root = reread();
    assert_json(json_object_get(root, "throughput"), "{\"wafers_per_hour\": 720.0, \"reason\": null, "
                                                     "\"wafers\": 1, \"seconds\": 5.0, "
                                                     "\"first_cycle\": 2, \"last_cycle\": 2, "
                                                     "\"puts\": 1, \"counting\": [\"P\"]}");
    assert_json(json_object_get(root, "split"),
                "{\"motion_s\": 8.4979999999999993, \"loaded_s\": 6.0, \"empty_s\": 2.4980000000000002, "
                "\"vacuum_s\": "
                "0.499, \"handover_s\": 0.0030000000000000001, \"waiting_s\": 1.0}");
    assert_json(
        json_object_get(element(root, "commands", 1), "split"),
        "{\"motion_s\": 0.0, \"loaded_s\": 0.0, \"empty_s\": 0.0, \"vacuum_s\": 0.0, \"handover_s\": 0.0, "
        "\"waiting_s\": 1.0}");
    assert_json(json_object_get(root, "cycles"),
                "[{\"line\": 2, \"name\": null, \"begin_s\": 0.0, \"end_s\": 5.0, \"wafers\": 0}, "
                "{\"line\": 4, \"name\": \"second\", \"begin_s\": 5.0, \"end_s\": 10.0, \"wafers\": 1}]");
    json_decref(root);
}

static void json_gantt(void **state) {
    (void)state;
    begin();
    json_t *root = reread();
    assert_int_equal(json_array_size(json_object_get(root, "gantt")), 10);
    assert_json(element(root, "gantt", 1),
                "{\"resource\": \"robot\", \"gripper\": null, \"from_s\": 1.5, \"to_s\": "
                "2.0, \"what\": \"vacuum\"}");
    assert_json(element(root, "gantt", 5),
                "{\"resource\": \"robot\", \"gripper\": null, \"from_s\": 9.0, \"to_s\": "
                "9.5, \"what\": \"empty\"}");
    assert_json(element(root, "gantt", 6),
                "{\"resource\": \"gripper\", \"gripper\": \"EE\", \"from_s\": 1.5, "
                "\"to_s\": 9.0, \"what\": \"Wäfer №3\"}");
    assert_json(element(root, "gantt", 7),
                "{\"resource\": \"valve\", \"gripper\": \"EE\", \"from_s\": "
                "1.3999999999999999, \"to_s\": 9.0099999999999998, \"what\": \"open\"}");
    assert_json(element(root, "gantt", 8),
                "{\"resource\": \"chuck\", \"gripper\": \"PA\", \"from_s\": 9.5, \"to_s\": "
                "10.0, \"what\": \"loaded\"}");
    json_decref(root);
}

static void json_reach(void **state) {
    (void)state;
    begin();
    fill_reach();
    json_t *root = reread();
    assert_int_equal(json_array_size(json_object_get(root, "reach")), 4);
    assert_json(element(root, "reach", 0),
                "{\"station\": \"A\", \"slot\": 1, \"axis\": \"theta\", \"margin\": 1620.0, "
                "\"at\": 0.0, \"end\": \"min\", \"unit\": \"deg\"}");
    assert_json(element(root, "reach", 2),
                "{\"station\": \"A\", \"slot\": 25, \"axis\": \"z\", \"margin\": 157.25, "
                "\"at\": 1142.75, \"end\": \"max\", \"unit\": \"mm\"}");
    json_decref(root);
}

static void json_of_nothing(void **state) {
    (void)state;
    fixture_empty(&f);
    json_t *root = reread();
    assert_json(
        json_object_get(root, "throughput"),
        "{\"wafers_per_hour\": null, \"reason\": \"there is no cell\", \"wafers\": 0, \"seconds\": 0.0, "
        "\"first_cycle\": null, \"last_cycle\": null, \"puts\": 0, \"counting\": []}");
    assert_json(json_object_get(root, "gantt"), "[]");
    assert_json(json_object_get(root, "reach"), "[]");
    json_decref(root);
}

/* The library's wh_status_text leaves out what only the program answers. */
static void every_status_has_its_text(void **state) {
    (void)state;
#define WH_STATUS(number, name, text) assert_string_equal(wh_record_error_text(WH_STATUS_##name), text);
#include "math/status.def"
#undef WH_STATUS
    assert_string_equal(wh_record_error_text((wh_status_t)255), "unknown status");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gantt_shows_the_commands),
        cmocka_unit_test(gantt_in_ascii),
        cmocka_unit_test(gantt_at_any_width),
        cmocka_unit_test(gantt_of_a_window),
        cmocka_unit_test(steady_cycles_by_themselves),
        cmocka_unit_test(times),
        cmocka_unit_test(sections_are_asked_for),
        cmocka_unit_test(wafers_per_hour_are_counted),
        cmocka_unit_test(margins),
        cmocka_unit_test(json_sums),
        cmocka_unit_test(json_gantt),
        cmocka_unit_test(json_reach),
        cmocka_unit_test(every_status_has_its_text),
        cmocka_unit_test(json_of_nothing),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
